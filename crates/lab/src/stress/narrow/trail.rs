//! One way through all decisions for both precisions.
//!
//! A walk that scatters decides where it goes. Two walks that decide apart part for good, and their
//! difference says nothing: single precision therefore takes the decisions that the doubles took, and
//! its draw is weighted by how much more or less likely they are in it,
//!
//! ```text
//! X₂₄ · ∏ P₂₄(decision)/P₅₃(decision),   P₂₄(u < q) = ⌈2²⁴ q⌉/2²⁴
//! ```
//!
//! whose mean is exactly that of walks that decide in single precision. Boundaries are not decided at
//! all: what leaves is scored with its chance, and what stays goes on with the rest,
//!
//! ```text
//! X = Σ value · P(leave) ∏ P(stay),   P₂₄(stay) the share of all 2²⁴ numbers that end inside
//! ```
//!
//! until roulette, with the doubles' chances in both precisions, ends it. All these chances are doubles:
//! what is single is what a renderer would compute.

use super::precision::Precision;
use crate::stress::narrow::dice::Dice;
use theory::particle::{Event, Odds};

/// The decisions of a walk, made by doubles or repeated.
pub struct Trail {
    dice: Dice,
    /// Which of a few events, and its chance in doubles.
    made: Vec<(u8, f64)>,
    /// The next to repeat; `None` where they are made.
    next: Option<usize>,
    likelihood: f64,
    is_by_chance: bool,
}

/// What becomes of a flight.
pub struct Flown<P> {
    /// The weight of what leaves.
    pub gone: f64,
    /// Where what stays lands; `None` if nothing is followed.
    pub at: Option<P>,
}

/// Below this weight roulette is played.
const FOLLOWED: f64 = 1e-3;

impl Trail {
    /// To be decided.
    pub fn new(dice: Dice) -> Self {
        Self { dice, made: Vec::new(), next: None, likelihood: 1.0, is_by_chance: false }
    }

    /// To be decided, boundaries too, as estimators do.
    pub fn by_chance(dice: Dice) -> Self {
        Self { is_by_chance: true, ..Self::new(dice) }
    }

    /// The same decisions once more, with the same random numbers.
    #[must_use]
    pub fn again(self, dice: Dice) -> Self {
        Self { dice, next: Some(0), likelihood: 1.0, ..self }
    }

    /// How many decisions were made.
    pub fn length(&self) -> f64 {
        self.made.len() as f64
    }

    /// The weight of what is followed, beside that of the walk itself.
    #[inline(always)]
    pub fn likelihood(&self) -> f64 {
        self.likelihood
    }

    /// Follows what was left behind with a weight.
    pub fn resume(&mut self, likelihood: f64) {
        self.likelihood = likelihood;
    }

    /// Random numbers for what may take more of them in one precision than in the other.
    #[must_use]
    pub fn apart(&mut self) -> Self {
        Self::new(Dice::new(self.dice.word(), "narrow-apart", 0))
    }

    /// A uniform number.
    #[inline(always)]
    pub fn uniform<P: Precision>(&mut self) -> P {
        P::uniform(self.dice.word())
    }

    /// One of a few events with these chances.
    #[inline(always)]
    fn choose<const N: usize>(&mut self, chances: [f64; N]) -> u8 {
        let u = f64::uniform(self.dice.word());
        let Some(next) = &mut self.next else {
            let (mut event, mut below) = (0, chances[0]);
            while event + 1 < N && u >= below {
                event += 1;
                below += chances[event];
            }
            // Rounding of the sum may leave the last event a number, but not a chance.
            while event > 0 && chances[event] <= 0.0 {
                event -= 1;
            }
            #[allow(clippy::cast_possible_truncation)] // three at most
            let event_as_byte = event as u8;
            self.made.push((event_as_byte, chances[event]));
            return event_as_byte;
        };
        let (event, chance) = self.made[*next];
        *next += 1;
        self.likelihood *= chances[usize::from(event)] / chance;
        event
    }

    /// Whether something of this chance happens: `u < q`.
    #[inline(always)]
    pub fn happens<P: Precision>(&mut self, q: P) -> bool {
        let chance = q.chance();
        self.choose([chance, 1.0 - chance]) == 0
    }

    /// What happens at a tentative collision, as [`Odds::decide`] does.
    #[inline(always)]
    pub fn decide<P: Precision>(&mut self, odds: &Odds<P>) -> Event {
        let (scattered, on) = (odds.scatter.chance(), (odds.scatter + odds.transmit).chance());
        match self.choose([scattered, (on - scattered).max(0.0), 1.0 - on]) {
            0 => Event::Scattered,
            1 => Event::Transmitted,
            _ => Event::Absorbed,
        }
    }

    /// A flight of mean optical depth 1 of a weight, `reach` from the boundary. What is inside for a depth
    /// is inside for all that are less.
    #[inline(always)]
    pub fn fly<P: Precision>(
        &mut self,
        (weight, reach): (P, P),
        land: impl Fn(P) -> P,
        inside: impl Fn(P) -> bool,
    ) -> Flown<P> {
        let flown = |u: P| land(-(u.each(1.0) - u).ln());
        let chance = P::chance_to_stay(reach.double(), |u| inside(flown(u)));
        let (gone, kept) = (self.likelihood * (1.0 - chance), self.likelihood * chance);
        let share = f64::uniform(self.dice.word());
        let at = flown(P::share(share, chance));
        if self.is_by_chance {
            let stays = self.choose([chance, 1.0 - chance]) == 0;
            return Flown { gone: if stays { 0.0 } else { 1.0 }, at: stays.then_some(at) };
        }
        self.likelihood = kept;
        let is_followed = self.is_followed(weight.double().abs() * kept);
        Flown { gone, at: is_followed.then_some(at) }
    }

    /// Roulette by the weight in doubles.
    #[inline(always)]
    fn is_followed(&mut self, weight: f64) -> bool {
        let u = f64::uniform(self.dice.word());
        let (event, chance) = if let Some(next) = &mut self.next {
            *next += 1;
            self.made[*next - 1]
        } else {
            let chance = (weight / FOLLOWED).min(1.0);
            let made = (u8::from(u >= chance), chance);
            self.made.push(made);
            made
        };
        if event == 0 {
            self.likelihood /= chance;
        }
        event == 0
    }
}
