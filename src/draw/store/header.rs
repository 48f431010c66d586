//! Description of what was drawn: the header of every log, and the keys of experiments.

use serde::{Deserialize, Serialize};

use crate::draw::share::Share;
use crate::plan::{Plan, PlannedCase, PlannedExperiment};
use estimators::DrawBuffer;
use numeric::rng::{hash, name_hash};
use theory::parallel;

/// Number of draws by which data files are distinguished.
const FIRST_DRAWS: usize = 256;

/// Everything that draws depend on.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// Version of the tool.
    pub version: String,
    /// Fingerprint of the program's file.
    pub program: String,
    /// Words of the command that asks for these draws.
    pub words: Vec<String>,
    /// Share of the run; `None` for a run's own log.
    pub share: Option<Share>,
    /// Cases of the plan.
    pub cases: Vec<CaseKeys>,
}

/// Name of a case, hash of its text, and one key per experiment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseKeys {
    name: String,
    text: u64,
    experiments: Vec<u64>,
}

impl Header {
    /// Describes the draws of this program for the plan of a command with these words.
    pub fn new(plan: &Plan, program: &str, words: &[String], share: Option<Share>) -> Self {
        let version = env!("CARGO_PKG_VERSION");
        let made_by = format!("{version} {program}");
        let cases = parallel::map(&plan.cases, |case| CaseKeys {
            name: case.case.name.clone(),
            text: case.case.digest,
            experiments: case
                .experiments
                .iter()
                .map(|one| key(plan, case, one, &made_by))
                .collect(),
        });
        let (version, program) = (version.to_owned(), program.to_owned());
        Self { version, program, words: words.to_owned(), share, cases }
    }

    /// Returns the keys of the experiments, in the order of the plan.
    pub fn keys(&self) -> Vec<u64> {
        self.cases.iter().flat_map(|case| case.experiments.iter().copied()).collect()
    }

    /// Returns why draws of `self` cannot be joined with those of `expected`; `None` if they can.
    pub fn mismatch(&self, expected: &Self) -> Option<String> {
        let beyond = |these: &Self, others: &Self| {
            let new = these.words.iter().filter(|word| !others.words.contains(word));
            let new: Vec<&str> = new.map(String::as_str).collect();
            if new.is_empty() { "fewer options".to_owned() } else { new.join(" ") }
        };
        let pairs = [
            ("by version", self.version.clone(), expected.version.clone()),
            ("by the build", self.program.clone(), expected.program.clone()),
            ("with", beyond(self, expected), beyond(expected, self)),
        ];
        if let Some((what, this, other)) = pairs.iter().find(|(_, this, other)| this != other) {
            return Some(format!("it was drawn {what} {this}, not {other}"));
        }
        if self.cases.len() != expected.cases.len() || self.words != expected.words {
            return Some("it has other cases or options, or the same in another order".to_owned());
        }
        let mut both = self.cases.iter().zip(&expected.cases);
        both.find(|(this, other)| this != other).map(|(this, other)| {
            let what = match (this.name == other.name, this.text == other.text) {
                (false, _) => "another name",
                (true, false) => "another text",
                (true, true) => "other data files",
            };
            format!("the case {} had {what} when it was drawn", other.name)
        })
    }
}

/// Returns a hash of everything that draws and decisions of an experiment depend on.
fn key(plan: &Plan, case: &PlannedCase, planned: &PlannedExperiment, made_by: &str) -> u64 {
    let requested: Vec<_> = planned.questions.iter().map(|q| (q.check, q.channel)).collect();
    let numbers = (planned.draws, planned.fixed, planned.horizon, planned.expect_biased);
    let predicted = planned.outcome.as_ref().ok().map(|ready| {
        let channels = ready.prediction.channels.iter();
        channels.map(|of| (of.truth, of.mean, of.moments)).collect::<Vec<_>>()
    });
    let place = (case.case.digest, &planned.id, planned.address);
    let looks = (plan.levels, plan.options.fixed, plan.options.blocks_per_look);
    let first = first_draws(planned);
    name_hash(&format!("{:?}", (made_by, place, numbers, requested, predicted, first, looks)))
}

/// Returns a hash of the first draws: they depend on more than the predictions, such as the order of equal voxels.
fn first_draws(planned: &PlannedExperiment) -> Option<u64> {
    let ready = planned.outcome.as_ref().ok()?;
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    ready.experiment.fill(&mut planned.streams(0), FIRST_DRAWS, &mut buffer);
    let values = buffer.values.iter().flatten().flat_map(|value| value.to_bits().to_le_bytes());
    let lookups = buffer.lookups.iter().flat_map(|lookups| lookups.to_le_bytes());
    Some(hash(&values.chain(lookups).collect::<Vec<u8>>()))
}
