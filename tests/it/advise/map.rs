//! Map of the best estimators: `cargo test --release --test it advise::map -- --ignored` writes `docs/advise-map.csv` and
//! `docs/pictures/advise-map.svg`.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{ANY, asked, request};
use trueflight::advise::{AdviceRequest, Costs, Row};
use trueflight::report::plots::axis::Axis;
use trueflight::report::plots::figure::{Figure, Foot, LEFT};
use trueflight::report::plots::legend::LegendEntry;
use trueflight::report::plots::panel::Panel;
use trueflight::report::plots::style::COLOURS;
use trueflight::report::plots::svg;

/// Optical thicknesses.
const DEPTHS: [f64; 4] = [0.1, 1.0, 3.0, 10.0];
/// Least σ_t relative to the largest, and share of the line below spikes.
const MEDIA: [[f64; 2]; 4] = [[0.8, 0.5], [0.0, 0.9], [0.0, 0.3], [0.0, 0.07]];
/// Number of spikes.
const SPIKES: u32 = 24;
/// Factors by which majorants exceed the maximum.
const LOOSENESS: [f64; 2] = [1.0, 4.0];
/// Seconds of a draw and of a lookup: an array in the cache, and a shader of many octaves.
const COSTS: [[f64; 2]; 2] = [[2e-8, 5e-9], [2e-8, 2e-6]];

/// Returns the estimator of a row in words, without its numbers.
fn words(row: &Row) -> String {
    let name = row.estimator.split(" (").next().unwrap_or_default();
    let rule = row
        .estimator
        .split(" (")
        .nth(1)
        .map(|rule| rule.split([',', ')']).next().unwrap_or_default());
    let rule = rule.map(|rule| format!(" {rule}")).unwrap_or_default();
    let control = row.control.split(' ').next().filter(|word| !word.is_empty());
    let control = control.map(|word| format!(", {word}")).unwrap_or_default();
    let kinds = [("local", ", local majorants"), ("pilot", ", pilots")];
    let kind = kinds.into_iter().find(|(word, _)| row.sampling.contains(word));
    let local = kind.map_or("", |(_, words)| words);
    format!("{name}{rule}{control}{local}")
}

/// Returns knots and values of irregular spikes, and the largest σ_t over the mean.
fn spikes([floor, share]: [f64; 2], depth: f64) -> (String, f64) {
    let (mut knots, mut values) = (vec![0.0], vec![floor]);
    for i in 0..SPIKES {
        let cell = 4.0 / f64::from(SPIKES);
        let half = 0.5 * cell * share;
        // The golden section places a spike in its cell.
        let at = (f64::from(i) * 0.618_033_988_75).fract();
        let middle = cell * f64::from(i) + half + at * (cell - 2.0 * half);
        for (t, value) in [(middle - half, floor), (middle, 1.0), (middle + half, floor)] {
            if t > knots[knots.len() - 1] {
                knots.push(t);
                values.push(value);
            }
        }
    }
    if knots[knots.len() - 1] < 4.0 {
        knots.push(4.0);
        values.push(floor);
    }
    let pieces = knots.windows(2).zip(values.windows(2));
    let whole: f64 = pieces.map(|(t, v)| 0.5 * (t[1] - t[0]) * (v[0] + v[1])).sum();
    let values: Vec<f64> = values.iter().map(|value| value * depth / whole).collect();
    (format!("medium.piecewise-linear = {{ knots = {knots:?}, values = {values:?} }}"), 4.0 / whole)
}

#[test]
#[ignore = "writes docs/advise-map.csv and docs/pictures/advise-map.svg"]
fn the_map_of_winners_is_drawn() {
    let mut table = String::from(
        "draw_s,lookup_s,majorant,max_over_mean,tau,rank,estimator,sampling,cost_s,deviation\n",
    );
    let mut cells = Vec::new();
    for [draw, lookup] in COSTS {
        for looseness in LOOSENESS {
            for (shape, depth) in MEDIA.iter().flat_map(|m| DEPTHS.map(|depth| (*m, depth))) {
                let (medium, ratio) = spikes(shape, depth);
                let head = "title = \"map\"\n[problem.transmittance]";
                let text = format!("{head}\n{medium}\nspan = [0, 4]\n{ANY}");
                let costs = Costs::Given { draw, lookup };
                let advice = asked(&text, &AdviceRequest { looseness, ..request(costs) });
                for row in advice.rows.iter().take(8) {
                    let sampling = row.constant.or(row.factor).unwrap_or(1.0);
                    let (name, rank, time, deviation) =
                        (words(row), row.rank, row.time, row.score.deviation());
                    let _ = writeln!(
                        table,
                        "{draw:e},{lookup:e},{looseness},{ratio:.2},{depth},{rank},\"{name}\",{sampling},{time:.3e},{deviation:.3e}",
                    );
                }
                cells.push((words(&advice.rows[0]), ratio));
            }
        }
    }
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/");
    std::fs::write(format!("{docs}pictures/advise-map.svg"), drawn(&cells)).expect("written");
    std::fs::write(format!("{docs}advise-map.csv"), table).expect("written");
}

/// Draws the winners as a map for each cost and majorant.
fn drawn(cells: &[(String, f64)]) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (name, _) in cells {
        *counts.entry(name).or_default() += 1;
    }
    let mut names: Vec<&str> = counts.keys().copied().collect();
    names.sort_by_key(|name| std::cmp::Reverse(counts[name]));
    let colour = |name: &str| {
        let place = names.iter().position(|other| *other == name).unwrap_or(0);
        COLOURS[place % COLOURS.len()]
    };
    let entry = |name: &&str| LegendEntry {
        label: (*name).to_owned(),
        line: Some((&[], 9.0)),
        marker: None,
        colour: colour(name),
    };
    let entries: Vec<LegendEntry> = names.iter().map(entry).collect();
    let notes = ["24 irregular spikes on a line, from nearly homogeneous (× max/mean) to thin layers. A draw costs 20 ns. Estimators that \
         need a majorant have one that exceeds the maximum by the given factor."
        .to_owned()];
    let foot = Foot { top: 870.0, entries: &entries, notes: &notes };
    let titles = ["Who wins where", "least predicted time to a standard error of 1 %"];
    let mut figure = Figure::with_foot("advise-map", 1200.0, titles, &foot).expect("a figure");
    for (index, block) in cells.chunks(MEDIA.len() * DEPTHS.len()).enumerate() {
        let (column, line) = (index % LOOSENESS.len(), index / LOOSENESS.len());
        let (left, top) = (LEFT + 500.0 * column as f64, 104.0 + 390.0 * line as f64);
        let axis = |title: &str| Axis { title: title.to_owned(), log: false, low: 0.0, high: 4.0 };
        let panel =
            Panel { left, top, right: left + 290.0, bottom: top + 290.0, x: axis(""), y: axis("") };
        for (at, (name, _)) in block.iter().enumerate() {
            let (x, y) = ((at % DEPTHS.len()) as f64, (at / DEPTHS.len()) as f64);
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
            let spots = corners.iter().filter_map(|(dx, dy)| panel.spot(x + dx, y + dy)).collect();
            figure.sheet.area(spots, colour(name));
        }
        let sheet = &mut figure.sheet;
        let centre = trueflight::drawing::sheet::Align::Middle;
        let dark = trueflight::report::plots::style::DARK;
        for (i, depth) in DEPTHS.iter().enumerate() {
            sheet.text(
                [left + 72.5 * (i as f64 + 0.5), top + 306.0],
                format!("τ {depth}"),
                13.0,
                dark,
                centre,
            );
        }
        for (i, (_, ratio)) in block.iter().step_by(DEPTHS.len()).enumerate() {
            let at = [left - 26.0, top + 290.0 - 72.5 * (i as f64 + 0.5)];
            sheet.text(at, format!("× {ratio:.1}"), 13.0, dark, centre);
        }
        let lookup = if line == 0 { "5 ns" } else { "2 µs" };
        let head = format!("lookup {lookup}, majorant × {}", LOOSENESS[column]);
        sheet.text([left + 145.0, top - 14.0], head, 14.0, dark, centre);
    }
    svg::document(&figure.close(&foot))
}
