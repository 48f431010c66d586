//! Radiance along a ray through a ball of isotropic scattering, or mean intensity at a point in it.
//!
//! ```text
//! a particle sets out at the eye, against the light; where it meets the light, or is connected to it at a
//! scattering, it has found light of radiance 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume` | a ball in which σ_t depends on the distance from its centre: `radial`, or `constant` or `gaussian` with `bounds.sphere` about the same centre | required |
//! | `ray = { origin, direction }` | where it begins and where it looks; a `length` does not count | required |
//! | `sought` | `"radiance"` along the ray, or `"mean-intensity"` at its origin, of all directions alike | `"radiance"` |
//! | `albedo` | a in [0, 1], the same everywhere | required unless swept |
//! | `phase.isotropic = {}` | the only phase function that theory solves here | required |
//! | `light.environment = {}` | radiance 1 from all sides | one of |
//! | `light.black-sphere = { radius }` | a black sphere at the centre: it shines with radiance 1 and absorbs what meets it | these three |
//! | `light.distant = { direction }` | a light in one direction, of the fluence of that environment, 4π | is required |
//! | `sampling` | σ̂ in space of every estimator without its own: `constant`, or `local-majorants` with a `grid` | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! The mean intensity in an environment is the probability to escape from that point, in any direction:
//! `sought = "mean-intensity"` with `light.environment` asks for escape probabilities.
//!
//! A distant light is not radially symmetric. At the centre it has the effect of an environment of the same
//! fluence; elsewhere theory has no answer. It needs `sought = "mean-intensity"` and a ray that begins at
//! the centre. A point light is refused: next-event estimation scores `1/r²` at a scattering at distance r
//! from it, and the square of that score has no finite mean once light is scattered twice. Its single
//! scattering has a problem of its own, `single-scattering`.
//!
//! The answer comes from Peierls' integral equation, to five digits and mostly more; its error is stated. Pictures ask
//! for multiple scattering in any volume under any sky, and draw their references: `picture.multiple-scattering`.
//!
//! Source: R. Peierls, *Critical conditions in neutron multiplication*, Mathematical Proceedings of the
//! Cambridge Philosophical Society 35 (1939).
//!
//! ```toml
//! title = "An example of ball"
//!
//! [problem.ball]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0.2, 0, -2], direction = [0, 0, 1] }
//! albedo = 0.8
//! phase = "isotropic"
//! light.black-sphere.radius = 0.5
//! sampling = 1.6
//! estimators = [{ particle.rule = "weighted" }, { next-event.rule = "weighted" }, "bidirectional"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::slice;

use super::{Problem, Scene, Sky};
use media::body::RayNeed;
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use media::{Body, Medium};
use numeric::geometry::{Bounds, Point, Ray};

/// Light of a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BallLight {
    /// Light from all sides.
    Environment,
    /// Light from a black sphere of the given radius at the centre.
    BlackSphere(f64),
    /// Light from one direction: a unit vector towards the light.
    Distant(Point),
}

/// Quantity that is sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sought {
    /// Radiance along the ray.
    Radiance,
    /// Radiance at the origin of the ray, on average over all directions.
    MeanIntensity,
}

/// A ball with a light and an eye.
#[derive(Clone)]
pub struct Sphere {
    /// The medium in space.
    pub scene: Scene,
    ray: Ray,
    medium: Medium,
    /// The centre of the ball.
    pub centre: Point,
    /// R.
    pub radius: f64,
    /// Light.
    pub light: BallLight,
    /// Quantity that is sought.
    pub sought: Sought,
}

impl Sphere {
    /// σ_t as a function of the squared distance from the centre.
    pub fn extinction(&self, r2: f64) -> f64 {
        self.scene.volume.extinction_at(self.centre + Point([r2.sqrt(), 0.0, 0.0]))
    }

    /// A bound on σ_t.
    pub fn majorant(&self) -> f64 {
        let within = self.scene.volume.bounds().enclosing_box();
        within.map_or(f64::INFINITY, |within| self.scene.volume.majorant(&within))
    }

    /// Distance of the line of the ray from the centre.
    pub fn offset(&self) -> f64 {
        self.ray.nearest_to(self.centre).1.norm()
    }

    /// Distance from the point of the ray that is nearest to the centre to the beginning of the ray.
    pub fn begins(&self) -> f64 {
        (self.ray.origin - self.centre).dot(self.ray.direction)
    }

    /// Distance of the ray's origin from the centre.
    pub fn distance(&self) -> f64 {
        (self.ray.origin - self.centre).norm()
    }

    /// Point where the ray enters the ball, or begins within it.
    pub fn entry(&self) -> Point {
        let ray = Ray { length: f64::INFINITY, ..self.ray };
        ray.at(self.scene.volume.bounds().clip(&ray).from)
    }

    /// The direction of the ray.
    pub fn direction(&self) -> Point {
        self.ray.direction
    }

    /// Mistakes of the settings, or of questions without an answer: the key, what is wrong, and the cure.
    fn mistakes(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut actual = Vec::new();
        if self.scene.phase != Phase::Isotropic(Isotropic) {
            let label = self.scene.phase.label();
            let wrong = format!("theory has no answer for `{label}`");
            actual.push(("phase", wrong, "write `phase.isotropic = {}`"));
        }
        if self.scene.albedo.even().is_none() {
            actual.push(("albedo", "the albedo varies".into(), "theory takes one number here"));
        }
        let core = if let BallLight::BlackSphere(core) = self.light { core } else { 0.0 };
        if core >= self.radius {
            let wrong = format!("its radius is {core}, that of the ball {}", self.radius);
            actual.push(("light", wrong, "the black sphere is inside the ball"));
        }
        let away = self.distance();
        let ray = Ray { length: f64::INFINITY, ..self.ray };
        if core > 0.0 && away <= core {
            let wrong = "it begins in the black sphere".into();
            actual.push(("ray", wrong, "move its origin outwards"));
        }
        if self.sought == Sought::Radiance && self.scene.volume.bounds().clip(&ray).is_empty() {
            actual.push(("ray", "it misses the ball".into(), "the medium must be on its way"));
        }
        if self.sought == Sought::MeanIntensity && away > self.radius {
            let wrong = format!("it begins {away} from the centre of a ball of {}", self.radius);
            actual.push(("ray", wrong, "the point is in the ball"));
        }
        let is_central = self.sought == Sought::MeanIntensity && away <= 1e-12 * self.radius;
        if matches!(self.light, BallLight::Distant(_)) && !is_central {
            let help = "theory knows it at the centre: begin the ray there, and write \
                        `sought = \"mean-intensity\"`";
            actual.push(("light", "a distant light is not radially symmetric".into(), help));
        }
        actual
    }
}

fn read_light(settings: &Settings) -> Option<BallLight> {
    let names = ["environment", "black-sphere", "distant"].map(str::to_owned);
    let explain = |name: &str| {
        let actual = "next-event estimation of a point light in a medium that scatters more than \
                     once has an infinite variance";
        let help = "take `black-sphere`, or the problem `single-scattering`";
        (name == "point").then(|| [actual, help].map(str::to_owned))
    };
    let (index, light) = settings.chosen_explained("light", &names, &explain)?;
    let read = match index {
        0 => Some(BallLight::Environment),
        1 => light.number("radius", Domain::Positive).map(BallLight::BlackSphere),
        _ => light.triple("direction").and_then(|direction| {
            let actual = Point(direction).normalised().map(BallLight::Distant);
            if actual.is_none() {
                light.fault("direction", "the direction is the zero vector", "point at the light");
            }
            actual
        }),
    };
    light.close();
    read
}

impl Problem for Sphere {
    type Value = [f64; 1];
    const RAY: RayNeed = RayNeed::Line;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let scene = Scene::bounded(body, settings);
        let light = read_light(settings);
        let words = ["radiance", "mean-intensity"];
        let sought = settings.word_or("sought", &words, "radiance");
        let (scene, light, sought) = (scene?, light?, sought?);
        let Body::Volume { ray, .. } = body? else { return None };
        let Bounds::Sphere { centre, radius } = scene.volume.bounds() else {
            return not_radial(settings);
        };
        if !scene.volume.facts().is_radial {
            return not_radial(settings);
        }
        let sought = if sought == words[0] { Sought::Radiance } else { Sought::MeanIntensity };
        let medium = body?.medium();
        let sphere = Self { scene, ray: *ray, medium, centre, radius, light, sought };
        let mistakes = sphere.mistakes();
        for (key, wrong, help) in &mistakes {
            settings.fault(key, wrong, *help);
        }
        mistakes.is_empty().then_some(sphere)
    }

    super::in_space!();
}

fn not_radial<T>(settings: &Settings) -> Option<T> {
    let help = "take `radial`, or `constant` or `gaussian` with `bounds.sphere` about its centre, \
                the blob no narrower than 0.15 radii";
    settings.fault(
        "volume",
        "theory takes a ball whose σ_t depends on the distance from its centre",
        help,
    );
    None
}

/// The radiance along a ray through any medium that scatters the light of a sky: a pixel of a picture.
///
/// ```text
/// L(o, d) = T L_sky(d) + ∫ T(s) σ_t a ∫ p(cos θ) L(p(s), d') dω' ds
/// L = E[Σ w L_sky(d')]  over all particles that leave in a direction d'
/// ```
///
/// There is no closed form but in a furnace (a = 1 under a constant sky of radiance 1: L = 1): pictures ask for it, and
/// draw their references.
///
/// Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light Transport Estimators for
/// Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017), Eq. 1, section 4.1.
pub struct MultipleScattering {
    /// The medium in space.
    pub scene: Scene,
    /// The light from around it.
    pub sky: Sky,
    ray: Ray,
    medium: Medium,
}

impl MultipleScattering {
    /// Along a ray.
    pub fn new(scene: Scene, sky: Sky, ray: Ray) -> Self {
        let support = scene.volume.bounds().clip(&ray);
        let profile = scene.volume.along(&ray, support);
        let medium = Medium::new(profile, ray.span(), support);
        Self { scene, sky, ray, medium }
    }

    /// Point where the ray enters the bounds, and its direction; `None` if it misses them.
    pub fn entry(&self) -> Option<[Point; 2]> {
        let inside = self.medium.support();
        (!inside.is_empty()).then(|| [self.ray.at(inside.from), self.ray.direction])
    }

    /// The radiance of the sky behind the volume.
    pub fn background(&self) -> f64 {
        self.sky.radiance(self.ray.direction)
    }
}

impl Problem for MultipleScattering {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (scene, sky) = (Scene::bounded(body, settings), Sky::read(settings));
        let Body::Volume { ray, .. } = body? else { return None };
        Some(Self::new(scene?, sky?, *ray))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::catalogue::Value;
    use media::catalogue::fixture::{list, read, table};

    fn light<const N: usize>(
        name: &str,
        settings: [(&str, Value); N],
    ) -> (Option<BallLight>, Vec<String>) {
        read([("light", table([(name, table(settings))]))], read_light)
    }

    #[test]
    fn light_comes_from_all_sides_from_the_middle_or_from_afar() {
        assert_eq!(light("environment", []), (Some(BallLight::Environment), vec![]));
        let radius = ("radius", Value::Number(0.25));
        assert_eq!(light("black-sphere", [radius]), (Some(BallLight::BlackSphere(0.25)), vec![]));
        let far = light("distant", [("direction", list(&[0.0, 0.0, 4.0]))]).0;
        assert_eq!(far, Some(BallLight::Distant(Point([0.0, 0.0, 1.0]))));
    }

    #[test]
    fn lights_without_size_direction_or_variance_are_refused() {
        let nothing = light("black-sphere", [("radius", Value::Number(0.0))]);
        assert_eq!(nothing, (None, vec!["`radius` is 0".to_owned()]));
        let nowhere = light("distant", [("direction", list(&[0.0; 3]))]);
        assert_eq!(nowhere, (None, vec!["the direction is the zero vector".to_owned()]));
        let (point, faults) = light("point", [("position", list(&[0.0; 3]))]);
        assert!(point.is_none() && faults[0].contains("infinite variance"), "{faults:?}");
    }
}
