//! What a run comes to: the mean e-value, the e-BH list, the margins, and, for each case, the biases
//! that it could have seen and how soon it was decided.

use crate::record::{CaseRecord, Finding, Gate, Results, Row, Suspect, Verdict};
use gate::session::Reason;
use gate::stats::gate::TYPICAL;
use gate::stats::multiplicity;

/// Fills in what only the whole run can say.
pub fn complete(results: &mut Results) {
    let (alpha, cases) = (results.alpha, &mut results.cases);
    for case in cases.iter_mut() {
        case.visible_bias = visible_bias(case);
        case.pace = pace(case);
    }
    let gate = &mut results.gate;
    let suspects: Vec<Suspect> = cases
        .iter()
        .flat_map(|case| scalars(case).map(|(row, finding)| suspect(case, &row, finding)))
        .collect();
    let ln_e: Vec<f64> = suspects.iter().map(|suspect| suspect.ln_e).collect();
    if !ln_e.is_empty() {
        gate.ln_mean_e = Some(multiplicity::mean_e_value(&ln_e)).filter(|e| e.is_finite());
        let strongest = ln_e.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        gate.smallest_margin = Some(gate.ln_e_limit - strongest).filter(|m| m.is_finite());
    }
    let listed = multiplicity::e_benjamini_hochberg(&ln_e, alpha);
    gate.triage = listed.into_iter().map(|index| suspects[index].clone()).collect();
    close(gate, cases);
}

fn close(gate: &mut Gate, cases: &[CaseRecord]) {
    let means = || cases.iter().flat_map(CaseRecord::rows).flat_map(|row| row.findings());
    let passed = |finding: &&Finding| {
        finding.check == "mean" && finding.verdict == Verdict::Pass && !finding.expects_bias
    };
    let assumed = Reason::VarianceAssumed.to_string();
    gate.variance_assumed = means().filter(passed).filter(|f| f.reason == assumed).count();
    let biases = means().filter(passed).filter_map(|finding| Some(finding.gate?.tolerance));
    gate.worst_bias = biases.reduce(f64::max);
}

/// The scalars of a case with the row that they stand in; those of the whole experiment stand in the first of its rows.
fn scalars(case: &CaseRecord) -> impl Iterator<Item = (Row<'_>, &Finding)> {
    // Draws that two experiments share count once.
    let own = case.rows().filter(|row| row.experiment.same_as.is_none());
    own.flat_map(|row| {
        let scalars =
            row.own_findings().filter(|found| found.gate.is_some() && !found.expects_bias);
        scalars.map(move |finding| (row, finding))
    })
}

fn suspect(case: &CaseRecord, row: &Row, finding: &Finding) -> Suspect {
    let mut experiment = row.experiment.label.clone();
    if let Some(swept) = row.experiment.swept() {
        experiment = format!("{experiment} at {swept}");
    }
    if !finding.channel.is_empty() {
        experiment = format!("{experiment}, {}", finding.channel);
    }
    let ln_e = finding.gate.map_or(0.0, |gate| gate.ln_e);
    Suspect { case: case.name.clone(), experiment, check: finding.check.clone(), ln_e }
}

/// The range of ε over the means that were promised a pass.
fn visible_bias(case: &CaseRecord) -> Option<[f64; 2]> {
    let means = case.rows().flat_map(|row| row.findings()).filter(|f| f.check == "mean");
    let promised = means.filter_map(|finding| finding.gate.filter(|gate| gate.needed.is_none()));
    let tolerances: Vec<f64> = promised.map(|gate| gate.tolerance).collect();
    let least = tolerances.iter().copied().reduce(f64::min)?;
    let range = [least, tolerances.iter().copied().fold(least, f64::max)];
    Some(range).filter(|range| range.iter().all(|end| end.is_finite()))
}

/// See [`CaseRecord::pace`].
fn pace(case: &CaseRecord) -> Option<f64> {
    let passed = scalars(case).filter(|(_, finding)| finding.verdict == Verdict::Pass);
    let (taken, typical) = passed.filter_map(|(_, finding)| finding.gate).fold(
        (0.0, 0.0),
        |(taken, typical), gate| {
            let unit = gate.variance / (gate.tolerance * gate.tolerance);
            (taken + gate.draws as f64, typical + TYPICAL * unit)
        },
    );
    (typical > 0.0).then(|| taken / typical)
}
