//! Fields of the rows of a run: the columns of `summary.csv`, of the files of the cases, of `--format csv|json`, of the
//! console, of the page and of the manual.

use crate::record::{Best, Score, Verdict};
use crate::report::fields::table;
use crate::report::run::summary_csv::SummaryRow;
use estimators::Knowledge;
use numeric::Grade;
use numeric::digits::short;
use theory::prediction::search::PlaceKind;

/// Fields that differ from run to run, which files of results alone leave out.
pub const TIMED: [&str; 3] = ["seconds", "ns_per_lookup", "reused"];

table! {
    impl<'a> for SummaryRow<'a> {
        "case": "Case: the name of its file" = |line| &line.case.name;
        "problem": "Kind of problem, as transmittance or rod" = |line| &line.case.problem;
        "medium": "Medium, as in `trueflight list media`" = |line| &line.case.medium;
        "estimator": "Estimator with its settings" = |line| &line.experiment.label;
        "sampling" ["σ̂", "1/length", Short(5)]:
            "Sampling extinction σ̂, if it is a constant: the rate of tentative collisions"
            = |line| line.experiment.sampling();
        "control": "Control extinction, which the estimator integrates exactly" = |line| &line.experiment.id.control;
        "channel": "Which value of a draw, as T(2) or a colour; empty if a draw is one value" = |line| &line.channel;
        "seed": "Seed of all random numbers of the run" = |line| line.seed;
        "draws": "Number of draws of mean, variance and z, fixed by the plan" = |line| line.experiment.draws;
        "mean" ["mean", "of the case", Fixed(6)]: "Mean of the draws" = |line| line.mean;
        "standard_error" ["± mean", "of the case", Short(3)]:
            "Standard error of the mean, from the draws' own variance" = |line| line.standard_error;
        "truth" ["truth", "of the case", Fixed(6)]: "Exact answer" = |line| line.truth;
        "truth_error" ["± truth", "of the case", Short(2)]: "Bound on the error of the exact answer" = |line| line.truth_error;
        "z_mean" ["z", "", Signed]:
            "Difference of the mean from the truth in predicted standard errors; within ±2 for 95 of 100 correct estimators"
            = |line| (line.z_mean, line.is_normal(Score::Mean));
        "variance" ["variance", "of the case, squared", Fixed(4)]: "Variance of one draw, measured" = |line| line.variance;
        "predicted_variance" ["variance", "of the case, squared", Fixed(4)]: "Variance of one draw in theory" = |line| line.predicted_variance;
        "z_variance" ["z_V", "", Signed]:
            "Difference of the variance from theory in predicted standard errors" = |line| (line.z_variance, line.is_normal(Score::Variance));
        "lookups_per_draw" ["lookups", "", Fixed(4)]:
            "Mean number of evaluations of σ_t by a draw: its cost" = |line| line.experiment.lookups_per_draw;
        "predicted_lookups" ["lookups", "", Fixed(4)]: "Expected number of lookups of a draw" = |line| line.experiment.predicted_lookups;
        "z_lookups" ["z_N", "", Signed]:
            "Difference of the lookups from theory in predicted standard errors"
            = |line| (line.experiment.z_lookups, line.is_normal(Score::Lookups));
        "predicted_kurtosis" ["κ", "", Fixed(3)]:
            "Kurtosis of a draw in theory: 3 for the normal distribution, large for heavy tails" = |line| line.predicted_kurtosis;
        "detectable_bias" ["ε", "", Percent]:
            "Tolerance ε of the mean: the smallest bias, relative to the truth, that a pass excludes" = |line| line.detectable_bias;
        "fom" ["FoM", "", Fixed(4)]:
            "Figure of merit 1/(variance × lookups), measured: larger is better" = |line| line.fom;
        "seconds" ["seconds", "s", Short(3)]: "Processor time of the drawing" = |line| line.experiment.spent.seconds;
        "ns_per_lookup" ["ns/lookup", "ns", Short(3)]: "Processor time of one lookup" = |line| line.ns_per_lookup();
        "verdict": "Result: pass, fail, inconclusive, underpowered or refused" = |line| line.verdict.map(Verdict::word);
        "reason": "Reason of the verdict; empty for a plain pass" = |line| line.why();
        "sampling_kind": "Kind of σ̂, as constant or local majorants" = |line| &line.experiment.id.sampling.kind;
        "swept" ["swept", "", Short(5)]: "Value of the swept quantity" = |line| line.experiment.swept();
        "predicted_skewness" ["skewness", "", Fixed(3)]: "Skewness of a draw in theory" = |line| line.predicted_skewness;
        "predicted_fom" ["FoM", "", Fixed(4)]: "Figure of merit in theory" = |line| line.predicted_fom;
        "stable_share" ["stable", "", Percent]:
            "Share of the ray on which the variance stays bounded, σ̂ E[(1 − W)²] ≤ 2σ_t" = |line| line.experiment.stable_share;
        "best_sampling" ["best σ̂", "1/length", Short(4)]:
            "Constant σ̂ with the largest figure of merit in theory" = |line| line.best_sampling();
        "best_fom" ["best FoM", "", Fixed(4)]: "Figure of merit at the best σ̂" = |line| line.best_fom();
        "p_law" ["smallest p", "", Short(3)]: "Smallest p-value of the tests of whole distributions" = |line| line.experiment.p_law;
        "drawn": "Number of draws when every check was decided" = |line| line.experiment.drawn;
        "same_as": "Experiment that is the same by definition, and drawn once for both" = |line| line.experiment.same_as();
        "skipped" ["skipped", "", Percent]: "Share of the ray or the box that is skipped as empty" = |line| line.experiment.skipped;
        "loss_1" ["J₁", "", Fixed(4)]: "∫ σ̂ E[1 − W] along the ray, of weights W" = |line| line.losses.map(|losses| losses[0]);
        "loss_2" ["J₂", "", Fixed(4)]: "∫ σ̂ E[(1 − W)²]" = |line| line.losses.map(|losses| losses[1]);
        "loss_3" ["J₃", "", Fixed(4)]: "∫ σ̂ E[(1 − W)³]" = |line| line.losses.map(|losses| losses[2]);
        "loss_4" ["J₄", "", Fixed(4)]: "∫ σ̂ E[(1 − W)⁴]" = |line| line.losses.map(|losses| losses[3]);
        "relative_m2" ["m₂", "", Fixed(4)]: "Variance of a draw over the squared truth" = |line| line.relative_moments[0];
        "relative_m3" ["m₃", "", Fixed(4)]: "Third central moment over the cubed truth" = |line| line.relative_moments[1];
        "relative_m4" ["m₄", "", Fixed(4)]: "Fourth central moment over the truth to the fourth power" = |line| line.relative_moments[2];
        "lookups_variance" ["V of lookups", "", Short(4)]: "Variance of the number of lookups in theory" = |line| line.experiment.lookups_variance;
        "rare_event_size" ["n(2)", "", Fixed(3)]:
            "Number of draws below which the events that make the variance are missing" = |line| line.rare_event_size;
        "log_unit" ["u", "", Short(6)]: "All values are in units of exp(−u); empty for plain units" = |line| line.log_unit;
        "reused": "yes if an earlier run made the draws" = |line| line.experiment.spent.is_reused.then_some("yes");
        "moments_error" ["m error", "", Fixed(2)]: "Bound on the relative error of the predicted variance" = |line| line.moments_error;
        "not_normal": "z-scores that are not to be read as normal: too few draws, or too heavy tails"
            = |line| line.not_normal.iter().map(|score| score.word()).collect::<Vec<_>>().join(" ");
        "log10_ltuv" ["lg LTUV", "", Signed]: "log₁₀ of variance × lookups, measured: lookups to unit variance" = |line| line.log10_ltuv();
        "predicted_log10_ltuv" ["lg LTUV", "", Signed]: "log₁₀ of variance × lookups in theory" = |line| line.predicted_log10_ltuv();
        "setup_lookups" ["setup", "", Plain]: "Lookups of a ray before its first draw" = |line| line.experiment.setup_lookups;
        "draws_per_ray": "Number of draws that share the setup lookups" = |line| line.case.draws_per_ray;
        "needs": "Knowledge of the medium beside lookups, as its optical depth τ" = |line| Knowledge::list(&line.experiment.needs);
        "best_kind" ["best is", "", Plain]: "Kind of the best σ̂: an optimum, or a share of a limit" = |line| line.best.as_ref().map_or("", kind);
        "best_limit" ["limit", "", Fixed(4)]: "Limit of the figure of merit, if it rises with σ̂ to one" = |line| line.best_limit();
        "lookups_error" ["N error", "", Fixed(2)]: "Bound on the relative error of the expected lookups" = |line| line.experiment.lookups_error;
        "covariance" ["Cov next", "of the case, squared", Fixed(4)]: "Covariance of one draw with the next channel in theory" = |line| line.covariance;
        "error_grade" ["errors are", "", Plain]: "Ground of `truth_error` and `moments_error`: proven, or estimated from resolutions"
            = |line| line.error_grade.map(Grade::word);
        "lookups_moments_error" ["V_N error", "", Fixed(2)]:
            "Bound on the relative error of variance and fourth central moment of the lookups" = |line| line.experiment.lookups_moments_error;
        "walk_lookups" ["by walk", "", Fixed(4)]:
            "Expected lookups of a draw's walk; empty if no shadow rays are cast" = |line| line.experiment.walk_lookups;
        "shadow_lookups" ["by shadow", "", Fixed(4)]:
            "Expected lookups of a draw's shadow rays" = |line| line.experiment.shadow_lookups;
        "lookups_grade" ["N error is", "", Plain]: "Ground of `lookups_error`: proven, or estimated from resolutions"
            = |line| line.experiment.lookups_grade.map(Grade::word);
    } screens {
        "variance_ratio" ["s²/V", "", Places(3)]: "Measured variance over that of theory" = |line| line.variance_ratio();
        "lookups_spread" ["± σ", "", Fixed(4)]: "Standard deviation of the number of lookups in theory"
            = |line| line.experiment.lookups_variance.map(f64::sqrt);
        "needed" ["needed", "", Enough]: "Number of draws that a pass takes, where the plan has too few" = |line| line.foreseen.as_ref().and_then(|foreseen| foreseen.needed);
        "best_sampling_marked" ["best σ̂", "1/length", Fixed(4)]: "Best σ̂, marked where its figure of merit is 90 % of a limit"
            = |line| best_sampling(line);
        "best_fom_marked" ["best FoM", "", Fixed(4)]: "Figure of merit at the best σ̂, which is infinite without a variance"
            = |line| line.best.as_ref().map(|best| best.fom.unwrap_or(f64::INFINITY));
        "setup": "Lookups of a ray before its first draw, if there are any"
            = |line| line.experiment.setup_lookups.filter(|&lookups| lookups > 0);
        "largest_ln_e" ["ln E", "", Short(4)]: "Largest evidence against the estimator, of all checks: it fails at the limit of the run"
            = |line| line.largest_ln_e();
    }
}

/// Returns the kind of a best σ̂.
pub fn kind(best: &Best) -> &'static str {
    if best.kind == PlaceKind::NearLimit { "90 % of the limit" } else { best.kind.words() }
}

/// Returns the best σ̂, marked if it is a share of a limit; empty if it was not searched.
fn best_sampling(line: &SummaryRow) -> String {
    let text = line.best.as_ref().map(|best| {
        let mark = if best.limit.is_some() { " (90 %)" } else { "" };
        format!("{}{mark}", short(best.sampling, 4))
    });
    text.unwrap_or_default()
}
