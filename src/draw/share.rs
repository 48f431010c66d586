//! A run shared out: which blocks a part of it draws, and whether parts are of the same run.
//!
//! ```text
//! blocks, numbered through the experiments of the plan: number n belongs to part n mod N + 1 of N
//! ```
//!
//! A part cannot know when the gate decides, so it draws its share of all blocks up to the horizon.
//! Experiments that share their lookups count as one, so that a part draws them together.

use std::fmt;
use std::str::FromStr;

use fearless_simd::Level;
use serde::{Deserialize, Serialize};

use crate::plan::{Plan, Planned, PlannedCase};
use estimators::DrawBuffer;
use numeric::pack;
use numeric::rng::{hash, name_hash};
use theory::parallel;

/// How many draws tell one data file from another.
const FIRST: usize = 256;

/// A part of a run, `1/1` for the whole of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Which part, from 1.
    pub part: u32,
    /// Of how many.
    pub of: u32,
}

impl Share {
    /// All of a run.
    pub const WHOLE: Self = Self { part: 1, of: 1 };
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').map(|(part, of)| (part.parse(), of.parse()));
        match numbers {
            Some((Ok(part), Ok(of))) if (1..=of).contains(&part) && of <= 1_000_000 => {
                Ok(Self { part, of })
            }
            _ => Err("it takes a part and their number, such as 3/16".into()),
        }
    }
}

/// What a file of blocks is about: everything that its draws depend on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// The version of the tool.
    pub version: String,
    /// The fingerprint of the program's file.
    pub program: String,
    /// Whether its packs multiply and add in one rounding: machines that do make other bits than those that do not.
    pub is_fused: bool,
    /// The words of the command that ask for these draws.
    pub words: Vec<String>,
    /// Which part of them it is; nothing for a run's journal.
    pub share: Option<Share>,
    /// Each case with a hash of its text, and one of what is planned of it.
    pub cases: Vec<(String, u64, u64)>,
}

impl Header {
    /// What this program draws of a plan, asked by such words.
    pub fn new(plan: &Plan, program: &str, words: &[String], share: Option<Share>) -> Self {
        let case = |planned: &PlannedCase| {
            (planned.case.name.clone(), planned.case.digest, digest(plan, planned))
        };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            program: program.to_owned(),
            is_fused: pack::fuses(Level::new()),
            words: words.to_owned(),
            share,
            cases: parallel::map(&plan.cases, case),
        }
    }

    /// Why what is in `self` cannot go on, or go together, with what is expected.
    pub fn mismatch(&self, expected: &Self) -> Option<String> {
        let told = |what: &str, this: &str, other: &str| format!("{what} {this}, not {other}");
        if self.version != expected.version {
            return Some(told("it was drawn by version", &self.version, &expected.version));
        }
        if self.is_fused != expected.is_fused {
            let word = |is_fused| if is_fused { "fused" } else { "plain" };
            let (this, other) = (word(self.is_fused), word(expected.is_fused));
            return Some(told("it was drawn by arithmetic that is", this, other));
        }
        if self.program != expected.program {
            return Some(told("it was drawn by the build", &self.program, &expected.program));
        }
        if self.words != expected.words {
            let beyond = |these: &[String], others: &[String]| -> String {
                let new = these.iter().filter(|word| !others.contains(word));
                let new: Vec<&str> = new.map(String::as_str).collect();
                if new.is_empty() { "fewer options".to_owned() } else { new.join(" ") }
            };
            let (this, other) = (&self.words, &expected.words);
            return Some(told("it was drawn with", &beyond(this, other), &beyond(other, this)));
        }
        if self.cases.len() != expected.cases.len() {
            return Some("it has another number of cases".to_owned());
        }
        let changed = self.cases.iter().zip(&expected.cases).find(|(this, other)| this != other);
        changed.map(|(this, other)| {
            let what = match (this.0 == other.0, this.1 == other.1) {
                (false, _) => "another name",
                (true, false) => "another text",
                (true, true) => "other data files",
            };
            format!("the case {} had {what} when it was drawn", other.0)
        })
    }
}

/// A hash of everything that the draws of a case depend on beside its text.
fn digest(plan: &Plan, planned_case: &PlannedCase) -> u64 {
    let experiments = planned_case.experiments.iter().map(|planned| {
        let asked: Vec<_> = planned.questions.iter().map(|q| (&q.check, q.channel)).collect();
        let numbers = (planned.draws, planned.fixed, planned.horizon, planned.expect_biased);
        let predicted = planned.outcome.as_ref().ok().map(|ready| {
            let channels = ready.prediction.channels.iter();
            channels.map(|of| (of.truth, of.mean, of.moments)).collect::<Vec<_>>()
        });
        let first = first_draws(planned);
        format!("{:?}", (planned.address, planned.shared, numbers, asked, predicted, first))
    });
    let all: Vec<String> = experiments.collect();
    name_hash(&format!(
        "{all:?} {:?} {:?}",
        plan.levels,
        (plan.options.fixed, plan.options.blocks_per_look)
    ))
}

/// A hash of the first draws of an experiment: what they depend on is more than what theory predicts of it, such as
/// the order of equal voxels.
fn first_draws(planned: &Planned) -> Option<u64> {
    let ready = planned.outcome.as_ref().ok()?;
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    ready.experiment.fill(&mut planned.streams(0), FIRST, &mut buffer);
    let values = buffer.values.iter().flatten().flat_map(|value| value.to_bits().to_le_bytes());
    let lookups = buffer.lookups.iter().flat_map(|lookups| lookups.to_le_bytes());
    Some(hash(&values.chain(lookups).collect::<Vec<u8>>()))
}

/// The experiments that are drawn together: by their numbers through the plan, with their numbers of blocks.
#[derive(Debug)]
struct Company {
    shares: Option<(usize, u64)>,
    experiments: Vec<(u32, u64)>,
}

fn companies(plan: &Plan) -> Vec<Company> {
    let mut companies: Vec<Company> = Vec::new();
    let cases = plan.cases.iter().enumerate();
    let all = cases.flat_map(|(at, case)| (0..case.experiments.len()).map(move |i| (at, case, i)));
    for ((at, case, index), number) in all.zip(0..) {
        let planned = &case.experiments[index];
        if planned.outcome.is_err() || case.twin(index).is_some() {
            continue;
        }
        let member = (number, planned.horizon.div_ceil(plan.step()));
        let shares = planned.shared.map(|shared| (at, shared.experiment));
        let same = |company: &&mut Company| shares.is_some() && company.shares == shares;
        match companies.iter_mut().find(same) {
            Some(company) => company.experiments.push(member),
            None => companies.push(Company { shares, experiments: vec![member] }),
        }
    }
    companies
}

/// A block of experiments that are drawn together: a piece of work.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Piece {
    /// The experiments, by their numbers through the plan.
    pub experiments: Vec<u32>,
    /// The block.
    pub block: u64,
}

/// The blocks of a share, one after the other.
pub fn pieces(plan: &Plan, share: Share) -> impl Iterator<Item = Piece> {
    let mut before = 0;
    companies(plan).into_iter().flat_map(move |company| {
        let blocks = company.experiments.iter().map(|one| one.1).max().unwrap_or(0);
        let (part, of) = (u64::from(share.part - 1), u64::from(share.of));
        let first = (part + of - before % of) % of;
        before += blocks;
        (first..blocks).step_by(share.of as usize).map(move |block| {
            let there = company.experiments.iter().filter(|one| block < one.1);
            Piece { experiments: there.map(|one| one.0).collect(), block }
        })
    })
}
