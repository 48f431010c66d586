//! Layers of a slab: thin ones, doubled ones, and one laid upon another.
//!
//! With rows for the direction of incidence and columns for that of escape, energy goes from one layer to the next
//! by matrix products. A is the transmission: the direct beam `D = e^{−τ/μ}` on its diagonal, the scattered T
//! elsewhere; layer 1 is above, layer 2 below:
//!
//! ```text
//! M = (1 − R₂R₁)⁻¹ = 1 + R₂R₁ + (R₂R₁)² + …          light between the layers
//! R = R₁ + A₁ M R₂ A₁,   T = A₁ M A₂ − D₁D₂,   N = N₁ + A₁ M (N₂ + R₂ N₁)
//! ```
//!
//! All terms are positive, D is kept apart, and nothing cancels. N is the expected score of the
//! collisions of one particle, by its direction of incidence.
//!
//! Numbers are doubles or power series in y. Where each collision multiplies the weight by the mark `z = 1 + y` and
//! scores 1, N has the factorial moments of the number M of collisions. The reason is that `zᴹ − 1` is the sum of
//! `(z − 1) z^{m−1}` over the collisions m = 1 … M:
//!
//! ```text
//! N = E[Σ_m (1 + y)^{m−1}] = (E[(1 + y)^M] − 1)/y = Σ_k E[M(M − 1)…(M − k + 1)] y^{k−1}/k!
//! ```
//!
//! Source: H. C. van de Hulst, *Multiple Light Scattering* (Academic Press, 1980), chapter 4; J. E.
//! Hansen, L. D. Travis, *Light scattering in planetary atmospheres*, Space Science Reviews 16,
//! 527–610 (1974), section 3. The scores are added here: they follow a particle through the same
//! series.

use super::directions::Directions;
use crate::Kernel;
use numeric::Scalar;
use numeric::matrix::Matrix;

/// Response of a layer to light that comes from above.
#[derive(Clone)]
pub struct Layer<S = f64> {
    /// R: scattered back, by direction of incidence and of escape.
    pub reflected: Matrix<S>,
    /// T: scattered through.
    pub scattered: Matrix<S>,
    /// D: let through without scattering, by direction of incidence.
    pub direct: Vec<S>,
    /// N.
    pub score: Vec<S>,
}

impl<S: Scalar> Layer<S> {
    /// A homogeneous layer by `doublings` doublings of one so thin that light scatters in it at most once; `None`
    /// where the expected energy is infinite.
    pub fn homogeneous(directions: &Directions, slice: &Kernel<S>, doublings: i32) -> Option<Self> {
        // Without loss, light along the layer collides without end.
        if slice.lost().leading() < 0.0 || slice.is_endless() {
            return None;
        }
        let mut part = 0.5f64.powi(doublings);
        let mut layer = Self::thin(directions, slice, part);
        for _ in 0..doublings {
            layer = layer.doubled()?;
            part *= 2.0;
            // Computed again, so that rounding does not double with the layer.
            layer.direct = direct(directions, slice, part);
        }
        Some(layer)
    }

    /// A share of the layer in which light scatters at most once.
    ///
    /// ```text
    /// Rᵢⱼ = S P⁻ᵢⱼ (h/μᵢ) φ(u(1/μᵢ + 1/μⱼ)),   φ(y) = (1 − e^{−y})/y,   u = (1 − Q) h
    /// Tᵢⱼ = S P⁺ᵢⱼ (h/μᵢ) e^{−u/μⱼ} φ(u(1/μᵢ − 1/μⱼ)),   Nᵢ = (h/μᵢ) φ(u/μᵢ)
    /// ```
    fn thin(directions: &Directions, slice: &Kernel<S>, part: f64) -> Self {
        let flown = slice.rate * part;
        let lost = slice.lost() * flown;
        let inverse: Vec<f64> = directions.cosines.iter().map(|cosine| 1.0 / cosine).collect();
        let (rows, columns) = (inverse.len(), directions.count());
        let reflected = Matrix::new(rows, columns, |i, j| {
            let path = lost * (inverse[i] + inverse[j]);
            slice.scattered * directions.back.at(i, j) * flown * inverse[i] * path.mean_decay()
        });
        let scattered = Matrix::new(rows, columns, |i, j| {
            // The smaller exponent is factored out: nothing overflows.
            let minimum = inverse[i].min(inverse[j]);
            let path = lost * (inverse[i] - inverse[j]).abs();
            let through = (-lost * minimum).exp() * path.mean_decay();
            slice.scattered * directions.onward.at(i, j) * flown * inverse[i] * through
        });
        let score = inverse.iter().map(|&i| (lost * i).mean_decay() * (slice.score * flown * i));
        let score = score.collect();
        Self { reflected, scattered, direct: direct(directions, slice, part), score }
    }

    /// The layer on another of its kind, for which `M R A = R M A`.
    fn doubled(&self) -> Option<Self> {
        let square = self.reflected.square();
        let twice = square.times(&square);
        self.joined(self, &twice, Matrix::clone)
    }

    /// The layer on top of another one.
    pub fn over(&self, below: &Self) -> Option<Self> {
        let there_and_back = below.reflected.times(&self.reflected).square();
        // X = R₂(A₁ + R₁X), by the same series.
        let once = below.reflected.times(&self.through());
        let within = there_and_back.series_times(&once)?;
        let upward = once.plus(&below.reflected.times(&self.reflected.times(&within)));
        self.joined(below, &there_and_back, |_| upward)
    }

    /// A without its rows for further directions.
    fn through(&self) -> Matrix<S> {
        let mut through = self.scattered.square();
        for i in 0..through.columns() {
            through.add(i, i, self.direct[i]);
        }
        through
    }

    /// Joins two layers, given `R₂R₁` and the function that makes `X = M R₂ A₁` from `R₁Y`, `Y = M A₂`.
    fn joined(
        &self,
        below: &Self,
        there_and_back: &Matrix<S>,
        upward: impl FnOnce(&Matrix<S>) -> Matrix<S>,
    ) -> Option<Self> {
        let columns = there_and_back.columns();
        // One more column for the scores: M (N₂ + R₂N₁).
        let extinctions = |score: &[S]| -> Vec<S> {
            let back = below.reflected.applied(score);
            below.score.iter().zip(back).map(|(&own, back)| own + back).collect()
        };
        let (through, scores) = (below.through(), extinctions(&self.score));
        let expected = Matrix::new(columns, columns + 1, |i, j| {
            if j < columns { through.at(i, j) } else { scores[i] }
        });
        let solved = there_and_back.series_times(&expected)?;
        let downward = Matrix::new(columns, columns, |i, j| solved.at(i, j));
        let inner: Vec<S> = (0..columns).map(|i| solved.at(i, columns)).collect();
        let turned = self.reflected.times(&downward);
        let upward = upward(&turned);
        // Y − D₂ and M (N₂ + R₂N₁) for all rows, the further directions among them.
        let past = below.scattered.clone().plus(&below.reflected.times(&turned));
        let again = self.reflected.applied(&inner);
        let seen: Vec<S> = self.score.iter().zip(again).map(|(&own, back)| own + back).collect();
        let (all, passed) = (extinctions(&seen), self.scattered.applied(&inner));
        let reflected = self.reflected.clone().plus(&self.scattered.times(&upward));
        let scattered = self.scattered.times(&downward);
        let score = (0..all.len()).map(|i| self.score[i] + passed[i] + self.direct[i] * all[i]);
        Some(Self {
            reflected: reflected.plus_rows(&self.direct, &upward),
            scattered: scattered.plus_rows(&self.direct, &past),
            direct: self.direct.iter().zip(&below.direct).map(|(&a, &b)| a * b).collect(),
            score: score.collect(),
        })
    }
}

fn direct<S: Scalar>(directions: &Directions, slice: &Kernel<S>, part: f64) -> Vec<S> {
    let lost = slice.lost() * slice.rate * part;
    directions.cosines.iter().map(|&cosine| (-lost / cosine).exp()).collect()
}
