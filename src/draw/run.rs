//! Drawing until every question is decided: looks at fixed places, blocks in the order of addresses.
//!
//! ```text
//! looks after 1, 2, 3, … blocks, growing by 1.15, and at the horizon
//! ```
//!
//! With `--blocks-per-look K` a block here is K blocks of 2¹⁴ draws, which are merged by the thread that draws them.
//!
//! A look uses exactly the blocks up to it. Blocks that other threads drew ahead are kept until their look, and are
//! discarded if it never comes: decisions do not depend on the number of threads. In each round every open experiment
//! gets the blocks to its next look, in the order of the cases. Draws that a decided experiment saves go to the open
//! ones.

use std::collections::{BTreeMap, VecDeque};
use std::convert::Infallible;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use crate::draw::block::{Block, Drawn, DrawnExperiment, Draws, Progress};
use crate::draw::share::{self, BlockName, Drawing, Share};
use crate::draw::store::Store;
use crate::plan::{Plan, PlannedExperiment};
use ::gate::session::{Sink, Until, drive};
use ::gate::stats::gate::{self, PLANNED, TYPICAL};
use ::gate::stats::verdict::BLOCK;
use checks::check::Look;

/// Blocks drawn between two merges, for each thread, and at most: some 600 MB. Results do not depend on it.
const BATCH: usize = 256;
const MAX_BATCH: usize = 1 << 16;

/// The last of k scalars passes later than one of them by this share of ln k, as measured on the built-in suite.
const LAST: f64 = 0.12;

/// Event of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Draws that this drawing is expected to make in all: an estimate that becomes exact at its end.
    Expected(u64),
    /// Draws were made.
    Drawn(u64),
    /// Draws of an earlier run were read; they are no part of [`Step::Expected`].
    Kept(u64),
}

/// Listener of a drawing.
pub type Listener<'a> = dyn Fn(Step) + Sync + 'a;

/// Draws a plan; `listen` is called at every step.
pub fn draw<'p>(plan: &'p Plan, listen: &Listener) -> Draws<'p> {
    draw_with(plan, &Store::default(), listen)
}

/// Draws what a store does not have; the store keeps the blocks, and can end the drawing.
pub fn draw_with<'p>(plan: &'p Plan, store: &Store, listen: &Listener) -> Draws<'p> {
    let begin = Instant::now();
    let is_late =
        || plan.options.seconds.is_some_and(|limit| begin.elapsed().as_secs_f64() >= limit);
    let is_over = || is_late() || store.is_stopped();
    let drawing = Drawing::new(plan, &is_over);
    let all = plan.experiments().map(|(case, planned)| {
        let drawn = Drawn::default();
        DrawnExperiment { case, planned, drawn }
    });
    let mut experiments: Vec<DrawnExperiment> = all.collect();
    let mut running = BTreeMap::new();
    for one in experiments.iter_mut().filter(|one| one.planned.is_drawn()) {
        let planned = one.planned;
        let at = store.progress(planned).unwrap_or_else(|| Progress::new(planned));
        if at.drawn.is_reused {
            one.drawn = at.drawn;
        } else {
            let (step, ahead) = (plan.step(), VecDeque::new());
            running.insert(planned.number, Running { planned, step, at, ahead });
        }
    }
    let mut rounds = Rounds(running);
    let kept = AtomicU64::new(0);
    let listen = |step| {
        if let Step::Kept(draws) = step {
            kept.fetch_add(draws, Ordering::Relaxed);
        }
        listen(step);
    };
    let expect = |Rounds(running): &Rounds| {
        let all: u64 = running.values().map(Running::expected).sum();
        let new = all.saturating_sub(kept.load(Ordering::Relaxed));
        listen(Step::Expected(plan.options.budget.map_or(new, |budget| new.min(budget))));
    };
    // Blocks that an earlier run had merged.
    listen(Step::Kept(rounds.draws()));
    expect(&rounds);
    let mut budget = plan.options.budget;
    let (mut cut_by_time, mut cut_by_budget) = (false, false);
    let until = Until { maximum: None, is_decided: true };
    let Ok::<_, Infallible>(_) = drive(&mut rounds, until, |rounds, _| {
        let Rounds(running) = rounds;
        // Draws that other experiments need up to their fixed numbers are reserved.
        let mut reserved: u64 = running.values().map(Running::reserve).sum();
        for one in running.values_mut().filter(|one| !one.at.is_done) {
            reserved -= one.reserve();
            if take(&mut budget, one.stage(), reserved) {
                reserved += one.reserve().saturating_sub(one.stage());
            } else {
                (one.at.is_done, cut_by_budget) = (true, true);
            }
        }
        let mut round = Round::new(running, 4 * store.workers.threads());
        while !cut_by_time {
            let names = batch(&mut round, store);
            if names.is_empty() {
                break;
            }
            let mut drawn = store.blocks(&names, &drawing, &listen);
            for name in names {
                let Some(one) = running.get_mut(&name.0) else { continue };
                // Blocks behind a missing one are left out: the kept blocks are the first ones.
                match drawn.remove(&name) {
                    Some(block) if !cut_by_time => one.ahead.push_back(block),
                    _ => cut_by_time = true,
                }
                one.merge();
            }
            if !cut_by_time {
                store.shorten(running.iter().map(|(&number, one)| (number, &one.at)));
            }
        }
        for one in running.values_mut().filter(|one| !one.at.is_done) {
            // Blocks drawn ahead of an earlier look may complete this one.
            one.merge();
            one.look(plan);
        }
        expect(rounds);
        Ok(!cut_by_time)
    });
    store.synchronise();
    for (number, one) in rounds.0 {
        experiments[number as usize].drawn = one.at.drawn;
    }
    for index in 0..experiments.len() {
        let Some(id) = &experiments[index].planned.same_as else { continue };
        let same = experiments.iter().find(|other| other.planned.id == *id);
        if let Some(drawn) = same.map(|other| other.drawn.clone()) {
            experiments[index].drawn = drawn;
        }
    }
    Draws { experiments, cut_by_time, cut_by_budget }
}

/// Draws a share of a plan into the file of a store, without looks. Returns whether the share is complete.
pub fn draw_share(plan: &Plan, share: Share, store: &Store, listen: &Listener) -> bool {
    let is_over = || store.is_stopped();
    let drawing = Drawing::new(plan, &is_over);
    let mut names = share::blocks(plan, share);
    loop {
        let some = batch(&mut names, store);
        if some.is_empty() || store.is_stopped() {
            store.synchronise();
            return !store.is_stopped();
        }
        store.blocks(&some, &drawing, listen);
    }
}

/// Returns the blocks to draw until the next merge.
fn batch(names: &mut impl Iterator<Item = BlockName>, store: &Store) -> Vec<BlockName> {
    names.take((BATCH * store.workers.threads()).min(MAX_BATCH)).collect()
}

/// Takes draws from the budget; false if it has too few beside those that are reserved.
fn take(budget: &mut Option<u64>, draws: u64, reserved: u64) -> bool {
    let Some(all) = *budget else { return true };
    let left = all.checked_sub(draws).filter(|left| *left >= reserved);
    *budget = left.or(*budget);
    left.is_some()
}

/// All experiments that are being drawn, by their numbers, round by round.
struct Rounds<'p>(BTreeMap<u32, Running<'p>>);

impl Sink for Rounds<'_> {
    fn draws(&self) -> u64 {
        self.0.values().map(|one| one.at.drawn.draws).sum()
    }

    fn is_open(&self) -> bool {
        self.0.values().any(|one| !one.at.is_done)
    }
}

/// Blocks from one number up to another of one experiment.
#[derive(Clone)]
struct Span {
    experiment: u32,
    from: u64,
    until: u64,
    /// Number of the block at the last look.
    last: u64,
}

/// Blocks up to the next look of every open experiment, block by block, so that a time limit affects all equally. They
/// are generated one by one: those between two looks may be more than memory holds.
#[derive(Clone)]
struct Round {
    spans: Vec<Span>,
    /// The next block, and the place of its experiment.
    block: u64,
    span: usize,
    /// End of the blocks, exclusive.
    end: u64,
}

impl Round {
    /// Returns the blocks up to the next looks, and further ones until there are `enough` to keep all threads at work.
    fn new(running: &BTreeMap<u32, Running>, enough: usize) -> Self {
        let span = |one: &Running| {
            let from = one.at.blocks + one.ahead.len() as u64;
            Span {
                experiment: one.planned.number,
                from,
                until: one.at.look.max(from),
                last: one.last(),
            }
        };
        let spans: Vec<Span> = running.values().filter(|one| !one.at.is_done).map(span).collect();
        let block = spans.iter().map(|span| span.from).min().unwrap_or(0);
        let mut round = Self { spans, block, span: 0, end: 0 };
        loop {
            round.end = round.spans.iter().map(|span| span.until).max().unwrap_or(0);
            let missing = round.clone().take(enough).count();
            // Only looks that miss blocks need draws.
            if missing == 0 || missing == enough {
                return round;
            }
            let mut is_longer = false;
            for span in &mut round.spans {
                let longer = gate::next_look(span.until).min(span.last);
                is_longer |= longer != span.until;
                span.until = longer;
            }
            if !is_longer {
                return round;
            }
        }
    }
}

impl Iterator for Round {
    type Item = BlockName;

    fn next(&mut self) -> Option<BlockName> {
        while self.block < self.end {
            while let Some(span) = self.spans.get(self.span) {
                self.span += 1;
                if (span.from..span.until).contains(&self.block) {
                    return Some((span.experiment, self.block));
                }
            }
            (self.block, self.span) = (self.block + 1, 0);
        }
        None
    }
}

/// Experiment that is being drawn.
struct Running<'p> {
    planned: &'p PlannedExperiment,
    /// Number of draws that are merged as one block.
    step: u64,
    /// Merged blocks and decisions so far.
    at: Progress,
    /// Blocks drawn ahead of the next look.
    ahead: VecDeque<Block>,
}

impl Running<'_> {
    /// Returns the number of blocks at the last look.
    fn last(&self) -> u64 {
        self.planned.horizon.div_ceil(self.step)
    }

    /// Returns the number of draws at the next look.
    fn until(&self) -> u64 {
        (self.at.look * self.step).min(self.planned.horizon)
    }

    /// Returns the number of draws that it is expected to make in all, draws ahead of a look that never comes included.
    fn expected(&self) -> u64 {
        let ahead: u64 = self.ahead.iter().map(|block| block.draws).sum();
        let made = self.at.drawn.draws + ahead;
        if self.at.is_done { made } else { made.max(self.until()).max(expected(self.planned)) }
    }

    /// Returns the number of draws up to the next look.
    fn stage(&self) -> u64 {
        self.until() - self.at.drawn.draws
    }

    /// Returns the number of draws that are still to be made up to the fixed number, in whole blocks.
    fn reserve(&self) -> u64 {
        if self.at.is_done {
            return 0;
        }
        let fixed = self.planned.fixed.div_ceil(self.step) * self.step;
        fixed.min(self.planned.horizon).saturating_sub(self.at.drawn.draws)
    }

    /// Merges drawn blocks, up to the next look.
    fn merge(&mut self) {
        while self.at.blocks < self.at.look {
            let Some(block) = self.ahead.pop_front() else { return };
            let number = self.at.blocks * (self.step / BLOCK);
            self.at.drawn.merge(self.planned, &block, number);
            self.at.blocks += 1;
        }
    }

    /// Decides every question that can be decided, and whether to go on.
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

    /// Returns whether the check that ends the drawing has failed.
    fn has_failed(&self, plan: &Plan) -> bool {
        let Some(check) = plan.options.until_failed else { return false };
        let both = self.planned.questions.iter().zip(&self.at.drawn.totals);
        both.filter(|(question, _)| question.check == check)
            .any(|(question, total)| question.answer.has_failed(total))
    }
}

/// Returns the number of draws that an experiment is expected to make. A correct scalar passes after 17/27 of its plan;
/// one that is not promised to pass keeps the drawing open until all planned draws are made.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of draws
fn expected(planned: &PlannedExperiment) -> u64 {
    if planned.horizon <= planned.draws {
        return planned.horizon;
    }
    let promised =
        planned.scalars().filter(|(_, scalar)| scalar.planned.underpowered.is_none()).count();
    let typical = TYPICAL / PLANNED * (1.0 + LAST * (promised.max(1) as f64).ln());
    let longest = planned.scalars().fold(planned.fixed, |longest, (_, scalar)| {
        let draws = match scalar.planned.underpowered {
            Some(_) => planned.draws,
            None => (scalar.planned.design.draws() * typical).ceil() as u64,
        };
        longest.max(draws)
    });
    (longest.div_ceil(BLOCK) * BLOCK).min(planned.horizon)
}
