//! The walk of a particle through a volume: `SimulateParticle`.
//!
//! ```text
//! begin    at the place of the tally;  w = 1
//! fly      through an optical depth −ln u of σ̂;  beyond the bounds the particle has left
//! collide  r = σ_t/σ̂;  by the probabilities of the rule and u:
//!            scattered     w ← w · a r/q_s;  it turns later by an angle θ at an azimuth φ
//!            straight on   w ← w · (1 − r)/q_t
//!            absorbed      the end
//!          roulette, where it is played: small |w| ← w₀ with probability |w|/w₀, else the end
//! set out  where shadow rays are cast, one is cast from each scattering first; then it turns, and flies on
//! ```
//!
//! A flight takes a random number, a collision one where more than one event is possible, a scattering one for θ
//! and one for φ, roulette one. Cells without σ̂, and all that lies outside the bounds, cost nothing. A [`Tally`]
//! scores the walk.
//!
//! Shadow rays and new directions cost more than a step. A lane that needs one stands still until several lanes of
//! a pack do; meanwhile, the others go on.

use super::particle::ParticleSettings;
use super::shadow::{ShadowRays, Shadows};
use super::tally::{CollisionTally, Departure, Scattering, Tally};
use crate::walks::steps::roulette;
use crate::walks::{Route, TentativeCollision, Walk};
use media::sampling::BothWays;
use media::sampling::{Flights, MajorantView};
use media::{Batches, Majorants};
use numeric::geometry::Point;
use numeric::geometry::frame::turned_lanes;
use numeric::rng::Random;
use numeric::{Kept, Lane, Mask, kept};
use theory::problems::Scene;

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

kept! {
    /// State of walks.
    pub struct State<L, F> {
        /// The particles.
        pub path: Path<L>,
        /// Sums and state of their tallies.
        pub totals: F,
        /// Lookups that needed no step.
        known: L,
        shadows: Shadows<L>,
        /// Lanes at a tentative collision of a walk or of a shadow ray, and the places.
        inside: L::Mask,
        place: [L; 3],
        /// σ̂ of walks at their tentative collisions.
        pub sampling: L,
        /// Lanes with a walk that ended in this step.
        pub ended: L::Mask,
        /// Lanes that were scattered in this step.
        pub scattered: L::Mask,
        /// Lanes with a shadow ray that came to its end in this step.
        lit: L::Mask,
        /// Lanes that have yet to cast a shadow ray.
        aims: L::Mask,
        /// Lanes that have yet to turn and to set out.
        turns: L::Mask,
        /// Lanes that have yet to set out in their present directions.
        begins: L::Mask,
    }
}

/// Lanes of a pack that set out together.
const TOGETHER: u32 = 3;

/// Particles in a scene, and their tally.
pub struct InSpace<'a, T> {
    tally: &'a T,
    /// The particle: its rule and roulette.
    pub particle: ParticleSettings,
    /// The medium.
    pub scene: &'a Scene,
    ground: MajorantView<'a>,
    shadow_rays: Option<ShadowRays<'a>>,
    /// a, where it is the same everywhere.
    albedo: Option<f64>,
    /// σ_t for packs, and a where it varies.
    fields: &'a [Batches<'a>],
}

impl<T> Clone for InSpace<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for InSpace<'_, T> {}

impl<'a, T: Tally> InSpace<'a, T> {
    /// The walk through a scene and its σ̂; packs provide the fields that they look up.
    pub fn new(
        tally: &'a T,
        particle: ParticleSettings,
        (scene, majorants): (&'a Scene, &'a Majorants),
        fields: &'a [Batches<'a>],
    ) -> Self {
        let (ground, albedo) = (MajorantView::new(majorants, tally.core()), scene.albedo.even());
        Self { tally, particle, scene, ground, shadow_rays: tally.shadow_rays(), albedo, fields }
    }

    /// Lanes that stand still until they set out together.
    #[inline(always)]
    fn waits<L: Lane>(state: &State<L, T::Found<L>>) -> L::Mask {
        state.aims | state.turns | state.begins
    }

    /// Flies; returns the lanes at a tentative collision.
    #[inline(always)]
    pub fn advance<L: Lane>(&self, state: &mut State<L, T::Found<L>>, depth: L) -> L::Mask {
        self.advance_through(
            state,
            depth,
            #[inline(always)]
            |here, _| here,
        )
    }

    /// Flies through a σ̂ computed from that of a cell and that of the cell in which the flight began; returns the
    /// lanes at a tentative collision.
    #[inline(always)]
    pub fn advance_through<L: Lane>(
        &self,
        state: &mut State<L, T::Found<L>>,
        depth: L,
        sampling: impl Fn(L, L) -> L + Copy,
    ) -> L::Mask {
        let (waits, origin) = (Self::waits(state), state.path.flights.origin);
        let walks = if T::CASTS { !waits & !state.shadows.on } else { !waits };
        let flown = state.path.flights.fly(&self.ground, walks, depth, sampling);
        (state.inside, state.place, state.sampling) = (flown.inside, origin, flown.sampling);
        state.place.set_where(walks, flown.place);
        self.tally.flown(&mut state.totals, flown.length, state.path.weight);
        if let (true, Some(rays)) = (T::CASTS, &self.shadow_rays) {
            let (reached, inside) = state.shadows.fly(rays, origin, depth);
            state.place.set_where(state.shadows.on, reached);
            state.inside |= inside;
        }
        state.inside
    }

    /// Adds the events to the tally, given the fields at the places; returns tentative collisions.
    #[inline(always)]
    pub fn score<L: Lane>(
        &self,
        state: &mut State<L, T::Found<L>>,
        fields: &[L],
        random: &mut impl Random<L>,
    ) -> CollisionTally<L> {
        let State { inside, place, sampling, .. } = *state;
        let extinction = fields[0];
        let albedo = match self.albedo {
            Some(albedo) => extinction.each(albedo),
            None => fields[1],
        };
        let casts = state.shadows.on;
        if let (true, Some(rays)) = (T::CASTS, &self.shadow_rays) {
            let light = state.shadows.collide(rays, random, (place, casts & inside), extinction);
            self.tally.lit(&mut state.totals, light, state.shadows.through);
            state.lit = light.0;
        }
        let walks = !(casts | Self::waits(state));
        let (inside, left) = (inside & walks, walks & !inside);
        let Path { weight, unscattered, flights: Flights { direction, .. } } = state.path;
        let at = CollisionTally { inside, place, weight, ratio: extinction / sampling, albedo };
        self.tally.collided(&mut state.totals, &at);
        let departure = Departure { left, place, direction, weight, unscattered };
        self.tally.escaped(&mut state.totals, &departure);
        state.ended = walks;
        at
    }

    /// Decides the events at collisions; returns the lanes that end.
    #[inline(always)]
    pub fn decide<L: Lane>(
        &self,
        state: &mut State<L, T::Found<L>>,
        at: &CollisionTally<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let CollisionTally { inside, place, weight, ratio, albedo } = *at;
        let (zero, one, walks) = (weight.each(0.0), weight.each(1.0), state.ended);
        let probabilities = self.particle.rule.probabilities(ratio, albedo);
        // A number is taken only where more than one event is possible.
        let surely_on = probabilities.scatter.at_most(zero) & one.at_most(probabilities.transmit);
        let surely_scattered = !surely_on & one.at_most(probabilities.scatter);
        let by_chance = inside & !surely_on & !surely_scattered;
        let number = random.uniform_where(by_chance);
        let (is_scattered, is_passed) = probabilities.decide_each(by_chance, number);
        let is_scattered = is_scattered | (inside & surely_scattered);
        let goes_on = is_scattered | is_passed | (inside & surely_on);
        let factor =
            L::select(is_scattered, probabilities.scatter_weight, probabilities.transmit_weight);
        state.path.weight.scale_where(goes_on, factor);
        let goes_on = roulette(self.particle.roulette, goes_on, &mut state.path.weight, random);
        state.ended = walks & !goes_on;
        Self::scatter(state, is_scattered & goes_on, place);
        state.ended
    }

    /// Splits particles at collisions: the scattered ones continue in `state`, the transmitted ones are returned.
    #[inline(always)]
    pub fn split<L: Lane>(
        &self,
        state: &mut State<L, T::Found<L>>,
        at: &CollisionTally<L>,
    ) -> Path<L> {
        let straight = Path { weight: at.weight * at.ratio.one_minus(), ..state.path };
        state.path.weight = at.weight * at.albedo * at.ratio;
        state.ended = !at.inside;
        Self::scatter(state, at.inside & !state.path.weight.equals(0.0), at.place);
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
            state.known = state.known + self.tally.connect(&mut state.totals, &at, random);
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
                let (rays, from) = ((rays, self.fields.first()), (origin, weight));
                let (totals, through) = state.shadows.cast(rays, casts, &light, from, reach.ends);
                self.tally.lit(&mut state.totals, totals, through);
            } else {
                let at = Scattering { which: casts, place: origin, weight };
                let tracked =
                    self.tally.track(&mut state.totals, &at, (&light, reach.ends), random);
                state.known = state.known + tracked;
            }
            // Lanes with a ray that needed no tracking turn next.
            state.turns = casts & !state.shadows.on;
        }
        state.path.flights.direction.set_where(turns, direction);
        state.path.flights.enter(&self.ground, sets_out, &reach);
    }

    /// Begins the walks that replace those that ended.
    #[inline(always)]
    fn begin_again<L: Lane>(&self, state: &mut State<L, T::Found<L>>, random: &mut impl Random<L>) {
        let (ended, one) = (state.ended, state.path.weight.each(1.0));
        let [origin, direction] = self.tally.begin(one, ended, random);
        state.path.flights.origin.set_where(ended, origin);
        state.path.flights.direction.set_where(ended, direction);
        state.path.weight.set_where(ended, one);
        state.path.unscattered |= ended;
        state.totals.set_where(ended, self.tally.nothing(one.each(0.0)));
        state.known.set_where(ended, one.each(0.0));
    }

    /// Casts shadow rays of lanes that were scattered, or turns them; these lanes and those that begin set out, as
    /// soon as there are enough of them.
    #[inline(always)]
    pub fn go_on<L: Lane>(&self, state: &mut State<L, T::Found<L>>, random: &mut impl Random<L>) {
        let (weight, origin) = (state.path.weight, state.path.flights.origin);
        let sets_out = state.scattered | state.ended;
        let turns = if self.tally.begins_turned() { sets_out } else { state.scattered };
        state.begins |= sets_out & !turns;
        if T::CASTS {
            self.tally.scattered(&mut state.totals, turns, origin);
            let is_nothing = weight.equals(0.0);
            state.aims |= turns & !is_nothing;
            state.turns |= (turns & is_nothing) | state.lit;
        } else {
            state.turns |= turns;
        }
        let none = turns & !turns;
        (state.ended, state.scattered, state.lit) = (none, none, none);
        if Self::waits(state).are_enough(TOGETHER) {
            self.set_out(state, random);
        }
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
        let (before, phase) = (path.flights.direction, &self.scene.phase);
        let mut cosine = number.outlined_if_narrow(
            #[inline(always)]
            move || phase.cosine(number),
        );
        let mut axis = before;
        if self.tally.begins_turned() {
            cosine.set_where(path.unscattered, self.tally.first_cosine(number));
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

impl<T: Tally> Walk for InSpace<'_, T> {
    type State<L: Lane> = State<L, T::Found<L>>;

    const ON_RAY: bool = false;
    const IN_SPACE: bool = true;
    const IS_NOWHERE: bool = true;

    /// Walks that have all ended: the first step replaces them.
    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, all: L::Mask, _: &mut impl Random<L>) -> Self::State<L> {
        let (zero, none) = (one.each(0.0), !all);
        State {
            path: Path { flights: Flights::new(zero), weight: one, unscattered: all },
            totals: self.tally.nothing(zero),
            known: zero,
            shadows: Shadows::new(zero),
            inside: none,
            place: [zero; 3],
            sampling: one,
            ended: all,
            scattered: none,
            lit: none,
            aims: none,
            turns: none,
            begins: none,
        }
    }

    /// The next step begins the walks.
    #[inline(always)]
    fn restart<L: Lane>(&self, _: &mut Self::State<L>, _: L::Mask, _: L, _: &mut impl Random<L>) {}

    #[inline(always)]
    fn numbers<L: Lane>(&self, state: &mut Self::State<L>, random: &mut impl Random<L>) -> [L; 2] {
        if state.ended.any() {
            self.begin_again(state, random);
        }
        self.go_on(state, random);
        [-random.ln_uniform_where(!Self::waits(state)); 2]
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        _: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        self.advance(state, depth)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let at = self.score(state, extinctions.in_space, random);
        !self.decide(state, &at, random)
    }

    #[inline(always)]
    fn media(&self) -> usize {
        if self.albedo.is_some() { 1 } else { 2 }
    }

    #[inline(always)]
    fn in_space<L: Lane>(&self, state: &Self::State<L>) -> (L::Mask, [L; 3]) {
        (state.inside, state.place)
    }

    #[inline(always)]
    fn fields(&self) -> &[Batches<'_>] {
        self.fields
    }

    #[inline(always)]
    fn field(&self, number: usize, place: Point) -> f64 {
        if number == 0 {
            self.scene.volume.extinction_within(place)
        } else {
            self.scene.albedo.at(place)
        }
    }

    #[inline(always)]
    fn lookups<L: Lane>(&self, state: &Self::State<L>, counted: L) -> L {
        counted + state.known
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.tally.channels()
    }

    #[inline(always)]
    fn value<L: Lane>(&self, state: &Self::State<L>, _: L::Mask, channel: usize) -> L {
        self.tally.value(&state.totals, channel)
    }
}
