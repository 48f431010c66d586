//! What a run found: all that a report may know.
//!
//! A record has three parts. `results` is the same to the bit for any number of threads on any
//! machine; `timing` and the `comparison` with a stored run are not, and are kept apart. Unknown is `None`, never zero. JSON writes infinite
//! numbers as `null`: those of [`GateFinding`] may be.

mod anatomy;
pub mod baseline;
pub mod comparison;
pub mod curves;
pub mod evaluate;
mod measured;
pub mod plot_data;
pub mod qualify;
mod repeat;
pub mod summary;
mod theory_rows;
pub mod verdict;

pub use gate::stats::verdict::{GateFinding, Verdict};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

use crate::record::comparison::Comparison;
use numeric::null;

pub use crate::record::plot_data::{
    Anatomy, Best, Course, Curve, CurvePoint, MeasuredPoint, Sweep,
};

/// The version of the record's form: it grows when a field changes its meaning or goes away.
pub const SCHEMA: u32 = 1;

/// A finished run, prediction or plan.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// What was drawn, predicted and decided.
    pub results: Results,
    /// How long it took, and where.
    pub timing: Timing,
    /// What changed since a stored run, where it was compared with one.
    pub comparison: Option<Comparison>,
}

/// The part of a record that depends on nothing but the cases, the seed and the options.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Results {
    /// The version of the record's form, [`SCHEMA`].
    pub schema: u32,
    /// The version of the tool.
    pub version: String,
    /// The run's seed.
    pub seed: u64,
    /// The chance that a correct run shows any failure at all.
    pub alpha: f64,
    /// How random numbers are found.
    pub streams: String,
    /// How the error rate is shared, and what came of it.
    pub gate: Gate,
    /// Whether a time limit or an interruption cut the draws short; such results depend on the machine.
    pub cut_by_time: bool,
    /// Whether the budget of draws ran out before all was decided.
    pub cut_by_budget: bool,
    /// The cases, in the order they were given.
    pub cases: Vec<CaseRecord>,
}

/// The error control of a run: levels fixed before the first draw, and what came of them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Gate {
    /// K: how many scalars go through the gate and share 4/5 of α.
    pub scalars: usize,
    /// How many p-values share 1/5 of α, by Holm.
    pub laws: usize,
    /// How many declared biases have an α of their own.
    pub biased: usize,
    /// β, the chance that a scalar passes although its bias is as large as its tolerance.
    pub beta: f64,
    /// A scalar fails at this ln E.
    #[serde(deserialize_with = "null::read")]
    pub ln_e_limit: f64,
    /// A scalar passes when both its ln P reach this.
    #[serde(deserialize_with = "null::read")]
    pub ln_p_limit: f64,
    /// ln of the mean e-value of all scalars: near or below 0 where all is well.
    pub ln_mean_e: Option<f64>,
    /// How far the strongest evidence stays below its limit; negative where something fails.
    pub smallest_margin: Option<f64>,
    /// The largest bias of a mean that a pass leaves possible, relative to its unit.
    pub worst_bias: Option<f64>,
    /// How many means passed although their variance could not be tested.
    pub variance_assumed: usize,
    /// The e-BH list at α: where to look first.
    pub triage: Vec<Suspect>,
}

/// An entry of the e-BH list.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Suspect {
    /// The case.
    pub case: String,
    /// The estimator, with σ̂ and control where they tell it from others.
    pub experiment: String,
    /// The check.
    pub check: String,
    /// ln of its e-value.
    #[serde(deserialize_with = "null::endless")]
    pub ln_e: f64,
}

/// What was found for one case file.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct CaseRecord {
    /// The case's name: its path below the cases folder, without `.toml`.
    pub name: String,
    /// Its file, as it was given; for a built-in case, its name with `.toml`.
    pub path: String,
    /// Its title.
    pub title: String,
    /// The problem's name, as `trueflight list problems` has it.
    pub problem: String,
    /// The field's name in the catalogue.
    pub medium: String,
    /// Number of draws that share the setup lookups of a ray; `None` in records without it.
    pub draws_per_ray: Option<u64>,
    /// The smallest and the largest bias of a mean, relative to its unit, that its experiments were
    /// planned to see.
    #[serde(deserialize_with = "null::read")]
    pub visible_bias: Option<[f64; 2]>,
    /// How many draws its scalars took to pass, all together, in units of what is typical,
    /// `17 V/ε²` draws each.
    pub pace: Option<f64>,
    /// One row per experiment and channel; the rows of one experiment follow each other.
    pub rows: Vec<Row>,
    /// What was swept, with the theory's curves.
    pub sweep: Option<Sweep>,
    /// The ray seen from the side, for cases with a curve.
    pub anatomy: Option<Anatomy>,
    /// Contents of the files of the medium, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub facts: Vec<String>,
    /// Doubts about the medium and its ray, such as a ray that meets nothing of the volume, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
}

impl CaseRecord {
    /// Whether a row is the first of its experiment; what is refused has one row only.
    pub fn begins_experiment(&self, row: usize) -> bool {
        let stream = |row: usize| self.rows[row].stream;
        row == 0 || stream(row).is_none() || stream(row - 1) != stream(row)
    }
}

/// One experiment (one estimator at one sweep point), one channel of its value.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Row {
    /// The estimator with its own settings, as in `single(non-terminating, a=0.7)`.
    pub estimator: String,
    /// The number of the estimator in the case's list, from 0: with the swept value the identity of the experiment. `None` in
    /// records from before it was kept.
    pub listed: Option<usize>,
    /// The constant sampling extinction, 1/length; `None` where σ̂ varies or is not used.
    pub sampling: Option<f64>,
    /// The sampling extinction in words, as in `piecewise-linear`; empty where none is used.
    pub sampling_kind: String,
    /// The control in words, as in `constant 0.3`; empty for none.
    pub control: String,
    /// Knowledge of the medium that σ̂, control and estimator need beside lookups, as in `τ`; empty for none.
    #[serde(default)]
    pub needs: String,
    /// The value of the swept quantity; `None` for experiments outside the sweep.
    pub swept: Option<f64>,
    /// The kernel that draws, `ordered` or `order-free`; empty for what is refused.
    pub kernel: String,
    /// The estimator before it in the case that it is by definition: it was drawn once for both. Empty
    /// for what is drawn for itself.
    pub same_as: String,
    /// How many experiments of the case, this one included, look the medium up once for all; `None`
    /// where each does for itself.
    pub sharing: Option<u64>,
    /// The share of the ray's support, in space of the box about the volume, on which σ̂ is 0 because
    /// nothing is to be found there;
    /// `None` where it is as the case has it.
    pub skipped: Option<f64>,
    /// The channel's name, as in `T(5)` or `reflectance`; empty where the value has one channel only.
    pub channel: String,
    /// How many draws the means, variances and z-scores of this row are of: a number fixed by the
    /// plan.
    pub draws: Option<u64>,
    /// How many draws the gate took to decide.
    pub drawn: Option<u64>,
    /// The name of the experiment's streams: with the seed and a block's number it finds them.
    pub stream: Option<u64>,
    /// The command that repeats the experiment.
    pub command: String,
    /// The command that decides an inconclusive experiment, or, of a plan, all of the case that it leaves inconclusive.
    /// Empty where no number of draws does, and for all others.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub decide: String,
    /// `inconclusive` or `underpowered` where a plan has too few draws for a pass; `None` in a run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foreseen: Option<Verdict>,
    /// Draws that such a row of a plan needs; `None` where no number of draws is enough.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub needed_draws: Option<f64>,
    /// The mean of the draws.
    pub mean: Option<f64>,
    /// The standard error of the mean from the draws' own variance.
    pub standard_error: Option<f64>,
    /// The exact answer.
    pub truth: Option<f64>,
    /// The bound on the truth's own error.
    pub truth_error: Option<f64>,
    /// (mean − truth) in predicted standard errors.
    pub z_mean: Option<f64>,
    /// The unbiased sample variance of one draw.
    pub variance: Option<f64>,
    /// The variance of one draw in theory.
    pub predicted_variance: Option<f64>,
    /// (variance − predicted) in predicted standard deviations of the sample variance.
    pub z_variance: Option<f64>,
    /// The predicted standard deviation of the sample variance, for error bars.
    pub variance_deviation: Option<f64>,
    /// The mean number of lookups of σ_t.
    pub lookups_per_draw: Option<f64>,
    /// The same in theory.
    pub predicted_lookups: Option<f64>,
    /// Lookups of σ_t for a ray before its first draw, as at explorer points and by pilot rays; no part of the lookups per
    /// draw. `None` where the experiment is refused.
    pub setup_lookups: Option<u64>,
    /// (lookups − predicted) in predicted standard errors.
    pub z_lookups: Option<f64>,
    /// The predicted standard deviation of the mean number of lookups, for error bars.
    pub lookups_deviation: Option<f64>,
    /// Which of `z_mean`, `z_variance` and `z_lookups` are not to be read as normal: the draws are too few,
    /// or their tails too heavy.
    #[serde(deserialize_with = "z_scores")]
    pub not_normal: Vec<&'static str>,
    /// The p-value of the test of the whole law, where the law is known.
    pub p_law: Option<f64>,
    /// The skewness of one draw in theory.
    pub predicted_skewness: Option<f64>,
    /// The kurtosis of one draw in theory (3 for the normal law).
    pub predicted_kurtosis: Option<f64>,
    /// ε of the mean: the smallest bias, relative to the truth, that a pass excludes.
    pub detectable_bias: Option<f64>,
    /// The measured figure of merit, 1/(variance · (lookups per draw + setup lookups/draws per ray)).
    pub fom: Option<f64>,
    /// The same in theory.
    pub predicted_fom: Option<f64>,
    /// The share of the ray on which `w ≤ 2σ_t`, the stability condition, holds.
    pub stable_share: Option<f64>,
    /// The constant σ̂ with the largest predicted figure of merit of this channel, or what `best_kind` says. `None` where
    /// it is not asked for.
    pub best_sampling: Option<f64>,
    /// The figure of merit there; `None` where it is infinite.
    pub best_fom: Option<f64>,
    /// Kind of `best_sampling`: `optimum`, `90 % of the limit` where the figure of merit rises with σ̂ to a limit, `no
    /// variance`, or `end of the search`. Empty where it is not asked for.
    #[serde(default)]
    pub best_kind: String,
    /// The limit of a figure of merit that rises with σ̂ to one.
    pub best_limit: Option<f64>,
    /// `pass`, `fail`, `inconclusive`, `underpowered` or `refused`; `None` where nothing was drawn.
    pub verdict: Option<Verdict>,
    /// Why, in words; empty for a plain pass.
    pub reason: String,
    /// The fields along the ray, one for each channel of the medium, where the experiment is refused.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub courses: Vec<Course>,
    /// What each check found.
    pub findings: Vec<Finding>,
    /// `J_k = ∫ σ̂ E[(1 − W)^k]`, k = 1 … 4, of product estimators.
    #[serde(deserialize_with = "null::read")]
    pub losses: Option<[f64; 4]>,
    /// The central moments `μ_k/T^k` of one draw in theory, k = 2, 3, 4; `None` where they are
    /// unknown or overflow.
    pub relative_moments: [Option<f64>; 3],
    /// A bound on the relative error of the predicted variance and, where that is known, of the fourth
    /// moment; `None` where it is not bounded.
    pub moments_error: Option<f64>,
    /// The variance of the number of lookups of one draw in theory.
    pub lookups_variance: Option<f64>,
    /// `P(0), P(1), …` lookups of one draw in theory; empty where unknown or longer than 100.
    #[serde(deserialize_with = "null::read")]
    pub lookups_pmf: Vec<f64>,
    /// `n(2)`: with fewer draws the events that make the variance are not seen.
    pub rare_event_size: Option<f64>,
    /// `E[X⁸]/E[X⁴]²`, which says how heavy the tails of the sample variance are.
    pub eighth_moment_ratio: Option<f64>,
    /// All values of the row are in units of `exp(−log_unit)`; `None` where they are as they are.
    pub log_unit: Option<f64>,
}

impl Row {
    /// The command to run next, with the word before it: what decides an inconclusive row, else what repeats it.
    pub fn next_command(&self) -> Option<(&'static str, &str)> {
        let next = match self.verdict {
            Some(Verdict::Inconclusive) => ("decide", self.decide.as_str()),
            _ => ("repeat", self.command.as_str()),
        };
        Some(next).filter(|next| !next.1.is_empty())
    }

    /// `log₁₀ LTUV`, LTUV = V · lookups of a draw with its share of the setup lookups: the lookups to unit variance of
    /// Miller et al. 2019, section 6; the figure of merit upside down.
    pub fn log10_ltuv(&self) -> Option<f64> {
        self.fom.map(|fom| -fom.log10())
    }

    /// The same in theory.
    pub fn predicted_log10_ltuv(&self) -> Option<f64> {
        self.predicted_fom.map(|fom| -fom.log10())
    }
}

/// What a row has z-scores of.
const Z_SCORES: [&str; 3] = ["z_mean", "z_variance", "z_lookups"];

/// Reads names of z-scores: there are three.
fn z_scores<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<&'static str>, D::Error> {
    let known = |name: &String| Z_SCORES.into_iter().find(|z| z == name);
    let names = Vec::<String>::deserialize(from)?;
    names
        .iter()
        .map(|name| known(name).ok_or_else(|| D::Error::unknown_variant(name, &Z_SCORES)))
        .collect()
}

/// What one check found of one experiment.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Finding {
    /// The check's name in the catalogue.
    pub check: String,
    /// What the check asked about, as in `the mean`.
    pub what: String,
    /// Whether the case declares a bias that the check must show.
    pub expects_bias: bool,
    /// The channel it is about; empty for the experiment as a whole.
    pub channel: String,
    /// The statistic, in standard deviations, where the check has one.
    pub z: Option<f64>,
    /// The p-value, for tests of a whole law.
    pub p: Option<f64>,
    /// Where the gate stands, for scalars.
    pub gate: Option<GateFinding>,
    /// Pairs of draws and ln E at the gate's looks, ascending: the last is the decision's. Of more than 64 looks an even
    /// choice, ln E in steps of 0.001.
    #[serde(default, deserialize_with = "null::read", skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<[f64; 2]>,
    /// The block at whose end it was decided, or where it was found.
    pub block: Option<u64>,
    /// What the check says.
    pub verdict: Verdict,
    /// Why, with the numbers.
    pub reason: String,
}

/// The part of a record that differs from run to run.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Timing {
    /// How many threads drew.
    pub threads: usize,
    /// The vector hardware that drew, as in `avx512`.
    pub level: String,
    /// Wall-clock seconds of the whole run.
    pub seconds: f64,
    /// Per case and row, the processor seconds of the drawing; the rows of one experiment share
    /// one figure. `None` where nothing was drawn.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Per case and row, whether the draws are those of an earlier run, and the seconds with them.
    pub reused: Vec<Vec<bool>>,
}
