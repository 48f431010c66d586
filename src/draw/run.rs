//! Drawing until every question is decided: looks at fixed places, blocks in the order of addresses.
//!
//! ```text
//! looks after 1, 2, 3, … blocks, growing by 1.15, and at the horizon
//! ```
//!
//! With `--blocks-per-look K` a block here is K blocks of 2¹⁴ draws, merged by whoever draws them.
//!
//! A look uses exactly the blocks up to it. Blocks that other threads drew ahead wait for their
//! look, and are discarded if it never comes: what is decided does not depend on the threads. In
//! each round every open experiment gets the blocks to its next look, in the order of the cases;
//! what a decided experiment saves goes to those that are open.

use std::collections::{BTreeMap, VecDeque};
use std::convert::Infallible;
use std::time::Instant;

use crate::checks::check::Look;
use crate::draw::block::Block;
use crate::draw::drawn::{Drawn, Draws, Standing};
use crate::draw::progress::{self, Listener, Progress, Step};
use crate::draw::share::{self, Piece, Share};
use crate::draw::store::Store;
use crate::draw::workers::Drawing;
use crate::plan::{BLOCK, Plan, Planned};
use ::gate::session::{Sink, Until, drive};
use ::gate::stats::gate;

/// Blocks drawn between two merges, for each thread, and at most: some 600 MB. Results do not depend on it.
const BATCH: usize = 256;
const MOST: usize = 1 << 16;

/// An experiment that is being drawn.
struct Running<'p> {
    case: usize,
    index: usize,
    /// Its number through the plan.
    number: u32,
    planned: &'p Planned,
    /// How many draws are merged as one block.
    step: u64,
    /// What is merged and decided.
    at: Standing,
    /// Blocks drawn ahead of the next look.
    ahead: VecDeque<Block>,
}

/// All experiments that are being drawn, round by round.
struct Rounds<'p> {
    running: Vec<Running<'p>>,
}

impl Sink for Rounds<'_> {
    fn draws(&self) -> u64 {
        self.running.iter().map(|one| one.at.drawn.draws).sum()
    }

    fn is_open(&self) -> bool {
        self.running.iter().any(|one| !one.at.is_done)
    }
}

/// Draws a plan; `progress` is called after each block with the number of its draws.
pub fn draw(plan: &Plan, progress: &(dyn Fn(u64) + Sync)) -> Draws {
    draw_with(plan, &Store::default(), progress)
}

/// Draws what a store does not have; the store keeps the blocks, and can end the drawing.
pub fn draw_with(plan: &Plan, store: &Store, progress: &(dyn Fn(u64) + Sync)) -> Draws {
    draw_heard(plan, store, &|step| match step {
        Step::Drawn(draws) | Step::Kept(draws) if draws > 0 => progress(draws),
        _ => {}
    })
}

/// Draws what a store does not have; `listen` hears of every step.
pub fn draw_heard(plan: &Plan, store: &Store, listen: &Listener) -> Draws {
    let begin = Instant::now();
    let is_late =
        || plan.options.seconds.is_some_and(|limit| begin.elapsed().as_secs_f64() >= limit);
    let is_over = || is_late() || store.is_stopped();
    let drawing = Drawing::new(plan, &is_over);
    let (mut cases, running) = begin_all(plan, store);
    let mut rounds = Rounds { running };
    let progress = Progress::new(plan, listen);
    let listen = |step| progress.hear(step);
    // What a run before had merged.
    progress.keep(rounds.running.iter().map(|one| one.at.drawn.draws));
    progress.expect(rounds.running.iter().map(Running::expected));
    let mut budget = plan.options.budget;
    let (mut cut_by_time, mut cut_by_budget) = (false, false);
    let until = Until { most: None, is_decided: true };
    let Ok::<_, Infallible>(_) = drive(&mut rounds, until, |Rounds { running }, _| {
        // What others need for their fixed draws is not taken from them.
        let mut reserved: u64 = running.iter().map(Running::reserve).sum();
        for one in running.iter_mut().filter(|one| !one.at.is_done) {
            reserved -= one.reserve();
            if take(&mut budget, one.stage(), reserved) {
                reserved += one.reserve().saturating_sub(one.stage());
            } else {
                (one.at.is_done, cut_by_budget) = (true, true);
            }
        }
        let mut round = Round::new(running, 4 * store.workers.threads());
        while !cut_by_time {
            let units = batch(&mut round, store, |unit| unit.running.len());
            if units.is_empty() {
                break;
            }
            let pieces: Vec<Piece> = units.iter().map(|unit| unit.piece(running)).collect();
            let drawn = store.blocks(&pieces, &drawing, &listen);
            let members = units.iter().flat_map(|unit| &unit.running);
            for (&one, block) in members.zip(drawn) {
                // What comes after a missing block is left out: the first blocks are kept.
                match block {
                    Some(block) if !cut_by_time => running[one].ahead.push_back(block),
                    _ => cut_by_time = true,
                }
                running[one].merge();
            }
            if !cut_by_time {
                store.shorten(running.iter().map(|one| (one.number, &one.at)));
            }
        }
        for one in running.iter_mut().filter(|one| !one.at.is_done) {
            // Blocks drawn ahead of an earlier look may be all that this one waits for.
            one.merge();
            one.look(plan);
        }
        progress.expect(running.iter().map(Running::expected));
        Ok(!cut_by_time)
    });
    store.synchronise();
    for one in rounds.running {
        cases[one.case][one.index] = one.at.drawn;
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

/// Draws a share of a plan into the file of a store, without a look at it; whether all of it is there.
pub fn draw_share(plan: &Plan, share: Share, store: &Store, listen: &Listener) -> bool {
    let is_over = || store.is_stopped();
    let drawing = Drawing::new(plan, &is_over);
    let mut pieces = share::pieces(plan, share);
    loop {
        let some = batch(&mut pieces, store, |piece| piece.experiments.len());
        if some.is_empty() || store.is_stopped() {
            store.synchronise();
            return !store.is_stopped();
        }
        store.blocks(&some, &drawing, listen);
    }
}

/// What is drawn until the next merge; an item is so many blocks.
fn batch<T>(
    items: &mut impl Iterator<Item = T>,
    store: &Store,
    blocks: impl Fn(&T) -> usize,
) -> Vec<T> {
    let most = (BATCH * store.workers.threads()).min(MOST);
    let (mut some, mut sum) = (Vec::new(), 0);
    while sum < most {
        let Some(item) = items.next() else { break };
        sum += blocks(&item);
        some.push(item);
    }
    some
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
fn begin_all<'p>(plan: &'p Plan, store: &Store) -> (Vec<Vec<Drawn>>, Vec<Running<'p>>) {
    let mut cases: Vec<Vec<Drawn>> =
        plan.cases.iter().map(|case| vec![Drawn::default(); case.experiments.len()]).collect();
    let mut running = Vec::new();
    let mut numbers = 0..;
    for (case, planned_case) in plan.cases.iter().enumerate() {
        for ((index, planned), number) in
            planned_case.experiments.iter().enumerate().zip(&mut numbers)
        {
            if planned.outcome.is_err() || planned_case.twin(index).is_some() {
                continue;
            }
            let at = store.standing(number, planned).unwrap_or_else(|| Standing::new(planned));
            if at.drawn.is_reused {
                cases[case][index] = at.drawn;
                continue;
            }
            let (step, ahead) = (plan.step(), VecDeque::new());
            running.push(Running { case, index, number, planned, step, at, ahead });
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
    fn piece(&self, running: &[Running]) -> Piece {
        let experiments = self.running.iter().map(|&one| running[one].number).collect();
        Piece { experiments, block: self.block }
    }
}

/// The blocks from one number up to another of one that is running.
#[derive(Clone)]
struct Span {
    running: usize,
    from: u64,
    until: u64,
}

/// The blocks up to the next look of every open experiment, block by block so that a time limit cuts all
/// alike. They are made one by one: those between two looks may be more than memory holds.
#[derive(Clone)]
struct Round {
    /// Those that share their lookups are one.
    companies: Vec<Vec<Span>>,
    /// The next unit.
    block: u64,
    company: usize,
    /// Beyond the last.
    end: u64,
}

impl Round {
    /// The blocks up to the next looks; and further ones while they are not `enough` to keep all threads at work.
    fn new(running: &[Running], enough: usize) -> Self {
        let drawn = |one: &Running| one.at.blocks + one.ahead.len() as u64;
        let mut until: Vec<u64> = running.iter().map(|one| one.at.look.max(drawn(one))).collect();
        loop {
            let mut companies = BTreeMap::<_, Vec<Span>>::new();
            for (i, one) in running.iter().enumerate().filter(|(_, one)| !one.at.is_done) {
                let shared = one.planned.shared.map(|shared| (one.case, shared.experiment));
                // Nobody else has this address.
                let company = companies.entry((shared.is_none().then_some(i), shared)).or_default();
                company.push(Span { running: i, from: drawn(one), until: until[i] });
            }
            let companies: Vec<Vec<Span>> = companies.into_values().collect();
            let spans = || companies.iter().flatten();
            let block = spans().map(|span| span.from).min().unwrap_or(0);
            let end = spans().map(|span| span.until).max().unwrap_or(0);
            let round = Self { companies, block, company: 0, end };
            let missing = round.clone().take(enough).count();
            // Only where a look waits for blocks is there anything to draw.
            if missing == 0 || missing == enough {
                return round;
            }
            let both = running.iter().zip(&until);
            let longer: Vec<u64> =
                both.map(|(one, &until)| gate::next_look(until).min(one.last())).collect();
            if longer == until {
                return round;
            }
            until = longer;
        }
    }
}

impl Iterator for Round {
    type Item = Unit;

    fn next(&mut self) -> Option<Unit> {
        while self.block < self.end {
            while let Some(company) = self.companies.get(self.company) {
                self.company += 1;
                let there = |span: &&Span| (span.from..span.until).contains(&self.block);
                let running: Vec<usize> =
                    company.iter().filter(there).map(|span| span.running).collect();
                if !running.is_empty() {
                    return Some(Unit { block: self.block, running });
                }
            }
            (self.block, self.company) = (self.block + 1, 0);
        }
        None
    }
}

impl Running<'_> {
    /// The last look.
    fn last(&self) -> u64 {
        self.planned.horizon.div_ceil(self.step)
    }

    /// The draws that it is expected to make in all, those ahead of a look that never comes with them.
    fn expected(&self) -> u64 {
        let ahead: u64 = self.ahead.iter().map(|block| block.draws).sum();
        let made = self.at.drawn.draws + ahead;
        let look = (self.at.look * self.step).min(self.planned.horizon);
        if self.at.is_done { made } else { made.max(look).max(progress::expected(self.planned)) }
    }

    /// The draws up to the next look.
    fn stage(&self) -> u64 {
        (self.at.look * self.step).min(self.planned.horizon) - self.at.drawn.draws
    }

    /// The draws that are still to come up to the fixed number, in whole blocks.
    fn reserve(&self) -> u64 {
        if self.at.is_done {
            return 0;
        }
        let fixed = self.planned.fixed.div_ceil(self.step) * self.step;
        fixed.min(self.planned.horizon).saturating_sub(self.at.drawn.draws)
    }

    /// Merges what was drawn, up to the next look.
    fn merge(&mut self) {
        while self.at.blocks < self.at.look {
            let Some(block) = self.ahead.pop_front() else { return };
            let number = self.at.blocks * (self.step / BLOCK);
            self.at.drawn.merge(self.planned, &block, number);
            self.at.blocks += 1;
        }
    }

    /// Decides what can be decided, and whether to go on.
    fn look(&mut self, plan: &Plan) {
        let planned = self.planned;
        let draws = self.at.drawn.draws;
        let mut is_open = draws < planned.fixed;
        for (question, total) in planned.questions.iter().zip(&mut self.at.drawn.totals) {
            let levels = plan.levels.of(question.expects_bias);
            is_open |= question.answer.look(total, Look { draws, planned: planned.draws, levels });
        }
        let is_over = draws >= planned.horizon || self.has_failed(plan);
        self.at.is_done = is_over || (!is_open && !plan.options.fixed);
        self.at.look = gate::next_look(self.at.look).min(self.last());
    }

    /// Whether the one check that matters has failed.
    fn has_failed(&self, plan: &Plan) -> bool {
        let Some(name) = &plan.options.until_failed else { return false };
        let both = self.planned.questions.iter().zip(&self.at.drawn.totals);
        both.filter(|(question, _)| question.check == *name)
            .any(|(question, total)| question.answer.has_failed(total))
    }
}
