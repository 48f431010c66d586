//! Paths by a technique and what they are worth, sixteen at a time: as [`super::super::walk::Path`].

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::tracker::{Subpaths, Tracker};
use crate::numeric::pack::WIDTH;
use crate::numeric::{Lane, Span};
use crate::problems::Problem;
use crate::problems::bidirectional_rod::{HIGHEST_ORDER, Sensor};
use crate::rng::PACKS;
use crate::theory::bidirectional_rod::{Combination, quotient};

impl<S: Simd> Tracker<'_, S> {
    /// What paths by a technique `[r, s]` are worth.
    #[inline(always)]
    pub fn technique(
        &mut self,
        [order, s]: [usize; 2],
        lives: [mask64x8<S>; PACKS],
    ) -> [f64x8<S>; PACKS] {
        let is_transmitted = self.setup.problem.sensor == Sensor::Transmitted;
        let [light, camera] = match s {
            0 => [[0, 0], [order, 1]],
            _ if s == order + 2 => [[order, 1], [0, 0]],
            _ => [[s - 1, 0], [order + 1 - s, 0]],
        };
        let light = self.subpaths(true, light, lives);
        let camera = self.subpaths(false, camera, [light[0].whole, light[1].whole]);
        let mut valid = [camera[0].whole, camera[1].whole];
        let mut paths = [self.path([order, s], &light[0], &camera[0]); PACKS];
        paths[1] = self.path([order, s], &light[1], &camera[1]);
        for pack in 0..PACKS {
            if s == 0 {
                valid[pack] &= camera[pack].left & !camera[pack].is_forward[order];
            } else if s == order + 2 {
                let forward = light[pack].is_forward[order];
                let arrives = if is_transmitted { forward } else { !forward };
                valid[pack] &= light[pack].left & arrives;
            }
        }
        let zero = paths[0].at[0].each(0.0);
        if !(valid[0] | valid[1]).any_true() {
            return [zero; PACKS];
        }
        let is_hit = s == 0 || s == order + 2;
        if !is_hit && self.page.is_tracked {
            let [first, second] = &mut paths;
            self.connect(s, [light[0].last, light[1].last], [first, second], valid);
        }
        let mut worth = [zero; PACKS];
        for pack in 0..PACKS {
            let path = &mut paths[pack];
            if !self.page.is_tracked {
                self.attenuate(path, valid[pack]);
            }
            let mut counts = valid[pack];
            if !is_hit {
                counts &= zero.below(path.transmittance[s - 1]);
            }
            worth[pack] = Lane::select(counts, path.worth(self.page.combination), zero);
        }
        worth
    }

    /// Paths by a technique `[r, s]`, from the vertices of two subpaths, before they are connected.
    #[inline(always)]
    fn path(&self, [order, s]: [usize; 2], light: &Subpaths<S>, camera: &Subpaths<S>) -> Paths<S> {
        let (problem, support) = (&self.setup.problem, self.setup.mesh.support());
        let is_transmitted = problem.sensor == Sensor::Transmitted;
        let from_light = s.saturating_sub(1).min(order);
        let from_camera = order - from_light;
        let one = self.lookups[0].each(1.0);
        let all = one.at_most(one);
        let mut path = Paths {
            order,
            light: s,
            at: [one.each(support.from); HIGHEST_ORDER + 2],
            is_forward: [all; HIGHEST_ORDER + 1],
            transmittance: [one; HIGHEST_ORDER + 1],
            phase: [one; HIGHEST_ORDER],
            albedo: problem.albedo,
        };
        if is_transmitted {
            path.at[order + 1] = one.each(support.to);
        }
        path.at[1..=from_light].copy_from_slice(&light.at[..from_light]);
        for i in 0..from_camera {
            path.at[order - i] = camera.at[i];
        }
        // A hit has one more segment than scatterings.
        for j in 0..from_light + usize::from(s == order + 2) {
            path.is_forward[j] = light.is_forward[j];
            path.transmittance[j] = light.nulls[j];
        }
        for j in 0..from_camera + usize::from(s == 0) {
            path.is_forward[order - j] = !camera.is_forward[j];
            path.transmittance[order - j] = camera.nulls[j];
        }
        if s == order + 1 {
            path.is_forward[s - 1] = if is_transmitted { all } else { !all };
        } else if s > 1 && s <= order {
            path.is_forward[s - 1] = path.at[s - 1].below(path.at[s]);
        }
        for i in 0..order {
            let turns = path.is_forward[i] ^ path.is_forward[i + 1];
            let (on, back) = (one.each(problem.forward), one - problem.forward);
            path.phase[i] = Lane::select(turns, back, on);
        }
        path
    }

    /// `T̂` in closed form: of the connection, or of all segments where weights ask for them.
    #[inline(always)]
    fn attenuate(&self, path: &mut Paths<S>, which: mask64x8<S>) {
        let Paths { order, light, .. } = *path;
        let all = matches!(self.page.combination, Combination::Full(_));
        for j in 0..=order {
            if all || j + 1 == light {
                path.transmittance[j] = self.between(path.at[j], path.at[j + 1], which);
            }
        }
    }

    /// The transmittances between places, where they are asked for.
    #[inline(always)]
    fn between(&self, a: f64x8<S>, b: f64x8<S>, which: mask64x8<S>) -> f64x8<S> {
        let (mut from, mut to) = ([0.0; WIDTH], [0.0; WIDTH]);
        a.or_less(b).store_slice(&mut from);
        a.or_more(b).store_slice(&mut to);
        let (medium, bits) = (self.setup.problem.medium(), which.to_bitmask());
        for (lane, from) in from.iter_mut().enumerate() {
            let is_asked = bits >> lane & 1 == 1;
            let depth = || medium.optical_depth(Span::new(*from, to[lane])).value;
            *from = if is_asked { -depth() } else { 0.0 };
        }
        f64x8::from_slice(a.token(), &from).exp()
    }
}

/// Paths from the light to the sensor, as [`super::walk::Path`].
#[derive(Clone, Copy)]
pub struct Paths<S: Simd> {
    pub order: usize,
    pub light: usize,
    pub at: [f64x8<S>; HIGHEST_ORDER + 2],
    pub is_forward: [mask64x8<S>; HIGHEST_ORDER + 1],
    pub transmittance: [f64x8<S>; HIGHEST_ORDER + 1],
    pub phase: [f64x8<S>; HIGHEST_ORDER],
    pub albedo: f64,
}

impl<S: Simd> Paths<S> {
    /// What they are worth.
    #[inline(always)]
    fn worth(&self, combination: Combination) -> f64x8<S> {
        let Self { order, light, .. } = *self;
        let own = self.quotient(light);
        match combination {
            Combination::Full(heuristic) => {
                let share = heuristic.share(
                    light,
                    order,
                    #[inline(always)]
                    |s| self.quotient(s),
                );
                share * own
            }
            Combination::Directional(heuristic) => {
                let share = heuristic.share(
                    light,
                    order,
                    #[inline(always)]
                    |s| self.directions(s),
                );
                share * own
            }
            Combination::Technique(_) => own,
        }
    }

    /// `c_s`.
    #[inline(always)]
    fn quotient(&self, s: usize) -> f64x8<S> {
        quotient(
            s,
            self.order,
            #[inline(always)]
            |j| self.transmittance[j],
            #[inline(always)]
            |i| self.phase[i - 1] * self.albedo,
        )
    }

    /// The same without a and T̂.
    #[inline(always)]
    fn directions(&self, s: usize) -> f64x8<S> {
        quotient(
            s,
            self.order,
            #[inline(always)]
            |_| self.at[0].each(1.0),
            #[inline(always)]
            |i| self.phase[i - 1],
        )
    }
}
