//! Techniques of single scattering in a homogeneous medium, as theory has them and as chains, see `scattered`.

use super::chains::{Chain, Term};
use super::prelude::*;
use super::series::{binomial, power};
use super::shared_walk::{ORDERS, degree, of_mean};
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Collisions, Node, Points, Scene, Technique, Tracking, walks};

fn wide<const N: usize>(numbers: [f64; N]) -> [Wide; N] {
    numbers.map(Wide::from)
}

/// A homogeneous medium with its σ̂ and its control, in 32 digits.
#[derive(Clone, Copy)]
struct Sampled {
    sampling: Wide,
    control: Wide,
    weight: Wide,
}

impl Sampled {
    fn new(sigma: f64, sampling: f64, control: f64) -> Self {
        let [sigma, sampling, control] = wide([sigma, sampling, control]);
        Self { sampling, control, weight: 1.0 - (sigma - control) / sampling }
    }

    /// `kσ_c + σ̂(1 − x)`, x what is left of a weight to the power k.
    fn loss(&self, k: usize, left: Wide) -> Wide {
        k as f64 * self.control + self.sampling * (1.0 - left)
    }

    fn signed(&self, k: usize) -> Wide {
        self.loss(k, power(self.weight, k))
    }
}

/// One scene, and the chain that it becomes.
pub struct Case {
    sigma: Wide,
    /// `σ_t c`.
    scattered: Wide,
    walk: Sampled,
    /// B for the powers 0 … 4.
    shadow: [Wide; 5],
    /// The mean lookups of a shadow ray: factors, powers of r and exponents of `e^{−br}`.
    cast: Vec<(Wide, i32, Wide)>,
    length: Wide,
    /// Equations of all techniques.
    pub chain: Chain,
}

/// Raw moments, from the solved chain.
pub type Moments = dyn Fn(&[Wide]) -> [Wide; 4];
/// Mean lookups, from the solved chain.
pub type Lookups = dyn Fn(&[Wide]) -> Wide;

/// What is to be compared: exact raw moments and lookups, from the solved chain.
pub struct Wanted {
    /// In tables.
    pub name: &'static str,
    /// Whether it is a walk that scatters at many points.
    pub is_walk: bool,
    /// As theory finds it.
    pub found: Points,
    /// `E[X], …, E[X⁴]`.
    pub moments: Box<Moments>,
    /// The mean lookups.
    pub lookups: Option<Box<Lookups>>,
}

fn shadow_losses(sigma: f64, tracking: Tracking) -> [Wide; 5] {
    std::array::from_fn(|k| match tracking {
        Tracking::Exact => Wide::from(sigma) * k as f64,
        Tracking::Ratio { sampling, control } => Sampled::new(sigma, sampling, control).signed(k),
        Tracking::Delta { .. } => Wide::from(if k == 0 { 0.0 } else { sigma }),
    })
}

/// `σ̂ r`, or of delta tracking `(σ̂/σ_t)(1 − e^{−σ_t r})`.
fn cast(sigma: f64, tracking: Tracking) -> Vec<(Wide, i32, Wide)> {
    let nothing = Wide::default();
    match tracking {
        Tracking::Exact => Vec::new(),
        Tracking::Ratio { sampling, .. } => vec![(Wide::from(sampling), 1, nothing)],
        Tracking::Delta { sampling } => {
            let ratio = Wide::from(sampling) / sigma;
            vec![(ratio, 0, nothing), (-ratio, 0, Wide::from(sigma))]
        }
    }
}

impl Case {
    /// A scene of a length, with σ̂ and a control along the ray, and shadow rays.
    pub fn new(
        problem: &SingleScattering,
        (sigma, length): (f64, f64),
        [sampling, control]: [f64; 2],
        tracking: Tracking,
    ) -> Self {
        let scale = Wide::from(problem.albedo()) / (Wide::PI * Wide::PI).scaled(4);
        Self {
            sigma: Wide::from(sigma),
            scattered: scale * Wide::from(sigma),
            walk: Sampled::new(sigma, sampling, control),
            shadow: shadow_losses(sigma, tracking),
            cast: cast(sigma, tracking),
            length: Wide::from(length),
            chain: Chain::new(problem.distance(), problem.foot(), length),
        }
    }

    fn term(&mut self, factor: Wide, (power, loss): (i32, Wide), of: Option<usize>) -> Term {
        Term { factor, kernel: self.chain.kernel(power, loss), of }
    }

    fn add(&mut self, rate: Wide, factor: Wide, kernel: (i32, Wide), of: Option<usize>) -> usize {
        let term = self.term(factor, kernel, of);
        self.chain.add(rate, vec![term])
    }

    /// The mean lookups of shadow rays from points of density `f rⁿ e^{−as}`.
    fn shadows(&mut self, rate: Wide, factor: Wide, power: i32) -> usize {
        let cast = self.cast.clone();
        let term = |(share, more, loss)| self.term(factor * share, (power + more, loss), None);
        let terms = cast.into_iter().map(term).collect();
        self.chain.add(rate, terms)
    }

    /// At every collision.
    pub fn at_collisions(&mut self, scene: &Scene) -> Wanted {
        let Sampled { sampling, weight, .. } = self.walk;
        let gain = self.scattered / sampling;
        let mut known: Vec<usize> = Vec::new();
        for k in 1..5 {
            let terms = (1..=k).map(|j| {
                let factor = binomial(k, j) * power(weight, k - j) * power(gain, j);
                let lower = (j < k).then(|| known[k - j - 1]);
                let kernel = (-2 * i32::try_from(j).unwrap_or(0), self.shadow[j]);
                self.term(sampling * factor, kernel, lower)
            });
            let terms = terms.collect();
            known.push(self.chain.add(self.walk.signed(k), terms));
        }
        let cast = self.shadows(Wide::default(), sampling, 0);
        let flown = sampling * self.length;
        Wanted {
            name: "at collisions",
            is_walk: true,
            found: walks::at_collisions(scene),
            moments: Box::new(move |at| std::array::from_fn(|k| at[known[k]])),
            lookups: Some(Box::new(move |at| flown + at[cast])),
        }
    }

    /// At one of all collisions.
    pub fn resampled(&mut self, scene: &Scene, tracking: Tracking) -> Wanted {
        let Sampled { sampling, weight, .. } = self.walk;
        let (gain, size) = (self.scattered / sampling, weight.abs());
        let nothing = Wide::default();
        let ways =
            |j: usize, n: usize| sampling * binomial(j, n) * power(size, j - n) * power(gain, n);
        let of_power = |n: usize| -2 * i32::try_from(n).unwrap_or(0);
        let mut f: Vec<usize> = Vec::new();
        for j in 1..4 {
            let terms = (1..=j).map(|n| {
                let lower = (n < j).then(|| f[j - n - 1]);
                self.term(ways(j, n), (of_power(n), nothing), lower)
            });
            let terms = terms.collect();
            f.push(self.chain.add(self.walk.loss(j, power(size, j)), terms));
        }
        let mut last = Vec::new();
        for k in 1..5 {
            let sign = if k % 2 == 1 { weight } else { size };
            let mut g: Vec<usize> = Vec::new();
            for j in 0..k {
                let mut terms = Vec::new();
                for n in 0..=j {
                    let own = (of_power(n + 1), self.shadow[k]);
                    let lower = (n < j).then(|| f[j - n - 1]);
                    terms.push(self.term(ways(j, n) * gain, own, lower));
                    if n > 0 {
                        let later = (of_power(n), nothing);
                        terms.push(self.term(ways(j, n) * sign, later, Some(g[j - n])));
                    }
                }
                g.push(self.chain.add(self.walk.loss(j + 1, power(size, j) * sign), terms));
            }
            last.push(g[k - 1]);
        }
        let flown = sampling * self.length;
        let is_free = tracking == Tracking::Exact;
        let lookups: Box<Lookups> = Box::new(move |_| flown);
        Wanted {
            name: "resampled",
            is_walk: true,
            found: walks::resampled(scene, is_free),
            moments: Box::new(move |at| std::array::from_fn(|k| at[last[k]])),
            lookups: is_free.then_some(lookups),
        }
    }

    /// At points that share a walk.
    pub fn at_points(&mut self, scene: &Scene, problem: &SingleScattering, count: usize) -> Wanted {
        let density = |node: &Node| problem.equiangular_density_beyond(node.along);
        let found = walks::at_points(scene, count, &density);
        let mut known: Vec<usize> = Vec::new();
        for order in ORDERS {
            let degree = degree(&order);
            let terms = (1..5).filter(|&m| order[m - 1] > 0).map(|m| {
                let mut lower = order;
                lower[m - 1] -= 1;
                let rest = ORDERS.iter().position(|order| *order == lower).map(|i| known[i]);
                self.term(Wide::from(order[m - 1] as f64), (-2, self.shadow[m]), rest)
            });
            let terms = terms.collect();
            known.push(self.chain.add(self.walk.signed(degree), terms));
        }
        let (none, scattered) = (Wide::default(), self.scattered);
        let norm = self.add(none, Wide::ONE, (-2, none), None);
        let cast = self.shadows(none, Wide::ONE, -2);
        let flown = self.walk.sampling * self.length;
        let n = count as f64;
        let moments = move |at: &[Wide]| {
            of_mean(count, |i| {
                let order = &ORDERS[i];
                let (k, points) = (degree(order), order.iter().sum::<usize>());
                at[known[i]] * power(scattered, k) * power(at[norm], k - points)
            })
        };
        Wanted {
            name: "shared walk",
            is_walk: true,
            found,
            moments: Box::new(moments),
            lookups: Some(Box::new(move |at| flown + n * (1.0 + at[cast] / at[norm]))),
        }
    }

    /// Of delta tracking.
    pub fn found(&mut self, scene: &Scene) -> Wanted {
        let sigma = self.sigma;
        let sampling = self.walk.sampling;
        let medium = scene.problem.medium();
        let flown = Piecewise::constant(sampling.value(), medium.support());
        let collisions = Collisions { medium, sampling: &flown, scatters: 1.0 };
        let technique = Technique {
            density: &|node| collisions.density(node),
            gain: &|node| collisions.worth(node),
            blur: &|node| node.error[1],
            found: Some(&collisions),
            weighted: None,
        };
        let gain = self.scattered / sigma;
        let known = [1, 2, 3, 4].map(|k| {
            let kernel = (-2 * i32::try_from(k).unwrap_or(0), self.shadow[k]);
            self.add(sigma, sigma * power(gain, k), kernel, None)
        });
        let cast = self.shadows(sigma, sigma, 0);
        let walked = -(-sigma * self.length).exp_m1() * sampling / sigma;
        Wanted {
            name: "delta tracking",
            is_walk: false,
            found: Points::of(scene, &technique),
            moments: Box::new(move |at| known.map(|index| at[index])),
            lookups: Some(Box::new(move |at| walked + at[cast])),
        }
    }

    /// At a point of the density `rⁿ e^{−as}` over its integral, which `density` holds.
    pub fn at_point(
        &mut self,
        (name, scene, along): (&'static str, &Scene, CameraTracking),
        [density, blur]: [&dyn Fn(&Node) -> f64; 2],
        (n, a): (i32, Wide),
    ) -> Wanted {
        let gain = |node: &Node| node.extinction * node.source / density(node);
        let found = Points::of(
            scene,
            &Technique { density, gain: &gain, blur, found: None, weighted: None },
        );
        let none = Wide::default();
        let before = |k: usize, case: &Self| match along {
            CameraTracking::Exact => case.sigma * k as f64,
            CameraTracking::Ratio => case.walk.signed(k),
            CameraTracking::Delta => case.sigma,
        };
        let scattered = self.scattered;
        let norm = self.add(a, Wide::ONE, (n, none), None);
        let known = [1, 2, 3, 4].map(|k: usize| {
            let whole = i32::try_from(k).unwrap_or(0);
            let rate = before(k, self) + a - k as f64 * a;
            let kernel = (n - whole * (2 + n), self.shadow[k]);
            self.add(rate, power(scattered, k), kernel, None)
        });
        // σ̂ s, or of delta tracking (σ̂/σ_t)(1 − e^{−σ_t s}); what comes through casts a shadow ray.
        let through = if along == CameraTracking::Delta { self.sigma } else { none };
        let walked = (along == CameraTracking::Ratio)
            .then(|| self.add(a, self.walk.sampling, (0, none), Some(norm)));
        let left = self.add(a + through, Wide::ONE, (n, none), None);
        let cast = self.shadows(a + through, Wide::ONE, n);
        let ratio = self.walk.sampling / self.sigma;
        Wanted {
            name,
            is_walk: false,
            found,
            moments: Box::new(move |at| {
                let mut scale = Wide::ONE;
                known.map(|index| {
                    let moment = at[index] * scale;
                    scale = scale * at[norm];
                    moment
                })
            }),
            lookups: Some(Box::new(move |at| {
                let walked = walked.map_or(ratio * (at[norm] - at[left]), |walked| at[walked]);
                1.0 + (walked + at[cast]) / at[norm]
            })),
        }
    }
}
