//! Techniques of single scattering: predicted by theory, and by nodes along the ray in 32 digits, see `nodes`.
//!
//! `A_k` is the rate of decay of the k-th moment of the transmittance from the ray's origin, `e^{−B_k}` the k-th
//! moment of that of the shadow ray. S is the light that is scattered towards the origin, without these
//! transmittances.
//!
//! ```text
//! at a point of density p       E[X^k] = ∫ p (σ_t S/p)^k e^{−∫A_k − B_k} ds
//! at every collision            U_k' = A_k U_k − Σⱼ (k over j) σ̂ (σ_t S/σ̂)ʲ e^{−Bⱼ} w^{k−j} U_{k−j}
//! resampled                     E[F^{k−1} G_k], see `theory::single::walks`
//! at n points, one walk         E[A₁^{n₁} A₂^{n₂} …], likewise, A_m = ∫ p (T̂ σ_t S/p)^m E[T̂_shadow^m] ds
//! ```

use super::equations::{binomial, power};
use super::nodes::{PanelLine, Solution};
use super::prelude::*;
use super::shared_walk::{ORDERS, degree, of_mean};
use theory::problems::{Problem, SingleScattering};
use theory::single::predict::DENSITY;
use theory::single::{
    self, Camera, CameraTracking, Collisions, RayNode, RayScene, TechniqueMoments, Tracking, walks,
};

/// Technique that samples points of a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PointTechnique {
    /// Scores at every collision of a walk.
    AtCollisions,
    /// Score at one of all collisions of a walk.
    Resampled,
    /// Scores at points that share a walk.
    SharedWalk,
    /// Score at the end of delta tracking.
    Delta,
    /// Score at a point sampled by angle.
    ByAngle(CameraTracking),
    /// Score at a point sampled with a density that falls exponentially with the distance.
    ByDepth(CameraTracking),
}

/// Estimator of a scene without its technique.
pub struct Estimator<'a> {
    /// Light, ray and medium.
    pub problem: &'a SingleScattering,
    /// σ̂ and σ_c along the ray.
    pub walk: [f64; 2],
    /// Transmittance of shadow rays.
    pub tracking: Tracking,
    /// Points that share a walk.
    pub count: usize,
}

impl Estimator<'_> {
    /// Rate of points by depth, which are found in closed form: no deeper than −ln 2⁻⁵³ = 37.
    fn rate(&self) -> f64 {
        self.walk[0].min(30.0 / self.problem.medium().support().length())
    }

    /// Returns the prediction of theory.
    pub fn found(&self, technique: PointTechnique) -> TechniqueMoments {
        let (problem, [sampling, control]) = (self.problem, self.walk);
        let medium = problem.medium();
        let (mesh, support) = (Mesh::new(medium.clone()), medium.support());
        let flown = Piecewise::constant(sampling, support);
        let along = match technique {
            PointTechnique::ByAngle(along) | PointTechnique::ByDepth(along) => along,
            PointTechnique::Delta => CameraTracking::Exact,
            _ => CameraTracking::Ratio,
        };
        let control = if along == CameraTracking::Ratio && control != 0.0 {
            Control::Pieces(Piecewise::constant(control, support))
        } else {
            Control::None
        };
        let camera = Camera::new(&mesh, &flown, &control, along);
        let scene = &RayScene::new(problem, camera, self.tracking);
        let of = |density: &dyn Fn(&RayNode) -> f64, blur: &dyn Fn(&RayNode) -> f64| {
            let gain = |node: &RayNode| node.extinction * node.source / density(node);
            let (by_collisions, weighted) = (None, None);
            let technique =
                single::ScoredDensity { density, gain: &gain, blur, by_collisions, weighted };
            TechniqueMoments::of(scene, &technique, Vec::new())
        };
        let by_angle = |node: &RayNode| problem.equiangular_density_beyond(node.along);
        match technique {
            PointTechnique::AtCollisions => walks::at_collisions(scene),
            PointTechnique::Resampled => walks::resampled(scene, self.tracking == Tracking::Exact),
            PointTechnique::SharedWalk => walks::at_points(scene, self.count, &by_angle),
            PointTechnique::ByAngle(_) => of(&by_angle, &|_| DENSITY),
            PointTechnique::ByDepth(_) => {
                let rate = self.rate();
                let computed = -(-rate * support.length()).exp_m1();
                let density = |node: &RayNode| rate * (-rate * node.s).exp() / computed;
                of(&density, &|node| DENSITY + f64::EPSILON * rate * node.s)
            }
            PointTechnique::Delta => {
                Collisions { medium, sampling: &flown, scatters: 1.0 }.points(scene)
            }
        }
    }
}

/// A place of a ray.
pub struct RayPlace {
    /// σ_t.
    pub extinction: DoubleDouble,
    /// `σ_t S`.
    pub scattered: DoubleDouble,
    /// `e^{−B}` for the powers 0 … 4.
    pub shadow: [DoubleDouble; 5],
    /// Mean lookups of the shadow ray; unknown in fields.
    pub cast: Option<DoubleDouble>,
}

/// A node of a ray.
struct At {
    place: RayPlace,
    /// Density of points by angle.
    by_angle: DoubleDouble,
    /// Factor of a weight at a collision.
    weight: DoubleDouble,
    /// Score of a collision without its shadow ray.
    gain: DoubleDouble,
}

/// A ray by nodes.
pub struct Ray<'a> {
    estimator: &'a Estimator<'a>,
    line: PanelLine,
    at: Vec<At>,
    sampling: DoubleDouble,
    control: DoubleDouble,
}

/// `E[X], …, E[X⁴]`, and the mean lookups if they are known.
pub type ExactMoments = ([DoubleDouble; 4], Option<DoubleDouble>);

impl<'a> Ray<'a> {
    /// Cuts a ray at ends and further, for a largest rate of what is lost along it.
    pub fn new(
        estimator: &'a Estimator,
        ends: &[f64],
        rate: f64,
        place: &dyn Fn(DoubleDouble) -> RayPlace,
    ) -> Self {
        let ends: Vec<DoubleDouble> = ends.iter().copied().map(DoubleDouble::from).collect();
        let line = PanelLine::new(&ends, |_| rate);
        let distance = DoubleDouble::from(estimator.problem.distance());
        let foot = estimator.problem.foot();
        let by_angle = line.values(|_, s| 1.0 / (distance * distance + (s - foot).powi(2)));
        let whole = line.one_way(|_| DoubleDouble::default(), |i| by_angle[i]).begin;
        let [sampling, control] = estimator.walk.map(DoubleDouble::from);
        let at = |(place, by_angle): (RayPlace, DoubleDouble)| At {
            by_angle: by_angle / whole,
            weight: 1.0 - (place.extinction - control) / sampling,
            gain: place.scattered / sampling,
            place,
        };
        let at = line.values(|_, s| place(s)).into_iter().zip(by_angle).map(at).collect();
        Self { estimator, line, at, sampling, control }
    }

    /// The radiance.
    pub fn radiance(&self) -> DoubleDouble {
        let source = |at: &At, _| scored(&at.place, DoubleDouble::ONE, 1);
        self.solve(|at| at.place.extinction, source).begin
    }

    /// Moments and lookups of a technique.
    pub fn exact(&self, technique: PointTechnique) -> ExactMoments {
        match technique {
            PointTechnique::AtCollisions => self.at_collisions(),
            PointTechnique::Resampled => self.resampled(),
            PointTechnique::SharedWalk => self.shared_walk(),
            PointTechnique::Delta => self.delta(),
            PointTechnique::ByAngle(along) => {
                self.at_point(along, &self.at.iter().map(|at| at.by_angle).collect::<Vec<_>>())
            }
            PointTechnique::ByDepth(along) => {
                let rate = DoubleDouble::from(self.estimator.rate());
                let all = -(-rate * self.length()).exp_m1();
                self.at_point(along, &self.line.values(|_, s| rate * (-(rate * s)).exp() / all))
            }
        }
    }

    fn length(&self) -> DoubleDouble {
        DoubleDouble::from(self.estimator.problem.medium().support().length())
    }

    /// `U' = a U − g`, given a node and its number.
    fn solve(
        &self,
        rate: impl Fn(&At) -> DoubleDouble,
        source: impl Fn(&At, usize) -> DoubleDouble,
    ) -> Solution<DoubleDouble> {
        self.line.one_way(|i| rate(&self.at[i]), |i| source(&self.at[i], i))
    }

    /// `∫ p e^{−∫a} ds` of shadow rays' lookups.
    fn cast(
        &self,
        rate: impl Fn(&At) -> DoubleDouble,
        density: impl Fn(&At, usize) -> DoubleDouble,
    ) -> Option<DoubleDouble> {
        let is_known = self.at.iter().all(|at| at.place.cast.is_some());
        let cast = |at: &At, i| density(at, i) * at.place.cast.unwrap_or_default();
        is_known.then(|| self.solve(rate, cast).begin)
    }

    /// `kσ_c + σ̂(1 − x)`, x what is left of a weight to the power k.
    fn loss(&self, k: usize, left: DoubleDouble) -> DoubleDouble {
        k as f64 * self.control + self.sampling * (1.0 - left)
    }

    /// Loss of weights that keep their signs.
    fn signed(&self, at: &At, k: usize) -> DoubleDouble {
        self.loss(k, power(at.weight, k))
    }

    /// `σ̂ℓ`.
    fn flown(&self) -> DoubleDouble {
        self.sampling * self.length()
    }

    fn at_collisions(&self) -> ExactMoments {
        let mut known: Vec<Solution<DoubleDouble>> = Vec::new();
        for k in 1..5 {
            let source = |at: &At, i: usize| {
                let term = |j: usize| {
                    let kept = power(at.weight, k - j) * before(&known, k - j, i);
                    binomial(k, j) * power(at.gain, j) * at.place.shadow[j] * kept
                };
                self.sampling * (1..=k).map(term).sum::<DoubleDouble>()
            };
            known.push(self.solve(|at| self.signed(at, k), source));
        }
        let cast = self.cast(|_| DoubleDouble::default(), |_, _| self.sampling);
        (std::array::from_fn(|k| known[k].begin), cast.map(|cast| self.flown() + cast))
    }

    fn resampled(&self) -> ExactMoments {
        // n of j collisions score.
        let ways = |at: &At, j: usize, n: usize| {
            let kept = power(at.weight.abs(), j - n);
            self.sampling * binomial(j, n) * kept * power(at.gain, n)
        };
        let mut f: Vec<Solution<DoubleDouble>> = Vec::new();
        for j in 1..4 {
            let source = |at: &At, i| (1..=j).map(|n| ways(at, j, n) * before(&f, j - n, i)).sum();
            f.push(self.solve(|at| self.loss(j, power(at.weight.abs(), j)), source));
        }
        let moment = |k: usize| {
            let sign = |at: &At| if k % 2 == 1 { at.weight } else { at.weight.abs() };
            let mut g: Vec<Solution<DoubleDouble>> = Vec::new();
            for j in 0..k {
                let source = |at: &At, i: usize| {
                    let own = |n| ways(at, j, n) * before(&f, j - n, i);
                    let later = |n: usize| ways(at, j, n) * g[j - n].at[i];
                    let own = at.gain * at.place.shadow[k] * (0..=j).map(own).sum::<DoubleDouble>();
                    own + sign(at) * (1..=j).map(later).sum::<DoubleDouble>()
                };
                let left = |at: &At| power(at.weight.abs(), j) * sign(at);
                g.push(self.solve(|at| self.loss(j + 1, left(at)), source));
            }
            g[k - 1].begin
        };
        let is_free = self.estimator.tracking == Tracking::Exact;
        ([1, 2, 3, 4].map(moment), is_free.then(|| self.flown()))
    }

    fn shared_walk(&self) -> ExactMoments {
        let mut known: Vec<Solution<DoubleDouble>> = Vec::new();
        for order in ORDERS {
            let source = |at: &At, i: usize| {
                let term = |m: usize| {
                    let mut lower = order;
                    lower[m - 1] -= 1;
                    let rest = ORDERS.iter().position(|order| *order == lower);
                    let rest = rest.map_or(DoubleDouble::ONE, |rest| known[rest].at[i]);
                    order[m - 1] as f64 * scored(&at.place, at.by_angle, m) * rest
                };
                (1..5).filter(|&m| order[m - 1] > 0).map(term).sum()
            };
            known.push(self.solve(|at| self.signed(at, degree(&order)), source));
        }
        let count = self.estimator.count;
        let cast = self.cast(|_| DoubleDouble::default(), |at, _| at.by_angle);
        let lookups = cast.map(|cast| self.flown() + count as f64 * (1.0 + cast));
        (of_mean(count, |order| known[order].begin), lookups)
    }

    fn delta(&self) -> ExactMoments {
        let rate = |at: &At| at.place.extinction;
        let moment = |k| {
            let source = |at: &At, _| scored(&at.place, at.place.extinction, k);
            self.solve(rate, source).begin
        };
        let walked = self.solve(rate, |_, _| self.sampling).begin;
        let cast = self.cast(rate, |at, _| at.place.extinction);
        ([1, 2, 3, 4].map(moment), cast.map(|cast| walked + cast))
    }

    fn at_point(&self, along: CameraTracking, density: &[DoubleDouble]) -> ExactMoments {
        let moment = |k: usize| {
            let rate = |at: &At| match along {
                CameraTracking::Exact => k as f64 * at.place.extinction,
                CameraTracking::Ratio => self.signed(at, k),
                CameraTracking::Delta => at.place.extinction,
            };
            self.solve(rate, |at, i| scored(&at.place, density[i], k)).begin
        };
        // A walk to the point collides on its way; one that is lost casts no shadow ray.
        let [sampling, is_lost] = match along {
            CameraTracking::Exact => [0.0, 0.0],
            CameraTracking::Ratio => [1.0, 0.0],
            CameraTracking::Delta => [1.0, 1.0],
        };
        let rate = |at: &At| is_lost * at.place.extinction;
        let beyond = self.solve(|_| DoubleDouble::default(), |_, i| density[i]);
        let walked = self.solve(rate, |_, i| sampling * self.sampling * beyond.at[i]).begin;
        let cast = self.cast(rate, |_, i| density[i]);
        ([1, 2, 3, 4].map(moment), cast.map(|cast| 1.0 + walked + cast))
    }
}

/// `U_j` of a node; `U_0 = 1`.
fn before(known: &[Solution<DoubleDouble>], j: usize, node: usize) -> DoubleDouble {
    if j == 0 { DoubleDouble::ONE } else { known[j - 1].at[node] }
}

/// `p (σ_t S/p)^k e^{−B_k}`.
fn scored(place: &RayPlace, density: DoubleDouble, k: usize) -> DoubleDouble {
    density * power(place.scattered / density, k) * place.shadow[k]
}
