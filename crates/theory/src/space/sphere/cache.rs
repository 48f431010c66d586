//! Memo of answers: experiments of one ball share them.

use super::ball::Ball;
use super::shells::Resolution;
use super::{Lights, Observable, Solved, Spreads, centre_of, solved};
use crate::memo::Memo;
use numeric::Known;

/// Key of an answer, without σ_t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// R.
    pub radius: f64,
    /// The radius of a black sphere at the centre.
    pub core: Option<f64>,
    /// a.
    pub albedo: f64,
    /// Radiances of the lights.
    pub lights: Lights,
    /// True if the environment stands for a distant light, looked at from the centre.
    pub is_distant: bool,
    /// Quantity that is computed.
    pub observable: Observable,
}

/// Solution for one observable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The value.
    pub value: Known,
    /// Bounds on the second moments of draws, the errors of the solution included.
    pub spreads: Spreads,
}

static ANSWERS: Memo<Vec<u64>, Option<Answer>> = Memo::new(1024);

impl Scene {
    /// The bits of all numbers, and of σ_t at 33 places, enough to distinguish fields.
    fn key(&self, extinction: &dyn Fn(f64) -> f64) -> Vec<u64> {
        let (kind, observable) = match self.observable {
            Observable::Mean(r) => (0.0, [r, 0.0]),
            Observable::Radiance { offset, from } => (1.0, [offset, from]),
        };
        let lights = [self.lights.environment, self.lights.core];
        let core = self.core.unwrap_or(-1.0);
        let distant = f64::from(u8::from(self.is_distant));
        let mut numbers = vec![self.radius, core, self.albedo, kind, distant];
        numbers.extend(lights);
        numbers.extend(observable);
        let outer = self.radius * self.radius;
        numbers.extend((0..=32).map(|i| extinction(outer * f64::from(i) / 32.0)));
        numbers.into_iter().map(f64::to_bits).collect()
    }

    fn answer(&self, extinction: &dyn Fn(f64) -> f64) -> Option<Answer> {
        let centre = centre_of(self.core);
        let ball = Ball { radius: self.radius, centre, extinction };
        let resolution = Resolution::COARSE.about(centre, self.radius);
        let solved = solved(&ball, self.albedo, self.lights, resolution)?;
        let value = resolution.known(solved.each_ref().map(|s| s.answer(self.observable)));
        let of = |solved: &Solved| solved.spreads(self.observable, self.is_distant);
        let [fine, coarse, coarsest] = solved.each_ref().map(of);
        let above = |numbers| {
            let Known { value, error, .. } = resolution.known(numbers);
            value + error
        };
        Some(Answer { value, spreads: Spreads::joined(&[fine?, coarse?, coarsest?], above) })
    }
}

/// Returns the answer; it is computed only once, also if several threads need it.
pub fn cached(scene: &Scene, extinction: &dyn Fn(f64) -> f64) -> Option<Answer> {
    ANSWERS.get(scene.key(extinction), || scene.answer(extinction))
}
