//! Selection of cases, and options of their drawing.

use anyhow::Context;
use clap::Args;

use super::help::Names;
use super::numbers::{self, Budget};
use super::{Console, output};
use crate::case::{Case, Catalogue, suite};
use crate::plan::{Amount, Filter, Options, Plan};

/// Experiments, and the seed of their random numbers.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Experiments")]
pub struct Experiments {
    /// Case files, folders of them, or names of built-in cases; without any, the built-in suite
    #[arg(value_name = "CASES", help_heading = None::<&str>)]
    #[arg(value_parser = Names::Cases, hide_possible_values = true)]
    cases: Vec<String>,
    /// Only experiments that match: a case, an estimator, or `case:estimator`, with `*` and `?`
    #[arg(long, value_name = "GLOB", value_parser = Names::Experiments, hide_possible_values = true)]
    filter: Option<String>,
    #[command(flatten)]
    seed: Seed,
}

/// Options that the commands on cases share.
#[derive(Debug, Clone, Args)]
pub struct Selection {
    #[command(flatten)]
    experiments: Experiments,
    /// Draws per experiment, such as 1e6, whatever the cases say [default: the case's, or 4e6; check: 4e5]
    #[arg(long, help_heading = "Drawing", value_name = "N", value_parser = numbers::draws, allow_hyphen_values = true)]
    draws: Option<u64>,
    /// Probability that a correct run shows any failure
    #[arg(long, help_heading = "Drawing", default_value_t = 1e-3, value_name = "A", value_parser = numbers::alpha, allow_hyphen_values = true)]
    alpha: f64,
    /// Threads [default: one per processor]; results do not depend on them
    #[arg(long, help_heading = "Drawing", value_name = "N", value_parser = numbers::threads, allow_negative_numbers = true)]
    pub threads: Option<u16>,
}

/// Threads of a command.
#[derive(Debug, Clone, Copy, Args)]
pub struct Threads {
    /// Threads [default: one per processor]; results do not depend on them
    #[arg(long, value_name = "N", value_parser = numbers::threads, allow_negative_numbers = true)]
    pub threads: Option<u16>,
}

impl Threads {
    /// Calls `f` on the requested number of threads.
    pub fn install<T: Send>(
        self,
        f: impl FnOnce() -> anyhow::Result<T> + Send,
    ) -> anyhow::Result<T> {
        on_threads(self.threads.map_or(0, usize::from), f)
    }
}

/// Seed of a command.
#[derive(Debug, Clone, Copy, Args)]
pub struct Seed {
    /// Seed of all random numbers
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = numbers::seed, allow_negative_numbers = true)]
    pub seed: u64,
}

/// Looks of the gate, and limits that stop the drawing.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Drawing")]
pub struct Looks {
    /// Look only after every K blocks of 16384 draws, which are kept, sent and merged as one: for very long runs
    #[arg(long, default_value_t = 1, value_name = "K", value_parser = numbers::whole::<u64>(1..=1_000_000), allow_negative_numbers = true)]
    blocks_per_look: u64,
    /// Stop after a time (30s, 5m; results then depend on the machine) or a number of draws of all experiments
    /// together (1e8, at least one block of 16384)
    #[arg(long, value_name = "B", value_parser = numbers::budget, allow_negative_numbers = true)]
    pub budget: Option<Budget>,
    /// Draw exactly what is planned: no check stops the drawing, none prolongs it
    #[arg(long)]
    fixed_draws: bool,
    /// Let every underpowered check make its experiment inconclusive
    #[arg(long)]
    strict: bool,
}

impl Looks {
    /// Returns whether all experiments share a number of draws: the number left for one then depends on the others.
    pub fn shares_draws(&self) -> bool {
        matches!(self.budget, Some(Budget::Draws(_)))
    }

    /// Returns these options with the budget of others.
    #[must_use]
    pub fn with_budget_of(self, other: &Self) -> Self {
        Self { budget: other.budget, ..self }
    }

    /// Adds these options to those of a plan.
    pub fn of(&self, options: Options) -> Options {
        let Self { fixed_draws: fixed, strict, blocks_per_look, budget } = *self;
        let (seconds, budget) = match budget {
            Some(Budget::Seconds(seconds)) => (Some(seconds), None),
            Some(Budget::Draws(draws)) => (None, Some(draws)),
            None => (None, None),
        };
        Options { seconds, budget, blocks_per_look, fixed, strict, ..options }
    }
}

impl Experiments {
    /// Reads the cases; mistakes in files are shown in place.
    pub fn read(&self, catalogue: &Catalogue, console: &Console) -> anyhow::Result<Vec<Case>> {
        let mut cases = Vec::new();
        let mut errors = Vec::new();
        let built_in = if self.cases.is_empty() { suite::suite() } else { Vec::new() };
        for source in &built_in {
            catalogue.read(source).map_or_else(|error| errors.push(error), |case| cases.push(case));
        }
        for name in &self.cases {
            catalogue
                .named(name)
                .map_or_else(|result| errors.extend(result), |result| cases.extend(result));
        }
        if errors.is_empty() {
            return distinct(cases);
        }
        Err(output::mistakes(&errors, console, ["case file", "nothing was run"]))
    }

    /// Returns the options of a plan that makes this amount of draws.
    pub fn options(&self, draws: Amount) -> anyhow::Result<Options> {
        let filter = self.filter.as_deref().map(Filter::new).transpose();
        let filter = filter.context("--filter takes a pattern such as \"*eq21*:single\"")?;
        Ok(Options { seed: self.seed.seed, draws, filter, ..Options::default() })
    }

    /// Plans the cases, with a progress bar; a selection without experiments is an error.
    pub fn plan<'a>(
        &self,
        cases: &'a [Case],
        options: &Options,
        console: &Console,
    ) -> anyhow::Result<Plan<'a>> {
        let bar = output::progress("planning", "experiments", 0, console);
        let plan = Plan::with_progress(cases, options, &|prepared, all| {
            bar.set_length(all as u64);
            bar.set_position(prepared as u64);
        });
        bar.finish_and_clear();
        if plan.cases.is_empty() {
            let filter = self.filter.as_deref().unwrap_or_default();
            anyhow::bail!(
                "--filter \"{filter}\" keeps none of the experiments; \
                 `trueflight plan` lists what there is"
            );
        }
        Ok(plan)
    }
}

impl Selection {
    /// Reads the cases; mistakes in files are shown in place.
    pub fn read(&self, catalogue: &Catalogue, console: &Console) -> anyhow::Result<Vec<Case>> {
        self.experiments.read(catalogue, console)
    }

    /// Returns the cases as they were named.
    pub fn names(&self) -> &[String] {
        &self.experiments.cases
    }

    /// Returns these options with the number of threads of others.
    #[must_use]
    pub fn on_threads_of(self, other: &Self) -> Self {
        Self { threads: other.threads, ..self }
    }

    /// Returns the options of a plan; `usual` is the number of draws if neither an argument nor the case gives it.
    pub fn options(&self, usual: u64) -> anyhow::Result<Options> {
        let draws = self.draws.map_or(Amount::CaseOr(usual), Amount::Exactly);
        let options = self.experiments.options(draws)?;
        Ok(Options { alpha: self.alpha, ..options })
    }

    /// Calls `f` with the plan of the cases, on the requested number of threads.
    pub fn with_plan<T: Send>(
        &self,
        cases: &[Case],
        options: &Options,
        console: &Console,
        f: impl FnOnce(&Plan) -> anyhow::Result<T> + Send,
    ) -> anyhow::Result<T> {
        on_threads(self.threads.map_or(0, usize::from), || {
            f(&self.experiments.plan(cases, options, console)?)
        })
    }
}

/// Calls `f` on this number of threads; 0 is one per processor.
pub fn on_threads<T: Send>(
    threads: usize,
    f: impl FnOnce() -> anyhow::Result<T> + Send,
) -> anyhow::Result<T> {
    let (mut f, mut result) = (Some(f), None);
    install(threads, &mut || result = f.take().map(|f| f()))?;
    result.context("the threads did nothing")?
}

/// Calls `f` once on this number of threads: rayon's way to its threads is compiled here alone.
fn install(threads: usize, f: &mut (dyn FnMut() + Send)) -> anyhow::Result<()> {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build()?.install(f);
    Ok(())
}

/// Leaves out repeated cases. Two different cases of one name are an error: they would share random numbers and files.
fn distinct(cases: Vec<Case>) -> anyhow::Result<Vec<Case>> {
    let mut kept: Vec<Case> = Vec::with_capacity(cases.len());
    for case in cases {
        let place = |case: &Case| case.path.canonicalize().unwrap_or_else(|_| case.path.clone());
        match kept.iter().find(|other| other.name == case.name) {
            None => kept.push(case),
            Some(other) if place(other) == place(&case) => {}
            Some(other) => anyhow::bail!(
                "two cases are called {}: {} and {}; rename one, or run them apart",
                case.name,
                other.path.display(),
                case.path.display()
            ),
        }
    }
    Ok(kept)
}
