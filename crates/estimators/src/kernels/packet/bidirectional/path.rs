//! Paths by a technique and what they are worth, sixteen at a time: as a `Path` of `bidirectional_rod/walk`.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::tracker::{Side, Tracker};
use numeric::pack::WIDTH;
use numeric::rng::PACKS;
use numeric::{Lane, Span};
use theory::bidirectional_rod::{Combination, quotient};
use theory::problems::Problem;
use theory::problems::bidirectional_rod::{HIGHEST_ORDER, Sensor};

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
        self.walk(Side::Light, light, lives);
        let from_light = &self.subpaths[Side::Light as usize];
        let whole = [from_light[0].whole, from_light[1].whole];
        self.walk(Side::Camera, camera, whole);
        let mut valid = lives;
        for (pack, valid) in valid.iter_mut().enumerate() {
            self.join([order, s], pack);
            let camera = &self.subpaths[Side::Camera as usize][pack];
            let light = &self.subpaths[Side::Light as usize][pack];
            *valid = camera.whole;
            if s == 0 {
                *valid &= camera.left & !camera.is_forward[order];
            } else if s == order + 2 {
                let forward = light.is_forward[order];
                *valid &= light.left & if is_transmitted { forward } else { !forward };
            }
        }
        let zero = self.lookups[0].each(0.0);
        if !(valid[0] | valid[1]).any_true() {
            return [zero; PACKS];
        }
        let is_hit = s == 0 || s == order + 2;
        if !is_hit && self.page.is_tracked {
            self.connect(s, valid);
        }
        let mut worth = [zero; PACKS];
        for pack in 0..PACKS {
            if !self.page.is_tracked {
                self.attenuate(pack, valid[pack]);
            }
            let (path, mut counts) = (&self.paths[pack], valid[pack]);
            if !is_hit {
                counts &= zero.below(path.transmittance[s - 1]);
            }
            worth[pack] = Lane::select(counts, path.worth(self.page.combination), zero);
        }
        worth
    }

    /// Makes paths by a technique `[r, s]` of the vertices of two subpaths, before they are connected.
    #[inline(always)]
    fn join(&mut self, [order, s]: [usize; 2], pack: usize) {
        let (problem, support) = (&*self.setup.problem, self.setup.mesh.support());
        let light = &self.subpaths[Side::Light as usize][pack];
        let camera = &self.subpaths[Side::Camera as usize][pack];
        let path = &mut self.paths[pack];
        let is_transmitted = problem.sensor == Sensor::Transmitted;
        let from_light = s.saturating_sub(1).min(order);
        let from_camera = order - from_light;
        let one = self.lookups[0].each(1.0);
        let all = one.at_most(one);
        (path.order, path.light) = (order, s);
        path.at[0] = one.each(support.from);
        path.at[order + 1] = one.each(if is_transmitted { support.to } else { support.from });
        for i in 0..from_light {
            path.at[i + 1] = light.at[i];
        }
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
        if s >= 1 && s <= order + 1 {
            path.is_forward[s - 1] = match s {
                _ if s == order + 1 => {
                    if is_transmitted {
                        all
                    } else {
                        !all
                    }
                }
                1 => all,
                _ => path.at[s - 1].below(path.at[s]),
            };
            path.transmittance[s - 1] = one;
        }
        for i in 0..order {
            let turns = path.is_forward[i] ^ path.is_forward[i + 1];
            let (on, back) = (one.each(problem.forward), one - problem.forward);
            path.phase[i] = Lane::select(turns, back, on);
        }
    }

    /// `T̂` in closed form: of the connection, or of all segments where weights ask for them.
    #[inline(always)]
    fn attenuate(&mut self, pack: usize, which: mask64x8<S>) {
        let (order, light) = (self.paths[pack].order, self.paths[pack].light);
        let all = matches!(self.page.combination, Combination::Full(_));
        for j in 0..=order {
            if all || j + 1 == light {
                let (from, to) = (self.paths[pack].at[j], self.paths[pack].at[j + 1]);
                self.paths[pack].transmittance[j] = self.between(from, to, which);
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

/// Paths from the light to the sensor.
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
    /// None yet.
    #[inline(always)]
    pub fn new(like: f64x8<S>, albedo: f64) -> Self {
        let (one, all) = (like.each(1.0), like.at_most(like));
        Self {
            order: 0,
            light: 0,
            at: [one; HIGHEST_ORDER + 2],
            is_forward: [all; HIGHEST_ORDER + 1],
            transmittance: [one; HIGHEST_ORDER + 1],
            phase: [one; HIGHEST_ORDER],
            albedo,
        }
    }

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
