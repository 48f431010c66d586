//! Media of the comparison, and the cases that theory predicts.
//!
//! ```text
//! σ_t(t) = τ (1 + 0.8 sin(6π(t − t₀))),  t = t₀ … t₀ + 1
//! σ_t(p) = τ (1.8 − 3.6 x + 2 x²),  x = |p − c|²/R²,  R = ½,  c = (t₀, t₀, t₀)
//! ```
//!
//! τ is the optical depth of the ray, and of the ball along a diameter; t₀ is a whole number. Walks look σ_t up in
//! their own precision. On shadow rays to a point light the estimators compute σ_t and transmittances in doubles, for
//! both precisions.

use numeric::Lane;

/// Settings of the ray in 1-D. Words in capitals become numbers, see [`StressScene::case`].
pub const RAY: &str = "span = [FROM, TO]\nmedium.sines = { base = DEPTH, amplitudes = [WAVE], \
    frequencies = [18.84955592153876], phases = [0] }";
/// Settings of this ray in space, with a point light beside it.
pub const LIT: &str = "ray = { origin = [0, 0, FROM], direction = [0, 0, 1], length = 1 }\n\
    volume.sines = { base = DEPTH, amplitudes = [WAVE], vectors = [[0, 0, 18.84955592153876]], phases = [0] }\n\
    light.position = [0.3, 0, FOOT]\nalbedo = 0.8\nphase.henyey-greenstein.g = 0.5";
/// Settings of the ball, and of a ray into it.
pub const BALL: &str = "ray = { origin = [ASIDE, FROM, BEFORE], direction = [0, 0, 1], length = 2 }\n\
    volume.radial = { centre = [FROM, FROM, FROM], radius = 0.5, coefficients = [SHAPE] }";

const FREQUENCY: f64 = 18.849_555_921_538_76;
const WAVE: f64 = 0.8;
const RADIUS: f64 = 0.5;
const SHAPE: [f64; 3] = [1.8, -3.6, 2.0];

/// A ray of length 1, or a ball of diameter 1.
#[derive(Debug, Clone, Copy)]
pub struct StressScene {
    /// τ.
    pub depth: f64,
    /// ∫σ̂.
    pub collisions: f64,
    /// t₀.
    pub from: f64,
}

impl StressScene {
    /// σ_t along the ray.
    #[inline(always)]
    pub fn on_ray<L: Lane>(&self, t: L) -> L {
        let wave = ((t - self.from) * FREQUENCY).sin();
        (wave * WAVE + 1.0) * self.depth
    }

    /// σ_t in the ball.
    #[inline(always)]
    pub fn in_ball<L: Lane>(&self, place: [L; 3]) -> L {
        let [x, y, z] = place.map(|axis| (axis - self.from) * (1.0 / RADIUS));
        let square = x * x + y * y + z * z;
        let [a, b, c] = SHAPE.map(|shape| shape * self.depth);
        ((square * c + b) * square + a).or_more(square.each(0.0))
    }

    /// The case of a problem with its medium and settings, and of an estimator. Words in capitals become numbers.
    pub fn case(&self, [problem, medium, settings, _]: [&str; 4], estimator: &str) -> String {
        let Self { depth, collisions, from } = *self;
        let shape = SHAPE.map(|shape| (shape * depth).to_string()).join(", ");
        let text = format!(
            "title = \"t\"\n[problem.{problem}]\n{medium}\n{settings}\nestimators = [{{ {estimator} }}]"
        );
        [
            ("SAMPLING", "sampling.constant = { value = COLLISIONS }".to_owned()),
            ("CELLS", "sampling.local-majorants = { segments = 12 }".to_owned()),
            ("COLLISIONS", collisions.to_string()),
            ("DEPTH", depth.to_string()),
            ("WAVE", (WAVE * depth).to_string()),
            ("LEAST", ((1.0 - WAVE) * depth).to_string()),
            ("SHAPE", shape),
            ("FROM", from.to_string()),
            ("TO", (from + 1.0).to_string()),
            ("FOOT", (from + 0.7).to_string()),
            ("ASIDE", (from + 0.15).to_string()),
            ("BEFORE", (from - 1.0).to_string()),
        ]
        .iter()
        .fold(text, |text, (word, number)| text.replace(word, number))
    }
}
