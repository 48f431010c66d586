//! Advice as a table on the screen and as files.
//!
//! ```text
//! advise.csv          one row per estimator with its best settings
//! report.html         everything as a page
//! advise.svg, .png    cost against σ̂, and the best σ̂ along the ray
//! ```

pub mod console;
pub mod html;
pub mod plot;

use crate::advise::{Advice, Row};
use crate::report::fields::{self, Table, table};
use crate::report::{Artifact, ReportError, plots};

/// Row with the advice that it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct AdviceRow<'a> {
    /// Advice.
    pub advice: &'a Advice,
    /// Row.
    pub row: &'a Row,
}

table! {
    impl<'a> for AdviceRow<'a> {
        "case": "Case: the name of its file" = |of| &of.advice.case;
        "problem": "Kind of problem" = |of| &of.advice.problem;
        "medium": "Medium" = |of| &of.advice.medium;
        "rays": "Number of rays" = |of| of.advice.rays;
        "group": "Rows that are ranked together: ranked, bounded by theory, or informed of τ" = |of| of.row.group.word();
        "rank": "Rank in the group" = |of| of.row.rank;
        "is_tie" ["tie", "", Plain]: "True if another row is within the error of the costs" = |of| of.row.is_tie;
        "estimator": "Estimator with its settings" = |of| &of.row.estimator;
        "sampling" ["σ̂", "1/length", Short(4)]: "Best sampling extinction σ̂, if it is a constant" = |of| of.row.constant;
        "sampling_kind" ["kind of σ̂", "", Plain]: "Kind of σ̂, as constant or local majorants" = |of| &of.row.sampling;
        "sampling_factor" ["factor", "", Short(4)]: "Best factor on a σ̂ that is not constant" = |of| of.row.factor;
        "control": "Control extinction" = |of| &of.row.control;
        "kind": "Kind of the best σ̂: optimum, or near a limit" = |of| of.row.kind.words();
        "unit": "Unit of costs: s or lookups" = |of| of.advice.unit();
        "cost" ["cost", "s or lookups", Short(3)]: "Cost to the error, or the budget; over several rays, of each" = |of| of.row.time;
        "cost_least": "Cost to the error, or the error, of the ray with the least" = |of| of.row.of_rays[0];
        "cost_most": "Cost to the error, or the error, of the ray with the most" = |of| of.row.of_rays[1];
        "error" ["error", "", Short(3)]: "Relative standard error at that cost" = |of| of.row.error;
        "draws" ["draws", "", Short(2)]: "Draws at that cost" = |of| of.row.draws();
        "cost_per_draw": "Cost of a draw with its share of the setup" = |of| of.row.score.cost;
        "cost_error": "Relative error of the costs" = |of| of.row.cost_error;
        "relative_deviation" ["s.d./T", "", Fixed(3)]: "Standard deviation of a draw over the transmittance" = |of| of.row.score.deviation();
        "lookups_per_draw" ["lookups", "", Fixed(3)]: "Expected number of lookups of a draw" = |of| of.row.score.lookups;
        "setup_lookups" ["setup", "", Short(3)]: "Lookups of a ray before its first draw" = |of| of.row.score.setup_lookups;
        "margin_below" ["doubles below", "", Short(3)]: "Factor on σ̂ below which the cost doubles; 0 for none" = |of| of.row.margins.map(|margins| margins[0]);
        "margin_above" ["doubles above", "", Short(3)]: "Factor on σ̂ above which the cost doubles" = |of| of.row.margins.map(|margins| margins[1]);
        "least_sampling" ["least σ̂", "", Short(3)]: "Least σ̂, or factor, for which the estimator exists with a finite variance; 0 for any" = |of| of.row.minimum;
        "kurtosis" ["kurtosis", "", Short(3)]: "Largest kurtosis of a draw on a ray" = |of| of.row.score.kurtosis;
        "trusted_draws" ["draws until trusted", "", Short(2)]: "Draws until the sample variance has a standard error of 10 %" = |of| of.row.trusted();
        "needs": "Knowledge of the medium that is needed beside lookups" = |of| &of.row.needs;
        "lines": "Lines for a case" = |of| &of.row.lines;
    } screens {
        "rank_marked" ["", "", Right]: "Rank in the group, marked where rows are a tie" = |of| console::rank(of.row);
        "sampling_marked" ["σ̂", "1/length", Right]: "Best σ̂, or the factor on one that is not constant" = |of| console::sampling(of.row);
        "time" ["time", "s", Time]: "Time to the error" = |of| of.row.time;
        "error_percent" ["error", "", Percent]: "Relative standard error within the budget" = |of| of.row.error;
        "setup" ["setup", "", Short(3)]: "Lookups of a ray before its first draw, if there are any" = |of| Some(of.row.score.setup_lookups).filter(|&lookups| lookups > 0.0);
        "margins" ["σ̂ ×", "", Right]: "Factors on σ̂ between which the cost stays below its double" = |of| of.row.margins.map_or_else(String::new, console::margins);
    }
}

fn joined(advice: &Advice) -> impl Iterator<Item = AdviceRow<'_>> {
    advice.rows.iter().map(move |row| AdviceRow { advice, row })
}

/// Returns the rows as CSV, with a first line of names.
pub fn csv(advice: &Advice) -> Result<String, ReportError> {
    fields::csv("the advice", &AdviceRow::of_files(), joined(advice))
}

/// Returns the rows as a JSON array of objects, one per line; unknown is `null`.
pub fn json(advice: &Advice) -> Result<String, ReportError> {
    fields::json(&AdviceRow::of_files(), joined(advice))
}

/// Returns the rows as a JSON object of columns; unknown is `null`.
pub fn columns(advice: &Advice) -> Result<String, ReportError> {
    fields::columns(&AdviceRow::of_files(), &joined(advice).collect::<Vec<_>>())
}

/// Returns every file of an advice.
pub fn render(advice: &Advice) -> Result<Vec<Artifact>, ReportError> {
    let mut files = vec![
        Artifact::text("advise.csv", csv(advice)?),
        Artifact::text("report.html", html::text(advice)?),
    ];
    files.extend(plots::artifacts("advise", "", &plot::figure(advice)?)?);
    Ok(files)
}
