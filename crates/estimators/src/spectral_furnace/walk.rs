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
use crate::chromatic::{WalkEvents, WalkerWeights};
use crate::setup::walker::Walker;
use crate::walks::hero::{HeroDistribution, LastPiece, Media, Weighing, number_of_hero};
use crate::walks::{GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use media::Batches;
use media::body::MAX_CHANNELS;
use media::sampling::BothWays;
use numeric::geometry::exit::{along, ends, ends_in_place};
use numeric::geometry::frame::turned_lanes;
use numeric::geometry::{Bounds, Point};
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};
use theory::problems::SpectralFurnace;

/// Distance to the boundary of a ball, in radii, within which rounding may place the end of a grazing flight on the
/// wrong side.
const DOUBTFUL: f64 = 1e-6;

/// The walk into a furnace.
#[derive(Clone, Copy)]
pub struct InFurnace<'a, S> {
    problem: &'a SpectralFurnace,
    among: Scatterers<'a, S>,
    weighing: Weighing,
    scores_all: bool,
    /// The distribution of the hero, if one is chosen.
    distribution: Option<HeroDistribution>,
    /// σ_t of each channel for packs.
    fields: &'a [Batches<'a>],
}

kept! {
    /// Walks on their way, kept in memory.
    pub struct Path<L> {
        place: [L; 3],
        direction: [L; 3],
        inside: L::Mask,
        /// The number of the hero, its σ̂ and its albedo.
        hero: L,
        majorant: L,
        albedo: L,
        /// The length of the path, and of its last flight.
        length: L,
        last: L,
        densities: Densities<L>,
    }
}

impl<'a, S: WalkEvents> InFurnace<'a, S> {
    /// The walk by steps on a setup.
    #[inline(always)]
    pub fn new(
        steps: S,
        by: WalkerWeights<'a>,
        setup: &'a Setup<SpectralFurnace>,
        fields: &'a [Batches<'a>],
    ) -> Self {
        let (problem, count) = (&*setup.problem, setup.fields.len());
        let WalkerWeights { walker, weighing, scores_all } = by;
        let media = Media::new(setup, &walker.probabilities(count));
        let mut phases = [problem.channels[0].phase; MAX_CHANNELS];
        for (channel, own) in problem.channels.iter().enumerate() {
            phases[channel] = own.phase;
        }
        let distribution = walker.heroes().map(|heroes| HeroDistribution::new(heroes, count));
        let among = Scatterers { media, albedos: &problem.albedos, phases, walker, steps };
        Self { problem, among, weighing, scores_all, distribution, fields }
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

impl<S: WalkEvents> Walk for InFurnace<'_, S> {
    type State<L: Lane> = Path<L>;

    const ON_RAY: bool = false;
    const IN_SPACE: bool = true;
    const PAUSES: bool = false;
    const IS_CHROMATIC: bool = true;
    const IS_NOWHERE: bool = true;
    const SCORES: Scores = Scores::Later;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, all: L::Mask, random: &mut impl Random<L>) -> Path<L> {
        let zero = one.each(0.0);
        let mut path = Path {
            place: [zero; 3],
            direction: [zero; 3],
            inside: all,
            hero: zero,
            majorant: one,
            albedo: zero,
            length: zero,
            last: zero,
            densities: Densities::new(one),
        };
        self.restart(&mut path, all, one, random);
        path
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        path: &mut Path<L>,
        which: L::Mask,
        one: L,
        random: &mut impl Random<L>,
    ) {
        let (Scatterers { media, albedos, .. }, zero) = (&self.among, one.each(0.0));
        let hero = match &self.distribution {
            Some(distribution) => distribution.choose(random.uniform_where(which)),
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
        if self.scores_all {
            path.densities.restart(media.count, which, one);
        }
    }

    #[inline(always)]
    fn numbers<L: Lane>(&self, _: &mut Path<L>, random: &mut impl Random<L>) -> [L; 2] {
        [-random.ln_uniform(); 2]
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Path<L>,
        _: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let flight = depth / path.majorant;
        let end = self.end_beyond(path, flight);
        path.inside = !end.at_most(flight);
        path.last = L::select(path.inside, flight, end.or_more(end.each(0.0)));
        path.length = path.length + path.last;
        path.place = along(path.place, path.direction, path.last);
        path.inside
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (inside, one, hero) = (extinctions.inside, path.length.each(1.0), path.hero);
        let own = path.densities.look(&self.among, hero, extinctions.in_space);
        let probabilities = path.densities.probabilities(&self.among, [own, path.albedo]);
        let [passes, scatters, _] = probabilities;
        let number = random.uniform_where(inside);
        let scattered = inside & number.below(scatters);
        let null = inside & !scattered & number.below(scatters + passes);
        let mut cosine = one;
        if scattered.any() {
            cosine = self.scatter(path, scattered, random);
        }
        if self.scores_all && inside.maybe() {
            let events = Events { scattered, null, collided: inside };
            path.densities.weigh(&self.among, hero, (events, probabilities), cosine);
        }
        scattered | null
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.among.media.count
    }

    #[inline(always)]
    fn in_space<L: Lane>(&self, path: &Path<L>) -> (L::Mask, [L; 3]) {
        (path.inside, path.place)
    }

    #[inline(always)]
    fn fields(&self) -> &[Batches<'_>] {
        self.fields
    }

    #[inline(always)]
    fn field(&self, channel: usize, place: Point) -> f64 {
        self.problem.channels[channel].volume.extinction_within(place)
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.among.media.count
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        path: &'a Path<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        (some[0], some[1], some[2]) = (path.hero, path.length, path.last);
        let count = if self.scores_all { self.media() } else { 0 };
        [&some[..3], &path.densities.weights[..count], &[], &[], &[]]
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], _: L::Mask, lookups: L, values: &mut [L]) -> L {
        let (media, zero) = (&self.among.media, lookups.each(0.0));
        let [hero, mut length, last] = [numbers[0], numbers[1], numbers[2]];
        if !self.scores_all {
            media.alone(hero, values);
            return zero;
        }
        for (channel, value) in values.iter_mut().enumerate() {
            *value = numbers[3 + channel];
        }
        let is_weighted = matches!(self.among.walker, Walker::Mis(_));
        if is_weighted && self.weighing.last_piece != LastPiece::Everywhere {
            length = length - last;
        }
        media.common(hero, [length, lookups], values);
        if is_weighted { media.balance(self.weighing.missing, values) } else { zero }
    }
}
