//! The walk of a particle through a volume: `SimulateParticle`.
//!
//! ```text
//! begin    at the place of the tally;  w = 1
//! fly      through an optical depth −ln u of σ̂;  beyond the bounds the particle has left
//! collide  r = σ_t/σ̂;  by the odds of the rule and u:
//!            scattered     w ← w · a r/q_s;  it turns later by an angle θ at an azimuth φ
//!            straight on   w ← w · (1 − r)/q_t
//!            absorbed      the end
//!          roulette, where it is played: small |w| ← w₀ with probability |w|/w₀, else the end
//! set out  where shadow rays are cast, one is cast from each scattering first; then it turns, and flies on
//! ```
//!
//! A flight takes a random number, a collision one where more than one event is possible, a scattering one for θ
//! and one for φ, roulette one. Cells without σ̂, and all that lies outside the bounds, cost nothing. A [`Tally`]
//! scores the walk; each of its [`Steps`] may be that of a known bug.
//!
//! Shadow rays and new directions cost more than a step. A lane that needs one stands still until several lanes of
//! a pack do; meanwhile, the others go on.

use super::bank::Walk;
use super::shadow::{ShadowRays, Shadows};
use super::tally::{Collision, Departure, Scattering, Tally};
use media::majorants::flights::{Flights, Flown, Ground};
use media::phase::Phase;
use media::{Batches, Majorants};
use numeric::geometry::frame::turned_lanes;
use numeric::pack::WIDTH;
use numeric::rng::Random;
use numeric::{Kept, Lane, Mask, kept};
use theory::particle::Odds;
use theory::problems::Scene;

/// The steps of a walk; a known bug may replace each of them.
pub trait Steps: Copy {
    /// The odds at collisions of the given ratio `σ_t/σ̂` and albedo.
    fn odds<L: Lane>(&self, ratio: L, albedo: L) -> Odds<L>;

    /// Lanes of `goes_on` that survive roulette, with their weights.
    fn survive<L: Lane>(
        &self,
        goes_on: L::Mask,
        weight: &mut L,
        random: &mut impl Random<L>,
    ) -> L::Mask;

    /// σ̂ of a flight in a cell, from σ̂ of the cell and of that in which the flight begins.
    #[inline(always)]
    fn through<L: Lane>(&self, here: L, begun: L) -> L {
        let _ = begun;
        here
    }

    /// The uniform number that decides a collision, for the lanes in `which`; `depth` is the optical depth of the flight.
    #[inline(always)]
    fn number<L: Lane>(&self, which: L::Mask, depth: L, random: &mut impl Random<L>) -> L {
        let _ = depth;
        random.uniform_where(which)
    }

    /// The cosine of the scattering angle, from a uniform number.
    #[inline(always)]
    fn deflection<L: Lane>(&self, phase: &Phase, number: L) -> L {
        phase.cosine(number)
    }

    /// The axis about which a particle of a direction turns.
    #[inline(always)]
    fn axis<L: Lane>(&self, direction: [L; 3]) -> [L; 3] {
        direction
    }

    /// The cosine with which a walk begins, from a uniform number, given the right one.
    #[inline(always)]
    fn first_cosine<L: Lane>(&self, right: L, number: L) -> L {
        let _ = number;
        right
    }
}

kept! {
    /// Particles.
    pub struct Path<L> {
        /// The flights.
        pub flights: Flights<L>,
        /// w.
        pub weight: L,
        /// Lanes that were never scattered.
        pub unscattered: L::Mask,
    }
}

/// State of walks.
#[derive(Clone, Copy)]
pub struct State<L: Lane, F> {
    /// The particles.
    pub path: Path<L>,
    /// Sums and state of their tallies.
    pub found: F,
    /// Lookups so far.
    pub lookups: L,
    shadows: Shadows<L>,
    ended: L::Mask,
    /// Lanes that were scattered in this step.
    scattered: L::Mask,
    /// Lanes with a shadow ray that came to its end in this step.
    lit: L::Mask,
    /// Lanes that have yet to cast a shadow ray.
    aims: L::Mask,
    /// Lanes that have yet to turn and to set out.
    turns: L::Mask,
    /// Lanes that have yet to set out in their present directions.
    begins: L::Mask,
}

/// Flights of walks and of their shadow rays.
#[derive(Clone, Copy)]
pub struct Flight<L: Lane> {
    flown: Flown<L>,
    /// The optical depth.
    pub depth: L,
}

/// Particles in a scene, their steps, and their tally.
pub struct InSpace<'a, T, S> {
    tally: &'a T,
    steps: S,
    scene: &'a Scene,
    ground: Ground<'a>,
    shadow_rays: Option<ShadowRays<'a>>,
    /// σ_t for packs.
    fields: Option<&'a Batches<'a>>,
}

impl<'a, T: Tally, S: Steps> InSpace<'a, T, S> {
    /// The walk through a scene and its σ̂; packs provide the fields that they look up.
    pub fn new(
        tally: &'a T,
        steps: S,
        (scene, majorants): (&'a Scene, &'a Majorants),
        fields: Option<&'a Batches<'a>>,
    ) -> Self {
        let ground = Ground::new(majorants, tally.core());
        Self { tally, steps, scene, ground, shadow_rays: tally.shadow_rays(), fields }
    }

    /// Lanes that stand still until they set out together.
    #[inline(always)]
    fn waits<L: Lane>(state: &State<L, T::Found<L>>) -> L::Mask {
        state.aims | state.turns | state.begins
    }

    /// Counts lookups and adds the events to the tally; returns tentative collisions.
    #[inline(always)]
    pub fn score<L: Lane>(
        &self,
        state: &mut State<L, T::Found<L>>,
        flight: &Flight<L>,
        [extinction, albedo]: [L; 2],
        random: &mut impl Random<L>,
    ) -> Collision<L> {
        let Flown { inside, sampling, place, .. } = flight.flown;
        state.lookups.count_where(inside);
        let casts = state.shadows.on;
        if let (true, Some(rays)) = (T::CASTS, &self.shadow_rays) {
            let light = state.shadows.collide(rays, random, (place, casts & inside), extinction);
            self.tally.lit(&mut state.found, light, state.shadows.through);
            state.lit = light.0;
        }
        let walks = !(casts | Self::waits(state));
        let (inside, left) = (inside & walks, walks & !inside);
        let Path { weight, unscattered, flights: Flights { direction, .. } } = state.path;
        let at = Collision { inside, place, weight, ratio: extinction / sampling, albedo };
        self.tally.collided(&mut state.found, &at);
        let departure = Departure { left, place, direction, weight, unscattered };
        self.tally.escaped(&mut state.found, &departure);
        state.ended = walks;
        at
    }

    /// Decides the events at collisions after flights of optical depths; returns the lanes that end.
    #[inline(always)]
    pub fn decide<L: Lane>(
        &self,
        state: &mut State<L, T::Found<L>>,
        at: &Collision<L>,
        depth: L,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let Collision { inside, place, weight, ratio, albedo } = *at;
        let (zero, one, walks) = (weight.each(0.0), weight.each(1.0), state.ended);
        let odds = self.steps.odds(ratio, albedo);
        // A number is taken only where more than one event is possible.
        let surely_on = odds.scatter.at_most(zero) & one.at_most(odds.transmit);
        let surely_scattered = !surely_on & one.at_most(odds.scatter);
        let by_chance = inside & !surely_on & !surely_scattered;
        let number = self.steps.number(by_chance, depth, random);
        let (is_scattered, is_passed) = odds.decide_each(by_chance, number);
        let is_scattered = is_scattered | (inside & surely_scattered);
        let goes_on = is_scattered | is_passed | (inside & surely_on);
        let factor = L::select(is_scattered, odds.scatter_weight, odds.transmit_weight);
        state.path.weight.scale_where(goes_on, factor);
        let goes_on = self.steps.survive(goes_on, &mut state.path.weight, random);
        state.ended = walks & !goes_on;
        Self::scatter(state, is_scattered & goes_on, place);
        state.ended
    }

    /// Splits particles at collisions: the scattered ones continue in `state`, the transmitted ones are returned.
    #[inline(always)]
    pub fn split<L: Lane>(&self, state: &mut State<L, T::Found<L>>, at: &Collision<L>) -> Path<L> {
        let straight = Path { weight: at.weight * at.ratio.one_minus(), ..state.path };
        state.path.weight = at.weight * at.albedo * at.ratio;
        state.ended = !at.inside;
        Self::scatter(state, at.inside, at.place);
        straight
    }

    /// Scatters the lanes in `scattered` at places.
    #[inline(always)]
    fn scatter<L: Lane>(state: &mut State<L, T::Found<L>>, scattered: L::Mask, place: [L; 3]) {
        state.scattered = scattered;
        state.path.unscattered &= !scattered;
        state.path.flights.origin.set_where(scattered, place);
    }

    /// Lets the delayed lanes set out.
    #[inline(always)]
    fn set_out<L: Lane>(&self, state: &mut State<L, T::Found<L>>, random: &mut impl Random<L>) {
        let (zero, origin) = (state.path.weight.each(0.0), state.path.flights.origin);
        let moves = Self::waits(state);
        let (casts, turns, sets_out) = (state.aims, state.turns, state.turns | state.begins);
        let nobody = moves & !moves;
        (state.aims, state.turns, state.begins) = (nobody, nobody, nobody);
        if T::CONNECTS {
            let weight = state.path.weight;
            let at = Scattering { which: turns & !weight.equals(0.0), place: origin, weight };
            state.lookups = state.lookups + self.tally.connect(&mut state.found, &at, random);
        }
        let parallel = if T::CASTS { self.tally.parallel() } else { None };
        let draws = if parallel.is_some() { turns } else { turns | casts };
        let (mut direction, mut number) = (state.path.flights.direction, zero);
        if draws.any() {
            number = random.uniform_where(draws);
            direction = self.turned(&state.path, (draws, number), casts, random);
        }
        if let Some(towards) = parallel {
            direction.set_where(casts, towards.each(zero));
        }
        let reach = self.ground.reach([origin, direction], moves);
        if T::CASTS {
            let light = self.tally.aim(origin, number).light(direction, reach.stop);
            let (light, weight) = (self.tally.light(origin, light), state.path.weight);
            if let Some(rays) = &self.shadow_rays {
                let (rays, from) = ((rays, self.fields), (origin, weight));
                let (found, through) = state.shadows.cast(rays, casts, &light, from, reach.ends);
                self.tally.lit(&mut state.found, found, through);
            } else {
                let at = Scattering { which: casts, place: origin, weight };
                let tracked = self.tally.track(&mut state.found, &at, (&light, reach.ends), random);
                state.lookups = state.lookups + tracked;
            }
            // Lanes with a ray that needed no tracking turn next.
            state.turns = casts & !state.shadows.on;
        }
        state.path.flights.direction.set_where(turns, direction);
        state.path.flights.enter(&self.ground, sets_out, &reach);
    }

    /// New directions of the lanes in `which`, from uniform numbers: directions of shadow rays for lanes that cast
    /// one, directions of walks for the others.
    #[inline(always)]
    fn turned<L: Lane>(
        &self,
        path: &Path<L>,
        (which, number): (L::Mask, L),
        casts: L::Mask,
        random: &mut impl Random<L>,
    ) -> [L; 3] {
        let (before, phase, steps) = (path.flights.direction, &self.scene.phase, &self.steps);
        let mut cosine = number.outlined_if_narrow(
            #[inline(always)]
            move || steps.deflection(phase, number),
        );
        let mut axis = steps.axis(before);
        if self.tally.begins_turned() {
            let first = steps.first_cosine(self.tally.first_cosine(number), number);
            cosine.set_where(path.unscattered, first);
        }
        if T::CASTS {
            let aim = self.tally.aim(path.flights.origin, number);
            axis.set_where(casts, aim.axis);
            cosine.set_where(casts, aim.cosine);
        }
        let turns = random.uniform_where(which);
        let mut direction = before;
        direction.set_where(
            which,
            turns.outlined_if_narrow(
                #[inline(always)]
                move || turned_lanes(axis, cosine, turns),
            ),
        );
        direction
    }
}

impl<T: Tally, S: Steps> Walk for InSpace<'_, T, S> {
    type State<L: Lane> = State<L, T::Found<L>>;
    type Flight<L: Lane> = Flight<L>;
    type Met<L: Lane> = [L; 2];

    const TOGETHER: u32 = 3;

    #[inline(always)]
    fn none<L: Lane>(&self, one: L) -> Self::State<L> {
        let (zero, all, none) = (one.each(0.0), one.at_most(one), one.below(one));
        State {
            path: Path { flights: Flights::new(zero), weight: one, unscattered: all },
            found: self.tally.nothing(zero),
            lookups: zero,
            shadows: Shadows::new(zero),
            ended: all,
            scattered: none,
            lit: none,
            aims: none,
            turns: none,
            begins: none,
        }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, state: &mut Self::State<L>, random: &mut impl Random<L>) {
        let (ended, one) = (state.ended, state.path.weight.each(1.0));
        let [origin, direction] = self.tally.begin(one, ended, random);
        state.path.flights.origin.set_where(ended, origin);
        state.path.flights.direction.set_where(ended, direction);
        state.path.weight.set_where(ended, one);
        state.path.unscattered |= ended;
        state.found.set_where(ended, self.tally.nothing(one.each(0.0)));
        state.lookups.set_where(ended, one.each(0.0));
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        random: &mut impl Random<L>,
    ) -> (Flight<L>, [L; 3]) {
        let (waits, origin) = (Self::waits(state), state.path.flights.origin);
        let depth = -random.ln_uniform_where(!waits);
        let walks = if T::CASTS { !waits & !state.shadows.on } else { !waits };
        let steps = &self.steps;
        let mut flown = state.path.flights.fly(
            &self.ground,
            walks,
            depth,
            #[inline(always)]
            move |here, begun| steps.through(here, begun),
        );
        let mut place = origin;
        place.set_where(walks, flown.place);
        self.tally.flown(&mut state.found, flown.length, state.path.weight);
        if let (true, Some(rays)) = (T::CASTS, &self.shadow_rays) {
            let (reached, inside) = state.shadows.fly(rays, origin, depth);
            place.set_where(state.shadows.on, reached);
            flown.inside |= inside;
        }
        flown.place = place;
        (Flight { flown, depth }, place)
    }

    #[inline(always)]
    fn inside<L: Lane>(flight: &Flight<L>) -> L::Mask {
        flight.flown.inside
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        flight: &Flight<L>,
        met: [L; 2],
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let at = self.score(state, flight, met, random);
        self.decide(state, &at, flight.depth, random)
    }

    /// Casts shadow rays of lanes that were scattered, or turns them; these lanes and those that begin set out, as
    /// soon as there are enough of them.
    #[inline(always)]
    fn go_on<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        together: u32,
        random: &mut impl Random<L>,
    ) {
        let (weight, origin) = (state.path.weight, state.path.flights.origin);
        let sets_out = state.scattered | state.ended;
        let turns = if self.tally.begins_turned() { sets_out } else { state.scattered };
        state.begins |= sets_out & !turns;
        if T::CASTS {
            self.tally.scattered(&mut state.found, turns, origin);
            let is_nothing = weight.equals(0.0);
            state.aims |= turns & !is_nothing;
            state.turns |= (turns & is_nothing) | state.lit;
        } else {
            state.turns |= turns;
        }
        if Self::waits(state).bits().count_ones() >= together {
            self.set_out(state, random);
        }
    }

    fn count(&self) -> usize {
        T::SUMS
    }

    #[inline(always)]
    fn store<L: Lane>(&self, state: &Self::State<L>, rows: &mut [[f64; WIDTH]]) {
        for (number, sum) in T::sums(&state.found).iter().enumerate() {
            sum.store(&mut rows[number]);
        }
    }

    #[inline(always)]
    fn lookups<L: Lane>(state: &Self::State<L>) -> L {
        state.lookups
    }
}
