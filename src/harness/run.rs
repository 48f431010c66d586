//! Drawing until every question is decided: looks at fixed places, blocks in the order of addresses.
//!
//! ```text
//! looks after 1, 2, 3, … blocks, growing by 1.15, and at the horizon
//! ```
//!
//! A look uses exactly the blocks up to it. Blocks that other threads drew ahead wait for their
//! look, and are discarded if it never comes: what is decided does not depend on the threads. In
//! each round every open experiment gets the blocks to its next look, in the order of the cases;
//! what a decided experiment saves goes to those that are open.

use std::collections::VecDeque;
use std::time::Instant;

use super::cache::Cache;
use super::checks::Kind;
use super::draw::{self, Block};
use super::drawn::{Drawn, Draws, Total};
use super::plan::{BLOCK, Plan, Planned};
use crate::numeric::parallel;
use crate::stats::gate::Decision;

/// Blocks drawn between two merges; results do not depend on it.
const BATCH: usize = 256;

/// An experiment that is being drawn.
struct Running<'p> {
    case: usize,
    index: usize,
    planned: &'p Planned,
    drawn: Drawn,
    /// How many blocks are merged.
    blocks: u64,
    /// After how many blocks the next look comes.
    look: u64,
    /// Blocks drawn ahead of the next look.
    ahead: VecDeque<Block>,
    is_done: bool,
}

/// Draws a plan; `progress` is told after each block how many draws it made.
pub fn draw(plan: &Plan, progress: &(dyn Fn(u64) + Sync)) -> Draws {
    draw_uncached(plan, &Cache::default(), progress)
}

/// Draws what an earlier run has not drawn already.
pub fn draw_uncached(plan: &Plan, cache: &Cache, progress: &(dyn Fn(u64) + Sync)) -> Draws {
    let begin = Instant::now();
    let expired =
        || plan.options.seconds.is_some_and(|limit| begin.elapsed().as_secs_f64() >= limit);
    let (mut cases, mut running) = begin_all(plan, cache);
    let mut budget = plan.options.budget;
    let (mut cut_by_time, mut cut_by_budget) = (false, false);
    while !cut_by_time && running.iter().any(|one| !one.is_done) {
        // What others need for their fixed draws is not taken from them.
        let mut reserved: u64 = running.iter().map(Running::reserve).sum();
        for one in running.iter_mut().filter(|one| !one.is_done) {
            reserved -= one.reserve();
            if take(&mut budget, one.stage(), reserved) {
                reserved += one.reserve().saturating_sub(one.stage());
            } else {
                (one.is_done, cut_by_budget) = (true, true);
            }
        }
        for units in units(&running).chunks(BATCH) {
            let drawn: Vec<Vec<Option<Block>>> = parallel::map(units, |unit| {
                let drawn = if expired() { Vec::new() } else { unit.draw(&running) };
                progress(drawn.iter().flatten().map(|block| block.draws).sum());
                drawn
            });
            let drawn = units.iter().zip(drawn).flat_map(|(unit, blocks)| {
                let blocks = blocks.into_iter().chain(std::iter::repeat_with(|| None));
                unit.running.iter().copied().zip(blocks)
            });
            for (one, block) in drawn {
                // What comes after a missing block is left out: the first blocks are kept.
                match block {
                    Some(block) if !cut_by_time => running[one].ahead.push_back(block),
                    _ => cut_by_time = true,
                }
                running[one].merge();
            }
        }
        for one in running.iter_mut().filter(|one| !one.is_done) {
            // Blocks drawn ahead of an earlier look may be all that this one waits for.
            one.merge();
            one.look(plan);
        }
    }
    for one in running {
        cases[one.case][one.index] = one.drawn;
    }
    for (drawn, planned_case) in cases.iter_mut().zip(&plan.cases) {
        for index in 0..drawn.len() {
            if let Some(twin) = planned_case.twin(index) {
                drawn[index] = drawn[twin].clone();
            }
        }
    }
    Draws { cases, cut_by_time, cut_by_budget }
}

/// Takes draws from the budget, if there is one and it has them beside those that are reserved.
fn take(budget: &mut Option<u64>, draws: u64, reserved: u64) -> bool {
    let enough = |left: &u64| *left >= reserved;
    let left = budget.map(|left| left.checked_sub(draws).filter(enough));
    match left {
        Some(None) => false,
        Some(left) => {
            *budget = left;
            true
        }
        None => true,
    }
}

/// What is drawn already, and those that are still to be drawn.
fn begin_all<'p>(plan: &'p Plan, cache: &Cache) -> (Vec<Vec<Drawn>>, Vec<Running<'p>>) {
    let mut cases: Vec<Vec<Drawn>> =
        plan.cases.iter().map(|case| vec![Drawn::default(); case.experiments.len()]).collect();
    let mut running = Vec::new();
    for (case, planned_case) in plan.cases.iter().enumerate() {
        for (index, planned) in planned_case.experiments.iter().enumerate() {
            if planned.outcome.is_err() || planned_case.twin(index).is_some() {
                continue;
            }
            if let Some(drawn) = cache.drawn(plan, planned_case, planned) {
                cases[case][index] = drawn;
                continue;
            }
            running.push(Running {
                case,
                index,
                planned,
                drawn: Drawn::new(planned),
                blocks: 0,
                look: 1,
                ahead: VecDeque::new(),
                is_done: false,
            });
        }
    }
    (cases, running)
}

/// A block of an experiment, or of several that share their lookups.
struct Unit {
    block: u64,
    running: Vec<usize>,
}

impl Unit {
    fn draw(&self, running: &[Running]) -> Vec<Option<Block>> {
        let group: Vec<&Planned> = self.running.iter().map(|&one| running[one].planned).collect();
        draw::blocks(&group, self.block)
    }
}

/// The blocks up to the next look of every open experiment, block by block so that a time limit
/// cuts all alike; and further ones while there are too few to keep all threads at work.
fn units(running: &[Running]) -> Vec<Unit> {
    let enough = 4 * rayon::current_num_threads();
    let open = || running.iter().enumerate().filter(|(_, one)| !one.is_done);
    let drawn = |one: &Running| one.blocks + one.ahead.len() as u64;
    let mut until: Vec<u64> = running.iter().map(|one| one.look.max(drawn(one))).collect();
    let blocks = |until: &[u64]| -> Vec<(u64, usize)> {
        open().flat_map(|(i, one)| (drawn(one)..until[i]).map(move |b| (b, i))).collect()
    };
    let missing = |until: &[u64]| grouped(running, blocks(until)).len();
    // Only where a look waits for blocks is there anything to draw.
    if missing(&until) > 0 {
        while missing(&until) < enough {
            let longer: Vec<u64> = running
                .iter()
                .zip(&until)
                .map(|(one, &until)| next_look(until, one.last()))
                .collect();
            if longer == until {
                break;
            }
            until = longer;
        }
    }
    grouped(running, blocks(&until))
}

/// The blocks as units of work: those of experiments that share their lookups are one.
fn grouped(running: &[Running], mut blocks: Vec<(u64, usize)>) -> Vec<Unit> {
    let company = |&(block, i): &(u64, usize)| {
        let one = &running[i];
        let shared = one.planned.shared.map(|shared| (one.case, shared.experiment));
        // Nobody else has this address.
        (block, shared.is_none().then_some(i), shared)
    };
    blocks.sort_by_key(|unit| (company(unit), unit.1));
    let groups = blocks.chunk_by(|a, b| company(a) == company(b));
    let unit = |group: &[(u64, usize)]| Unit {
        block: group[0].0,
        running: group.iter().map(|member| member.1).collect(),
    };
    groups.map(unit).collect()
}

/// The look after one at `blocks`.
fn next_look(blocks: u64, last: u64) -> u64 {
    (blocks + 1).max(blocks * 115 / 100).min(last)
}

impl Running<'_> {
    /// The last look.
    fn last(&self) -> u64 {
        self.planned.horizon.div_ceil(BLOCK)
    }

    /// The draws up to the next look.
    fn stage(&self) -> u64 {
        (self.look * BLOCK).min(self.planned.horizon) - self.drawn.draws
    }

    /// The draws that are still to come up to the fixed number, in whole blocks.
    fn reserve(&self) -> u64 {
        if self.is_done {
            return 0;
        }
        let fixed = self.planned.fixed.div_ceil(BLOCK) * BLOCK;
        fixed.min(self.planned.horizon).saturating_sub(self.drawn.draws)
    }

    /// Merges what was drawn, up to the next look.
    fn merge(&mut self) {
        while self.blocks < self.look {
            let Some(block) = self.ahead.pop_front() else { return };
            self.drawn.merge(&block, self.blocks);
            self.blocks += 1;
        }
    }

    /// Decides what can be decided, and whether to go on.
    fn look(&mut self, plan: &Plan) {
        let planned = self.planned;
        let draws = self.drawn.draws;
        let mut is_open = draws < planned.fixed;
        for (question, total) in planned.questions.iter().zip(&mut self.drawn.totals) {
            let (Kind::Scalar(scalar), Total::Gate(state)) = (&question.kind, total) else {
                continue;
            };
            if state.decision == Decision::Open {
                let sums = state.psi.map(|sum| sum.value());
                state.mean = state.y.value() / draws as f64;
                state.evidence = scalar.design.evidence(sums, draws as f64);
                state.draws = draws;
                let levels = &plan.levels;
                let level = if question.expects_bias { levels.ln_biased } else { levels.ln_fail };
                state.decision = state.evidence.decision(level, levels.ln_pass);
                if state.decision == Decision::Passed && scalar.underpowered.is_some() {
                    state.decision = Decision::Open;
                }
            }
            let was_promised = scalar.underpowered.is_none() || draws < planned.draws;
            is_open |= state.decision == Decision::Open && was_promised;
        }
        let is_over = draws >= planned.horizon || self.has_failed(plan);
        self.is_done = is_over || (!is_open && !plan.options.fixed);
        self.look = next_look(self.look, self.last());
    }

    /// Whether the one check that matters has failed.
    fn has_failed(&self, plan: &Plan) -> bool {
        let Some(name) = &plan.options.until_failed else { return false };
        let both = self.planned.questions.iter().zip(&self.drawn.totals);
        both.filter(|(question, _)| question.check == *name).any(|(question, total)| {
            match (&question.kind, total) {
                (_, Total::Gate(state)) => state.decision == Decision::Failed,
                (Kind::Always(always), Total::Largest(largest, _)) => {
                    largest.is_nan() || *largest > always.bound
                }
                _ => false,
            }
        })
    }
}
