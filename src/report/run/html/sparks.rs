//! Small plots inside a row that opens: ln E from look to look, and the fields along the ray of a refused experiment.
//! They take their colours from the page, light or dark.

use crate::report::html::template::{Markup, html};

use crate::record::{Course, Finding};
use crate::report::lists::joined;
use crate::report::plots::svg;
use numeric::digits::{count, short};

/// Size of a plot in its own units.
const SIZE: [f64; 2] = [400.0, 120.0];

/// Range of the plot of evidence, in units of its limit.
const EVIDENCE: PlotView = PlotView { x: [0.0, 1.0], y: [-1.2, 1.2] };

/// Line: its name and its points.
struct SparkLine {
    name: String,
    points: Vec<[f64; 2]>,
}

/// Part of the plane that is shown.
struct PlotView {
    x: [f64; 2],
    y: [f64; 2],
}

impl PlotView {
    /// Returns the place of a point on the plot, in whole units.
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let share = |v: f64, [low, high]: [f64; 2]| {
            if high > low { ((v - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
        };
        [SIZE[0] * share(x, self.x), SIZE[1] * (1.0 - share(y, self.y))].map(f64::round)
    }

    fn path(&self, points: &[[f64; 2]]) -> String {
        let known = points.iter().filter(|point| point.iter().all(|v| v.is_finite()));
        // Whole numbers within the plot.
        #[expect(clippy::cast_possible_truncation)]
        svg::way(known.map(|point| self.place(*point).map(|v| v as i64)))
    }

    fn height(&self, y: f64) -> f64 {
        self.place([self.x[0], y])[1]
    }
}

/// Returns the background of all plots of ln E, defined once for the page: the limits, at which a check fails.
pub fn ground() -> Markup {
    let [limit, zero] = [1.0, 0.0].map(|y| EVIDENCE.height(y));
    html! {
        svg.hidden aria-hidden="true" focusable="false" {
            symbol.spark #ground viewBox="0 0 400 120" {
                path.mark d={ "M0 " (zero) "H400" } {}
                path.limit d={ "M0 " (limit) "H400" } {}
                text x="4" y=(limit + 12.0) { "fails" }
                text x="4" y=(zero - 4.0) { "ln E = 0" }
            }
        }
    }
}

/// Returns plots of ln E of each check of a row from look to look, in units of the limit at which it fails; nothing
/// without looks of the gate.
pub fn evidence(findings: &[&Finding]) -> Markup {
    let requested = findings.iter().copied().filter(|finding| !finding.path.is_empty());
    let [first, last] = ends(requested.clone().flat_map(|one| one.path.iter().map(|look| look[0])));
    let line = |finding: &Finding| {
        let limit = finding.gate?.ln_e_limit;
        let point = |&[draws, ln_e]: &[f64; 2]| [draws.log10(), ln_e / limit];
        Some(SparkLine {
            name: finding.check.to_string(),
            points: finding.path.iter().map(point).collect(),
        })
    };
    let lines: Vec<SparkLine> = requested.filter_map(line).collect();
    if lines.is_empty() {
        return html! {};
    }
    let view = PlotView { x: [first, last].map(f64::log10), ..EVIDENCE };
    let caption = format!("ln E from look to look, {} to {} draws: ", draws(first), draws(last));
    let marks = html! { use href="#ground" {} };
    figure("ln E from look to look", &caption, &marks, &lines, (&view, "draws"))
}

/// Returns a plot of σ_t, control and σ̂ along the ray of a refused experiment.
pub fn course(course: &Course) -> Markup {
    let fields =
        [("σ_t", &course.extinction), ("control", &course.control), ("σ\u{302}", &course.sampling)];
    let points = |field: &[f64]| course.t.iter().zip(field).map(|(&t, &v)| [t, v]).collect();
    let lines: Vec<SparkLine> = fields
        .iter()
        .filter(|(_, field)| !field.is_empty())
        .map(|(name, field)| SparkLine { name: (*name).to_owned(), points: points(field) })
        .collect();
    let values = lines.iter().flat_map(|line| line.points.iter().map(|point| point[1]));
    let [low, high] = ends(values);
    let [from, to] = ends(course.t.iter().copied());
    let view = PlotView { x: [from, to], y: [low.min(0.0), high] };
    let place =
        course.at.map_or_else(String::new, |at| format!("; it fails at t = {}", short(at, 4)));
    let names = joined(lines.iter().map(|line| &line.name), ", ");
    let label = format!("{names} along the ray{place}");
    let [from, to, high] = [from, to, high].map(|end| short(end, 3));
    let caption = format!("From t = {from} to {to}, up to {high} per length{place}: ");
    let marks = html! {
        path.mark d={ "M0 " (view.height(0.0)) "H400" } {}
        @if let Some(at) = course.at { path.limit d={ "M" (view.place([at, 0.0])[0]) " 0V120" } {} }
    };
    figure(&label, &caption, &marks, &lines, (&view, "t"))
}

fn figure(
    label: &str,
    caption: &str,
    marks: &Markup,
    lines: &[SparkLine],
    (view, along): (&PlotView, &str),
) -> Markup {
    let ends = [view.x, view.y].concat().into_iter().map(|end| short(end, 4));
    let range = joined(ends.chain([along.to_owned()]), " ");
    html! {
        figure.spark {
            svg viewBox="0 0 400 120" role="img" aria-label=(label) data-view=(range) {
                (marks)
                @for (place, line) in lines.iter().enumerate() {
                    path class={ "l" (place % 4) } d=(view.path(&line.points)) {}
                }
            }
            figcaption { (caption) @for (place, line) in lines.iter().enumerate() {
                span class={ "l" (place % 4) } { (line.name) } " "
            } }
        }
    }
}

fn draws(draws: f64) -> String {
    // Whole numbers of draws, below 2^53.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = draws as u64;
    count(whole)
}

/// Returns the minimum and the maximum of the finite numbers; zeros without any.
fn ends(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let known = numbers.filter(|number| number.is_finite());
    known.map(|x| [x, x]).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]).unwrap_or_default()
}
