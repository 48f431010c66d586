//! The walk of a hero to its first scattering, and the shadow ray from there, in several channels.
//!
//! ```text
//! the hero h flies through its σ̂;  at a tentative collision, r = σ_t/σ̂ of each channel:
//!   null, 1 − r_h       q_λ ← q_λ (1 − r_λ)
//!   absorbed            X = 0
//!   scattered, a_h r_h  q_λ ← q_λ r_λ a_λ, and
//! X_λ = q_λ/q p_λ(cos θ) Φ/(4π r²) T̂_λ,   q = q_h, or Σ_h w_h q_h by multiple importance sampling
//! ```
//!
//! In spectral tracking all channels walk together through one σ̂: probabilities `P_e` decide, and q is their
//! product. T̂ is exact, or `Π (1 − r_λ)` over the collisions of a shadow ray through the hero's σ̂. The rates of
//! these collisions and the transmittances through σ̂ are then factors of q, too. q is kept relative to the hero's,
//! see [`Media::common`]. The first flight and decision take two random numbers each time, a flight of a shadow ray
//! one, the choice of the hero one. Walks are scored when all have ended, exact shadow rays included.

use super::Shadow;
use super::events::{Right, WalkEvents};
use crate::setup::walker::Walker;
use crate::space::exit::{along, ends};
use crate::space::shadow::ShadowRays;
use crate::walks::hero::{HeroDistribution, Media, number_of_hero, of_hero, or_of_hero};
use crate::walks::{self, GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use crate::{Draw, Kernel, Request, Setup};
use media::body::MAX_CHANNELS;
use media::sampling::BothWays;
use media::{Batches, Lookups};
use numeric::geometry::Point;
use numeric::rng::{Random, Stream};
use numeric::{Kept, Lane, Mask, kept};
use theory::ParticleRule;
use theory::colours::probabilities::shares;
use theory::problems::{ChannelValues as Values, SpectralSingleScattering};
use theory::single::Tracking;

/// The number of lanes of a pack that cast their shadow rays together: aiming a ray costs more than a step.
const TOGETHER: u32 = 4;

/// Number of the hero of a walk that was not scattered.
const LOST: f64 = -1.0;

kept! {
    /// Walks to their scattering, and shadow rays from there.
    pub struct ScatteringFlight<L> {
        /// Lanes on their way along the ray, lanes that have yet to cast a shadow ray, and lanes with one in
        /// flight.
        walks: L::Mask,
        aims: L::Mask,
        casts: L::Mask,
        /// Lanes among the last at a tentative collision.
        inside: L::Mask,
        /// The number of each hero, its mean free path through σ̂ and its albedo.
        hero: L,
        mean_free_path: L,
        albedo: L,
        /// The length of the path, and where it scatters.
        length: L,
        s: L,
        /// The number of collisions along the ray, if [`WalkEvents::COUNTS`].
        collisions: L,
        /// q of each channel relative to the hero's, without the factors of σ̂.
        weights: [L; MAX_CHANNELS],
        /// The shadow ray, its present distance, and its end.
        origin: [L; 3],
        direction: [L; 3],
        t: L,
        end: L,
        /// `Π (1 − r_λ)` along it.
        through: [L; MAX_CHANNELS],
    }
}

/// The walk; it scores all channels, or the hero alone.
#[derive(Clone, Copy)]
pub struct ToScattering<'a, S, const ALL: bool> {
    setup: &'a Setup<SpectralSingleScattering>,
    walker: &'a Walker,
    distribution: Option<HeroDistribution>,
    media: Media,
    albedos: [f64; MAX_CHANNELS],
    /// True if shadow rays are tracked.
    tracks: bool,
    /// The fields on shadow rays, as packs look them up; empty for one lane.
    fields: &'a [Batches<'a>],
    steps: S,
}

/// Makes one draw.
#[inline(always)]
pub fn draw<const ALL: bool>(
    steps: impl WalkEvents,
    (walker, shadow): (&Walker, Shadow),
    setup: &Setup<SpectralSingleScattering>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<Values> {
    let walk = ToScattering::<_, ALL>::new(setup, (walker, shadow), &[], steps);
    walks::draw(&walk, setup.residual().sampling, medium, random)
}

/// Makes the draws of a request: compiled once for all walkers.
pub fn fill<const ALL: bool>(
    by: (&Walker, Shadow),
    kernel: Kernel,
    setup: &Setup<SpectralSingleScattering>,
    request: Request,
) {
    walks::by(
        kernel,
        setup,
        request,
        |level, medium, request| {
            let channels = setup.problem.channels.iter();
            let fields: Vec<_> =
                channels.map(|channel| channel.volume().batches(level, false)).collect();
            let walk = ToScattering::<_, ALL>::new(setup, by, &fields, Right);
            walks::packets(level, &walk, setup, medium, request)
        },
        #[inline(always)]
        |medium, random| draw::<ALL>(Right, by, setup, medium, random),
    );
}

impl<'a, S: WalkEvents, const ALL: bool> ToScattering<'a, S, ALL> {
    #[inline(always)]
    fn new(
        setup: &'a Setup<SpectralSingleScattering>,
        (walker, shadow): (&'a Walker, Shadow),
        fields: &'a [Batches<'a>],
        steps: S,
    ) -> Self {
        let (count, mut albedos) = (setup.fields.len(), [0.0; MAX_CHANNELS]);
        albedos[..count].copy_from_slice(&setup.problem.albedos);
        let distribution = walker.heroes().map(
            #[inline(always)]
            |heroes| HeroDistribution::new(heroes, count),
        );
        let (media, tracks) =
            (Media::new(setup, &walker.probabilities(count)), shadow == Shadow::Ratio);
        Self { setup, walker, distribution, media, albedos, tracks, fields, steps }
    }

    /// The probabilities to be scattered and to go straight on, given the hero's ratio and the ratios of all
    /// channels.
    #[inline(always)]
    fn probabilities<L: Lane>(&self, path: &ScatteringFlight<L>, own: L, ratios: &[L]) -> [L; 2] {
        if ALL && let Some(probabilities) = self.walker.together() {
            let [passes, scatters, _] = probabilities.of_events(
                self.media.count,
                #[inline(always)]
                |channel| shares(ratios[channel], self.albedos[channel]),
                &path.weights,
            );
            return [scatters, passes];
        }
        let probabilities = ParticleRule::Analog.probabilities(own, path.albedo);
        [probabilities.scatter, probabilities.transmit]
    }

    /// Multiplies the densities by the factors of events of these probabilities, and divides by the walker's.
    #[inline(always)]
    fn weigh<L: Lane>(
        &self,
        path: &mut ScatteringFlight<L>,
        [is_scattered, is_null]: [L::Mask; 2],
        [scatters, passes]: [L; 2],
        ratios: &[L],
    ) {
        let (mut next, mut own) = (path.weights, path.length);
        for (channel, &ratio) in ratios.iter().enumerate() {
            let scattered = self.steps.scattered(ratio, self.albedos[channel]);
            let factor = L::select(is_null, self.steps.passed(ratio), scattered);
            next[channel] = path.weights[channel] * factor;
            own = or_of_hero(path.hero, channel, own, next[channel]);
        }
        if self.walker.together().is_some() {
            own = L::select(is_null, passes, scatters);
        }
        for (weight, next) in path.weights.iter_mut().zip(next).take(ratios.len()) {
            weight.keep_where(is_scattered | is_null, next / own);
        }
    }

    /// Shadow rays from distances s, and their intervals within the bounds of the medium.
    #[inline(always)]
    fn shadows<L: Lane>(&self, which: L::Mask, s: L) -> ([[L; 3]; 2], [L; 2]) {
        let lit = &self.setup.problem.channels[0];
        let (origin, direction, distance) = lit.to_light(s);
        let [from, to] = ends(&lit.volume().bounds(), [origin, direction], which);
        ([origin, direction], [from.or_more(s.each(0.0)), distance.or_less(to)])
    }

    /// Casts the shadow rays of the lanes in `which`; returns the lanes with rays that enter the medium.
    #[inline(always)]
    fn cast<L: Lane>(&self, path: &mut ScatteringFlight<L>, which: L::Mask) -> L::Mask {
        let ([origin, direction], [from, to]) = self.shadows(which, path.s);
        path.origin.set_where(which, origin);
        path.direction.set_where(which, direction);
        path.t.keep_where(which, from);
        path.end.keep_where(which, to);
        let is_blocked = which & from.below(to);
        if self.steps.has_shadow_density() {
            path.length.add_where(is_blocked, to - from);
        }
        is_blocked
    }

    /// Exact transmittances of the shadow rays from distances s, of all channels or of the heroes'.
    #[inline(always)]
    fn exact<L: Lane>(&self, [hero, s]: [L; 2], is_lit: L::Mask, through: &mut [L]) {
        let (lines, [from, to]) = self.shadows(is_lit, s);
        let is_blocked = is_lit & from.below(to);
        for (channel, through) in through.iter_mut().enumerate() {
            let volume = self.setup.problem.channels[channel].volume();
            let rays = ShadowRays::new(volume, volume.bounds(), Tracking::Exact);
            let which = if ALL { is_blocked } else { is_blocked & hero.equals(channel as f64) };
            *through = rays.exact(self.fields.get(channel), which, lines, [from, to]);
        }
    }
}

impl<S: WalkEvents, const ALL: bool> Walk for ToScattering<'_, S, ALL> {
    type State<L: Lane> = ScatteringFlight<L>;

    const IS_CHROMATIC: bool = true;
    const IN_SPACE: bool = true;
    const SCORES: Scores = Scores::Later;

    #[inline(always)]
    fn begin<L: Lane>(
        &self,
        one: L,
        all: L::Mask,
        random: &mut impl Random<L>,
    ) -> ScatteringFlight<L> {
        let (none, zero, ones) = (all & !all, one.each(0.0), [one; MAX_CHANNELS]);
        let s = one.each(self.setup.residual().mesh.support().from);
        // Lanes without a shadow ray look up σ_t where this one enters.
        let (origin, direction, _) = self.setup.problem.channels[0].to_light(s);
        let mut path = ScatteringFlight {
            walks: none,
            aims: none,
            casts: none,
            inside: none,
            hero: zero,
            mean_free_path: one,
            albedo: one,
            length: zero,
            s,
            collisions: zero,
            weights: ones,
            origin,
            direction,
            t: zero,
            end: zero,
            through: ones,
        };
        self.restart(&mut path, all, one, random);
        path
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        path: &mut ScatteringFlight<L>,
        which: L::Mask,
        one: L,
        random: &mut impl Random<L>,
    ) {
        let (count, zero) = (self.media.count, one.each(0.0));
        let hero = match &self.distribution {
            Some(distribution) => distribution.choose(random.uniform_where(which)),
            None => zero,
        };
        let majorant = number_of_hero(hero, &self.media.majorants[..count]);
        path.hero.keep_where(which, hero);
        path.mean_free_path.keep_where(which, one / majorant);
        path.albedo.keep_where(which, number_of_hero(hero, &self.albedos[..count]));
        path.length.keep_where(which, zero);
        path.walks |= which;
        if S::COUNTS {
            path.collisions.keep_where(which, zero);
        }
        if ALL {
            for weight in &mut path.weights[..count] {
                weight.keep_where(which, one);
            }
        }
        if self.tracks {
            for through in &mut path.through[..count] {
                through.keep_where(which, one);
            }
        }
    }

    #[inline(always)]
    fn numbers<L: Lane>(
        &self,
        path: &mut ScatteringFlight<L>,
        random: &mut impl Random<L>,
    ) -> [L; 2] {
        let depth = -random.ln_uniform_where(path.walks | path.casts);
        [depth, random.uniform_where(path.walks)]
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(
        &self,
        path: &ScatteringFlight<L>,
        _: &Route<impl BothWays<L>>,
    ) -> L {
        path.mean_free_path
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut ScatteringFlight<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        path.inside = path.casts;
        if path.casts.any() {
            path.t.keep_where(path.casts, path.t + depth * path.mean_free_path);
            path.inside &= !path.end.at_most(path.t);
        }
        let from = route.here.reached();
        let flies = L::select(path.walks, depth, depth.each(0.0));
        let inside = path.walks & route.here.fly(flies);
        path.length.add_where(inside, route.here.reached() - from);
        inside
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut ScatteringFlight<L>,
        _: &mut Route<impl BothWays<L>>,
        collided: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, number, .. }, one) = (*collided, collided.t.each(1.0));
        let ScatteringFlight { walks, casts, .. } = *path;
        if S::COUNTS {
            path.collisions.count_where(inside);
        }
        let mut ends = walks & !inside;
        let mut is_scattered = walks & !walks;
        if walks.maybe() {
            let (mut ratios, mut own) = ([one; MAX_CHANNELS], one);
            let ratios = &mut ratios[..collided.extinctions.len()];
            for (channel, ratio) in ratios.iter_mut().enumerate() {
                *ratio = collided.extinctions[channel] / one.each(self.media.majorants[channel]);
                own = or_of_hero(path.hero, channel, own, *ratio);
            }
            let [scatters, passes] = self.probabilities(path, own, ratios);
            is_scattered = inside & number.below(scatters);
            let is_null = inside & !is_scattered & number.below(scatters + passes);
            if ALL {
                self.weigh(path, [is_scattered, is_null], [scatters, passes], ratios);
            }
            path.s.keep_where(is_scattered, t);
            ends = walks & !is_scattered & !is_null;
            path.hero.keep_where(ends, one.each(LOST));
            path.walks = is_null;
        }
        if !self.tracks {
            return !(ends | is_scattered);
        }
        if casts.any() {
            for (channel, &extinction) in collided.in_space.iter().enumerate() {
                let ratio = extinction / one.each(self.media.majorants[channel]);
                let through = path.through[channel] * ratio.one_minus();
                path.through[channel].keep_where(path.inside, through);
            }
            path.casts = path.inside;
            ends |= casts & !path.inside;
        }
        path.aims |= is_scattered;
        if path.aims.are_enough(TOGETHER) {
            let aims = path.aims;
            path.aims = aims & !aims;
            let is_blocked = self.cast(path, aims);
            path.casts |= is_blocked;
            ends |= aims & !is_blocked;
        }
        !ends
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.media.count
    }

    #[inline(always)]
    fn in_space<L: Lane>(&self, path: &ScatteringFlight<L>) -> (L::Mask, [L; 3]) {
        // Beyond the end there is no field to look up.
        let t = L::select(path.inside, path.t, path.end);
        (path.inside, along(path.origin, path.direction, t))
    }

    #[inline(always)]
    fn fields(&self) -> &[Batches<'_>] {
        self.fields
    }

    #[inline(always)]
    fn field(&self, channel: usize, place: Point) -> f64 {
        self.setup.problem.channels[channel].volume().extinction_within(place)
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.media.count
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        path: &'a ScatteringFlight<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        let count = self.media.count;
        (some[0], some[1], some[2], some[3]) = (path.hero, path.length, path.s, path.collisions);
        let weights = if ALL { &path.weights[..count] } else { &[] };
        let through = if self.tracks { &path.through[..count] } else { &[] };
        [&some[..4], weights, through, &[], &[]]
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], _: L::Mask, lookups: L, values: &mut [L]) -> L {
        let [hero, length, s, collisions, rest @ ..] = numbers else { return lookups };
        let (hero, length, s, zero) = (*hero, *length, *s, lookups.each(0.0));
        let collisions = if self.steps.has_shadow_density() { lookups } else { *collisions };
        let (is_lit, count) = (zero.at_most(hero), self.media.count);
        let mut through = [lookups; MAX_CHANNELS];
        let through = &mut through[..count];
        if self.tracks {
            through.copy_from_slice(&rest[rest.len() - count..]);
        } else {
            self.exact([hero, s], is_lit, through);
        }
        let heros = || of_hero(hero, through);
        if !ALL {
            for (channel, value) in values.iter_mut().enumerate() {
                let lit = &self.setup.problem.channels[channel];
                let probability = zero.each(self.media.probabilities[channel]);
                let alone =
                    lit.source(s) / zero.each(lit.albedo()) * through[channel] / probability;
                *value = L::select(hero.equals(channel as f64), alone, zero);
            }
            return zero;
        }
        values.copy_from_slice(&rest[..count]);
        self.media.common(hero, [length, collisions], values);
        let mut density = zero;
        for (channel, value) in values.iter_mut().enumerate() {
            let (common, lit) = (*value, &self.setup.problem.channels[channel]);
            let is_last = channel + 1 == count;
            density =
                density + common * self.steps.share(self.media.probabilities[channel], is_last);
            let through = self.steps.through(through[channel], heros);
            *value = common * through * lit.source(s) / zero.each(lit.albedo());
        }
        if !matches!(self.walker, Walker::Mis(_)) {
            density = zero.each(1.0);
        }
        for value in values.iter_mut() {
            *value = L::select(is_lit, *value / density, zero);
        }
        zero
    }
}
