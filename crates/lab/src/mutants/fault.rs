//! The steps of a walk, one function each: a fault replaces some of them.

use estimators::Setup;
use media::{Control, Cursor, Extinction, Lookups, Piecewise};
use numeric::Span;
use numeric::rng::{Stream, exponential, unit};
use theory::{Mesh, Outcome};

/// What a walk remembers, whether it should or not.
pub struct Memory {
    /// The stretch that is walked.
    pub support: Span,
    /// Where the flight began: the collision before, or the beginning of the support.
    pub from: f64,
    /// How many lookups were made.
    pub lookups: u32,
    /// The weight before the last collision.
    pub before: f64,
    /// The generator as it stood at the beginning of the draw.
    pub beginning: Stream,
    /// A random number kept for later.
    pub number: Option<f64>,
    /// Another one.
    pub older: Option<f64>,
}

impl Memory {
    /// At the beginning of a draw.
    pub fn new(support: Span, weight: f64, rng: &Stream) -> Self {
        let (from, beginning) = (support.from, *rng);
        Self { support, from, lookups: 0, before: weight, beginning, number: None, older: None }
    }
}

/// What a fault may change before the first draw.
pub struct Prepared<'a> {
    /// The medium.
    pub mesh: &'a Mesh,
    /// σ̂ on the support.
    pub sampling: &'a mut Piecewise,
    /// σ_c.
    pub control: &'a mut Control,
    /// `T_c = exp(−∫σ_c)`.
    pub control_transmittance: &'a mut f64,
}

/// The steps of a walk, of which a fault has one wrong; [`RIGHT`] are those of the estimators.
#[derive(Clone, Copy)]
pub struct Fault {
    /// See [`super::Trial::replays`].
    pub replays: bool,
    /// Changes what is prepared once.
    pub prepare: fn(Prepared<'_>),
    /// The optical depth of a flight through σ̂: exponential with mean 1.
    pub flight: fn(&mut Memory, &mut Stream) -> f64,
    /// Flies to the next tentative collision and answers σ̂ there; `None` beyond the end.
    pub fly: fn(&Piecewise, &mut Cursor, f64) -> Option<f64>,
    /// `σ_t` at the collision.
    pub look: fn(&Memory, &Lookups, f64) -> f64,
    /// `σ_c` at the collision.
    pub control: fn(&Memory, &Control, f64) -> f64,
    /// `r = (σ_t − σ_c)/σ̂`, from the whole of σ̂, the residual and σ̂ at the collision.
    pub ratio: fn(&Piecewise, f64, f64) -> f64,
    /// `q` and the weight of a survivor, with `q · weight = 1 − r`, from what is right and r.
    pub outcome: fn(Outcome, f64) -> Outcome,
    /// The number that decides: uniform, and independent of all others.
    pub number: fn(&mut Memory, &mut Stream) -> f64,
    /// Whether a collision is real, given that the number says so.
    pub real: fn(&Memory, bool) -> bool,
    /// The weight after a collision, from the one before it and its factor.
    pub weigh: fn(&Memory, f64, f64) -> f64,
    /// A walk of a weight ends nowhere but at the end or at a collision; `Some` ends it here with that value.
    pub stop: fn(&Memory, f64, &mut Stream) -> Option<f64>,
    /// The draw of a walk that reached the end: its weight.
    pub end: fn(&mut Memory, &Control, f64) -> f64,
    /// The distance of a real collision, from the beginning of the ray.
    pub distance: fn(Span, f64) -> f64,
    /// The distance of a flight that escapes: the length of the ray.
    pub escape: fn(&Memory, Span) -> f64,
}

/// No fault.
pub const RIGHT: Fault = Fault {
    replays: false,
    prepare: |_| {},
    flight: |_, rng| exponential(rng),
    fly: |sampling, cursor, depth| sampling.fly(cursor, depth),
    look: |_, medium, t| medium.extinction(t),
    control: |_, control, t| control.extinction(t),
    ratio: |_, residual, here| residual * (1.0 / here),
    outcome: |right, _| right,
    number: |_, rng| unit(rng),
    real: |_, real| real,
    weigh: |_, weight, factor| weight * factor,
    stop: |_, _, _| None,
    end: |_, _, weight| weight,
    distance: |ray, t| t - ray.from,
    escape: |_, ray| ray.length(),
};

impl Fault {
    /// A setup with what is prepared wrongly.
    pub fn prepared<P>(&self, mut setup: Setup<P>) -> Setup<P> {
        (self.prepare)(Prepared {
            mesh: &setup.mesh,
            sampling: &mut setup.sampling,
            control: &mut setup.control,
            control_transmittance: &mut setup.control_transmittance,
        });
        setup
    }
}
