//! The residual `σ_t − σ_c` beside σ̂ along a ray: where an estimator exists and is unbiased.

use super::Refusal;
use media::{Control, OpticalDepth, Piecewise};
use numeric::Span;
use numeric::digits::{number, rounded};
use theory::Mesh;

/// A gap shorter than this share of the support is flown through.
const SHORTEST_GAP: f64 = 1.0 / 16.0;

/// Inequalities are tested with this relative slack, so that `σ̂ = max σ_t` is not refused for
/// rounding.
const SLACK: f64 = 1e-12;

/// Largest expected number of collisions on a ray.
const MAX_COLLISIONS: f64 = 1e6;

/// σ_t, σ̂ and σ_c along a ray.
#[derive(Clone, Copy)]
pub struct Residual<'a> {
    /// Medium, cut into panels.
    pub mesh: &'a Mesh,
    /// σ̂ on the support.
    pub sampling: &'a Piecewise,
    /// σ_c.
    pub control: &'a Control,
}

impl Residual<'_> {
    /// Requires at most 10⁶ expected collisions on the ray: their counts must fit a table, and walks must end.
    ///
    /// # Errors
    ///
    /// The expected number of collisions, ∫σ̂.
    pub fn require_few_collisions(self, needs: &'static str) -> Result<(), Refusal> {
        let collisions = self.sampling.whole_depth();
        if collisions <= MAX_COLLISIONS {
            return Ok(());
        }
        Err(Refusal::mismatch(needs, format!("∫σ̂ = {collisions:e}")))
    }

    /// `σ_t − σ_c` at a distance, given σ_t.
    pub fn at(self, t: f64, extinction: f64) -> f64 {
        extinction - self.control.extinction(t)
    }

    /// Name of the residual in messages.
    fn name(self) -> &'static str {
        if self.control.is_none() { "σ_t" } else { "σ_t − σ_c" }
    }

    /// Requires σ̂ > 0 wherever the residual is not zero: a walk has no collisions where σ̂ = 0.
    ///
    /// # Errors
    ///
    /// The stretch of the ray that σ̂ leaves out.
    pub fn require_coverage(self) -> Result<(), Refusal> {
        let cut = self.mesh.refined(self.sampling.knots(), &|_, _| Vec::new());
        // A piece of σ̂ that is zero at its middle is zero throughout: pieces are straight and not
        // negative.
        let empty = self.sampling.knots().windows(2).map(|ends| Span::new(ends[0], ends[1]));
        let blind =
            empty.filter(|span| self.sampling.value(span.middle()) <= 0.0).find_map(|span| {
                let residual = cut.largest(&|t, sigma| {
                    if span.contains_inside(t) { self.at(t, sigma).abs() } else { 0.0 }
                });
                residual.filter(|&(_, size)| size > 0.0)
            });
        let blind = blind.or_else(|| self.touched_zero());
        match blind {
            None => Ok(()),
            Some((at, size)) => Err(Refusal::Inequality {
                needs: "σ̂ > 0 wherever the residual is not zero".into(),
                actual: format!("σ̂ = 0 while |{}| = {}", self.name(), rounded(size)),
                at,
            }),
        }
    }

    /// Returns a knot at which σ̂ falls to zero and the residual does not, with the size of the residual. Collisions
    /// next to it are so rare that their weights have an infinite variance.
    fn touched_zero(self) -> Option<(f64, f64)> {
        let medium = self.mesh.medium();
        let support = self.mesh.support();
        let size = |t: f64| self.at(t, medium.extinction(t)).abs();
        self.sampling.knots().windows(2).find_map(|ends| {
            let middle = 0.5 * (ends[0] + ends[1]);
            let inset = 1e-9 * (ends[1] - ends[0]);
            // Where the residual falls to zero with σ̂, their ratio stays near that in the middle.
            let usual = |t: f64| size(middle).max(size(t)) / self.sampling.value(middle);
            let blows_up = |t: &f64| size(*t) / self.sampling.value(*t) > 1e6 * usual(*t);
            let corners = [ends[0] + inset, ends[1] - inset];
            let inside = corners.into_iter().filter(|&t| support.contains_inside(t));
            inside.filter(blows_up).map(|t| (t, size(t))).next()
        })
    }

    /// Requires `σ_t − σ_c ≥ 0` everywhere.
    ///
    /// # Errors
    ///
    /// The distance of the largest violation.
    pub fn require_not_negative(self, needs: &'static str) -> Result<(), Refusal> {
        if self.control.is_none() {
            return Ok(());
        }
        let cut = self.mesh.refined(&self.control.breaks(), &|_, _| Vec::new());
        let worst = cut.largest(&|t, sigma| -self.at(t, sigma));
        let scale = cut.largest(&|_, sigma| sigma).map_or(0.0, |(_, largest)| largest);
        match worst {
            Some((at, deficit)) if deficit > SLACK * scale => Err(Refusal::Inequality {
                needs: needs.into(),
                actual: format!("{} = {}", self.name(), rounded(-deficit)),
                at,
            }),
            _ => Ok(()),
        }
    }

    /// Requires `σ_t − σ_c ≤ limit · σ̂` everywhere.
    ///
    /// # Errors
    ///
    /// The distance of the largest violation.
    pub fn require_ratio_at_most(self, limit: f64, needs: &'static str) -> Result<(), Refusal> {
        self.require_ratio_within(&[], |_| limit, needs)
    }

    /// Requires `σ_t − σ_c ≤ limit · σ̂` everywhere, for a limit that is straight between the given knots.
    ///
    /// # Errors
    ///
    /// The distance of the largest violation.
    pub fn require_ratio_within(
        self,
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
            let residual = self.at(t, sigma);
            if residual == 0.0 { 0.0 } else { residual / self.sampling.value(t) }
        };
        let worst = cut.largest(&|t, sigma| ratio(t, sigma) / limit(t));
        match worst {
            Some((at, excess)) if excess > 1.0 + SLACK => {
                let sampling = self.sampling.value(at);
                let name = self.name();
                let ratio = excess * limit(at);
                let [flown, residual, shown] = [sampling, ratio * sampling, ratio].map(rounded);
                let actual = format!("σ̂ = {flown} and {name} = {residual}, r = {shown},");
                Err(Refusal::Inequality { needs: needs.into(), actual, at })
            }
            _ => Ok(()),
        }
    }

    /// Requires one constant `σ̂ > 0` on the whole support, and returns it.
    ///
    /// # Errors
    ///
    /// The σ̂ that was found.
    pub fn require_constant_sampling(self) -> Result<f64, Refusal> {
        let needs = "a constant σ̂ > 0";
        match self.sampling.single_value() {
            Some(value) if value > 0.0 || self.mesh.support().is_empty() => Ok(value),
            Some(value) => Err(Refusal::mismatch(needs, format!("σ̂ = {}", number(value)))),
            None => Err(Refusal::mismatch(needs, "σ̂ varies along the ray")),
        }
    }

    /// Returns the stretches on which medium and control are 0: at both ends of the support, and gaps that are long
    /// enough to be worth a piece of σ̂. If medium and control are equal everywhere, it is the whole support.
    pub fn gaps(self) -> Vec<Span> {
        let support = self.mesh.support();
        let is_worth = |stretch: &Span| {
            let is_at_end = stretch.from == support.from || stretch.to == support.to;
            is_at_end || stretch.length() >= SHORTEST_GAP * support.length()
        };
        let mut stretches = self.empty_stretches();
        stretches.retain(is_worth);
        stretches.retain(|&stretch| self.sampling.optical_depth(stretch).value > 0.0);
        stretches
    }

    /// The longest stretches on which medium and control are 0, or the whole support where they are the same.
    fn empty_stretches(self) -> Vec<Span> {
        let cut = self.mesh.refined(&self.control.breaks(), &|_, _| Vec::new());
        let is_nothing = |t: f64, sigma: f64| sigma == 0.0 && self.control.extinction(t) == 0.0;
        let is_residual = |t: f64, sigma: f64| sigma != self.control.extinction(t);
        let (mut stretches, mut is_same) = (Vec::<Span>::new(), true);
        for panel in cut.panels() {
            let nodes = || panel.t.iter().zip(panel.extinction);
            is_same &= !nodes().any(|(&t, &sigma)| is_residual(t, sigma));
            if !nodes().all(|(&t, &sigma)| is_nothing(t, sigma)) {
                continue;
            }
            match stretches.last_mut() {
                Some(last) if last.to == panel.span.from => last.to = panel.span.to,
                _ => stretches.push(panel.span),
            }
        }
        if is_same {
            stretches = vec![self.mesh.support()];
        }
        // A residual between the nodes shows in the integral.
        stretches.retain(|&stretch| {
            let medium = self.mesh.medium().optical_depth(stretch);
            let control = self.control.optical_depth(stretch);
            (medium.value - control.value).abs() <= medium.error + control.error
        });
        stretches
    }

    /// `r`, where medium, control and σ̂ are each one constant on the support.
    pub fn constant_ratio(self) -> Option<f64> {
        let control = self.control.single_value()?;
        let sampling = self.sampling.single_value().filter(|&value| value > 0.0)?;
        let mut extinctions = self.mesh.panels().flat_map(|panel| panel.extinction);
        let first = *extinctions.next()?;
        extinctions.all(|&x| x == first).then_some((first - control) / sampling)
    }
}
