//! Where an estimator exists and is unbiased.

use super::{Refusal, Setup};
use numeric::Span;
use numeric::digits::{number, rounded};
use theory::Rule;
use theory::problems::Problem;

/// Inequalities are tested with this relative slack, so that `σ̂ = max σ_t` is not refused for
/// rounding.
const SLACK: f64 = 1e-12;

/// The logarithm of the largest weight that a draw may reach: a little below the largest double.
const LARGEST_WEIGHT: f64 = 700.0;
/// Walks that are rarer than `e^` this are never drawn: one in 1e21.
const NEVER: f64 = 48.4;

/// More collisions than this on a ray are walked one after the other.
const MOST_COLLISIONS: f64 = 1e6;

impl<P: Problem> Setup<P> {
    /// Whether a ray has so few collisions that their numbers fit a table, and that walks end.
    ///
    /// # Errors
    ///
    /// What is needed, and Λ.
    pub fn require_few_collisions(&self, needs: &'static str) -> Result<(), Refusal> {
        let collisions = self.sampling.whole_depth();
        if collisions <= MOST_COLLISIONS {
            return Ok(());
        }
        Err(Refusal::mismatch(needs, format!("∫σ̂ = {collisions:e}")))
    }

    fn residual(&self, t: f64, extinction: f64) -> f64 {
        extinction - self.control.extinction(t)
    }

    /// What the residual is called in messages.
    fn residual_name(&self) -> &'static str {
        if self.control.is_none() { "σ_t" } else { "σ_t − σ_c" }
    }

    /// σ̂ must be positive wherever the residual is not zero, or collisions are missed for good.
    ///
    /// # Errors
    ///
    /// The stretch of the ray that σ̂ leaves out.
    pub fn require_coverage(&self) -> Result<(), Refusal> {
        let cut = self.mesh.refined(self.sampling.knots(), &|_, _| Vec::new());
        // A piece of σ̂ that is zero at its middle is zero throughout: pieces are straight and not
        // negative.
        let empty = self.sampling.knots().windows(2).map(|ends| Span::new(ends[0], ends[1]));
        let blind =
            empty.filter(|span| self.sampling.value(span.middle()) <= 0.0).find_map(|span| {
                let residual = cut.largest(|t, sigma| {
                    if span.contains_inside(t) { self.residual(t, sigma).abs() } else { 0.0 }
                });
                residual.filter(|&(_, size)| size > 0.0)
            });
        let blind = blind.or_else(|| self.touched_zero());
        match blind {
            None => Ok(()),
            Some((at, size)) => Err(Refusal::Inequality {
                needs: "σ̂ > 0 wherever the residual is not zero",
                found: format!("σ̂ = 0 while |{}| = {}", self.residual_name(), rounded(size)),
                at,
            }),
        }
    }

    /// Weights that stay finite in every walk that may be drawn.
    ///
    /// ```text
    /// ln T_c + n ln max|W| ≤ 700,   P(N ≥ n) ≤ exp(−n ln(n/Λ) + n − Λ) = 1e-21,  Λ = ∫σ̂
    /// ```
    ///
    /// # Errors
    ///
    /// The largest factor and n.
    pub fn require_finite_weights(&self, rule: &dyn Rule) -> Result<(), Refusal> {
        let mut cuts = self.sampling.knots().to_vec();
        cuts.extend(self.control.breaks());
        let factor = |t: f64, sigma: f64| {
            let (residual, sampling) = (self.residual(t, sigma), self.sampling.value(t));
            if sampling > 0.0 { rule.outcome(residual / sampling).weight.abs() } else { 0.0 }
        };
        let cut = self.mesh.refined(&cuts, &|_, _| Vec::new());
        let Some((_, largest)) = cut.largest(factor).filter(|&(_, largest)| largest > 1.0) else {
            return Ok(());
        };
        let collisions = self.sampling.whole_depth();
        let rarity = |n: f64| n * (n / collisions).ln() - n + collisions;
        let (mut few, mut many) = (collisions, 2.0 * collisions + 1.0);
        while rarity(many) < NEVER {
            (few, many) = (many, 2.0 * many);
        }
        // To a thousandth is near enough, and beyond 2⁵³ numbers no longer differ by one.
        while many - few > (1e-3 * many).max(1.0) {
            let middle = 0.5 * (few + many);
            if rarity(middle) < NEVER { few = middle } else { many = middle }
        }
        let most = many.ceil();
        if self.control_transmittance.ln() + most * largest.ln() <= LARGEST_WEIGHT {
            return Ok(());
        }
        let needs = "weights that stay below 1e304";
        let found = format!("{most} collisions may multiply them by {largest:.3e} each");
        Err(Refusal::mismatch(needs, found))
    }

    /// A knot at which σ̂ falls to zero while the residual does not: collisions are then so rare
    /// beside what they must carry that the variance is infinite.
    fn touched_zero(&self) -> Option<(f64, f64)> {
        let medium = self.mesh.medium();
        let support = self.mesh.support();
        let size = |t: f64| self.residual(t, medium.extinction(t)).abs();
        self.sampling.knots().windows(2).find_map(|ends| {
            let middle = 0.5 * (ends[0] + ends[1]);
            let inset = 1e-9 * (ends[1] - ends[0]);
            // Where the residual vanishes with σ̂ their ratio stays what it is in the middle.
            let usual = |t: f64| size(middle).max(size(t)) / self.sampling.value(middle);
            let blows_up = |t: &f64| size(*t) / self.sampling.value(*t) > 1e6 * usual(*t);
            let corners = [ends[0] + inset, ends[1] - inset];
            let inside = corners.into_iter().filter(|&t| support.contains_inside(t));
            inside.filter(blows_up).map(|t| (t, size(t))).next()
        })
    }

    /// `σ_t − σ_c ≥ 0` everywhere.
    ///
    /// # Errors
    ///
    /// Where it is violated most.
    pub fn require_not_negative(&self, needs: &'static str) -> Result<(), Refusal> {
        if self.control.is_none() {
            return Ok(());
        }
        let cut = self.mesh.refined(&self.control.breaks(), &|_, _| Vec::new());
        let worst = cut.largest(|t, sigma| -self.residual(t, sigma));
        let scale = cut.largest(|_, sigma| sigma).map_or(0.0, |(_, largest)| largest);
        match worst {
            Some((at, deficit)) if deficit > SLACK * scale => Err(Refusal::Inequality {
                needs,
                found: format!("{} = {}", self.residual_name(), rounded(-deficit)),
                at,
            }),
            _ => Ok(()),
        }
    }

    /// `σ_t − σ_c ≤ limit · σ̂` everywhere.
    ///
    /// # Errors
    ///
    /// Where it is violated most.
    pub fn require_ratio_at_most(&self, limit: f64, needs: &'static str) -> Result<(), Refusal> {
        self.require_ratio_within(&[], |_| limit, needs)
    }

    /// The same with a limit that varies along the ray, straight between the given knots.
    ///
    /// # Errors
    ///
    /// Where it is violated most.
    pub fn require_ratio_within(
        &self,
        knots: &[f64],
        limit: impl Fn(f64) -> f64,
        needs: &'static str,
    ) -> Result<(), Refusal> {
        self.require_coverage()?;
        let mut cuts = self.sampling.knots().to_vec();
        cuts.extend(self.control.breaks());
        cuts.extend(knots);
        let cut = self.mesh.refined(&cuts, &|_, _| Vec::new());
        let ratio = |t: f64, sigma: f64| {
            let residual = self.residual(t, sigma);
            if residual == 0.0 { 0.0 } else { residual / self.sampling.value(t) }
        };
        let worst = cut.largest(|t, sigma| ratio(t, sigma) / limit(t));
        match worst {
            Some((at, excess)) if excess > 1.0 + SLACK => {
                let sampling = self.sampling.value(at);
                let name = self.residual_name();
                let ratio = excess * limit(at);
                let [flown, residual, shown] = [sampling, ratio * sampling, ratio].map(rounded);
                let found = format!("σ̂ = {flown} and {name} = {residual}, r = {shown},");
                Err(Refusal::Inequality { needs, found, at })
            }
            _ => Ok(()),
        }
    }

    /// A transmittance that is not in units of its own, see [`Problem::log_unit`].
    ///
    /// # Errors
    ///
    /// The optical depth.
    pub fn require_plain_unit(&self, needs: &'static str) -> Result<(), Refusal> {
        if self.log_unit == 0.0 {
            return Ok(());
        }
        Err(Refusal::mismatch(needs, format!("τ = {}", rounded(self.log_unit))))
    }

    /// One constant `σ̂ > 0` on the whole support.
    ///
    /// # Errors
    ///
    /// What σ̂ is instead.
    pub fn require_constant_sampling(&self) -> Result<f64, Refusal> {
        let needs = "a constant σ̂ > 0";
        match self.sampling.single_value() {
            Some(value) if value > 0.0 || self.mesh.support().is_empty() => Ok(value),
            Some(value) => Err(Refusal::mismatch(needs, format!("σ̂ = {}", number(value)))),
            None => Err(Refusal::mismatch(needs, "σ̂ varies along the ray")),
        }
    }
}
