//! A bound on the second moment of walks that scatter many times, where draws are relative to the density of one walker.
//!
//! Take A, N and S of [`Rates`], `α = A − N` and `Φ = ∫ p_λ²/p_h dω`. The second moment of the score that is still
//! to come has a maximum M over all places and directions. Where flights within the body are at most ℓ long,
//! ```text
//! M ≤ max over flights of e + (A_b + S Φ M) f,   e = e^{−αℓ},  f = (1 − e)/α
//! M ≤ max(1, (e + A_b f)/(1 − S Φ f)),  where S Φ f < 1
//! ```
//!
//! where leaving scores 1, and absorption, of the rate `A_b` in the second moment, scores 1 too, or nothing. Where
//! directions after a scattering are isotropic, e is a mean over them. Where α varies, S/α and `A_b/α` stand for S
//! and `A_b`, and `1 − e` for f. Where `S Φ f ≥ 1` the variance may be infinite or finite.
//!
//! Where extinctions lie in intervals, α and S are largest with the channel's own extinction at its upper end and those
//! of the others at their lower ends. α is smallest at the opposite ends. With `n = μ̄ − σ_t` and `r = σ_t/μ̄`,
//!
//! ```text
//! hero h     α = 2μ̄_λ − μ̄_h − n_λ²/n_h,  S = (a_λ σ_λ)²/(a_h σ_h):  both rise with σ_λ and fall with σ_h
//! average    ∂α/∂r_λ = μ̄ (1 − r_λ) (2 − (1 − r_λ)/Σ(1 − r))/P_n > 0,  S likewise;  P_n falls and P_s rises with each r
//! maximum    N = μ̄ (1 − r_λ)² (1 + (P_s + P_a)/P_n) falls with r_λ and rises with the others
//!            S = μ̄ (a_λ r_λ)² (1 + (P_n + P_a)/P_s) rises with r_λ;  P_n and 1/P_s, not P_a, fall with the others
//! ```
//!
//! By the maximum S is therefore at most that value times the largest ratio of both ends of another channel's interval.
//!
//! Source: derived; the equation of the second moment is that of J. Spanier, E. M. Gelbard, *Monte Carlo Principles and
//! Neutron Transport Problems* (1969).

use super::Chance;
use super::rates::{Proposal, Rates};
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::quadrature::GaussLegendre;
use numeric::{Span, order};

/// Number of halvings of the panels of the integral over directions, towards straight on and straight back.
const HALVINGS: i32 = 48;
/// Maximum error of a phase function's total where these panels resolve it.
const RESOLVED: f64 = 1e-11;
/// Maximum change of second moments, as a share of σ̂, that is rounding.
pub const NOTHING: f64 = 1e-12;
/// Margin of bounds beyond rounding.
const SLACK: f64 = 1e-9;

/// The rates of the second moment of a channel.
#[derive(Debug, Clone, Copy)]
pub struct SecondMomentRates {
    /// `α = A − N`.
    pub lost: f64,
    /// `S Φ`.
    pub scattered: f64,
    /// `A_b`.
    pub absorbed: f64,
}

/// Rates of a channel, given the extinctions of all channels and `Φ`.
pub fn square(
    rates: &Rates,
    walk: Proposal,
    channel: usize,
    extinctions: &[f64],
    phi: f64,
) -> SecondMomentRates {
    let mut k = vec![0; rates.majorants.len()];
    k[channel] = 2;
    let [_, scattered] = rates.gains(walk, &k, extinctions);
    SecondMomentRates {
        lost: rates.lost_by_square(walk, channel, extinctions),
        scattered: scattered * phi,
        absorbed: rates.absorbed(walk, &k, extinctions),
    }
}

/// Lower bound of α, upper bound of α, and upper bound of S Φ, where the extinction of each channel lies in an interval.
pub fn square_within(
    rates: &Rates,
    walk: Proposal,
    channel: usize,
    extinctions: &[Span],
    phi: f64,
) -> [f64; 3] {
    let corner = |own: fn(&Span) -> f64, other: fn(&Span) -> f64| {
        let at = |(i, span): (usize, &Span)| if i == channel { own(span) } else { other(span) };
        let at: Vec<f64> = extinctions.iter().enumerate().map(at).collect();
        square(rates, walk, channel, &at, phi)
    };
    let [low, high] = [corner(|x| x.from, |x| x.to), corner(|x| x.to, |x| x.from)];
    let others = extinctions.iter().enumerate().filter(|&(i, x)| i != channel && x.to > 0.0);
    let growth = match walk {
        Proposal::Together(Chance::Maximum) => {
            others.map(|(_, x)| x.to / x.from).fold(1.0, f64::max)
        }
        _ => 1.0,
    };
    [low.lost, high.lost, if high.scattered == 0.0 { 0.0 } else { high.scattered * growth }]
}

/// Second moments of the ends of a flight: e, and f.
#[derive(Debug, Clone, Copy)]
pub struct FlightMoments {
    /// The second moment e of leaving.
    pub leaves: f64,
    /// The factor f of rates.
    pub collides: f64,
}

impl FlightMoments {
    /// A flight of a length, where α is constant.
    pub fn of(lost: f64, length: f64) -> Self {
        if lost == 0.0 {
            return Self { leaves: 1.0, collides: length };
        }
        let gone = -lost * length;
        Self { leaves: gone.exp(), collides: -gone.exp_m1() / lost }
    }

    /// `e + (A_b + S M) f`.
    fn scores(self, [scattered, absorbed]: [f64; 2], then: f64) -> f64 {
        self.leaves + (absorbed + scattered * then) * self.collides
    }
}

/// M of walks that begin with one flight and go on with others; `None` where no bound is known.
pub fn largest(
    first: FlightMoments,
    then: FlightMoments,
    [scattered, absorbed]: [f64; 2],
) -> Option<f64> {
    let room = 1.0 - scattered * then.collides;
    let of_rates = [scattered, absorbed];
    let after = (then.leaves + absorbed * then.collides) / room;
    let maximum = after.max(1.0);
    let result = first.scores(of_rates, maximum).max(1.0) * (1.0 + SLACK);
    (room > SLACK && result.is_finite()).then_some(result)
}

/// Walk and channel without a bound on `E[X²]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbounded {
    /// Walk that has no bound.
    pub walk: Proposal,
    /// Number of the channel.
    pub channel: usize,
    /// Reason for a missing bound.
    pub reason: Reason,
}

/// Reason why a second moment has no bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reason {
    /// The second moment grows by this factor, 1 or more, from one scattering to the next.
    Grows(f64),
    /// The walk lacks events of the channel, or its weight has no limit.
    Unlimited,
    /// A phase function is too peaked to compute Φ.
    TooPeaked,
}

/// Bounds on `E[X²]` of all channels, mixed over walks with their probabilities. `of` returns the bound of a walk for a
/// channel and its Φ. Its error is the factor, 1 or more, by which the second moment grows from one scattering to the
/// next.
///
/// # Errors
///
/// The first walk and channel that have no bound.
pub fn of_walks(
    walks: &[(f64, Proposal)],
    phases: &[Phase],
    of: impl Fn(Proposal, usize, f64) -> Result<f64, f64>,
) -> Result<Vec<f64>, Unbounded> {
    let mut bounds = vec![0.0; phases.len()];
    for (channel, bound) in bounds.iter_mut().enumerate() {
        for &(weight, walk) in walks {
            let phi = match walk {
                Proposal::Hero(hero) => phi(&phases[channel], &phases[hero]),
                Proposal::Together(_) => 1.0,
            };
            *bound += weight
                * of(walk, channel, phi).map_err(|factor| {
                    let reason = match factor {
                        factor if factor.is_finite() => Reason::Grows(factor),
                        _ if phi.is_finite() => Reason::Unlimited,
                        _ => Reason::TooPeaked,
                    };
                    Unbounded { walk, channel, reason }
                })?;
        }
    }
    Ok(bounds)
}

/// Returns whether directions after a scattering are isotropic in all channels.
pub fn are_isotropic(phases: &[Phase]) -> bool {
    phases.iter().all(|phase| *phase == Phase::Isotropic(Isotropic))
}

/// `Φ = ∫ p_λ²/p_h dω ≥ 1`; infinite where a phase function is too peaked to be resolved.
pub fn phi(own: &Phase, hero: &Phase) -> f64 {
    if own == hero {
        return 1.0;
    }
    let rule = GaussLegendre::new(32);
    let halves = (0..=HALVINGS).map(|k| 0.5f64.powi(k));
    let mut knots: Vec<f64> = halves.flat_map(|half| [half - 1.0, 1.0 - half]).collect();
    knots.extend([-1.0, 1.0]);
    order::ascend(&mut knots);
    let over_directions = |f: &dyn Fn(f64) -> f64| {
        let panels = knots.windows(2).map(|ends| rule.integrate(ends[0], ends[1], f));
        std::f64::consts::TAU * panels.sum::<f64>()
    };
    let is_resolved =
        |phase: &Phase| (over_directions(&|cosine| phase.value(cosine)) - 1.0).abs() < RESOLVED;
    if !is_resolved(own) || !is_resolved(hero) {
        return f64::INFINITY;
    }
    over_directions(&|cosine| own.value(cosine).powi(2) / hero.value(cosine)).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::phase::henyey_greenstein::HenyeyGreenstein;
    use numeric::rng::{Address, unit};

    /// g of a channel and of a hero, and Φ.
    const PEAKED: [(f64, f64, f64); 4] = [
        (0.999, 0.998, 1.518_211_790_224_436),
        (0.99, 0.98, 1.524_101_485_328_942_3),
        (0.98, 0.97, 1.155_975_345_208_080_6),
        (0.9, -0.5, 224.796_962_135_276_35),
    ];

    /// A single channel scores 1 in every draw.
    #[test]
    fn a_channel_by_itself_scores_one() {
        let rates = Rates { majorants: vec![2.0], albedos: vec![0.7] };
        let square = square(&rates, Proposal::Hero(0), 0, &[1.5], 1.0);
        assert!((square.lost - 1.5).abs() < 1e-15 && (square.scattered - 1.05).abs() < 1e-15);
        let flight = FlightMoments::of(square.lost, 3.0);
        let result = largest(flight, flight, [square.scattered, square.absorbed]).expect("a bound");
        assert!((result - 1.0).abs() < 1e-8, "{result}");
    }

    #[test]
    fn a_scatterer_that_gains_too_much_has_no_bound() {
        let rates = Rates { majorants: vec![1.0; 2], albedos: vec![1.0, 0.25] };
        let square = square(&rates, Proposal::Hero(1), 0, &[1.0, 1.0], 1.0);
        // Each scattering multiplies the second moment by 4: a quarter of the flights may collide.
        assert!((square.scattered - 4.0).abs() < 1e-12);
        let at = |length: f64| {
            let flight = FlightMoments::of(square.lost, length);
            largest(flight, flight, [square.scattered, square.absorbed])
        };
        assert!(at(0.28).is_some() && at(0.29).is_none());
    }

    /// Compares with the definition where nothing cancels, and with all digits where the medium is thin.
    #[test]
    fn what_flights_lose_keeps_its_digits() {
        let rates = Rates { majorants: vec![1.5, 1.7], albedos: vec![0.4, 0.9] };
        let common = Rates { majorants: vec![1.5; 2], ..rates.clone() };
        for probability in [Chance::Average, Chance::Maximum] {
            for (rates, walk) in [
                (&rates, Proposal::Hero(0)),
                (&rates, Proposal::Hero(1)),
                (&common, Proposal::Together(probability)),
            ] {
                for channel in 0..2 {
                    let mut k = vec![0; 2];
                    k[channel] = 2;
                    let here = [0.8, 0.3];
                    let exact = rates.loss(walk, &k) - rates.gains(walk, &k, &here)[0];
                    let result = rates.lost_by_square(walk, channel, &here);
                    assert!((result - exact).abs() < 1e-14, "{walk:?}: {result} for {exact}");
                }
            }
        }
        // α ≈ 2σ_λ − σ_h, and 2σ_λ − (σ_λ + σ_h)/2 by the average.
        let thin = [1e-20, 0.8e-20];
        for (walk, exact) in [
            (Proposal::Hero(0), 0.6e-20),
            (Proposal::Hero(1), 0.8e-20),
            (Proposal::Together(Chance::Average), 0.7e-20),
        ] {
            let result = common.lost_by_square(walk, 1, &thin);
            assert!((result / exact - 1.0).abs() < 1e-14, "{walk:?}: {result} for {exact}");
        }
    }

    /// Random points of random boxes of extinctions.
    #[test]
    fn rates_in_a_box_are_within_those_of_its_corners() {
        let mut random = Address { seed: 1, experiment: 2, block: 3, lane: 0 }.pilot();
        let mut uniform = || unit(&mut random);
        for _ in 0..20_000 {
            let [albedos, majorants] = [(); 2].map(|()| [(); 3].map(|()| 0.05 + 0.95 * uniform()));
            let common = uniform() < 0.7;
            let majorants = if common { [majorants[0]; 3] } else { majorants };
            let rates = Rates { majorants: majorants.to_vec(), albedos: albedos.to_vec() };
            let within = majorants.map(|majorant| {
                let ends = [(); 2].map(|()| 0.99 * majorant * uniform());
                Span::new(ends[0].min(ends[1]), ends[0].max(ends[1]))
            });
            let point = within.map(|span| span.from + span.length() * uniform());
            let together = [Chance::Average, Chance::Maximum].map(Proposal::Together);
            let alone = [0, 1, 2].map(Proposal::Hero);
            for walk in alone.into_iter().chain(together.into_iter().filter(|_| common)) {
                let result = square(&rates, walk, 1, &point, 1.3);
                let [minimum, maximum, scattered] = square_within(&rates, walk, 1, &within, 1.3);
                let slack = 1e-12 * (1.0 + result.lost.abs());
                let context = format!("{walk:?}, {rates:?}, {within:?}, {point:?}");
                assert!(
                    minimum <= result.lost + slack && result.lost <= maximum + slack,
                    "{context}"
                );
                assert!(result.scattered <= scattered * (1.0 + 1e-12), "{context}");
            }
        }
    }

    #[test]
    fn a_loss_of_nearly_nothing_collides_all_along() {
        let flight = FlightMoments::of(-1.1e-16, 0.5);
        assert!((flight.collides - 0.5).abs() < 1e-15, "{flight:?}");
    }

    /// Beside an isotropic hero `Φ = Σ (2l + 1) g^{2l} = (1 + g²)/(1 − g²)²`; the others by adaptive quadrature in 30 digits.
    #[test]
    fn directions_are_integrated_however_peaked() {
        let isotropic = Phase::Isotropic(Isotropic);
        let of = |g: f64| Phase::HenyeyGreenstein(HenyeyGreenstein::new(g).expect("|g| < 1"));
        for g in [-0.999f64, -0.5, 0.3, 0.93, 0.99, 0.999] {
            let exact = (1.0 + g * g) / (1.0 - g * g).powi(2);
            let result = phi(&of(g), &isotropic);
            assert!((result / exact - 1.0).abs() < 1e-9, "{g}: {result} for {exact}");
        }
        assert_eq!(phi(&of(0.4), &of(0.4)), 1.0);
        for (own, hero, exact) in PEAKED {
            let result = phi(&of(own), &of(hero));
            assert!((result / exact - 1.0).abs() < 1e-9, "{own}, {hero}: {result} for {exact}");
        }
        assert!(phi(&of(0.999_999_99), &isotropic).is_infinite());
    }
}
