//! The walk of a hero through a volume in several channels, until it is absorbed or leaves.
//!
//! ```text
//! the hero h flies −ln u/σ̂_h;  beyond the bounds the walk has left
//! a tentative collision, r = σ_t/σ̂ of each channel, is null, absorbing or scattering by the hero's probabilities:
//!   f_λ ← f_λ (1 − r_λ),   f_λ r_λ (1 − a_λ),   f_λ r_λ a_λ p_λ(cos θ)
//! ```
//!
//! The furnace shines wherever a walk ends, so that f is the density of the walk itself. f is kept relative to the hero's,
//! see [`Densities`]. In spectral tracking all channels walk together through one σ̂ with one phase function: probabilities `P_e` decide,
//! and f is relative to them. A flight takes one random number, a collision one, a scattering one for θ and one for the azimuth, the
//! choice of the hero one.

use crate::Setup;
use crate::chromatic::densities::{Densities, Events, Scatterers};
use crate::chromatic::{By, Steps};
use crate::setup::walker::Walker;
use crate::space::bank::Walk;
use crate::walks::hero::{LastPiece, Weighing};
use crate::walks::hero::{Law, Media, number_of_hero};
use media::body::MOST_CHANNELS;
use numeric::geometry::Bounds;
use numeric::geometry::exit::{along, ends, ends_in_place};
use numeric::geometry::frame::turned_lanes;
use numeric::pack::WIDTH;
use numeric::rng::Random;
use numeric::{Lane, Mask};
use theory::problems::SpectralFurnace;

/// Number of numbers that a walk leaves beside its weights: its hero, its length, and the length of its last
/// flight.
const REST: usize = 3;

/// Distance to the boundary of a ball, in radii, within which rounding may place the end of a grazing flight on the
/// wrong side.
const DOUBTFUL: f64 = 1e-6;

/// The walk into a furnace.
pub struct InFurnace<'a, S> {
    problem: &'a SpectralFurnace,
    among: Scatterers<'a, S>,
    weighing: Weighing,
    scores_all: bool,
    /// The distribution of the hero, if one is chosen.
    law: Option<Law>,
}

/// Walks on their way, kept in memory.
#[derive(Clone, Copy)]
pub struct Path<L: Lane> {
    place: [L; 3],
    direction: [L; 3],
    ended: L::Mask,
    /// The number of the hero, its σ̂ and its albedo.
    hero: L,
    majorant: L,
    albedo: L,
    /// The length of the path, and of its last flight.
    length: L,
    last: L,
    /// Lookups.
    pub lookups: L,
    densities: Densities<L>,
}

impl<L: Lane> Path<L> {
    /// A number that a walk leaves.
    #[inline(always)]
    pub fn number(&self, number: usize) -> L {
        match number {
            0 => self.hero,
            1 => self.length,
            2 => self.last,
            _ => self.densities.weights[number - REST],
        }
    }
}

impl<'a, S: Steps> InFurnace<'a, S> {
    /// The walk by steps on a setup.
    #[inline(always)]
    pub fn new(steps: S, by: By<'a>, setup: &'a Setup<SpectralFurnace>) -> Self {
        let (problem, count) = (&*setup.problem, setup.fields.len());
        let By { walker, weighing, scores_all } = by;
        let media = Media::new(setup, &walker.probabilities(count));
        let mut phases = [problem.channels[0].phase; MOST_CHANNELS];
        for (channel, own) in problem.channels.iter().enumerate() {
            phases[channel] = own.phase;
        }
        let law = walker.heroes().map(|heroes| Law::new(heroes, count));
        let among = Scatterers { media, albedos: &problem.albedos, phases, walker, steps };
        Self { problem, among, weighing, scores_all, law }
    }

    /// Computes values from the numbers that walks left, and from their lookups; returns the defect.
    #[inline(always)]
    pub fn score<L: Lane>(
        &self,
        numbers: impl Fn(usize) -> L,
        lookups: L,
        values: &mut [L; MOST_CHANNELS],
    ) -> L {
        let media = &self.among.media;
        let (hero, mut length) = (numbers(0), numbers(1));
        let found = &mut values[..media.count];
        if !self.scores_all {
            media.alone(hero, found);
            return lookups.each(0.0);
        }
        for (channel, found) in found.iter_mut().enumerate() {
            *found = numbers(REST + channel);
        }
        let is_weighted = matches!(self.among.walker, Walker::Mis(_));
        if is_weighted && self.weighing.last_piece != LastPiece::Everywhere {
            length = length - numbers(2);
        }
        media.common(hero, [length, lookups], found);
        if is_weighted { media.balance(self.weighing.missing, found) } else { lookups.each(0.0) }
    }

    /// The distances to the boundary, where a flight ends beyond it or may do so.
    ///
    /// Where a ray grazes a ball the distance is computed with more digits, only where it is needed.
    #[inline(always)]
    fn end_beyond<L: Lane>(&self, path: &Path<L>, flight: L) -> L {
        let (all, bounds) = (flight.at_most(flight), &self.problem.bounds);
        let rays = [path.place, path.direction];
        let Bounds::Sphere { radius, .. } = bounds else {
            return ends_in_place(bounds, rays, all)[1];
        };
        let near = ends_in_place(bounds, rays, !all)[1];
        let is_doubtful = !flight.below(near - radius * DOUBTFUL);
        if is_doubtful.any() { ends(bounds, rays, is_doubtful)[1] } else { near }
    }

    /// Turns the lanes in `which`; returns the cosines.
    #[inline(always)]
    fn scatter<L: Lane>(
        &self,
        path: &mut Path<L>,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> L {
        let (among, hero, direction) = (&self.among, path.hero, path.direction);
        let (number, turns) = (random.uniform_where(which), random.uniform_where(which));
        let (cosine, turned) = turns.outlined_if_narrow(
            #[inline(always)]
            move || {
                let cosine = among.cosine(hero, number);
                (cosine, turned_lanes(direction, cosine, turns))
            },
        );
        for (axis, to) in path.direction.iter_mut().enumerate() {
            to.keep_where(which, turned[axis]);
        }
        cosine
    }
}

impl<S: Steps> Walk for InFurnace<'_, S> {
    type State<L: Lane> = Path<L>;
    type Flight<L: Lane> = L::Mask;
    type Met<L: Lane> = [L; MOST_CHANNELS];

    #[inline(always)]
    fn none<L: Lane>(&self, one: L) -> Path<L> {
        let zero = one.each(0.0);
        Path {
            place: [zero; 3],
            direction: [zero; 3],
            ended: one.at_most(one),
            hero: zero,
            majorant: one,
            albedo: zero,
            length: zero,
            last: zero,
            lookups: zero,
            densities: Densities::new(one),
        }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, random: &mut impl Random<L>) {
        let (Scatterers { media, albedos, .. }, which) = (&self.among, path.ended);
        let zero = path.length.each(0.0);
        let hero = match &self.law {
            Some(law) => law.choose(random.uniform_where(which)),
            None => zero,
        };
        path.hero.keep_where(which, hero);
        path.majorant.keep_where(which, number_of_hero(hero, &media.majorants[..media.count]));
        path.albedo.keep_where(which, number_of_hero(hero, &albedos[..media.count]));
        let (entry, direction) = (self.problem.entry.each(zero), self.problem.direction.each(zero));
        for axis in 0..3 {
            path.place[axis].keep_where(which, entry[axis]);
            path.direction[axis].keep_where(which, direction[axis]);
        }
        path.length.keep_where(which, zero);
        path.lookups.keep_where(which, zero);
        if self.scores_all {
            path.densities.restart(media.count, which, zero.each(1.0));
        }
    }

    #[inline(always)]
    fn fly<L: Lane>(&self, path: &mut Path<L>, random: &mut impl Random<L>) -> (L::Mask, [L; 3]) {
        let flight = -random.ln_uniform() / path.majorant;
        let end = self.end_beyond(path, flight);
        let inside = !end.at_most(flight);
        path.last = L::select(inside, flight, end.or_more(end.each(0.0)));
        path.length = path.length + path.last;
        path.place = along(path.place, path.direction, path.last);
        (inside, path.place)
    }

    #[inline(always)]
    fn inside<L: Lane>(inside: &L::Mask) -> L::Mask {
        *inside
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        inside: &L::Mask,
        found: [L; MOST_CHANNELS],
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (inside, one, hero) = (*inside, path.length.each(1.0), path.hero);
        path.lookups.keep_where(inside, path.lookups + 1.0);
        let own = path.densities.look(&self.among, hero, &found);
        let chances = path.densities.chances(&self.among, [own, path.albedo]);
        let [passes, scatters, _] = chances;
        let number = random.uniform_where(inside);
        let scattered = inside & number.below(scatters);
        let null = inside & !scattered & number.below(scatters + passes);
        let mut cosine = one;
        if scattered.any() {
            cosine = self.scatter(path, scattered, random);
        }
        if self.scores_all && inside.maybe() {
            let events = Events { scattered, null, collided: inside };
            path.densities.weigh(&self.among, hero, (events, chances), cosine);
        }
        path.ended = !(scattered | null);
        path.ended
    }

    fn count(&self) -> usize {
        REST + if self.scores_all { self.among.media.count } else { 0 }
    }

    #[inline(always)]
    fn store<L: Lane>(&self, path: &Path<L>, rows: &mut [[f64; WIDTH]]) {
        for (number, row) in rows.iter_mut().enumerate() {
            path.number(number).store(row);
        }
    }

    #[inline(always)]
    fn lookups<L: Lane>(path: &Path<L>) -> L {
        path.lookups
    }
}
