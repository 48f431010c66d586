//! What a run drew, kept for the next: an experiment that nothing has changed is not drawn again.
//!
//! Nothing has changed where the program file, the text of the case, what theory predicts (which a
//! field's data files enter), the seed, the numbers of draws and the levels of the gate are the same.
//! Then the same draws would be made again, bit for bit, and the same decisions. Experiments of which
//! theory does not know the moments are always drawn: what it predicts would not tell one data file
//! from another.

use std::collections::BTreeMap;

use fearless_simd::Level;
use serde::{Deserialize, Serialize};

use crate::draw::drawn::{Drawn, Draws};
use crate::plan::{Plan, Planned, PlannedCase};

use numeric::pack;
use numeric::rng::{hash, name_hash};

/// What is kept: experiments by what they are made of. Without a program nothing is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Cache {
    /// The fingerprint of the program's file.
    program: String,
    experiments: BTreeMap<u64, Drawn>,
    /// Whether all is to be drawn anew, whatever is kept.
    #[serde(skip)]
    pub is_fresh: bool,
}

/// More experiments than this are not kept: a file of some 20 MB.
const MOST: usize = 2000;

impl Cache {
    /// Nothing yet, drawn by a program of that fingerprint.
    pub fn new(program: &str) -> Self {
        Self { program: program.to_owned(), ..Self::default() }
    }

    /// What the same program wrote with [`Cache::bytes`]. What another one wrote, and what is broken,
    /// is as good as nothing.
    pub fn read(bytes: &[u8], program: &str) -> Self {
        let (content, digest) = bytes.split_at(bytes.len().saturating_sub(size_of::<u64>()));
        let is_whole = digest == hash(content).to_le_bytes();
        let kept = if is_whole { postcard::from_bytes(content).ok() } else { None };
        kept.filter(|kept: &Self| kept.program == program).unwrap_or_else(|| Self::new(program))
    }

    /// The content of a file; `None` where it cannot be encoded.
    pub fn bytes(&self) -> Option<Vec<u8>> {
        let mut bytes = postcard::to_stdvec(self).ok()?;
        bytes.extend(hash(&bytes).to_le_bytes());
        Some(bytes)
    }

    /// What an experiment drew.
    pub fn drawn(&self, plan: &Plan, case: &PlannedCase, planned: &Planned) -> Option<Drawn> {
        if self.is_fresh || self.experiments.is_empty() {
            return None;
        }
        let drawn = self.experiments.get(&self.key(plan, case, planned)?)?;
        (drawn.totals.len() == planned.questions.len())
            .then(|| Drawn { is_reused: true, ..drawn.clone() })
    }

    /// How many of a plan's experiments need not be drawn, of how many that can be.
    pub fn count(&self, plan: &Plan) -> [usize; 2] {
        let ready = || plan.experiments().filter(|(_, planned)| planned.outcome.is_ok());
        let kept = ready().filter(|(case, planned)| self.drawn(plan, case, planned).is_some());
        [kept.count(), ready().count()]
    }

    /// Keeps what a plan drew, unless a limit of time or of draws cut it short. Where that would be too
    /// many, those of earlier runs go.
    pub fn keep(&mut self, plan: &Plan, draws: &Draws) {
        if draws.cut_by_time || draws.cut_by_budget {
            return;
        }
        if self.experiments.len() + plan.experiments().count() > MOST {
            self.experiments.clear();
        }
        for (case, drawn) in plan.cases.iter().zip(&draws.cases) {
            for (planned, drawn) in case.experiments.iter().zip(drawn) {
                if let Some(key) = self.key(plan, case, planned) {
                    self.experiments.insert(key, drawn.clone());
                }
            }
        }
    }

    /// Everything that draws and decisions depend on; `None` where that cannot be told.
    fn key(&self, plan: &Plan, case: &PlannedCase, planned: &Planned) -> Option<u64> {
        let channels = planned.outcome.as_ref().ok()?.prediction.channels.iter();
        let predicted: Option<Vec<_>> =
            channels.map(|channel| Some((channel.truth, channel.mean, channel.moments?))).collect();
        let predicted = predicted?;
        let asked: Vec<_> = planned.questions.iter().map(|q| (&q.check, q.channel)).collect();
        let numbers = (planned.draws, planned.fixed, planned.horizon, plan.options.fixed);
        let numbers = (numbers, plan.options.blocks_per_look);
        let made_of =
            (&self.program, pack::word(Level::new()), case.case.digest, planned.variation);
        let drawn_by = (planned.address, planned.shared, planned.expect_biased, numbers);
        let levels = plan.levels;
        Some(name_hash(&format!("{made_of:?} {drawn_by:?} {predicted:?} {asked:?} {levels:?}")))
    }
}
