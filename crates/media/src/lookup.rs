//! Lookups of σ_t through one indirect call for a batch of distances or points.
//!
//! The events at a collision are compiled once per estimator and level of hardware, σ_t at a place once per field
//! and level. A kernel writes the places of a batch, one call returns `σ_t` at all of them, and the kernel goes on:
//! kernels and fields add up, they do not multiply. This is the *look up* of event-based tracking. A few kernels
//! have the formula of a few fields inlined: [`Inlined`].
//!
//! Source: F. B. Brown, W. R. Martin, *Monte Carlo methods for radiation transport analysis on vector
//! computers*, Progress in Nuclear Energy 14 (1984).

use std::marker::PhantomData;

use fearless_simd::Level;

use super::{Extinction, Facts, Field, Inlined, Medium};
use numeric::geometry::Bounds;
use numeric::pack::{self, Hardware, Task, WIDTH};
use numeric::pair::PAIR_WIDTH;
use numeric::{Lane, Pair};

/// A field at places of N coordinates, as one formula for every lane type.
trait Formula<const N: usize>: Send + Sync {
    /// `σ_t` at a place.
    fn at<L: Lane>(&self, place: [L; N]) -> L;
}

/// A field at distances along a ray.
struct Along<'a, F>(&'a F);

impl<F: Extinction> Formula<1> for Along<'_, F> {
    #[inline(always)]
    fn at<L: Lane>(&self, [t]: [L; 1]) -> L {
        self.0.extinction(t)
    }
}

/// A field at points; with bounds, it is 0 outside them.
struct Within<'a, F>(&'a F, Option<Bounds>);

impl<F: Field> Formula<3> for Within<'_, F> {
    #[inline(always)]
    fn at<L: Lane>(&self, p: [L; 3]) -> L {
        let values = self.0.value(p);
        match &self.1 {
            Some(bounds) => Lane::select(bounds.contains(p), values, values.each(0.0)),
            None => values,
        }
    }
}

/// The lookups of one field on the hardware of one level. All have the bits of [`Batch::one`].
trait FieldLookups<const N: usize>: Send + Sync {
    /// `σ_t` at one place.
    fn one(&self, place: [f64; N]) -> f64;

    /// `σ_t` at the places of two packs.
    fn pair(&self, places: &[[f64; PAIR_WIDTH]; N]) -> [f64; PAIR_WIDTH];

    /// `σ_t` at the places of one pack.
    fn pack(&self, places: &[[f64; WIDTH]; N]) -> [f64; WIDTH];
}

/// Lookups compiled for wide packs.
struct Compiled<F, S> {
    formula: F,
    simd: S,
}

impl<const N: usize, F: Formula<N>, S: Hardware> FieldLookups<N> for Compiled<F, S> {
    fn one(&self, place: [f64; N]) -> f64 {
        self.simd.vectorize(
            #[inline(always)]
            || self.formula.at(place),
        )
    }

    fn pair(&self, places: &[[f64; PAIR_WIDTH]; N]) -> [f64; PAIR_WIDTH] {
        self.simd.vectorize(
            #[inline(always)]
            || {
                // Not as a pair: draws along the ray have the bits of scalars.
                let zero = self.simd.splat(0.0);
                let (mut first, mut second) = ([zero; N], [zero; N]);
                for (axis, row) in places.iter().enumerate() {
                    Pair(first[axis], second[axis]) = Pair::from_row(self.simd, row);
                }
                let mut values = [0.0; PAIR_WIDTH];
                Pair(self.formula.at(first), self.formula.at(second)).store(&mut values);
                values
            },
        )
    }

    fn pack(&self, places: &[[f64; WIDTH]; N]) -> [f64; WIDTH] {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let mut lanes = [self.simd.splat(0.0); N];
                for (axis, row) in places.iter().enumerate() {
                    lanes[axis] = self.simd.load(row);
                }
                let mut values = [0.0; WIDTH];
                self.formula.at(lanes).store(&mut values);
                values
            },
        )
    }
}

/// Lookups of one place after the other, for hardware without packs.
struct OneByOne<F>(F);

impl<F> OneByOne<F> {
    fn each<const N: usize>(&self, rows: [&[f64]; N], values: &mut [f64])
    where
        F: Formula<N>,
    {
        let mut place = [0.0; N];
        for (lane, values) in values.iter_mut().enumerate() {
            for axis in 0..N {
                place[axis] = rows[axis][lane];
            }
            *values = self.0.at(place);
        }
    }
}

impl<const N: usize, F: Formula<N>> FieldLookups<N> for OneByOne<F> {
    fn one(&self, place: [f64; N]) -> f64 {
        let mut values = [0.0];
        self.each(place.each_ref().map(std::slice::from_ref), &mut values);
        values[0]
    }

    fn pair(&self, places: &[[f64; PAIR_WIDTH]; N]) -> [f64; PAIR_WIDTH] {
        let mut values = [0.0; PAIR_WIDTH];
        self.each(places.each_ref().map(<[f64; PAIR_WIDTH]>::as_slice), &mut values);
        values
    }

    fn pack(&self, places: &[[f64; WIDTH]; N]) -> [f64; WIDTH] {
        let mut values = [0.0; WIDTH];
        self.each(places.each_ref().map(<[f64; WIDTH]>::as_slice), &mut values);
        values
    }
}

/// Compiles the lookups of a formula for the hardware of a level.
fn compiled<'a, const N: usize>(
    formula: impl Formula<N> + 'a,
    level: Level,
) -> Box<dyn FieldLookups<N> + 'a> {
    match pack::on(level, Compile::<N, _>(formula, PhantomData)) {
        Ok(batch) => batch,
        Err(Compile(formula, _)) => Box::new(OneByOne(formula)),
    }
}

struct Compile<'a, const N: usize, F>(F, PhantomData<&'a ()>);

impl<'a, const N: usize, F: Formula<N> + 'a> Task for Compile<'a, N, F> {
    type Output = Box<dyn FieldLookups<N> + 'a>;

    fn run<S: Hardware>(self, simd: S) -> Self::Output {
        Box::new(Compiled { formula: self.0, simd })
    }
}

/// The optical depths of intervals of rays through a field, eight at a time.
pub trait Depths: Send + Sync {
    /// See [`Batches::depths`].
    fn of(&self, rays: &[[f64; WIDTH]; 8]) -> [f64; WIDTH];
}

/// A field with one formula of optical depths for every lane type.
pub trait DepthFormula: Send + Sync {
    /// The optical depth of an interval of a ray within the bounds. The ray has an origin and a direction. Its bits are those of
    /// [`Field::along`].
    fn depth<L: Lane>(&self, ray: [[L; 3]; 2], interval: [L; 2]) -> L;
}

/// Compiles a formula of optical depths for the hardware of a level, if it has packs.
pub fn depths<F: DepthFormula>(formula: &F, level: Level) -> Option<Box<dyn Depths + '_>> {
    pack::on(level, CompileDepths(formula)).ok()
}

struct CompileDepths<'a, F>(&'a F);

impl<'a, F: DepthFormula> Task for CompileDepths<'a, F> {
    type Output = Box<dyn Depths + 'a>;

    fn run<S: Hardware>(self, simd: S) -> Self::Output {
        Box::new(Compiled { formula: self.0, simd })
    }
}

impl<F: DepthFormula, S: Hardware> Depths for Compiled<&F, S> {
    fn of(&self, rays: &[[f64; WIDTH]; 8]) -> [f64; WIDTH] {
        self.simd.vectorize(
            #[inline(always)]
            || {
                let mut lanes = [self.simd.splat(0.0); 8];
                for (number, row) in rays.iter().enumerate() {
                    lanes[number] = self.simd.load(row);
                }
                let [a, b, c, x, y, z, from, to] = lanes;
                let depths = self.formula.depth([[a, b, c], [x, y, z]], [from, to]);
                let mut values = [0.0; WIDTH];
                depths.store(&mut values);
                values
            },
        )
    }
}

/// A field along a ray for kernels: `σ_t` in 1/length at distances inside the support.
pub struct Lookups<'a> {
    batch: Box<dyn FieldLookups<1> + 'a>,
    single_value: Option<f64>,
    is_costly: bool,
    inlined: Option<Inlined<'a>>,
    /// The fields of the channels after the first.
    further: Vec<Lookups<'a>>,
}

impl<'a> Lookups<'a> {
    /// Lookups of a field on the hardware of a level.
    pub fn new<F: Extinction + 'static>(field: &'a F, level: Level) -> Self {
        let Facts { single_value, is_costly, .. } = field.facts();
        let (batch, inlined) = (compiled(Along(field), level), Inlined::of(field));
        Self { batch, single_value, is_costly, inlined, further: Vec::new() }
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

    /// See [`Facts::is_costly`].
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
    pub fn pair<S: Hardware>(&self, simd: S, t: Pair<S::Pack>) -> Pair<S::Pack> {
        if let Some(value) = self.single_value {
            return Pair::splat(simd, value);
        }
        let mut row = [[0.0; PAIR_WIDTH]];
        t.store(&mut row[0]);
        Pair::from_row(simd, &self.batch.pair(&row))
    }

    /// Replaces distances by `σ_t`, with the bits that each has by itself.
    pub fn replace(&self, t: &mut [f64]) {
        let (pairs, rest) = t.as_chunks_mut();
        for pair in pairs {
            *pair = self.batch.pair(&[*pair]);
        }
        for t in rest {
            *t = self.batch.one([*t]);
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
                |t| match t.as_chunks_mut() {
                    ([pack], []) => *pack = self.batch.pack(&[*pack]),
                    _ => t.iter_mut().for_each(|t| *t = self.batch.one([*t])),
                },
            ),
        }
    }
}

/// A field in space for packets of walks: one indirect call returns σ_t at sixteen points.
pub struct Batches<'a> {
    batch: Box<dyn FieldLookups<3> + 'a>,
    depths: Option<Box<dyn Depths + 'a>>,
    single_value: Option<f64>,
}

impl<'a> Batches<'a> {
    /// Lookups of a field on the hardware of a level. `clipped` fields are looked up outside their bounds too,
    /// where they are 0.
    pub fn new<F: Field>(field: &'a F, level: Level, clipped: bool) -> Self {
        let bounds = clipped.then(|| field.bounds()).filter(|&b| b != Bounds::Everywhere);
        let single_value = field.facts().single_value.filter(|_| bounds.is_none());
        let batch = compiled(Within(field, bounds), level);
        Self { batch, depths: field.depths(level), single_value }
    }

    /// `σ_t` at the points of two packs.
    #[inline(always)]
    pub fn pair<S: Hardware>(&self, simd: S, points: &[[f64; PAIR_WIDTH]; 3]) -> Pair<S::Pack> {
        match self.single_value {
            Some(value) => Pair::splat(simd, value),
            None => Pair::from_row(simd, &self.batch.pair(points)),
        }
    }

    /// The optical depths of eight intervals of rays within the bounds. `rays` has the coordinates of origins and
    /// of directions, and the begins and ends of the intervals. `None` where the field has no formula for lanes,
    /// see [`Field::depths`].
    #[inline(always)]
    pub fn depths<L: Lane>(&self, rays: &[L; 8]) -> Option<L> {
        let depths = self.depths.as_ref()?;
        let mut rows = [[0.0; WIDTH]; 8];
        for (number, row) in rows.iter_mut().enumerate() {
            rays[number].store(row);
        }
        Some(rays[0].load(&depths.of(&rows)))
    }
}
