//! Wrong ways to share what a point from the light and delta tracking find.
//!
//! ```text
//! p = D/(Δθ r²),  q = a σ_t Π (1 − σ_t/σ̂),   X = Σ f(sᵢ) w_i/p_i,   w_i = p_i^β/(p^β + q^β)
//! ```

use super::target::{SINGLE_NULL_PATHS, SINGLE_ONE_SAMPLE, SINGLE_POWER};
use super::{About, Mutant, with};
use estimators::single_scattering::connection::{camera, shadow};
use estimators::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::Heuristic;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Tracking};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SingleScattering>> {
    let both = Mis { bug: Bug::None, is_one: false, heuristic: Heuristic::Balance };
    let one = Mis { is_one: true, ..both };
    let power = Mis { heuristic: Heuristic::Power, ..both };
    let of = |name, text, target, check, twin: Mis, bug| {
        let about = About { name, bug: text, target, check };
        let draws = |mis: Mis| with(mis, |mis, setup, medium, rng| mis.draw(setup, medium, rng));
        Mutant::new(about, draws(Mis { bug, ..twin }), draws(twin))
    };
    vec![
        of("null-paths-nulls-left-out", "the density of delta tracking leaves out its null collisions where it was sampled", SINGLE_NULL_PATHS, "mean", both, Bug::NullsLeftOut),
        of("null-paths-by-transmittance", "weights take transmittances for null collisions: unbiased, but another estimator", SINGLE_NULL_PATHS, "variance", both, Bug::ByTransmittance),
        of("null-paths-nothing-scattered", "a point from the light is worth what it is without σ_t there: no event was sampled", SINGLE_NULL_PATHS, "mean", both, Bug::NothingScattered),
        of("null-paths-wrong-end", "the angles of the ray's ends are measured from the wrong one", SINGLE_NULL_PATHS, "mean", both, Bug::WrongEnd),
        of("null-paths-averaged", "both techniques are sampled and added, and their average is taken", SINGLE_NULL_PATHS, "mean", both, Bug::Averaged),
        of("null-paths-shadow-twice", "the shadow ray's transmittance is a weight twice", SINGLE_NULL_PATHS, "mean", both, Bug::ShadowTwice),
        of("null-paths-albedo-twice", "the albedo is the chance to scatter and a factor of what is scattered", SINGLE_NULL_PATHS, "mean", both, Bug::AlbedoTwice),
        of("null-paths-absorbed-go-on", "a walk that is absorbed goes on as after a null collision", SINGLE_NULL_PATHS, "mean", both, Bug::AbsorbedGoOn),
        of("null-paths-scattering-is-null", "the scattering multiplies its own 1 − σ_t/σ̂ to those of the null collisions", SINGLE_NULL_PATHS, "mean", both, Bug::ScatteringIsNull),
        of("null-paths-one-not-doubled", "one technique is chosen and not divided by its chance", SINGLE_ONE_SAMPLE, "mean", one, Bug::Averaged),
        of("null-paths-squared-weights", "the power heuristic squares weights that sum to 1", SINGLE_POWER, "mean", power, Bug::SquaredWeights),
    ]
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    NullsLeftOut,
    ByTransmittance,
    NothingScattered,
    WrongEnd,
    Averaged,
    ShadowTwice,
    AlbedoTwice,
    AbsorbedGoOn,
    ScatteringIsNull,
    SquaredWeights,
}

/// Shadow rays of all targets.
const SHADOW: Tracking = Tracking::Ratio { sampling: 1.5, control: 0.0 };

/// Null-scattering paths with analog absorption, see `estimators/single_scattering/source_delta_mis.rs`.
#[derive(Clone, Copy)]
struct Mis {
    bug: Bug,
    is_one: bool,
    heuristic: Heuristic,
}

/// A scattering: where, σ_t there, and the product over null collisions before it.
type Scattering = [f64; 3];

impl Mis {
    fn draw(self, setup: &Setup<SingleScattering>, medium: &Lookups, rng: &mut Stream) -> Draw {
        let problem = &setup.problem;
        let mut draw = Draw::free([0.0], 0);
        let from_light = !self.is_one || rng.uniform() < 0.5;
        if from_light {
            let angle = rng.uniform() * problem.angles().length() + problem.angles().from;
            let angle = if self.bug == Bug::WrongEnd { -angle } else { angle };
            let s = problem.at_angle(angle);
            let extinction = medium.extinction(s);
            draw.lookups += 1;
            if extinction > 0.0 {
                let (kept, walked) = camera(setup, medium, CameraTracking::Ratio, s, rng);
                draw.lookups += walked;
                self.add(setup, [s, extinction, kept], true, rng, &mut draw);
            }
        }
        if !(self.is_one && from_light) {
            let (scattering, lookups) = self.collide(setup, medium, rng);
            draw.lookups += lookups;
            if let Some(scattering) = scattering {
                self.add(setup, scattering, false, rng, &mut draw);
            }
        }
        draw
    }

    fn collide(
        self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> (Option<Scattering>, u32) {
        let mut cursor = setup.sampling.begin();
        let (mut nulls, mut lookups) = (1.0, 0);
        loop {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else {
                return (None, lookups);
            };
            lookups += 1;
            let extinction = medium.extinction(cursor.t);
            let null = 1.0 - extinction / sampling;
            if number * sampling < extinction * setup.problem.albedo() {
                let is_null = self.bug == Bug::ScatteringIsNull;
                let nulls = if is_null { nulls * null } else { nulls };
                return (Some([cursor.t, extinction, nulls]), lookups);
            }
            if number * sampling < extinction && self.bug != Bug::AbsorbedGoOn {
                return (None, lookups);
            }
            nulls *= null;
        }
    }

    fn add(
        self,
        setup: &Setup<SingleScattering>,
        [s, extinction, kept]: Scattering,
        from_light: bool,
        rng: &mut Stream,
        draw: &mut Draw,
    ) {
        let problem = &setup.problem;
        let scatters = problem.albedo();
        let (lit, cast) = shadow(problem, SHADOW, s, rng);
        let lit = if self.bug == Bug::ShadowTwice { lit * lit } else { lit };
        draw.lookups += cast;
        let known = match self.bug {
            Bug::NullsLeftOut if !from_light => 1.0,
            Bug::ByTransmittance => {
                let before = Span::new(problem.medium().support().from, s);
                Lane::exp(-problem.medium().optical_depth(before).value)
            }
            _ => kept,
        };
        // What delta tracking finds is divided by its own density: of f/q × weight only the weight is left.
        let (collision, point) = (extinction * scatters * known, problem.equiangular_density(s));
        let found = if from_light { extinction * scatters * kept } else { collision };
        let (own, other) = if from_light { (point, collision) } else { (collision, point) };
        let density = match self.bug {
            Bug::SquaredWeights => (own + other) * (own + other) / own,
            _ => self.heuristic.shared(own, other),
        };
        let source = match self.bug {
            Bug::AlbedoTwice => problem.source(s),
            _ => problem.source(s) / scatters,
        };
        let found = if self.bug == Bug::NothingScattered && from_light {
            found / extinction
        } else {
            found
        };
        let times = match (self.is_one, self.bug) {
            (true, Bug::Averaged) => 1.0,
            (true, _) => 2.0,
            (false, Bug::Averaged) => 0.5,
            (false, _) => 1.0,
        };
        draw.value[0] += times * (found * source * lit / density);
    }
}
