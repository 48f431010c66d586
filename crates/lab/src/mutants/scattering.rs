//! The steps of walks that scatter, through rods, slabs and space, one function each.

use estimators::space::{self, Particle};
use media::Majorants;
use media::majorants::Flight;
use media::phase::Phase;
use numeric::Lane;
use numeric::geometry::{Point, frame};
use numeric::rng::Stream;
use theory::{Odds, ParticleRule};

/// The steps of a walk, of which a mutant has one wrong; those of [`right`] are the estimators'.
#[derive(Clone, Copy)]
pub struct Steps {
    /// The rule at a collision, roulette and splitting.
    pub particle: Particle,
    /// The odds at a collision, from those that are right and the albedo.
    pub odds: fn(Odds, f64) -> Odds,
    /// The weight after roulette, from that before it and what is right.
    pub kept: fn(f64, f64) -> f64,
    /// The cosine of the scattering angle.
    pub deflection: fn(&Phase, &mut Stream) -> f64,
    /// In space, the cosine with the normal of light from all sides.
    pub first_cosine: fn(f64) -> f64,
    /// In space, the optical depth of a flight, and a number for later where one is wrongly kept.
    pub depth: fn(&mut Stream) -> (f64, Option<f64>),
    /// In space, a flight through an optical depth; σ̂ where it ends.
    pub fly: fn(&Majorants, &mut Flight, f64) -> Option<f64>,
    /// In space, the direction after a deflection, at an azimuth in turns.
    pub turned: fn(Point, f64, f64) -> Point,
}

/// A walk without a mistake.
pub fn right(particle: Particle) -> Steps {
    Steps {
        particle,
        odds: |right, _| right,
        kept: |_, right| right,
        deflection: |phase, rng| phase.cosine(rng.uniform()),
        first_cosine: |number| (1.0 - number).sqrt(),
        depth: |rng| (-rng.ln_uniform(), None),
        fly: Majorants::fly,
        turned: frame::turned,
    }
}

/// The same by a rule, without roulette.
pub fn of(rule: ParticleRule) -> Steps {
    right(Particle::of(rule))
}

/// With roulette below a weight.
pub fn roulette(rule: ParticleRule, below: f64) -> Steps {
    right(Particle { roulette: Some(below), ..Particle::of(rule) })
}

/// The albedo as a chance and as a weight, `a² r`.
pub fn albedo_twice(right: Odds, albedo: f64) -> Odds {
    Odds { scatter_weight: albedo * right.scatter_weight, ..right }
}

/// Light that is scattered forward goes backward, `−cos θ`.
pub fn backward(phase: &Phase, rng: &mut Stream) -> f64 {
    -phase.cosine(rng.uniform())
}

/// One number for a flight and for what follows it.
pub fn number_twice(rng: &mut Stream) -> (f64, Option<f64>) {
    let number = 1.0 - rng.uniform();
    (-Lane::ln(number), Some(number))
}

impl Steps {
    fn odds_of(&self, ratio: f64, albedo: f64) -> Odds {
        (self.odds)(self.particle.rule.odds(ratio, albedo), albedo)
    }

    fn keeps(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        space::Steps::keep(&self.particle, rng, weight).map(|right| (self.kept)(weight, right))
    }
}

impl space::Steps for Steps {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.odds_of(ratio, albedo)
    }

    fn first_cosine(&self, number: f64) -> f64 {
        (self.first_cosine)(number)
    }

    fn splits(&self, depth: u32, total: u32) -> bool {
        self.particle.splits(depth, total)
    }

    fn depth(&self, rng: &mut Stream) -> (f64, Option<f64>) {
        (self.depth)(rng)
    }

    fn fly(&self, majorants: &Majorants, flight: &mut Flight, depth: f64) -> Option<f64> {
        (self.fly)(majorants, flight, depth)
    }

    fn deflection(&self, phase: &Phase, rng: &mut Stream) -> f64 {
        (self.deflection)(phase, rng)
    }

    fn turned(&self, direction: Point, cosine: f64, turns: f64) -> Point {
        (self.turned)(direction, cosine, turns)
    }

    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        self.keeps(rng, weight)
    }
}
