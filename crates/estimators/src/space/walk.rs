//! The walk of a particle through a volume: `SimulateParticle`.
//!
//! ```text
//! fly an optical depth −ln u through σ̂; beyond the bounds the particle has left
//! at a tentative collision r = σ_t/σ̂ and the rule says whether it goes straight on, is scattered or is
//! absorbed, and what becomes of its weight; scattered, it turns by an angle θ at an azimuth φ
//! ```
//!
//! What a walk is worth is not its business: a [`Sink`] is told what happens on the way. Which bugs a walk
//! may have is not its business either: its [`Steps`] can be replaced one by one. The loop is compiled
//! twice for each type of volume, for the honest [`Particle`] and for steps that are looked up as they
//! come; nothing in it depends on the problem.
//!
//! A flight takes a random number, a collision one where chance is left (a rule that never ends a walk asks
//! for none in a medium that only absorbs), a scattering one for θ and one for φ, roulette one. Cells
//! without σ̂, and all that lies outside the bounds, cost nothing at all.

use super::particle::Particle;
use super::tally::Collision;
use media::majorants::Flight;
use media::phase::Phase;
use media::{Majorants, Points};
use numeric::geometry::{Point, frame};
use numeric::pack::in_fused_code;
use numeric::rng::Stream;
use theory::particle::{Event, Odds};
use theory::problems::Scene;

/// A particle that sets out: where from, in which direction, with which weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Where it is: in the bounds, or on their boundary.
    pub place: Point,
    /// A unit vector.
    pub direction: Point,
    /// w.
    pub weight: f64,
}

/// A particle that is scattered, before its new direction is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Scattering {
    /// Where.
    pub place: Point,
    /// The direction of travel before.
    pub direction: Point,
    /// The weight after, the albedo in it.
    pub weight: f64,
    /// How often the particle has been scattered, this time included.
    pub order: u32,
}

/// What a walk reports to.
pub trait Sink {
    /// A particle flew a length, with a weight.
    fn flown(&mut self, length: f64, weight: f64) {
        let _ = (length, weight);
    }

    /// It met a tentative collision, whatever comes of it.
    fn collided(&mut self, at: &Collision<f64>) {
        let _ = at;
    }

    /// It was scattered. What is estimated from here, as the light of a lamp, may draw random numbers;
    /// the answer is the number of lookups that it took.
    fn scattered(&mut self, at: &Scattering, rng: &mut Stream) -> u32 {
        let _ = (at, rng);
        0
    }

    /// It left at a place, in a direction, with a weight, after so many scatterings.
    fn escaped(&mut self, at: Point, direction: Point, weight: f64, order: u32) {
        let _ = (at, direction, weight, order);
    }
}

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// The odds at a collision with the given ratio `σ_t/σ̂` and albedo.
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds;

    /// The cosine with the normal of light from all sides, of a uniform number: the law of Lambert.
    #[inline(always)]
    fn first_cosine(&self, number: f64) -> f64 {
        (1.0 - number).sqrt()
    }

    /// Whether both that goes straight on and that is scattered are followed, after so many such splits
    /// on the way from the start, and in the walk as a whole.
    #[inline(always)]
    fn splits(&self, depth: u32, total: u32) -> bool {
        let _ = (depth, total);
        false
    }

    /// The optical depth of a flight, and a number for later where one is wrongly kept.
    #[inline(always)]
    fn depth(&self, rng: &mut Stream) -> (f64, Option<f64>) {
        (-rng.ln_uniform(), None)
    }

    /// Flies to the next tentative collision and answers σ̂ there; `None` beyond the bounds.
    #[inline(always)]
    fn fly(&self, majorants: &Majorants, flight: &mut Flight, depth: f64) -> Option<f64> {
        majorants.fly(flight, depth)
    }

    /// What happens at a collision.
    #[inline(always)]
    fn decide(&self, odds: &Odds, kept: Option<f64>, rng: &mut Stream) -> Event {
        if odds.scatter <= 0.0 && odds.transmit >= 1.0 {
            Event::Transmitted
        } else if odds.scatter >= 1.0 {
            Event::Scattered
        } else {
            odds.decide(kept.unwrap_or_else(|| rng.uniform()))
        }
    }

    /// The cosine of the scattering angle.
    #[inline(always)]
    fn deflection(&self, phase: &Phase, rng: &mut Stream) -> f64 {
        phase.cosine(rng.uniform())
    }

    /// The direction after a deflection, at an azimuth in turns.
    #[inline(always)]
    fn turned(&self, direction: Point, cosine: f64, turns: f64) -> Point {
        frame::turned(direction, cosine, turns)
    }

    /// Whether a walk goes on with its weight, and with which: Russian roulette, where it is played.
    #[inline(always)]
    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        let _ = rng;
        Some(weight)
    }
}

/// Who makes the steps of a walk.
#[derive(Clone, Copy)]
pub enum By<'a> {
    /// A particle, by its rule.
    Rule(&'a Particle),
    /// Any steps, looked up as they come.
    Steps(&'a dyn Steps),
}

impl<'a> By<'a> {
    /// The steps, whosever they are.
    pub fn steps(self) -> &'a dyn Steps {
        match self {
            Self::Rule(particle) => particle,
            Self::Steps(steps) => steps,
        }
    }
}

/// Walks from a start and answers how many lookups that took.
#[inline(never)]
pub fn walk(
    by: By,
    scene: &Scene,
    majorants: &Majorants,
    start: Start,
    sink: &mut dyn Sink,
    rng: &mut Stream,
) -> u32 {
    let field = scene.volume.points();
    in_fused_code(
        #[inline(always)]
        || match by {
            By::Rule(steps) => Walk { steps, scene, field, majorants, start, sink, rng }.follow(),
            By::Steps(steps) => Walk { steps, scene, field, majorants, start, sink, rng }.follow(),
        },
    )
}

struct Walk<'a, S: ?Sized> {
    steps: &'a S,
    scene: &'a Scene,
    field: Points<'a>,
    majorants: &'a Majorants,
    start: Start,
    sink: &'a mut dyn Sink,
    rng: &'a mut Stream,
}

/// A particle between two flights.
#[derive(Debug, Clone, Copy)]
struct Traveller {
    start: Start,
    /// How often it has been scattered.
    order: u32,
    /// How many splits lie behind it.
    depth: u32,
}

impl<S: Steps + ?Sized> Walk<'_, S> {
    #[inline(always)]
    fn follow(mut self) -> u32 {
        let (mut lookups, mut splits) = (0, 0);
        let mut waiting: Vec<Traveller> = Vec::new();
        let mut next = Some(Traveller { start: self.start, order: 0, depth: 0 });
        while let Some(traveller) = next.take().or_else(|| waiting.pop()) {
            next = self.one_flight(traveller, (&mut lookups, &mut splits), &mut waiting);
        }
        lookups
    }

    /// Flies until a particle leaves, is scattered or ends; what is scattered goes on.
    #[inline(always)]
    fn one_flight(
        &mut self,
        mut traveller: Traveller,
        (lookups, splits): (&mut u32, &mut u32),
        waiting: &mut Vec<Traveller>,
    ) -> Option<Traveller> {
        let Start { place, direction, mut weight } = traveller.start;
        let mut flight = self.majorants.enter(place, direction);
        loop {
            let before = flight.t;
            let (depth, kept) = self.steps.depth(self.rng);
            let flown = self.steps.fly(self.majorants, &mut flight, depth);
            self.sink.flown(flight.t - before, weight);
            let place = flight.place();
            let Some(sampling) = flown else {
                self.sink.escaped(place, direction, weight, traveller.order);
                return None;
            };
            *lookups += 1;
            let ratio = self.field.extinction(place) / sampling;
            let albedo = self.scene.albedo.at(place);
            let at = Collision { inside: true, place: place.0, weight, ratio, albedo };
            self.sink.collided(&at);
            if self.steps.splits(traveller.depth, *splits) {
                *splits += 1;
                traveller.depth += 1;
                let scattered = weight * albedo * ratio;
                weight *= 1.0 - ratio;
                if scattered != 0.0 {
                    let other = Traveller { order: traveller.order + 1, ..traveller };
                    let other = self.scatter(place, direction, scattered, other, lookups);
                    if weight == 0.0 {
                        return Some(other);
                    }
                    waiting.push(other);
                } else if weight == 0.0 {
                    return None;
                }
                continue;
            }
            let odds = self.steps.odds_at(ratio, albedo);
            match self.steps.decide(&odds, kept, self.rng) {
                Event::Transmitted => {
                    weight = self.steps.keep(self.rng, weight * odds.transmit_weight)?;
                }
                Event::Scattered => {
                    traveller.order += 1;
                    let weight = self.steps.keep(self.rng, weight * odds.scatter_weight)?;
                    return Some(self.scatter(place, direction, weight, traveller, lookups));
                }
                Event::Absorbed => return None,
            }
        }
    }

    /// Tells of a scattering, and turns.
    #[inline(always)]
    fn scatter(
        &mut self,
        place: Point,
        direction: Point,
        weight: f64,
        traveller: Traveller,
        lookups: &mut u32,
    ) -> Traveller {
        let at = Scattering { place, direction, weight, order: traveller.order };
        *lookups += self.sink.scattered(&at, self.rng);
        let cosine = self.steps.deflection(&self.scene.phase, self.rng);
        let direction = self.steps.turned(direction, cosine, self.rng.uniform());
        Traveller { start: Start { place, direction, weight }, ..traveller }
    }
}
