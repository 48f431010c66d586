//! Channels with the same σ_t and σ̂: moments from a chain of equations by the numbers of scatterings.
//!
//! After i scatterings that kept the direction and j that turned it, at any places, the density of a path by the
//! walk of the channel λ is a common factor times
//!
//! ```text
//! q_λ = (a_λ p_f,λ)^i (a_λ (1 − p_f,λ))^j
//! ```
//!
//! so that all heroes together walk like one, with probabilities that depend on i and j; it flies forward where j
//! is even. With `p_λ` the probability of λ to go towards the emitter, at a scattering
//!
//! ```text
//! ā = Σ w_h q_h a_h/Σ w_h q_h,   p̄ = Σ w_h q_h a_h p_h/Σ w_h q_h a_h,   c_λ = q_λ a_λ p_λ/Σ w_h q_h a_h p_h
//! a shadow ray scores c_λ G, a hit c_λ H, with G and H distributed as in one channel with p̄, see [`crate::rod::lit`]
//! U_k'(x) = ±(σ U_k − σ ā E[Π (c_λ G + F_λ)^{k_λ}]),   U_k the mean of Π (what all future scatterings bring)^{k_λ}
//! E[Π F_λ^{k_λ}] = p̄ (Π c_λ^{k_λ} E[H^K] + U_k of the next state forward) + (1 − p̄) U_k of the next backward
//! ```
//!
//! with `k = (k_λ)`, `K = Σ k_λ`. An order has the equations of the next as its source: nothing couples.
//!
//! Source: derived.

use super::{Moments, PAIRS};
use crate::Mesh;
use crate::light::Techniques;
use crate::light::vertex::{Vertex, Weights};
use crate::prediction::raw::{HIGHEST, POWERS, RawMoments, binomial, power};
use crate::problems::SpectralLitRod;
use crate::rod::line::Line;
use crate::rod::lit::connections::along;
use crate::rod::lit::{walk, with_hit};
use crate::rod::spectral;
use crate::rod::walk::RodPoint;
use media::Piecewise;
use numeric::Known;

/// Maximum probability of orders of scattering that are left out.
const RARE: f64 = 1e-11;
/// Maximum number of orders of scattering.
const MAX_ORDERS: usize = 160;
/// Powers of a channel with computed moments: to the eighth, or to the second alone.
const POWERS_OF_ONE: [usize; 2] = [2, HIGHEST];

/// A rod in which all channels have the same σ_t and σ̂.
pub struct Orders<'a> {
    problem: &'a SpectralLitRod,
    albedos: Vec<f64>,
    mesh: &'a Mesh,
    heroes: &'a [f64],
    techniques: Techniques,
    count: usize,
}

/// A product of powers of one or two channels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Monomial {
    channels: [usize; 2],
    powers: [usize; 2],
}

/// Term of a binomial: powers of the shadow ray's score, and the moment of the rest.
struct Term {
    binomials: f64,
    powers: [usize; 2],
    /// Index of the moment of the rest; `None` where the rest has the power 0.
    rest: Option<usize>,
}

/// Numbers of scatterings that kept the direction, and that turned it.
struct OrderCounts {
    /// ā, p̄.
    albedo: f64,
    towards: f64,
    /// Powers of `c_λ`.
    coefficients: Vec<[f64; HIGHEST + 1]>,
}

/// U of every monomial at every node.
type Futures = Vec<Vec<f64>>;

impl<'a> Orders<'a> {
    /// Joins the parts; `None` where albedos are not constant, or light is scattered too often.
    pub fn new(
        problem: &'a SpectralLitRod,
        mesh: &'a Mesh,
        heroes: &'a [f64],
        techniques: Techniques,
    ) -> Option<Self> {
        let depth = mesh.optical_depth().value;
        let albedos = problem.albedos()?;
        let channels = albedos.iter().zip(&problem.forward);
        let needed = channels
            .map(|(&albedo, &forward)| spectral::orders_above(depth, albedo, forward, RARE));
        let count = needed.fold(0, usize::max);
        (count <= MAX_ORDERS).then_some(Self { problem, albedos, mesh, heroes, techniques, count })
    }

    /// `E[X^k]` of each channel with absolute errors for k = 1, 2, 3, 4 and 8, and mixed moments of each channel and
    /// the next. Without `with_distributions` the first two only.
    pub fn moments(&self, sampling: &Piecewise, with_distributions: bool) -> Option<Moments> {
        let rod = &self.problem.rods[0].rod;
        let highest = POWERS_OF_ONE[usize::from(with_distributions)];
        let (monomials, terms) = monomials(self.heroes.len(), highest);
        let numbers = walk(self.mesh, rod, sampling)
            .known(2, &|line| self.entering(line, highest, &monomials, &terms))?;
        let unscattered = self.mesh.optical_depth().exp_neg();
        let of = |monomial: Monomial, power: usize| {
            let at = monomials.iter().position(|known| *known == monomial)?;
            let scattered = numbers[at].blurred(RARE * numbers[at].value);
            Some(with_hit(scattered, unscattered, power, self.techniques))
        };
        let channels = 0..self.heroes.len();
        let raw = channels.clone().map(|channel| {
            RawMoments(std::array::from_fn(|i| {
                let k = POWERS[i].unsigned_abs() as usize;
                of(Monomial::of_one(channel, k), i).unwrap_or(Known::INFINITE)
            }))
        });
        let mixed = channels.skip(1).map(|channel| {
            PAIRS.map(|powers| {
                let result = of(Monomial { channels: [channel - 1, channel], powers }, 3);
                result.map_or(f64::INFINITY, |known| known.value)
            })
        });
        Some(Moments { raw: raw.collect(), mixed: mixed.collect() })
    }

    /// `q_λ`, ā, p̄ and `c_λ` of a state.
    fn state(&self, kept: usize, turned: usize) -> OrderCounts {
        let (mut all, mut scattered, mut towards) = (0.0, 0.0, 0.0);
        let mut shares = Vec::with_capacity(self.heroes.len());
        for (channel, weight) in self.heroes.iter().enumerate() {
            let (albedo, forward) = (self.albedos[channel], self.problem.forward[channel]);
            let density = power(albedo * forward, kept) * power(albedo * (1.0 - forward), turned);
            let phase = if turned.is_multiple_of(2) { forward } else { 1.0 - forward };
            all += weight * density;
            scattered += weight * density * albedo;
            towards += weight * density * albedo * phase;
            shares.push(density * albedo * phase);
        }
        let over = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        let coefficients = shares.iter().map(|share| {
            let one = over(*share, towards);
            let mut powers = [1.0; HIGHEST + 1];
            for k in 1..=HIGHEST {
                powers[k] = powers[k - 1] * one;
            }
            powers
        });
        OrderCounts {
            albedo: over(scattered, all),
            towards: over(towards, scattered),
            coefficients: coefficients.collect(),
        }
    }

    /// U of every monomial for the entering particle, on a line.
    fn entering(
        &self,
        line: &Line,
        highest: usize,
        monomials: &[Monomial],
        terms: &[Vec<Term>],
    ) -> Option<Vec<f64>> {
        let flow = line.straight(1)?;
        let weights = Weights::new(self.techniques, highest, false);
        let nulls = along(&weights.contour, line);
        let nothing = || vec![vec![0.0; nulls.len()]; monomials.len()];
        let mut next: Vec<Futures> = (0..=self.count).map(|_| nothing()).collect();
        let mut entering = vec![0.0; monomials.len()];
        for order in (0..self.count).rev() {
            let mut here = Vec::with_capacity(order + 1);
            for turned in 0..=order {
                let is_forward = turned.is_multiple_of(2);
                let state = self.state(order - turned, turned);
                // A particle that keeps its direction turns no more often; plus is the forward direction.
                let [plus, minus] =
                    if is_forward { [turned, turned + 1] } else { [turned + 1, turned] };
                let (plus, minus) = (&next[plus], &next[minus]);
                let mut sources = nothing();
                for (i, nulls) in nulls.iter().enumerate().filter(|_| state.albedo > 0.0) {
                    let vertex = weights.vertex(state.towards, nulls, 0.0);
                    let futures: Vec<f64> = monomials
                        .iter()
                        .enumerate()
                        .map(|(m, monomial)| {
                            let hit = state.product(monomial.channels, monomial.powers)
                                * vertex.hit[monomial.total()];
                            let onward = state.towards * (hit + plus[m][i]);
                            onward + (1.0 - state.towards) * minus[m][i]
                        })
                        .collect();
                    for (m, monomial) in monomials.iter().enumerate() {
                        sources[m][i] = state.scattered(&vertex, *monomial, &terms[m], &futures);
                    }
                }
                let way = usize::from(!is_forward);
                let solved = sources.iter().map(|source| {
                    let scattered = |i: usize, node: &RodPoint| {
                        let mut both = [0.0; 2];
                        both[way] =
                            node.sampling * (1.0 - node.means[0]) * state.albedo * source[i];
                        both
                    };
                    let worth = flow.solve(&scattered, [0.0; 2]);
                    let at_nodes = (0..nulls.len()).map(|i| worth.at(i)[way]).collect();
                    (at_nodes, worth.entering)
                });
                let (worth, begins): (Futures, Vec<f64>) = solved.unzip();
                if order == 0 {
                    entering = begins;
                }
                here.push(worth);
            }
            next = here;
        }
        Some(entering)
    }
}

impl Monomial {
    fn of_one(channel: usize, power: usize) -> Self {
        Self { channels: [channel, channel], powers: [power, 0] }
    }

    fn total(self) -> usize {
        self.powers[0] + self.powers[1]
    }
}

impl OrderCounts {
    /// `Π c_λ^{k_λ}`.
    #[inline]
    fn product(&self, channels: [usize; 2], powers: [usize; 2]) -> f64 {
        self.coefficients[channels[0]][powers[0]] * self.coefficients[channels[1]][powers[1]]
    }

    /// `E[Π (c_λ G + F_λ)^{k_λ}]`.
    fn scattered(
        &self,
        vertex: &Vertex,
        monomial: Monomial,
        terms: &[Term],
        futures: &[f64],
    ) -> f64 {
        let of = |term: &Term| {
            let shadow = vertex.connected[term.powers[0] + term.powers[1]];
            let own = term.binomials * self.product(monomial.channels, term.powers) * shadow;
            own * term.rest.map_or(1.0, |rest| futures[rest])
        };
        terms.iter().map(of).sum()
    }
}

/// Powers of each channel, and mixed ones of each and the next, with the terms of their binomials.
fn monomials(channels: usize, highest: usize) -> (Vec<Monomial>, Vec<Vec<Term>>) {
    let mut result: Vec<Monomial> = (0..channels)
        .flat_map(|channel| (1..=highest).map(move |k| Monomial::of_one(channel, k)))
        .collect();
    for channel in 1..channels {
        result.extend(PAIRS.map(|powers| Monomial { channels: [channel - 1, channel], powers }));
    }
    let place = |channels: [usize; 2], powers: [usize; 2]| {
        let monomial = match powers {
            [0, 0] => return None,
            [0, k] => Monomial::of_one(channels[1], k),
            [k, 0] => Monomial::of_one(channels[0], k),
            _ => Monomial { channels, powers },
        };
        result.iter().position(|known| *known == monomial)
    };
    let terms_of = |monomial: &Monomial| {
        let [p, q] = monomial.powers;
        let mut terms = Vec::new();
        for i in 0..=p {
            for j in 0..=q {
                let binomials = binomial(p, i) * binomial(q, j);
                let rest = place(monomial.channels, [p - i, q - j]);
                terms.push(Term { binomials, powers: [i, j], rest });
            }
        }
        terms
    };
    let terms = result.iter().map(terms_of).collect();
    (result, terms)
}
