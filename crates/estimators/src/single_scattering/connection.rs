//! The two transmittances of a scattering point: from the ray's origin, and from the light.
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `camera` | `"exact"`, `"ratio"` (residual ratio where there is a control) or `"delta"`, through σ̂ | `"exact"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, each one number | `"exact"` |
//!
//! The exact ones evaluate optical depths, never σ_t: no lookups. They are theory, which uses the
//! platform's library: the last bits of draws with one may differ between machines.
//!
//! A shadow ray is clipped to the bounds of the volume and walked from the scattering point. Where
//! σ_t = 0 there is nothing to light, and where it misses the bounds nothing in the way: neither
//! costs a lookup. Where delta tracking ended on the way to the point none is cast; one is where a tracked weight has
//! become 0, whose chance depends on the rounding of σ̂ and σ_t.

use super::main_part::MainPart;
use super::technique::{Kind, point};
use crate::{Draw, Inputs, Refusal, Setup};
use media::catalogue::{Domain, Settings};
use media::{Extinction, Lookups, Volume};
use numeric::digits::{number, rounded};
use numeric::geometry::Ray;
use numeric::pack::in_fused_code;
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::problems::{Problem, SingleScattering};
use theory::single::{Camera, CameraTracking, Scene, Tracking};

/// How both transmittances are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Connection {
    /// That from the ray's origin.
    pub camera: CameraTracking,
    /// That of the shadow ray.
    pub shadow: Tracking,
}

/// Reads `shadow`.
pub fn read_shadow(settings: &Settings) -> Option<Tracking> {
    if !settings.has("shadow") {
        return Some(Tracking::Exact);
    }
    let names = ["exact", "ratio", "delta"].map(str::to_owned);
    let (index, tracking) = settings.chosen("shadow", &names)?;
    let read = match index {
        0 => Some(Tracking::Exact),
        1 => {
            let sampling = tracking.number("sampling", Domain::Positive);
            let control = tracking.number_or("control", Domain::NonNegative, 0.0);
            sampling.zip(control).map(|(sampling, control)| Tracking::Ratio { sampling, control })
        }
        _ => tracking
            .number("sampling", Domain::Positive)
            .map(|sampling| Tracking::Delta { sampling }),
    };
    tracking.close();
    read
}

/// A shadow in words.
pub fn shadow_label(shadow: Tracking) -> String {
    match shadow {
        Tracking::Exact => "exact shadow".into(),
        Tracking::Ratio { sampling, control: 0.0 } => format!("ratio shadow {sampling}"),
        Tracking::Ratio { sampling, control } => {
            format!("residual ratio shadow {sampling}, {control}")
        }
        Tracking::Delta { sampling } => format!("delta shadow {sampling}"),
    }
}

/// Knowledge that exact shadow rays need.
pub fn shadow_needs(shadow: Tracking) -> Option<&'static str> {
    (shadow == Tracking::Exact).then_some("τ")
}

/// Delta tracking needs a majorant on every shadow ray, and walks along them must end.
///
/// # Errors
///
/// The bound on σ_t that it does not reach, or how many collisions there would be.
pub fn require_shadow(setup: &Setup<SingleScattering>, shadow: Tracking) -> Result<(), Refusal> {
    if let Tracking::Ratio { sampling, .. } | Tracking::Delta { sampling } = shadow {
        let collisions = sampling * setup.mesh.support().length();
        if collisions.is_nan() || collisions > 1e6 {
            let needs = "a shadow's σ̂ of at most 1e6 collisions on the ray's length";
            return Err(Refusal::mismatch(needs, format!("there would be {collisions:e}")));
        }
    }
    let Tracking::Delta { sampling } = shadow else { return Ok(()) };
    let bound = setup.problem.shadow_majorant();
    if sampling >= bound * (1.0 - 1e-12) {
        return Ok(());
    }
    let needs = "σ̄ ≥ σ_t on every shadow ray";
    Err(Refusal::mismatch(
        needs,
        format!("σ̄ = {} and σ_t is bounded by {} only", number(sampling), rounded(bound)),
    ))
}

impl Connection {
    /// Reads `camera`, one of the words, and `shadow`.
    pub fn read(settings: &Settings, words: &[&'static str]) -> Option<Self> {
        let camera = settings.word_or("camera", words, "exact").map(|word| match word {
            "ratio" => CameraTracking::Ratio,
            "delta" => CameraTracking::Delta,
            _ => CameraTracking::Exact,
        });
        let shadow = read_shadow(settings);
        Some(Self { camera: camera?, shadow: shadow? })
    }

    /// In words, as in `ratio camera, delta shadow 1.2`.
    pub fn label(&self) -> String {
        let camera = match self.camera {
            CameraTracking::Exact => "exact camera",
            CameraTracking::Ratio => "ratio camera",
            CameraTracking::Delta => "delta camera",
        };
        format!("{camera}, {}", shadow_label(self.shadow))
    }

    /// Knowledge that exact transmittances need.
    pub fn needs(&self) -> Option<&'static str> {
        let is_exact = self.camera == CameraTracking::Exact;
        is_exact.then_some("τ").or(shadow_needs(self.shadow))
    }

    /// The packets of points from the light, from the main part of the control, or from both.
    #[must_use]
    pub fn kind(&self, from_source: bool, from_main: bool) -> (Kind, Tracking) {
        (Kind::Points { camera: self.camera, from_source, from_main }, self.shadow)
    }

    /// What the walk from the ray's origin takes.
    pub fn inputs(&self) -> Inputs {
        match self.camera {
            CameraTracking::Exact => Inputs::NONE,
            CameraTracking::Ratio => Inputs::BOTH,
            CameraTracking::Delta => Inputs::SAMPLING,
        }
    }

    /// Whether both are unbiased.
    ///
    /// # Errors
    ///
    /// The violated inequality.
    pub fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        match self.camera {
            CameraTracking::Exact => {}
            CameraTracking::Ratio => setup.require_coverage()?,
            CameraTracking::Delta => setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?,
        }
        require_shadow(setup, self.shadow)
    }

    /// For theory, with more kinks of what is integrated.
    pub fn scene<'a>(&self, setup: &'a Setup<SingleScattering>, cuts: Vec<f64>) -> Scene<'a> {
        let camera = Camera::new(&setup.mesh, &setup.sampling, &setup.control, self.camera);
        Scene::new(&setup.problem, camera, self.shadow, cuts)
    }

    /// A draw of points from the light, from the main part of the control, or of one from each:
    /// `Σ T̂ σ_t S T̂_shadow/Σp`.
    #[inline(always)]
    pub fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        [from_source, from_main]: [bool; 2],
        rng: &mut Stream,
    ) -> Draw {
        let (problem, main) = (&*setup.problem, MainPart::of(setup).filter(|_| from_main));
        let is_both = from_source && main.is_some();
        let mut draw = Draw::free([0.0], 0);
        for is_source in [true, false] {
            let is_asked = if is_source { from_source } else { main.is_some() };
            if !is_asked {
                continue;
            }
            let u = rng.uniform();
            let s = match main {
                Some(main) if !is_source => main.point(u),
                _ => point(problem, u),
            };
            let density = match main {
                Some(main) if is_both => problem.equiangular_density(s) + main.density(s),
                Some(main) if !is_source => main.density(s),
                _ => problem.equiangular_density(s),
            };
            let (radiance, lookups) = self.scatter(setup, medium, s, rng);
            let value = radiance / density;
            // The one point's value is the draw's, its sign included where it is 0.
            draw.value[0] = if is_both { draw.value[0] + value } else { value };
            draw.lookups += lookups;
        }
        draw
    }

    /// `T̂ σ_t S T̂_shadow` at a point, and what it cost.
    #[inline(always)]
    pub fn scatter(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        s: f64,
        rng: &mut Stream,
    ) -> (f64, u32) {
        let extinction = medium.extinction(s);
        if extinction <= 0.0 {
            return (0.0, 1);
        }
        let (transmittance, walked) = camera(setup, medium, self.camera, s, rng);
        if self.camera == CameraTracking::Delta && transmittance == 0.0 {
            return (0.0, 1 + walked);
        }
        let (lit, cast) = shadow(&setup.problem, self.shadow, s, rng);
        let source = extinction * setup.problem.source(s);
        (transmittance * source * lit, 1 + walked + cast)
    }
}

/// The transmittance from the ray's origin, and its lookups.
#[inline(always)]
pub fn camera(
    setup: &Setup<SingleScattering>,
    medium: &Lookups,
    along: CameraTracking,
    to: f64,
    rng: &mut Stream,
) -> (f64, u32) {
    let ray = setup.problem.medium();
    let before = Span::new(ray.support().from, to);
    if along == CameraTracking::Exact {
        return (Lane::exp(-ray.optical_depth(before).value), 0);
    }
    let is_delta = along == CameraTracking::Delta;
    let mut weight =
        if is_delta { 1.0 } else { Lane::exp(-setup.control.optical_depth(before).value) };
    let mut cursor = setup.sampling.begin();
    let mut lookups = 0;
    loop {
        let flown = setup.sampling.fly(&mut cursor, -rng.ln_uniform());
        let Some(sampling) = flown.filter(|_| cursor.t < to) else { break };
        lookups += 1;
        let extinction = medium.extinction(cursor.t);
        if is_delta {
            if rng.uniform() * sampling < extinction {
                return (0.0, lookups);
            }
        } else {
            weight *= 1.0 - (extinction - setup.control.extinction(cursor.t)) / sampling;
        }
    }
    (weight, lookups)
}

/// The transmittance of the shadow ray of a point, and its lookups.
pub fn shadow(
    problem: &SingleScattering,
    tracking: Tracking,
    s: f64,
    rng: &mut Stream,
) -> (f64, u32) {
    let Some((ray, inside)) = problem.shadow(s) else { return (1.0, 0) };
    transmittance(problem.volume(), &ray, inside, tracking, rng)
}

/// The transmittance of a stretch of a ray within the bounds of a volume, in closed form.
pub fn exact(volume: &Volume, ray: &Ray, inside: Span) -> f64 {
    Lane::exp(-volume.along(ray, inside).optical_depth(inside).value)
}

/// The transmittance of a stretch of a ray within the bounds of a volume, and its lookups.
pub fn transmittance(
    volume: &Volume,
    ray: &Ray,
    inside: Span,
    tracking: Tracking,
    rng: &mut Stream,
) -> (f64, u32) {
    let (sampling, control) = match tracking {
        Tracking::Exact => return (exact(volume, ray, inside), 0),
        Tracking::Ratio { sampling, control } => (sampling, Some(control)),
        Tracking::Delta { sampling } => (sampling, None),
    };
    in_fused_code(
        #[inline(always)]
        || {
            let path = 1.0 / sampling;
            let mut weight = Lane::exp(-control.unwrap_or(0.0) * inside.length());
            let mut t = inside.from;
            let mut lookups = 0;
            loop {
                t -= rng.ln_uniform() * path;
                if t >= inside.to {
                    return (weight, lookups);
                }
                lookups += 1;
                let extinction = volume.extinction_at(ray.at(t));
                match control {
                    Some(control) => weight *= 1.0 - (extinction - control) * path,
                    None if rng.uniform() * sampling < extinction => return (0.0, lookups),
                    None => {}
                }
            }
        },
    )
}
