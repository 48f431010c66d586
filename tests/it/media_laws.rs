//! Laws that every field obeys, in 1-D and in 3-D, on rays of every kind.

use std::path::Path;

use crate::common::{predicted, try_body};
use fearless_simd::Level;
use trueflight::geometry::{Aabb, Point};
use trueflight::media::{Body, CATALOGUE, Medium};
use trueflight::numeric::quadrature::GaussLegendre;
use trueflight::numeric::{Span, sum::Sum};

/// 1-D forms, each on the span that follows.
const LINES: [(&str, &str); 17] = [
    ("constant = { extinction = 0.5 }", "[0, 4]"),
    ("constant = { extinction = 0 }", "[0, 1]"),
    ("piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0] }", "[-1, 5]"),
    ("piecewise-linear = { knots = [0, 1, 2.5, 4], values = [0.2, 1.5, 0, 0.9] }", "[0.3, 3.7]"),
    ("exponential = { extinction = 2, rate = 0.35 }", "[-2, 9]"),
    ("exponential = { extinction = 1e-3, rate = -400 }", "[0, 0.03]"),
    ("exponential = { extinction = 3e4, rate = 1e4 }", "[0, 10]"),
    ("exponential = { extinction = 0.5, rate = 0 }", "[1, 5]"),
    ("exponential = { extinction = 0.5, rate = 1e-300 }", "[1, 5]"),
    ("exponential = { extinction = 0.5, rate = -1e-18 }", "[1, 5]"),
    ("exponential = { extinction = 1.2, rate = 0.5, base = 0.2 }", "[0, 3]"),
    // e^{−727} has nine digits.
    ("exponential = { extinction = 6.4e196, rate = -956 }", "[-0.76, -0.37]"),
    // e^{−1000} is 0.
    ("exponential = { extinction = 1, rate = -10 }", "[-100, 0.5]"),
    ("gaussian = { peak = 3, centre = 2, width = 0.6 }", "[0, 7]"),
    ("gaussian = { peak = 300, centre = 5, width = 1e-3 }", "[0, 9]"),
    (
        "sines = { base = 1, amplitudes = [0.5, -0.5], frequencies = [2, 31], phases = [0, 1] }",
        "[-3, 8]",
    ),
    ("sines = { base = 2, amplitudes = [-1], frequencies = [0], phases = [1.57] }", "[0, 3]"),
];

/// 3-D forms; those without bounds of their own fill a box, a ball or all of space.
const VOLUMES: [&str; 27] = [
    "constant = { extinction = 0.5, bounds.sphere = { centre = [2, 2, 2], radius = 2 } }",
    "piecewise-constant = { breaks = [0, 1, 3], values = [1, 0.2], axis = [1, 0, 1] }",
    "piecewise-linear = { knots = [0, 1, 3], values = [1, 0, 0.2], axis = [0, 1, 2] }",
    "exponential = { extinction = 2, rate = 0.35 }",
    "exponential = { extinction = 2, rate = -1, axis = [1, 2, 2], \
     bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "gaussian = { peak = 3, centre = [1.7, 2.1, 2], width = 0.6 }",
    "gaussian = { peak = 3, centre = [1, 2, 2], width = 0.1, \
     bounds.sphere = { centre = [2, 2, 2], radius = 2 } }",
    "gaussian = { peak = 3, centre = 1.7, width = 0.6 }",
    // Almost level along the second ray.
    "gaussian = { peak = 9, centre = 2.5, width = 0.04, axis = [1, 2, 1e-9], \
     bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "radial = { centre = [2, 2, 2], radius = 1.9, coefficients = [2, -2] }",
    "radial = { centre = [1, 2, 2.5], radius = 2.7, coefficients = [0.1, 2, -3, 1.2] }",
    // (1 − 2x)² touches 0 inside.
    "radial = { centre = [2, 2, 2], radius = 1.5, coefficients = [1, -4, 4] }",
    "sines = { base = 0.8, amplitudes = [0.5, -0.3], vectors = [[1, 2, 3], [0, -9, 4]] }",
    "sines = { base = 1, amplitudes = [0.4, -0.6], frequencies = [2, 31], phases = [0, 1] }",
    "sines = { base = 1, amplitudes = [-0.5], frequencies = [7], axis = [1, 2, 1e-9] }",
    "eq21 = {}",
    "noise = { extinction = 2, octaves = 1 }",
    "noise = { extinction = 2, octaves = 3, fade = \"cubic\", frequency = 0.7, seed = 9 }",
    "noise = { extinction = 1, octaves = 7, bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "noise = { extinction = 1, octaves = 5, gain = 1, \
     bounds.sphere = { centre = [2, 2, 2], radius = 2 } }",
    "grid = { random = { size = [5, 5, 5], seed = 7 }, samples = \"vertices\", \
     bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "grid = { random = { size = [5, 4, 3], seed = 7 }, interpolation = \"nearest\", \
     samples = \"vertices\", bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "grid = { random = { size = [7, 4, 9] }, bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "grid = { random = { size = [7, 4, 9] }, border = \"zero\", extinction = 9, \
     bounds.box = { low = [0.1, 0, 0], high = [4, 3.7, 4] } }",
    "grid = { random = { size = [3, 4, 9] }, interpolation = \"nearest\", \
     bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "grid = { random = { size = [1, 1, 1] }, border = \"zero\", \
     bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
    "grid = { random = { size = [1, 2, 1] }, extinction = 0, \
     bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }",
];

/// Oblique, axial, missing, within a face, from inside, of zero length, grazing, diagonal.
const RAYS: [&str; 8] = [
    "{ origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 20 }",
    "{ origin = [0.25, 1.5, -3], direction = [0, 0, 1], length = 12 }",
    "{ origin = [50, 50, 50], direction = [1, 0, 0], length = 5 }",
    "{ origin = [-1, 0, 2], direction = [1, 0, 0], length = 9 }",
    "{ origin = [2, 2, 2], direction = [1, -2, 0.3], length = 7 }",
    "{ origin = [2, 2, 2], direction = [1, 0, 0], length = 0 }",
    "{ origin = [-20, 14, 12], direction = [1, -1, 0], length = 40 }",
    "{ origin = [-1, -1, -1], direction = [1, 1, 1], length = 12 }",
];

fn bodies() -> impl Iterator<Item = (String, Body)> {
    let lines = LINES.iter().map(|(field, span)| format!("medium.{field}\nspan = {span}"));
    let volumes = VOLUMES
        .iter()
        .flat_map(|field| RAYS.iter().map(move |ray| format!("volume.{field}\nray = {ray}")));
    lines.chain(volumes).map(|text| {
        let body =
            try_body(&text, Path::new(".")).unwrap_or_else(|faults| panic!("{text}: {faults:?}"));
        (text, body)
    })
}

/// Returns fractions spread over (0, 1) without the pattern of a lattice.
fn fractions(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(|i| (f64::from(i) * 0.618_033_988_749_894_9).fract())
}

fn within(span: Span, fraction: f64) -> f64 {
    span.from + fraction * (span.to - span.from)
}

/// Returns `∫σ_t` of lookups: panels between the breaks, halved until they agree.
fn quadrature(medium: &Medium) -> f64 {
    let (rule, support) = (GaussLegendre::new(20), medium.support());
    let mut ends = medium.breaks();
    ends.extend([support.from, support.to]);
    ends.sort_by(f64::total_cmp);
    let mut sum = Sum::default();
    let panel = |a: f64, b: f64| {
        let at: Vec<f64> = rule.nodes.iter().map(|x| a + (b - a) * x).collect();
        let values = medium.extinctions(&at);
        (b - a) * rule.weights.iter().zip(values).map(|(w, v)| w * v).sum::<f64>()
    };
    let mut open: Vec<(f64, f64, u32)> = ends.windows(2).map(|e| (e[0], e[1], 0)).collect();
    while let Some((a, b, depth)) = open.pop() {
        let middle = 0.5 * (a + b);
        let (whole, halves) = (panel(a, b), panel(a, middle) + panel(middle, b));
        if (whole - halves).abs() <= 1e-13 * halves || depth == 12 {
            sum.add(halves);
        } else {
            open.extend([(a, middle, depth + 1), (middle, b, depth + 1)]);
        }
    }
    sum.value()
}

#[test]
fn every_page_is_under_the_laws() {
    for page in CATALOGUE.pages {
        let begins = format!("{} =", page.name());
        assert!(VOLUMES.iter().any(|field| field.starts_with(&begins)), "{}", page.name());
    }
}

#[test]
fn optical_depth_is_additive() {
    for (text, body) in bodies() {
        let medium = body.medium();
        let span = medium.span();
        let whole = medium.optical_depth(span);
        for fraction in fractions(9) {
            let middle = within(span, fraction);
            let parts = medium.optical_depth(Span::new(span.from, middle))
                + medium.optical_depth(Span::new(middle, span.to));
            let allowed = 1e-13 * whole.value + whole.error + parts.error;
            let off = (parts.value - whole.value).abs();
            assert!(off <= allowed, "{text}: {off:e} at {middle}");
        }
    }
}

#[test]
fn optical_depth_is_the_integral_of_lookups() {
    for (text, body) in bodies() {
        let medium = body.medium();
        let (depth, integral) = (medium.optical_depth(medium.span()), quadrature(&medium));
        let off = (depth.value - integral).abs();
        assert!(off <= 1e-11 * depth.value + depth.error, "{text}: {depth:?} against {integral}");
    }
}

/// The panels between breaks, with the nodes that a page states, integrate σ_t and its square.
#[test]
fn panels_integrate_the_field_and_its_square() {
    for (text, body) in bodies() {
        let medium = body.medium();
        let (Some(nodes), support) = (medium.panel_nodes(), medium.support()) else { continue };
        let ends = support.cut(medium.breaks());
        let integrals = |nodes: usize| {
            let rule = GaussLegendre::new(nodes);
            Span::between(&ends).fold([0.0; 2], |sums, part| {
                let (at, weights): (Vec<f64>, Vec<f64>) = rule.on(part).unzip();
                let values = medium.extinctions(&at).into_iter().zip(weights);
                values.fold(sums, |[one, two], (x, w)| [one + w * x, two + w * x * x])
            })
        };
        // Along a diagonal the panels of a lattice are longest.
        let most = if text.contains("direction = [1, 1, 1]") { 1e-12 } else { 2e-13 };
        for (few, many) in integrals(nodes).into_iter().zip(integrals(24)) {
            assert!((few - many).abs() <= most * many.max(1e-2), "{text}: {few} for {many}");
        }
    }
}

/// Formulas of the optical depth for lanes have the bits of the field along the ray.
#[test]
fn lanes_have_the_optical_depths_of_rays() {
    for (text, body) in bodies() {
        let Body::Volume { volume, ray, .. } = &body else { continue };
        let (batches, span) = (volume.batches(Level::new(), false), body.medium().support());
        let ([a, b, c], [x, y, z]) = (ray.origin.0, ray.direction.0);
        if let Some(depth) = batches.depths(&[a, b, c, x, y, z, span.from, span.to]) {
            assert_eq!(depth, body.medium().optical_depth(span).value, "{text}");
        }
    }
}

#[test]
fn error_bounds_are_small() {
    for (text, body) in bodies() {
        let medium = body.medium();
        let depth = medium.optical_depth(medium.span());
        assert!(depth.value >= 0.0 && depth.error <= 1e-11 * depth.value.max(0.1), "{text}");
    }
}

#[test]
fn free_flight_inverts_optical_depth() {
    for (text, body) in bodies() {
        let medium = body.medium();
        let whole = medium.optical_depth(medium.span());
        assert_eq!(medium.free_flight(1.001 * whole.value + 1e-9), None, "{text}");
        let (support, inverse) = (medium.support(), medium.inverse());
        for fraction in fractions(30).filter(|_| whole.value > 0.0) {
            let depth = fraction * whole.value;
            for s in [medium.free_flight(depth), inverse.free_flight(depth)] {
                let s = s.unwrap_or_else(|| panic!("{text}: {fraction}"));
                let back = medium.optical_depth(Span::new(support.from, s));
                let allowed = 1e-12 * whole.value + back.error;
                let off = (back.value - depth).abs();
                assert!(off <= allowed, "{text}: {depth} became {back:?}");
            }
        }
    }
}

#[test]
fn lookups_are_those_of_the_volume_and_never_negative() {
    for (text, body) in bodies() {
        let medium = body.medium();
        let support = medium.support();
        for t in fractions(500).map(|fraction| within(support, fraction)) {
            let seen = medium.extinction(t);
            assert!(seen >= 0.0 && seen.is_finite(), "{text}: {seen} at {t}");
            if let Body::Volume { volume, ray, .. } = &body
                && !support.is_empty()
            {
                let there = volume.extinction_at(ray.at(t));
                let off = (seen - there).abs();
                assert!(off <= 1e-12 * there.max(1.0), "{text}: {seen} and {there} at {t}");
            }
        }
    }
}

#[test]
fn majorants_are_never_exceeded() {
    for field in VOLUMES {
        let text = format!("volume.{field}\nray = {}", RAYS[0]);
        let Ok(Body::Volume { volume, .. }) = try_body(&text, Path::new(".")) else {
            panic!("{text}");
        };
        for (i, edge) in (0..).zip([4.0, 1.0, 0.3, 0.01].repeat(10)) {
            let spread = |n: u32| (f64::from(n) * 0.754_877_666_246_692_7).fract() * (4.0 - edge);
            let low = Point([spread(i), spread(i + 50), spread(i + 90)]);
            let within = Aabb { low, high: low + Point([edge; 3]) };
            let highest = volume.majorant(&within);
            let mut shifts = fractions(3000);
            while let (Some(x), Some(y), Some(z)) = (shifts.next(), shifts.next(), shifts.next()) {
                let p = low + Point([x, y, z]) * edge;
                let value = volume.extinction_at(p);
                assert!(value <= highest, "{field}: {value} exceeds {highest} at {p:?}");
            }
        }
    }
}

/// Layers along a ray at the cosine 0.6 to their axis are the field along a line with lengths divided by 0.6.
#[test]
fn layers_have_the_predictions_of_a_line() {
    let pages = [
        ("constant = { extinction = 0.5 }", "constant = { extinction = 0.5 }"),
        (
            "piecewise-constant = { breaks = [-1, 0.2, 1.7, 3], values = [1, 0.3, 0.6] }",
            "piecewise-constant = { breaks = [0, 2, 4.5, 6.666666666666667], values = [1, 0.3, 0.6] }",
        ),
        (
            "piecewise-linear = { knots = [-1, 0.2, 3], values = [1, 0.3, 0.6] }",
            "piecewise-linear = { knots = [0, 2, 6.666666666666667], values = [1, 0.3, 0.6] }",
        ),
        (
            "exponential = { extinction = 0.5, rate = 0.5 }",
            "exponential = { extinction = 0.8243606353500641, rate = 0.3 }",
        ),
        (
            "gaussian = { peak = 0.9, centre = 0.8, width = 0.6 }",
            "gaussian = { peak = 0.9, centre = 3, width = 1 }",
        ),
        (
            "sines = { base = 0.5, amplitudes = [0.2, -0.3], frequencies = [2, 5], phases = [2, 9] }",
            "sines = { base = 0.5, amplitudes = [0.2, -0.3], frequencies = [1.2, 3], phases = [0, 4] }",
        ),
    ];
    let numbers = |field: &str| -> Vec<[Option<f64>; 4]> {
        let rows = predicted(&format!(
            "title = \"\"\n[problem.transmittance]\n{field}\nsampling = 1.2\nestimators = [\"woodcock\", \
             {{ residual-ratio = {{ control.mean = {{}} }} }}, {{ ratio = {{ sampling.local-majorants.segments = 9 }} }}]"
        ));
        let lookups = |at: usize| rows[at].experiment.predicted_lookups;
        let row = |at: usize| {
            [rows[at].truth, rows[at].predicted_variance, lookups(at), rows[at].predicted_kurtosis]
        };
        (0..rows.len()).map(row).collect()
    };
    for (layers, line) in pages {
        let ray = "ray = { origin = [3, 7, -1], direction = [0, 0.8, 0.6], length = 5 }";
        let in_space = numbers(&format!("volume.{layers}\n{ray}"));
        let on_line = numbers(&format!("medium.{line}\nspan = [0, 5]"));
        for (seen, expected) in in_space.as_flattened().iter().zip(on_line.as_flattened()) {
            let is_near = |(seen, expected): (f64, f64)| (seen - expected).abs() <= 1e-9 * expected;
            let agrees = seen.zip(*expected).map_or(seen == expected, is_near);
            assert!(agrees, "{layers}: {in_space:?}, {on_line:?}");
        }
        assert!(on_line[0].iter().all(Option::is_some), "{line}: {on_line:?}");
    }
}

#[test]
fn a_grid_file_brings_its_box_or_asks_for_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |high: f32| {
        let mut bytes = b"VOL\x03".to_vec();
        bytes.extend([1i32, 1, 1, 2, 1].iter().flat_map(|n| n.to_le_bytes()));
        let reals = [0.0f32, 0.0, 0.0, 1.0, 1.0, high, 0.5, 1.5];
        bytes.extend(reals.iter().flat_map(|x| x.to_le_bytes()));
        std::fs::write(folder.path().join("a.vol"), bytes).expect("written");
        let ray = "{ origin = [0.5, 0.5, -1], direction = [0, 0, 1], length = 9 }";
        try_body(&format!("volume.grid = {{ file = \"a.vol\" }}\nray = {ray}"), folder.path())
    };
    let medium = file(4.0).unwrap_or_else(|faults| panic!("{faults:?}")).medium();
    // Two cells of length 2, linear between their centres at 1 and 3, constant beyond.
    assert_eq!(medium.optical_depth(medium.span()).value, 4.0);
    let faults = file(0.0).err().unwrap_or_default();
    assert!(faults.iter().any(|fault| fault.message.contains("do not make a box")));
}
