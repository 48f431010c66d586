//! `CASE.svg` and `CASE.png`: variance, cost, efficiency and z-scores along a sweep, theory as lines and measurements
//! as points with error bars. If the medium is swept, LTUV, the lookups to unit variance of Miller et al. 2019, takes
//! the place of the efficiency, its reciprocal.

mod graph;
mod names;

use crate::record::{CaseRecord, Compared, Record, Score, Sweep};
use crate::report::lists::joined;
use crate::report::plots::figure::{Figure, Foot, LEFT, subject};
use crate::report::plots::series::{self, Series, collect, only_channel};
use crate::report::plots::{self, Axis, Panel, z_panel};
use crate::report::{Artifact, ReportError};
use drawing::Sheet;
use graph::{Graph, PanelQuantity};
use numeric::digits::{count, counted, short};

const WIDTH: f64 = 1200.0;
const TOP: f64 = 104.0;
const PANEL: [f64; 2] = [490.0, 290.0];
const PITCH: [f64; 2] = [600.0, 374.0];

/// Returns four panels for each case with a sweep.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let mut artifacts = Vec::new();
    for case in &record.results.cases {
        if let Some(sweep) = &case.sweep {
            let sheet = figure(case, sweep, record.results.seed)?;
            artifacts.extend(plots::artifacts(&case.name, "", &sheet)?);
        }
    }
    Ok(artifacts)
}

const VARIANCE_AND_COST: [PanelQuantity; 2] = [
    PanelQuantity {
        head: "(a) Variance of one draw",
        title: "variance V",
        values: |row| row.compared(Score::Variance),
        theory: |point| point.variance,
    },
    PanelQuantity {
        head: "(b) Cost",
        title: "lookups per draw N",
        values: |row| row.compared(Score::Lookups),
        theory: |point| point.lookups,
    },
];

/// Returns values without deviations.
const fn plain(measured: Option<f64>, theory: Option<f64>) -> Compared {
    Compared { measured, deviation: None, theory, z: None }
}

const EFFICIENCY: PanelQuantity = PanelQuantity {
    head: "(c) Efficiency",
    title: "figure of merit 1/(V·N)",
    values: |row| plain(row.fom, row.predicted_fom),
    theory: |point| point.fom,
};

const LOOKUPS_TO_UNIT_VARIANCE: PanelQuantity = PanelQuantity {
    head: "(c) Lookups to unit variance",
    title: "LTUV = V·N",
    values: |row| plain(row.fom.map(f64::recip), row.predicted_fom.map(f64::recip)),
    theory: |point| point.fom.recip(),
};

/// Returns the figure of a case with a sweep.
pub fn figure(case: &CaseRecord, sweep: &Sweep, seed: u64) -> Result<Sheet, ReportError> {
    let series = collect(case, sweep);
    let x = x_axis(sweep, &series);
    let of_medium = sweep.what.varies_medium();
    let has_setup = series.iter().any(|one| one.setup_lookups().is_some());
    let efficiency = match (of_medium, has_setup) {
        (true, false) => LOOKUPS_TO_UNIT_VARIANCE,
        (true, true) => PanelQuantity { title: "LTUV = V·(N + S/n)", ..LOOKUPS_TO_UNIT_VARIANCE },
        (false, false) => EFFICIENCY,
        (false, true) => PanelQuantity { title: "figure of merit 1/(V·(N + S/n))", ..EFFICIENCY },
    };
    let quantities = [VARIANCE_AND_COST[0], VARIANCE_AND_COST[1], efficiency];
    let graph =
        |(i, quantity)| Graph::new(place(i, &x, y_axis(&quantity, &series)), quantity, &series);
    let graphs: Vec<Graph> = quantities.into_iter().enumerate().map(graph).collect();
    let entries: Vec<_> = series.iter().map(Series::entry).collect();
    let mut notes = vec![z_panel::note(sweep)];
    notes.extend(z_panel::legend_of_hollow(&series));
    notes.extend(has_setup.then(|| setup_note(case)));
    if !of_medium {
        notes.extend(graph::note_on_optima(&series));
    }
    notes.extend(graph::notes(&graphs, &series));
    notes.extend(series::notes(&series));
    notes.extend(channels(case, &series));
    let foot = Foot { top: TOP + 2.0 * PITCH[1], entries: &entries, notes: &notes };
    let titles = [&*case.title, &subtitle(case, seed)];
    let mut figure = Figure::with_foot(&case.name, WIDTH, titles, &foot)?;
    figure.sheet.height -= 6.0;
    let Figure { face, sheet, .. } = &mut figure;
    for (i, graph) in graphs.iter().enumerate() {
        graph.draw(sheet, &series);
        if i == 0 {
            graph.write_names(face, sheet, &series);
        }
        if i == 2 && !of_medium {
            graph::draw_optima(face, sheet, &graph.panel, &series);
        }
    }
    z_panel::draw(face, sheet, place(3, &x, x.clone()), &series, sweep);
    Ok(figure.close(&foot))
}

/// Returns the meaning of S and n.
fn setup_note(case: &CaseRecord) -> String {
    let draws = counted(case.draws_per_ray, "draw");
    format!(
        "(c): S lookups before the first draw of a ray, shared by its n = {draws} (draws_per_ray of the case)"
    )
}

/// Returns sentences about the one channel of all curves, and about those that a crowded plot leaves out.
fn channels(case: &CaseRecord, series: &[Series]) -> Option<String> {
    let shown: Vec<&str> =
        series.iter().flat_map(|one| &one.rows).map(|row| row.values.channel.as_str()).collect();
    let mut missing: Vec<&str> = Vec::new();
    for row in case.rows().filter(|row| !row.channel.is_empty()) {
        if !shown.contains(&&*row.channel) && !missing.contains(&&*row.channel) {
            missing.push(&row.values.channel);
        }
    }
    let missing = missing.join("; ");
    let one = only_channel(shown.into_iter()).map(|channel| format!("All curves: {channel}"));
    let csv =
        (!missing.is_empty()).then(|| format!("In the CSV only, for lack of room: {missing}"));
    let said = joined(one.into_iter().chain(csv), ". ");
    (!said.is_empty()).then_some(said)
}

fn subtitle(case: &CaseRecord, seed: u64) -> String {
    let mut parts = vec![subject(&case.name, &case.medium)];
    let truths: Vec<f64> = case.rows().filter_map(|row| row.truth).collect();
    if let [first, rest @ ..] = &truths[..]
        && rest.iter().all(|truth| truth == first)
    {
        parts.push(format!("truth {}", short(*first, 6)));
    }
    let draws: Vec<u64> = case.experiments.iter().filter_map(|one| one.draws).collect();
    if let (Some(&minimum), Some(&maximum)) = (draws.iter().min(), draws.iter().max()) {
        let to = if minimum < maximum { format!(" to {}", count(maximum)) } else { String::new() };
        parts.push(format!("{}{to} draws", count(minimum)));
        parts.push(format!("seed {seed}"));
    }
    parts.join("  ·  ")
}

fn place(index: usize, x: &Axis, y: Axis) -> Panel {
    let left = LEFT + (index % 2) as f64 * PITCH[0];
    let top = TOP + (index / 2) as f64 * PITCH[1];
    Panel::at([left, top], PANEL, x.clone(), y)
}

fn x_axis(sweep: &Sweep, series: &[Series]) -> Axis {
    let swept =
        series.iter().flat_map(|one| one.rows.iter().filter_map(|row| row.experiment.swept()));
    let curves = sweep.curves.iter().flat_map(|curve| curve.points.iter().map(|point| point.x));
    // Estimators that are not swept have places of their own at the right edge.
    let fixed = series.iter().filter(|one| one.is_fixed()).count() as f64;
    let shown = swept.chain(curves).filter(|&x| !sweep.log || x > 0.0);
    let axis = Axis::around(sweep.axis.clone(), sweep.log, 0.06, shown);
    axis.extended(fixed * graph::PLACE / PANEL[0])
}

/// Returns a range with every measured point, and with predictions within four decades of them: the predicted variance
/// of some estimators has a pole.
fn y_axis(quantity: &PanelQuantity, series: &[Series]) -> Axis {
    let rows = || series.iter().flat_map(|one| &one.rows);
    let positive = |value: &f64| *value > 0.0 && value.is_finite();
    let mut shown: Vec<f64> =
        rows().filter_map(|row| (quantity.values)(row).measured).filter(positive).collect();
    let mut theory: Vec<f64> = series
        .iter()
        .flat_map(|one| one.theory(quantity.theory, quantity.values))
        .map(|(_, y)| y)
        .chain(rows().filter_map(|row| (quantity.values)(row).theory))
        .filter(positive)
        .collect();
    theory.sort_by(f64::total_cmp);
    let middle = theory.get(theory.len() / 2).copied();
    let low = shown.iter().copied().reduce(f64::min).or(middle).unwrap_or(1.0);
    let high = shown.iter().copied().reduce(f64::max).or(middle).unwrap_or(1.0);
    theory.retain(|&y| y >= low * 1e-4 && y <= high * 1e4);
    shown.extend(theory);
    Axis::around(quantity.title, true, 0.06, shown)
}
