//! Lookups of σ_t through one indirect call for a batch of distances or points.
//!
//! The events at a collision are compiled once per estimator and level of hardware, σ_t at a place once per field
//! and level. A kernel writes the places of a batch, one call returns `σ_t` at all of them, and the kernel goes on:
//! kernels and fields add up, they do not multiply. This is the *look up* of event-based tracking. A few kernels
//! have the formula of a few fields inlined: [`Inlined`].
//!
//! Source: F. B. Brown, W. R. Martin, *Monte Carlo methods for radiation transport analysis on vector
//! computers*, Progress in Nuclear Energy 14 (1984).

use fearless_simd::{Level, Simd, SimdBase, f64x8};

use super::{Extinction, Field, Inlined, Medium};
use numeric::fused::in_fused_code;
use numeric::geometry::{Bounds, Point};
use numeric::pack::{self, Task, WIDTH};
use numeric::twin::PAIR;
use numeric::{Lane, Twin};

/// The lookups of one field on the hardware of one level.
trait Batch: Send + Sync {
    /// `σ_t` at one distance.
    fn one(&self, t: f64) -> f64;

    /// Replaces the distances of two packs by `σ_t`, with the bits of [`Batch::one`].
    fn pair(&self, t: &mut [f64; PAIR]);

    /// Replaces any multiple of eight distances by `σ_t`, with the bits of [`Batch::one`].
    fn all(&self, t: &mut [f64]);
}

struct Compiled<'a, F, S> {
    field: &'a F,
    simd: S,
}

impl<F: Extinction, S: Simd> Batch for Compiled<'_, F, S> {
    fn one(&self, t: f64) -> f64 {
        self.simd.vectorize(
            #[inline(always)]
            || self.field.extinction(t),
        )
    }

    fn pair(&self, t: &mut [f64; PAIR]) {
        self.simd.vectorize(
            #[inline(always)]
            || {
                // Not as twins: draws along the ray have the bits of scalars.
                let Twin(first, second) = Twin::from_slice(self.simd, t);
                Twin(self.field.extinction(first), self.field.extinction(second)).store_slice(t);
            },
        );
    }

    fn all(&self, t: &mut [f64]) {
        self.simd.vectorize(
            #[inline(always)]
            || {
                for pack in t.as_chunks_mut::<WIDTH>().0 {
                    self.field.extinction(f64x8::from_slice(self.simd, pack)).store_slice(pack);
                }
            },
        );
    }
}

/// Lookups of one place after the other, for hardware without wide packs.
struct OneByOne<'a, F>(&'a F);

impl<F: Extinction> Batch for OneByOne<'_, F> {
    fn one(&self, t: f64) -> f64 {
        in_fused_code(
            #[inline(always)]
            || self.0.extinction(t),
        )
    }

    fn pair(&self, t: &mut [f64; PAIR]) {
        self.all(t);
    }

    fn all(&self, t: &mut [f64]) {
        in_fused_code(
            #[inline(always)]
            || {
                for t in t {
                    *t = self.0.extinction(*t);
                }
            },
        );
    }
}

/// A field along a ray for kernels: `σ_t` in 1/length at distances inside the support.
pub struct Lookups<'a> {
    batch: Box<dyn Batch + 'a>,
    single_value: Option<f64>,
    is_costly: bool,
    inlined: Option<Inlined<'a>>,
    /// The fields of the channels after the first.
    further: Vec<Lookups<'a>>,
}

impl<'a> Lookups<'a> {
    /// Lookups of a field on the hardware of a level.
    pub fn new<F: Extinction + 'static>(field: &'a F, level: Level) -> Self {
        let (single_value, is_costly) = (field.single_value(), field.is_costly());
        let batch = match pack::on_wide(level, Compile(field)) {
            Ok(batch) => batch,
            Err(Compile(field)) => Box::new(OneByOne(field)),
        };
        Self { batch, single_value, is_costly, inlined: Inlined::of(field), further: Vec::new() }
    }

    /// Lookups of one field for each channel: the first, and the others.
    pub fn of_channels(first: &'a Medium, further: &'a [Medium], level: Level) -> Self {
        let further = further.iter().map(|medium| medium.lookups(level)).collect();
        Self { further, ..first.lookups(level) }
    }

    /// The field of a channel.
    #[inline(always)]
    pub fn channel(&self, channel: usize) -> &Self {
        if channel == 0 { self } else { &self.further[channel - 1] }
    }

    /// `σ_t`, where it has one value.
    #[inline(always)]
    pub fn single_value(&self) -> Option<f64> {
        self.single_value
    }

    /// See [`Extinction::is_costly`].
    pub fn is_costly(&self) -> bool {
        self.is_costly
    }

    /// The field by its type, if some kernels have its formula in their loops.
    #[inline(always)]
    pub fn inlined(&self) -> Option<Inlined<'a>> {
        self.inlined
    }

    /// `σ_t` at the distances of two packs.
    #[inline(always)]
    pub fn pair<S: Simd>(&self, simd: S, t: Twin<f64x8<S>>) -> Twin<f64x8<S>> {
        if let Some(value) = self.single_value {
            return Twin::splat(simd, value);
        }
        let mut row = [0.0; PAIR];
        t.store_slice(&mut row);
        self.batch.pair(&mut row);
        Twin::from_slice(simd, &row)
    }

    /// Replaces distances by `σ_t`, with the bits that each has by itself.
    pub fn replace(&self, t: &mut [f64]) {
        let (pairs, rest) = t.as_chunks_mut();
        for pair in pairs {
            self.batch.pair(pair);
        }
        for t in rest {
            *t = self.batch.one(*t);
        }
    }
}

impl Extinction for Lookups<'_> {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        match self.single_value {
            Some(value) => t.each(value),
            None => t.replaced(
                #[inline(always)]
                |t| match t {
                    [t] => *t = self.batch.one(*t),
                    _ => self.batch.all(t),
                },
            ),
        }
    }
}

struct Compile<'a, F>(&'a F);

impl<'a, F: Extinction> Task for Compile<'a, F> {
    type Output = Box<dyn Batch + 'a>;

    fn run<S: Simd>(self, simd: S) -> Self::Output {
        Box::new(Compiled { field: self.0, simd })
    }
}

/// The lookups of one field in space.
trait AtPoint: Send + Sync {
    /// `σ_t` at a point within the bounds.
    fn one(&self, p: Point) -> f64;
}

impl<F: Field> AtPoint for F {
    fn one(&self, p: Point) -> f64 {
        in_fused_code(
            #[inline(always)]
            || self.extinction_at(p.0),
        )
    }
}

/// A field in space for kernels: `σ_t` in 1/length at points within the bounds.
pub struct Points<'a>(&'a dyn AtPoint);

impl<'a> Points<'a> {
    /// Lookups of a field.
    pub fn new<F: Field>(field: &'a F) -> Self {
        Self(field)
    }

    /// `σ_t` at a point.
    #[inline(always)]
    pub fn extinction(&self, p: Point) -> f64 {
        self.0.one(p)
    }
}

/// The lookups of one field in space on the hardware of one level.
trait PointBatch: Send + Sync {
    /// `σ_t` at the points of two packs, with the bits that each has by itself.
    fn pair(&self, points: &[[f64; PAIR]; 3]) -> [f64; PAIR];

    /// See [`Batches::depths`].
    fn depths(&self, rays: &[[f64; WIDTH]; 8]) -> Option<[f64; WIDTH]>;
}

struct CompiledInSpace<'a, F, S> {
    field: CompileInSpace<'a, F>,
    simd: S,
}

impl<F: Field, S: Simd> PointBatch for CompiledInSpace<'_, F, S> {
    fn pair(&self, points: &[[f64; PAIR]; 3]) -> [f64; PAIR] {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let [x, y, z] = points;
                let Twin(a, b) = Twin::from_slice(self.simd, x);
                let Twin(c, d) = Twin::from_slice(self.simd, y);
                let Twin(e, f) = Twin::from_slice(self.simd, z);
                let mut found = [0.0; PAIR];
                Twin(self.field.look_up([a, c, e]), self.field.look_up([b, d, f]))
                    .store_slice(&mut found);
                found
            },
        )
    }

    fn depths(&self, rays: &[[f64; WIDTH]; 8]) -> Option<[f64; WIDTH]> {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let mut lanes = [f64x8::splat(self.simd, 0.0); 8];
                for (number, row) in rays.iter().enumerate() {
                    lanes[number] = f64x8::from_slice(self.simd, row);
                }
                let [a, b, c, x, y, z, from, to] = lanes;
                let depths = self.field.field.depths_along([[a, b, c], [x, y, z]], [from, to])?;
                let mut found = [0.0; WIDTH];
                depths.store_slice(&mut found);
                Some(found)
            },
        )
    }
}

/// Lookups of one point after the other, for hardware without wide packs.
struct PointByPoint<'a, F>(CompileInSpace<'a, F>);

impl<F: Field> PointBatch for PointByPoint<'_, F> {
    fn pair(&self, points: &[[f64; PAIR]; 3]) -> [f64; PAIR] {
        let mut found = [0.0; PAIR];
        for (number, found) in found.iter_mut().enumerate() {
            let [x, y, z] = points;
            *found = in_fused_code(
                #[inline(always)]
                || self.0.look_up([x[number], y[number], z[number]]),
            );
        }
        found
    }

    fn depths(&self, _: &[[f64; WIDTH]; 8]) -> Option<[f64; WIDTH]> {
        None
    }
}

impl<F: Field> CompileInSpace<'_, F> {
    #[inline(always)]
    fn look_up<L: Lane>(&self, points: [L; 3]) -> L {
        let found = self.field.extinction_at(points);
        match &self.bounds {
            Some(bounds) => Lane::select(bounds.contain(points), found, found.each(0.0)),
            None => found,
        }
    }
}

/// A field in space for packets of walks: one indirect call returns σ_t at sixteen points.
pub struct Batches<'a> {
    batch: Box<dyn PointBatch + 'a>,
    single_value: Option<f64>,
}

impl<'a> Batches<'a> {
    /// Lookups of a field on the hardware of a level. `clipped` fields are looked up outside their bounds too,
    /// where they are 0.
    pub fn new<F: Field>(field: &'a F, level: Level, clipped: bool) -> Self {
        let bounds = clipped.then(|| field.bounds()).filter(|&b| b != Bounds::Everywhere);
        let single_value = field.single_value().filter(|_| bounds.is_none());
        let batch = match pack::on_wide(level, CompileInSpace { field, bounds }) {
            Ok(batch) => batch,
            Err(field) => Box::new(PointByPoint(field)),
        };
        Self { batch, single_value }
    }

    /// `σ_t` at the points of two packs.
    #[inline(always)]
    pub fn pair<S: Simd>(&self, simd: S, points: &[[f64; PAIR]; 3]) -> Twin<f64x8<S>> {
        match self.single_value {
            Some(value) => Twin::splat(simd, value),
            None => Twin::from_slice(simd, &self.batch.pair(points)),
        }
    }

    /// The optical depths of eight intervals of rays within the bounds. `rays` has the coordinates of origins and
    /// of directions, and the begins and ends of the intervals. `None` where the field has no formula for lanes,
    /// see [`Field::depths_along`].
    #[inline(always)]
    pub fn depths<L: Lane>(&self, rays: &[L; 8]) -> Option<L> {
        let mut rows = [[0.0; WIDTH]; 8];
        for (number, row) in rows.iter_mut().enumerate() {
            rays[number].store(row);
        }
        let depths = self.batch.depths(&rows)?;
        Some(rays[0].load(&depths))
    }
}

struct CompileInSpace<'a, F> {
    field: &'a F,
    /// Bounds, outside of which σ_t is 0.
    bounds: Option<Bounds>,
}

impl<'a, F: Field> Task for CompileInSpace<'a, F> {
    type Output = Box<dyn PointBatch + 'a>;

    fn run<S: Simd>(self, simd: S) -> Self::Output {
        Box::new(CompiledInSpace { field: self, simd })
    }
}
