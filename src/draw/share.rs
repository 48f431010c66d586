//! Shares of a run: the blocks that one machine of many draws.
//!
//! ```text
//! blocks are numbered through the experiments of the plan: number n belongs to part n mod N + 1 of N
//! ```
//!
//! The gate decides when all parts are there, so a part draws its share of all blocks up to the horizon.
//! Experiments that share their lookups count as one, so that a part draws them together.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::plan::Plan;

/// Part of a run; `1/1` is the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Share {
    /// Number of the part, from 1.
    pub part: u32,
    /// Number of parts.
    pub of: u32,
}

impl Share {
    /// Whole run.
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

/// Experiments that share their lookups, or one that shares none.
#[derive(Debug)]
struct Company {
    /// Case and address of the lookups.
    shares: Option<(usize, u64)>,
    /// Number of each experiment in the plan, and its number of blocks.
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

/// Piece of work: one block of experiments that are drawn together.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Piece {
    /// Numbers of the experiments in the plan.
    pub experiments: Vec<u32>,
    /// Number of the block.
    pub block: u64,
}

/// Returns the pieces of a share, in the order of the plan.
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
