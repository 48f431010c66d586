//! Predictions for walks from an eye in or before a ball to its light.
//!
//! ```text
//! hits                     0 ≤ X ≤ 1, so that E[X²] ≤ E[X]; without weights X is 0 or 1
//! combined techniques      E[X²] bounded as in [`super::spread`]
//! ```

use super::ball::Ball;
use super::shells::{BallResolution, Centre};
use super::{Lights, Observable, SolvedBall, Spread, Spreads, Techniques, solved};
use crate::memo::Memo;
use crate::problems::Sphere;
use crate::problems::ball::{BallLight, Sought};
use crate::single::Tracking;
use crate::space::energy_channel;
use crate::{Channel, Distribution, Moments, Prediction, Tails};
use numeric::Known;

/// Maximum relative error of an exact answer that draws are compared with.
pub const BLURRED: f64 = 1e-4;
/// Maximum optical depth from the surface to the centre for which the equation is solved.
pub const DEEPEST: f64 = 30.0;

/// Solution for one observable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallSolution {
    /// The value.
    pub value: Known,
    /// Bounds on the second moments of draws, the errors of the solution included.
    pub spreads: Spreads,
}

impl BallSolution {
    /// Solution under the light of a black sphere, or of the environment in a ball without one. A distant light is looked
    /// at from the centre, where the environment stands for it.
    fn new(ball: &Ball, albedo: f64, observable: Observable, is_distant: bool) -> Option<Self> {
        let is_black = matches!(ball.centre, Centre::Black(_));
        let [environment, core] = if is_black { [0.0, 1.0] } else { [1.0, 0.0] };
        let resolution = BallResolution::COARSE.about(ball.centre, ball.radius);
        let solved = solved(ball, albedo, Lights { environment, core }, resolution)?;
        let value = resolution.known(solved.each_ref().map(|s| s.answer(observable)));
        let of = |solved: &SolvedBall| solved.spreads(observable, is_distant);
        let [fine, coarse, coarsest] = solved.each_ref().map(of);
        let above = |numbers| {
            let Known { value, error, .. } = resolution.known(numbers);
            value + error
        };
        Some(Self { value, spreads: Spreads::joined(&[fine?, coarse?, coarsest?], above) })
    }
}

/// The exact answer; `None` where the equation is not solved, or the error of the answer is too large.
pub fn truth(sphere: &Sphere) -> Option<BallSolution> {
    answer(sphere).filter(|answer| blur(answer) <= BLURRED)
}

/// The relative error of an answer.
pub fn blur(answer: &BallSolution) -> f64 {
    answer.value.error / answer.value.value.abs()
}

/// Answers by the bits of all numbers of a ball, and of σ_t at 33 places, enough to distinguish fields.
static ANSWERS: Memo<Vec<u64>, Option<BallSolution>> = Memo::new(1024);

/// The answer with its error; `None` where the equation is not solved. Experiments of one ball share it.
pub fn answer(sphere: &Sphere) -> Option<BallSolution> {
    if sphere.majorant() * sphere.radius > DEEPEST {
        return None;
    }
    let (radius, albedo) = (sphere.radius, sphere.scene.albedo.even()?);
    let (centre, core) = match sphere.light {
        BallLight::BlackSphere(core) => (Centre::Black(core), core),
        BallLight::Environment | BallLight::Distant(_) => (Centre::Medium, -1.0),
    };
    let is_distant = matches!(sphere.light, BallLight::Distant(_));
    let (observable, requested) = match sphere.sought {
        Sought::Radiance => {
            let (offset, from) = (sphere.offset(), sphere.begins());
            (Observable::Radiance { offset, from }, [1.0, offset, from])
        }
        Sought::MeanIntensity => {
            let place = sphere.distance();
            (Observable::Mean(place), [0.0, place, 0.0])
        }
    };
    let extinction = |r2| sphere.extinction(r2);
    let places = (0..=32).map(|i| extinction(radius * radius * f64::from(i) / 32.0));
    let settings = [radius, core, albedo, f64::from(u8::from(is_distant))];
    let numbers = settings.into_iter().chain(requested).chain(places);
    ANSWERS.get(numbers.map(f64::to_bits).collect(), || {
        let ball = Ball { radius, centre, extinction: &extinction };
        BallSolution::new(&ball, albedo, observable, is_distant)
    })
}

/// G, a bound on `E[T̂²]/T` of tracked shadow rays on any way through a ball:
/// `E[T̂²] = T exp ∫((σ_t − σ_c)²/σ̂ − σ_t)`.
pub fn gain(sphere: &Sphere, shadow: Tracking) -> f64 {
    let Tracking::Ratio { sampling, control } = shadow else { return 1.0 };
    // It is convex in σ_t: largest at an end.
    let at = |sigma: f64| (sigma - control) * (sigma - control) / sampling - sigma;
    let worst = at(0.0).max(at(sphere.majorant())).max(0.0);
    (2.0 * sphere.radius * worst).exp()
}

/// The answer of a refused setup, which is not predicted.
const UNKNOWN: BallSolution = BallSolution {
    value: Known::estimated(f64::NAN, f64::INFINITY),
    spreads: Spreads(
        [Spread { unscattered: f64::NAN, lit: f64::NAN, rest: f64::NAN }; Techniques::ALL.len()],
    ),
};

/// Prediction for a draw that is 1 with the probability `value`, else 0. Where the probability may be 1 its variance is
/// bounded only.
fn all_or_nothing(value: Known) -> Prediction {
    let probability = value.value;
    if 1.0 - probability <= value.error {
        return Prediction::uncounted(Channel::bounded(
            value,
            (probability + value.error).min(1.0),
        ));
    }
    // E[Xᵏ] is the same for every k: the moments of a product whose losses are all −ln E[X].
    let error = 4.0 * value.error / (probability * (1.0 - probability));
    let moments =
        Moments::of_product(probability, [-probability.ln(); 4], error).graded(value.grade);
    let tails =
        Tails { rare_event_size: 1.0 / probability, eighth_moment_ratio: 1.0 / probability };
    let channel = Channel::unbiased(value, moments, tails);
    let distribution =
        Some(Distribution::Atoms(vec![(0.0, 1.0 - probability), (1.0, probability)]));
    Prediction { distribution, ..Prediction::uncounted(channel) }
}

/// Prediction for a combination of techniques, with shadow rays that are tracked somehow.
pub fn together(sphere: &Sphere, techniques: Techniques, shadow: Tracking) -> Prediction {
    let answer = truth(sphere).unwrap_or(UNKNOWN);
    let square = answer.spreads.of(techniques).square(gain(sphere, shadow));
    Prediction::uncounted(Channel::bounded(answer.value, square))
}

/// Prediction for a combination with an unknown variance: that of pilot draws stands in for it.
pub fn by_pilots(sphere: &Sphere) -> Prediction {
    let value = truth(sphere).unwrap_or(UNKNOWN).value;
    let channel = Channel::unbiased(value, None, Tails::LIGHT);
    Prediction::uncounted(Channel { pilot_variance_allowed: true, ..channel })
}

/// Prediction for a walk that hits the light. Its draws are 0 or 1 where it has no weight. Where nothing is absorbed and
/// light is everywhere, every draw is 1.
pub fn hits(sphere: &Sphere, is_chance: bool) -> Prediction {
    if sphere.light == BallLight::Environment && sphere.scene.albedo.even() == Some(1.0) {
        return Prediction::uncounted(energy_channel(0.0, 0.0));
    }
    let value = truth(sphere).unwrap_or(UNKNOWN).value;
    if is_chance {
        all_or_nothing(value)
    } else {
        Prediction::uncounted(Channel::bounded(value, value.value))
    }
}
