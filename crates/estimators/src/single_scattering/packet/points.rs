//! Points that are chosen beforehand: source-driven, scattering-driven, and both by multiple importance sampling.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Pages, Sums};
use crate::kernels::packet::bank::Numbers;
use crate::single_scattering::main_part::MainPart;
use crate::single_scattering::technique::point;
use crate::space::shadow::Found;
use crate::space::tally::add_where;
use numeric::{Lane, pack};
use theory::single::CameraTracking;

/// Eight walks to points.
pub struct Points<'a, S: Simd> {
    world: World<'a>,
    camera: CameraTracking,
    from_source: bool,
    main: Option<MainPart<'a>>,
    walk: Walk<'a, S>,
    looks: mask64x8<S>,
    done: mask64x8<S>,
    is_second: mask64x8<S>,
    s: f64x8<S>,
    extinction: f64x8<S>,
    weight: f64x8<S>,
}

/// Points that are chosen beforehand.
#[derive(Clone, Copy)]
pub struct Technique<'a> {
    /// How the transmittance from the ray's origin is found.
    pub camera: CameraTracking,
    /// Whether points are found from the light.
    pub from_source: bool,
    /// From what points are found, or those after the light's.
    pub main: Option<MainPart<'a>>,
}

impl<'a> Pages<'a> for Technique<'a> {
    type Page<S: Simd> = Points<'a, S>;

    #[inline(always)]
    fn page<S: Simd>(self, simd: S, world: World<'a>, walk: Walk<'a, S>) -> Self::Page<S> {
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        let Self { camera, from_source, main } = self;
        Points {
            world,
            camera,
            from_source,
            main,
            walk,
            looks: none,
            done: none,
            is_second: none,
            s: walk.t,
            extinction: zero,
            weight: zero,
        }
    }
}

impl<S: Simd> Points<'_, S> {
    /// These set out from the ray's origin to their points.
    #[inline(always)]
    fn set_out(&mut self, which: mask64x8<S>) {
        let begun = match self.camera {
            CameraTracking::Delta => self.s.each(1.0),
            _ => self.world.controlled(self.s),
        };
        self.weight = Lane::select(which, begun, self.weight);
        self.walk.begin(which);
    }
}

/// [`MainPart::point`].
#[inline(always)]
fn point_of<S: Simd>(main: MainPart, u: f64x8<S>) -> f64x8<S> {
    pack::outlined_if_narrow(
        u.token(),
        #[inline(always)]
        move || main.point(u),
    )
}

/// [`MainPart::density`].
#[inline(always)]
fn density_of<S: Simd>(main: MainPart, s: f64x8<S>) -> f64x8<S> {
    pack::outlined_if_narrow(
        s.token(),
        #[inline(always)]
        move || main.density(s),
    )
}

impl<S: Simd> Page<S> for Points<'_, S> {
    const LIT: u32 = 4;
    const DONE: u32 = 2;

    #[inline(always)]
    fn begin(&mut self, numbers: &mut Numbers<S>, which: mask64x8<S>, sums: &mut Sums<S>) {
        let u = numbers.uniform_where(which);
        let problem = &*self.world.setup.problem;
        let s = match (&self.main, self.from_source) {
            (None, _) => point(problem, u),
            (Some(main), false) => point_of(*main, u),
            (Some(main), true) => {
                Lane::select(self.is_second, point_of(*main, u), point(problem, u))
            }
        };
        self.s = Lane::select(which, s, self.s);
        match self.world.extinction {
            // It needs no step to be looked up.
            Some(value) if value > 0.0 && self.camera != CameraTracking::Exact => {
                add_where(&mut sums.lookups, which, s.each(1.0));
                self.extinction = s.each(value);
                self.set_out(which);
            }
            _ => self.looks |= which,
        }
    }

    #[inline(always)]
    fn flies(&self) -> mask64x8<S> {
        self.walk.on
    }

    #[inline(always)]
    fn fly(&mut self, _: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        let mut t = self.walk.t;
        if self.camera != CameraTracking::Exact {
            t = self.walk.fly(flies, depth);
            self.walk.inside &= t.below(self.s);
        }
        Lane::select(self.looks, self.s, t)
    }

    #[inline(always)]
    fn collide(
        &mut self,
        numbers: &mut Numbers<S>,
        _: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>) {
        let (zero, one) = (extinction.each(0.0), extinction.each(1.0));
        let looked = self.looks;
        let scatters = looked & zero.below(extinction);
        self.looks = looked & !looked;
        self.extinction = Lane::select(looked, extinction, self.extinction);
        let mut ends = looked & !scatters;
        let mut arrives = scatters;
        if self.camera == CameraTracking::Exact {
            add_where(&mut sums.lookups, looked, one);
            let transmittance = self.world.transmittance(self.s, scatters);
            self.weight = Lane::select(scatters, transmittance, self.weight);
        } else {
            let inside = self.walk.inside;
            add_where(&mut sums.lookups, looked | inside, one);
            arrives = self.walk.flew & !inside;
            if self.camera == CameraTracking::Delta {
                let number = numbers.uniform_where(inside);
                let killed = inside & (number * self.walk.sampling()).below(extinction);
                ends |= killed;
                self.walk.on &= !killed;
            } else {
                let weight = self.weight * self.walk.kept(&self.world, extinction);
                self.weight = Lane::select(inside, weight, self.weight);
            }
            self.walk.on &= !arrives;
            if looked.any_true() {
                self.set_out(scatters);
            }
        }
        self.done |= ends;
        (arrives, self.s)
    }

    #[inline(always)]
    fn lit(&mut self, (which, light): Found<S>, sums: &mut Sums<S>) {
        let problem = &*self.world.setup.problem;
        let radiance = self.weight * (self.extinction * problem.source(self.s)) * light;
        let density = match (&self.main, self.from_source) {
            (None, _) => problem.equiangular_density(self.s),
            (Some(main), false) => density_of(*main, self.s),
            (Some(main), true) => problem.equiangular_density(self.s) + density_of(*main, self.s),
        };
        let (value, is_one_of_two) = (radiance / density, self.from_source && self.main.is_some());
        // The one point's value is the draw's, its sign included where it is 0.
        let value = if is_one_of_two { sums.value + value } else { value };
        sums.value = Lane::select(which, value, sums.value);
        self.done |= which;
    }

    #[inline(always)]
    fn done(&mut self) -> &mut mask64x8<S> {
        &mut self.done
    }

    #[inline(always)]
    fn finish(&mut self) -> [mask64x8<S>; 2] {
        let (begins, mut ended) = (self.done, self.done);
        self.done = begins & !begins;
        if self.from_source && self.main.is_some() {
            ended &= self.is_second;
            self.is_second ^= begins;
        }
        [ended, begins]
    }
}
