//! A point from the light, the scattering of delta tracking, or both, by multiple importance sampling.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Pages, Sums};
use crate::kernels::packet::bank::Numbers;
use crate::single_scattering::technique::{Sharing, point};
use crate::space::shadow::Found;
use crate::space::tally::add_where;
use numeric::Lane;
use theory::single::CameraTracking;

/// Eight walks, to a point from the light or to the first real collision.
pub struct Mis<'a, S: Simd> {
    world: World<'a>,
    walk: Walk<'a, S>,
    sharing: Sharing,
    /// The chance that a real collision scatters.
    scatters: f64,
    looks: mask64x8<S>,
    done: mask64x8<S>,
    /// Whose point is the one from the light.
    from_light: mask64x8<S>,
    s: f64x8<S>,
    extinction: f64x8<S>,
    number: f64x8<S>,
    /// `Π (1 − σ_t/σ̂)`.
    kept: f64x8<S>,
}

/// Both techniques.
#[derive(Clone, Copy)]
pub struct Technique {
    /// How they share what they find.
    pub sharing: Sharing,
}

impl<'a> Pages<'a> for Technique {
    type Page<S: Simd> = Mis<'a, S>;

    #[inline(always)]
    fn page<S: Simd>(self, simd: S, world: World<'a>, walk: Walk<'a, S>) -> Self::Page<S> {
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        let sharing = self.sharing;
        let scatters = sharing.absorption.scatters(world.setup.problem.albedo());
        Mis {
            world,
            walk,
            sharing,
            scatters,
            looks: none,
            done: none,
            from_light: none,
            s: walk.t,
            extinction: zero,
            number: zero,
            kept: zero,
        }
    }
}

impl<S: Simd> Mis<'_, S> {
    #[inline(always)]
    fn is_tracked(&self) -> bool {
        self.sharing.camera == CameraTracking::Ratio
    }

    /// These set out from the ray's origin.
    #[inline(always)]
    fn set_out(&mut self, which: mask64x8<S>) {
        self.kept = Lane::select(which, self.kept.each(1.0), self.kept);
        self.walk.begin(which);
    }

    /// These set out to their first real collision.
    #[inline(always)]
    fn track(&mut self, which: mask64x8<S>) {
        self.from_light &= !which;
        self.set_out(which);
    }

    /// What becomes of these after their point from the light.
    #[inline(always)]
    fn go_on(&mut self, which: mask64x8<S>) {
        if self.sharing.is_one {
            self.done |= which;
        } else {
            self.track(which);
        }
    }
}

impl<S: Simd> Page<S> for Mis<'_, S> {
    const LIT: u32 = 4;
    const DONE: u32 = 2;

    #[inline(always)]
    fn begin(&mut self, numbers: &mut Numbers<S>, which: mask64x8<S>, sums: &mut Sums<S>) {
        let mut looks = which;
        if self.sharing.is_one {
            let u = numbers.uniform_where(which);
            looks &= u.below(u.each(0.5));
            self.track(which & !looks);
        }
        let s = point(&self.world.setup.problem, numbers.uniform_where(looks));
        self.s = Lane::select(looks, s, self.s);
        self.from_light |= looks;
        match self.world.extinction {
            // It needs no step to be looked up.
            Some(value) if value > 0.0 && self.is_tracked() => {
                add_where(&mut sums.lookups, looks, s.each(1.0));
                self.extinction = s.each(value);
                self.set_out(looks);
            }
            _ => self.looks |= looks,
        }
    }

    #[inline(always)]
    fn flies(&self) -> mask64x8<S> {
        self.walk.on
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        self.number = numbers.uniform_where(flies & !self.from_light);
        let t = self.walk.fly(flies, depth);
        self.walk.inside &= !self.from_light | t.below(self.s);
        Lane::select(self.looks, self.s, t)
    }

    #[inline(always)]
    fn collide(
        &mut self,
        _: &mut Numbers<S>,
        _: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>) {
        let (zero, one) = (extinction.each(0.0), extinction.each(1.0));
        let (inside, looked) = (self.walk.inside, self.looks);
        add_where(&mut sums.lookups, inside | looked, one);
        let left = self.walk.flew & !inside;
        let threshold = self.number * self.walk.sampling();
        let real = inside & !self.from_light & threshold.below(extinction);
        let hits = real & threshold.below(extinction * self.scatters);
        if self.is_tracked() {
            let kept = self.kept * self.walk.kept(&self.world, extinction);
            self.kept = Lane::select(inside & !real, kept, self.kept);
        }
        self.walk.on &= !(real | left);
        self.done |= (real & !hits) | (left & !self.from_light);
        let mut casts = hits | (left & self.from_light);
        self.s = Lane::select(hits, self.walk.t, self.s);
        self.extinction = Lane::select(hits | looked, extinction, self.extinction);
        if looked.to_bitmask() != 0 {
            let found = looked & zero.below(extinction);
            self.looks = looked & !looked;
            self.go_on(looked & !found);
            if self.is_tracked() {
                self.set_out(found);
            } else {
                casts |= found;
            }
        }
        (casts, self.s)
    }

    #[inline(always)]
    fn lit(&mut self, (which, light): Found<S>, sums: &mut Sums<S>) {
        let problem = &*self.world.setup.problem;
        let kept = match self.sharing.camera {
            CameraTracking::Exact => self.world.transmittance(self.s, which),
            _ => self.kept,
        };
        let collision = self.extinction * self.scatters * kept;
        let point = problem.equiangular_density(self.s);
        let own = Lane::select(self.from_light, point, collision);
        let other = Lane::select(self.from_light, collision, point);
        let density = self.sharing.heuristic.shared(own, other);
        let source = problem.source(self.s) / light.each(self.scatters);
        let times = if self.sharing.is_one { 2.0 } else { 1.0 };
        let value = collision * source * light / density * times;
        add_where(&mut sums.value, which, value);
        let first = which & self.from_light;
        self.done |= which & !first;
        self.go_on(first);
    }

    #[inline(always)]
    fn done(&mut self) -> &mut mask64x8<S> {
        &mut self.done
    }
}
