//! `∫σ_t dV` over balls and boxes, against quadrature of lookups.
//!
//! ```text
//! smooth fields     Gauss' rule along the edges of a box; of a ball along r and cos θ, even steps of φ
//! layers            ∫ σ_t(h) A(h) dh, A the area of the body at a height: Gauss' rule between knots and corners
//! grids and noise   Gauss' rule in every cell, in which they are polynomials
//! ```

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use super::prelude::*;
use media::Layered;
use media::Volume;
use media::constant::Constant;
use media::exponential::Exponential;
use media::gaussian::{Blob, Gaussian};
use media::grid::Grid;
use media::noise::Noise;
use media::piecewise_linear::Pieces;
use media::radial::Radial;
use media::sines::{Sines, Wave, Waves};
use media::voxels::{Interpolation, Placement};
use numeric::geometry::{Aabb, Bounds, Point};
use numeric::sum::Sum;
use theory::space::content;

/// Chords of fields that jump across them: a thousand fields take seconds, not minutes.
const FEW_CHORDS: f64 = 4e3;
/// Nodes along an edge or a radius: waves of 35 radians and blobs of a tenth are known to rounding.
const NODES: usize = 64;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let row = TrialRow::stated("∫σ_t dV, smooth", "smooth fields of five kinds, balls and boxes");
    let mut rows = run.fill([32, 1024], [row], smooth, |&(body, size, filling), seen| {
        let volume = filling.volume(body, size);
        see(&*volume, DoubleDouble::from(body.integral(&*volume)), content::MAX_CHORDS, seen)
    });
    for (trials, chords, range) in [
        ([32, 1024], FEW_CHORDS, "layers at any angle, 4e3 chords"),
        ([1, 16], content::MAX_CHORDS, "layers at any angle, 3e5 chords"),
    ] {
        let row = TrialRow::stated("∫σ_t dV, layers", range);
        rows.extend(run.fill(trials, [row], Stack::any, |stack, seen| layers(stack, chords, seen)));
    }
    let row =
        TrialRow::stated("∫σ_t dV, cells", "grids and noise over boxes, 4e3 chords; by cells");
    rows.extend(run.fill([32, 1024], [row], cells, |cells, seen| {
        let (volume, planes) = cells.of();
        let rule = GaussLegendre::new(4);
        let nodes = planes.each_ref().map(|planes| -> Vec<(f64, f64)> {
            Span::between(planes).flat_map(|span| rule.on(span).collect::<Vec<_>>()).collect()
        });
        see(&*volume, DoubleDouble::from(product(&*volume, &nodes)), FEW_CHORDS, seen)
    }));
    rows
}

/// Rounding of the quadrature, relative.
const ROUNDING: f64 = 2e-15;

/// Adds an error in units of the stated error and the rounding of the quadrature, less half a unit in the last place.
fn see(volume: &Volume, exact: DoubleDouble, chords: f64, seen: &mut Seen) -> Option<()> {
    let computed = content::by_chords(volume, chords)?;
    if exact.high <= 1e-290 {
        return None;
    }
    let allowed = computed.error + ROUNDING * exact.high;
    seen.beyond_rounding(0, Known::new(computed.value, allowed), exact);
    Some(())
}

/// Sums lookups at places along the axes, with their weights.
fn product(volume: &Volume, [xs, ys, zs]: &[Vec<(f64, f64)>; 3]) -> f64 {
    let mut sum = Sum::default();
    for &(x, of_x) in xs {
        for &(y, of_y) in ys {
            let at = |&(z, of_z): &_| of_z * volume.extinction_at(Point([x, y, z]));
            sum.add(zs.iter().map(at).sum::<f64>() * of_x * of_y);
        }
    }
    sum.value()
}

/// A ball or a box.
#[derive(Debug, Clone, Copy)]
enum Shape {
    Ball([f64; 3], f64),
    Box([f64; 3], [f64; 3]),
}

fn ball() -> impl Strategy<Value = Shape> {
    (sized(-3.0, 3.0), sized(-1.0, 1.0), [between(-1.0, 1.0); 3])
        .prop_map(|(radius, away, centre)| Shape::Ball(centre.map(|x| away * radius * x), radius))
}

fn body() -> impl Strategy<Value = Shape> {
    let cuboid = (sized(-3.0, 3.0), [between(-3.0, 3.0); 3], [between(0.1, 1.0); 3]).prop_map(
        |(size, low, edges)| {
            let low = low.map(|x| size * x);
            Shape::Box(low, [0, 1, 2].map(|i| low[i] + size * edges[i]))
        },
    );
    prop_oneof![ball(), cuboid]
}

impl Shape {
    fn bounds(self) -> Bounds {
        match self {
            Self::Ball(centre, radius) => Bounds::Sphere { centre: Point(centre), radius },
            Self::Box(low, high) => Bounds::Box(Aabb { low: Point(low), high: Point(high) }),
        }
    }

    fn centre(self) -> Point {
        match self {
            Self::Ball(centre, _) => Point(centre),
            Self::Box(low, high) => (Point(low) + Point(high)) * 0.5,
        }
    }

    /// Largest distance from the centre.
    fn reach(self) -> f64 {
        match self {
            Self::Ball(_, radius) => radius,
            Self::Box(low, high) => 0.5 * (Point(high) - Point(low)).norm(),
        }
    }

    /// Integral of a smooth field.
    fn integral(self, volume: &Volume) -> f64 {
        let rule = GaussLegendre::new(NODES);
        let (centre, radius) = match self {
            Self::Ball(centre, radius) => (Point(centre), radius),
            Self::Box(low, high) => {
                let nodes = [0, 1, 2].map(|i| rule.on(Span::new(low[i], high[i])).collect());
                return product(volume, &nodes);
            }
        };
        let turns = (0..NODES + 16).map(|i| TAU * i as f64 / (NODES + 16) as f64);
        let turns: Vec<(f64, f64)> = turns.map(f64::sin_cos).collect();
        let mut sum = Sum::default();
        for (r, of_r) in rule.on(Span::new(0.0, radius)) {
            for (cosine, of_cosine) in rule.on(Span::new(-1.0, 1.0)) {
                let across = r * ((1.0 - cosine) * (1.0 + cosine)).sqrt();
                let at = |&(sine, cosine_of_turn): &_| {
                    let away = Point([across * cosine_of_turn, across * sine, r * cosine]);
                    volume.extinction_at(centre + away)
                };
                let mean = turns.iter().map(at).sum::<f64>() / turns.len() as f64;
                sum.add(TAU * mean * of_cosine * (r * r * of_r));
            }
        }
        sum.value()
    }

    /// Area at a height along an axis, and the heights where it has kinks.
    fn area(self, axis: Point) -> (Box<dyn Fn(f64) -> DoubleDouble>, Vec<f64>) {
        let (low, high) = match self {
            Self::Box(low, high) => (low, high),
            Self::Ball(centre, radius) => {
                let middle = axis.dot(Point(centre));
                let area = move |h: f64| {
                    let off = DoubleDouble::from(h) - middle;
                    (DoubleDouble::product(radius, radius) - off * off) * PI
                };
                return (Box::new(area), vec![middle - radius, middle + radius]);
            }
        };
        if axis.0[1] == 0.0 {
            let face = DoubleDouble::from(high[1] - low[1]) * (high[2] - low[2]);
            return (Box::new(move |_| face), vec![low[0], high[0]]);
        }
        // A corner of the height v adds ± (h − v)₊²/(2 Π aᵢ).
        let corner = |number: usize| {
            let is_far = |i: usize| number >> i & 1 == 1;
            let at = |i: usize| {
                let is_high = is_far(i) == (axis.0[i] > 0.0);
                DoubleDouble::product(axis.0[i], if is_high { high[i] } else { low[i] })
            };
            let is_odd = (0..3).filter(|&i| is_far(i)).count() % 2 == 1;
            (at(0) + at(1) + at(2), if is_odd { -1.0 } else { 1.0 })
        };
        let corners: Vec<(DoubleDouble, f64)> = (0..8).map(corner).collect();
        let kinks = corners.iter().map(|(v, _)| v.value()).collect();
        let slopes = axis.0.map(|a| DoubleDouble::from(a.abs()));
        let scale = (slopes[0] * slopes[1] * slopes[2]).scaled(1);
        let area = move |h: f64| {
            let above = corners.iter().filter(|(v, _)| v.high < h);
            above.map(|&(v, sign)| (h - v).powi(2) * sign).sum::<DoubleDouble>() / scale
        };
        (Box::new(area), kinks)
    }
}

/// A smooth field; lengths are in reaches of its body.
#[derive(Debug, Clone, Copy)]
enum Filling {
    Constant,
    /// A rate along an axis.
    Exponential(f64, [f64; 3]),
    /// A wave: amplitude, phase and vector.
    Sines(f64, f64, [f64; 3]),
    /// Width and centre.
    Gaussian(f64, [f64; 3]),
    /// Coefficients after the first, of a ball.
    Radial([f64; 3]),
}

fn smooth() -> impl Strategy<Value = (Shape, f64, Filling)> {
    let anywhere = [between(-1.0, 1.0); 3];
    let exponential = (sign(), sized(-6.0, 1.5), anywhere)
        .prop_map(|(sign, rate, axis)| Filling::Exponential(sign * rate, axis));
    let wave = (between(-1.0, 1.0), between(-3.0, 3.0), sized(-2.0, 1.3), anywhere).prop_map(
        |(amplitude, phase, size, k)| Filling::Sines(amplitude, phase, k.map(|k| size * k)),
    );
    let blob = (sized(-1.0, 1.5), [between(-1.5, 1.5); 3])
        .prop_map(|(width, centre)| Filling::Gaussian(width, centre));
    let radial = [between(-0.3, 1.0); 3].prop_map(Filling::Radial);
    let any = prop_oneof![Just(Filling::Constant), exponential, wave, blob];
    prop_oneof![
        4 => (body(), sized(-6.0, 6.0), any),
        1 => (ball(), sized(-6.0, 6.0), radial),
    ]
}

impl Filling {
    fn volume(self, body: Shape, size: f64) -> Arc<Volume> {
        let (bounds, centre, unit) = (body.bounds(), body.centre(), body.reach());
        match self {
            Self::Constant => Arc::new(Constant::within(size, bounds)),
            Self::Exponential(rate, axis) => {
                let axis = Point(axis).normalised().unwrap_or(Point([0.0, 0.0, 1.0]));
                Arc::new(Layered::new(Exponential::new(size, rate / unit), axis, bounds))
            }
            Self::Sines(share, phase, k) => {
                let (amplitude, frequency) = (share * size, Point(k) * (1.0 / unit));
                let waves = Waves::new(size, vec![Wave { amplitude, frequency, phase }]);
                Arc::new(Sines::new(waves, bounds))
            }
            Self::Gaussian(width, away) => {
                let centre = centre + Point(away) * unit;
                let gaussian = Gaussian::new(size, centre, width * unit);
                Arc::new(Blob { gaussian, bounds })
            }
            Self::Radial(further) => {
                let [b, c, d] = further.map(|share| share * size);
                Arc::new(Radial::new(centre, unit, [size, b, c, d]))
            }
        }
    }
}

parameters! {
    /// Layers that jump, or bend, at heights along, across and askew of the chords.
    Stack {
        body: Shape = body(),
        axis: [f64; 3] = prop_oneof![
            Just([1.0, 0.0, 0.0]),
            between(0.05, 1.5).prop_map(|tilt| [tilt.sin(), 0.1 * tilt.sin(), tilt.cos()]),
            [(); 3].map(|()| (sign(), between(0.05, 1.0)).prop_map(|(sign, x)| sign * x)),
        ],
        reach: f64 = between(1.0, 1.3),
        bends: usize = 0..2_usize,
        values: Vec<f64> = vec(between(0.0, 1.0), 3..=7),
    }
}

fn layers(stack: &Stack, chords: f64, seen: &mut Seen) -> Option<()> {
    let &Stack { body, axis, reach, bends, ref values } = stack;
    let axis = Point(axis).normalised()?;
    let middle = axis.dot(body.centre());
    let (count, reach) = (values.len() - bends, body.reach() * reach);
    let at = |i: usize| middle + reach * (2.0 * i as f64 / count as f64 - 1.0);
    let knots: Vec<f64> = (0..=count).map(at).collect();
    let (steps, pieces) = match bends {
        0 => (true, Piecewise::steps(&knots, values)),
        _ => (false, Piecewise::lines(&knots, values)),
    };
    let (area, kinks) = body.area(axis);
    let inside = |h: f64| {
        let [low, high] = [f64::min, f64::max].map(|of| kinks.iter().copied().fold(kinks[0], of));
        h.clamp(low, high)
    };
    let mut ends: Vec<f64> = knots.iter().chain(&kinks).map(|&h| inside(h)).collect();
    ends.sort_by(f64::total_cmp);
    let rule = GaussLegendre::new(4);
    let nodes = Span::between(&ends).flat_map(|span| rule.on(span).collect::<Vec<_>>());
    let exact = nodes.map(|(h, weight)| area(h) * (pieces.value(h) * weight)).sum();
    let bounds = body.bounds();
    let volume: Arc<Volume> = if steps {
        Arc::new(Layered::new(Pieces::<true>(pieces.clone()), axis, bounds))
    } else {
        Arc::new(Layered::new(Pieces::<false>(pieces.clone()), axis, bounds))
    };
    see(&*volume, exact, chords, seen)
}

/// Grids and noise over boxes.
#[derive(Debug, Clone, Copy)]
struct Cells {
    low: [f64; 3],
    edges: [f64; 3],
    seed: u32,
    kind: ShapeKind,
}

#[derive(Debug, Clone, Copy)]
enum ShapeKind {
    Grid([usize; 3], Interpolation, Placement),
    /// Octaves and frequency.
    Noise(u32, f64),
}

fn cells() -> impl Strategy<Value = Cells> {
    let interpolation = any_of(&[Interpolation::Nearest, Interpolation::Trilinear]);
    let placement = any_of(&[Placement::Vertices, Placement::CentresClamped]);
    let size = [2..5_usize, 2..5_usize, 2..5_usize];
    let grid = (size, interpolation, placement).prop_map(|(n, i, p)| ShapeKind::Grid(n, i, p));
    let noise = (1..=2_u32, sized(-0.5, 0.3)).prop_map(|(octaves, f)| ShapeKind::Noise(octaves, f));
    let kind = prop_oneof![(grid, [between(0.2, 3.0); 3]), (noise, [between(0.2, 1.5); 3])];
    ([between(-2.0, 2.0); 3], 0..1000_u32, kind).prop_map(|(low, seed, (kind, edges))| Cells {
        low,
        edges,
        seed,
        kind,
    })
}

impl Cells {
    /// The field, and the planes between which it is a polynomial, axis by axis.
    fn of(&self) -> (Arc<Volume>, [Vec<f64>; 3]) {
        let &Self { low, edges, seed, kind } = self;
        let high = [0, 1, 2].map(|i| low[i] + edges[i]);
        let cuboid = Aabb { low: Point(low), high: Point(high) };
        match kind {
            ShapeKind::Grid(size, interpolation, placement) => {
                // All that samples of either kind, or their neighbourhoods, may begin and end at.
                let planes = [0, 1, 2].map(|i| {
                    let halves = 2 * (size[i] - usize::from(placement == Placement::Vertices));
                    let at = |j: usize| low[i] + (high[i] - low[i]) * j as f64 / halves as f64;
                    (0..=halves).map(at).collect()
                });
                (Arc::new(Grid::random(size, seed, cuboid, interpolation, placement)), planes)
            }
            ShapeKind::Noise(octaves, frequency) => {
                let width = 2.0 / f64::from(1_u32 << octaves) / frequency;
                let planes = [0, 1, 2].map(|i| {
                    let first = (low[i] / width).ceil();
                    let inner = (0..64).map(|j| (first + f64::from(j)) * width);
                    let inside = inner.filter(|&x| low[i] < x && x < high[i]);
                    std::iter::once(low[i]).chain(inside).chain([high[i]]).collect()
                });
                let bounds = Bounds::Box(cuboid);
                (Arc::new(Noise::of_octaves(2.0, (frequency, octaves), seed, bounds)), planes)
            }
        }
    }
}
