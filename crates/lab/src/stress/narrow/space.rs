//! Walks through a ball, and from a point source in a medium without end.
//!
//! ```text
//! σ_t(p) = τ (1.8 − 3.6 x + 2 x²),  x = |p − c|²/R²,  R = ½,  c = (t₀, t₀, t₀)
//! ```
//!
//! whose optical depth along a diameter is τ. The walk of pictures of multiple scattering is that of
//! `sphere, particle` in front of another sky; `lambertian` with splitting is `furnace` with splitting.
//! A furnace with the non-terminating rule is left out: where σ̂ ≥ σ_t each draw is 1, without noise.

use super::compare::{Estimator, Theory, tracked};
use super::place::Place;
use super::precision::Precision;
use super::scene::Scene;
use super::trail::{Flown, Trail};
use super::{EVERY, Entry, NO_DEPTH, stated};
use media::phase::PhaseFunction;
use media::phase::henyey_greenstein::HenyeyGreenstein;
use theory::ParticleRule;
use theory::particle::Event;

/// R.
const RADIUS: f64 = 0.5;
/// `σ_t/τ` as a polynomial of x.
const SHAPE: [f64; 3] = [1.8, -3.6, 2.0];
/// How far from the centre the ray passes that looks into the ball.
const OFFSET: f64 = 0.15;
/// The albedo; nothing is absorbed under light from all sides.
const ALBEDO: f64 = 0.8;
/// The mean cosine of scattering; light in a ball is scattered isotropically.
const FORWARD: f64 = 0.5;

/// What is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sought {
    /// The radiance in a furnace.
    Furnace,
    /// The path under light from all sides.
    Lambertian,
    /// The squared distance at absorption in a medium without end.
    Infinite,
    /// Light of an environment, met.
    Met,
    /// The same by shadow rays, ratio tracked.
    Ratio,
    /// By shadow rays, delta tracked.
    Delta,
}

/// A walk through space.
#[derive(Debug, Clone, Copy)]
struct Space {
    sought: Sought,
    rule: ParticleRule,
    /// How often both of what a collision leaves are followed.
    splits: u32,
}

/// A particle on its way.
#[derive(Clone, Copy)]
struct Traveller<P> {
    place: Place<P>,
    direction: Place<P>,
    weight: P,
    order: u32,
    depth: u32,
    /// What else it is weighted by where it waits.
    likelihood: f64,
}

/// The medium as a precision sees it.
struct Ball<'a, P> {
    scene: &'a Scene,
    centre: Place<P>,
    path: P,
    sampling: P,
    has_end: bool,
}

impl<P: Precision> Ball<'_, P> {
    #[inline(always)]
    fn extinction(&self, place: Place<P>) -> P {
        if !self.has_end {
            return P::of(self.scene.depth);
        }
        let away = place.less(self.centre).times(P::of(1.0 / RADIUS));
        let x = away.dot(away);
        let [a, b, c] = SHAPE.map(|shape| shape * self.scene.depth);
        ((x * c + b) * x + a).or_more(P::of(0.0))
    }

    /// How far it is to the surface.
    #[inline(always)]
    fn exit(&self, place: Place<P>, direction: Place<P>) -> P {
        if !self.has_end {
            return P::of(f64::INFINITY);
        }
        let to_centre = self.centre.less(place);
        let foot = to_centre.dot(direction);
        let aside = to_centre.plus(direction, -foot);
        let offset = aside.dot(aside).root();
        let (radius, zero) = (P::of(RADIUS), P::of(0.0));
        (foot + ((radius - offset) * (radius + offset)).or_more(zero).root()).or_more(zero)
    }

    /// The next tentative collision on the way to the exit.
    #[inline(always)]
    fn fly(&self, trail: &mut Trail, weight: P, [t, exit]: [P; 2]) -> Flown<P> {
        let reach = (exit - t) * self.sampling;
        trail.fly((weight, reach), |depth| t + depth * self.path, |t| t.below(exit))
    }
}

impl Space {
    /// Where a walk begins.
    fn start<P: Precision>(self, ball: &Ball<P>, trail: &mut Trail) -> Traveller<P> {
        let up = Place::of([0.0, 0.0, 1.0]);
        let anywhere =
            |trail: &mut Trail| up.turned(trail.uniform::<P>() * 2.0 - 1.0, trail.uniform::<P>());
        let (place, direction) = match self.sought {
            Sought::Infinite => (ball.centre, anywhere(trail)),
            Sought::Lambertian => {
                let outward = anywhere(trail);
                let cosine = (P::of(1.0) - trail.uniform::<P>()).root();
                let inward = outward.times(P::of(-1.0));
                let place = ball.centre.plus(outward, P::of(RADIUS));
                (place, inward.turned(cosine, trail.uniform::<P>()))
            }
            _ => {
                let below = (RADIUS * RADIUS - OFFSET * OFFSET).sqrt();
                let entry = Place::of([OFFSET, 0.0, -below]);
                (ball.centre.plus(entry, P::of(1.0)), up)
            }
        };
        Traveller { place, direction, weight: P::of(1.0), order: 0, depth: 0, likelihood: 1.0 }
    }

    fn albedo(self) -> f64 {
        if self.sought == Sought::Lambertian { 1.0 } else { ALBEDO }
    }

    fn is_isotropic(self) -> bool {
        matches!(self.sought, Sought::Met | Sought::Ratio | Sought::Delta)
    }

    #[inline(always)]
    fn turned<P: Precision>(self, trail: &mut Trail, direction: Place<P>) -> Place<P> {
        let u = trail.uniform::<P>();
        let forward = if self.is_isotropic() { 0.0 } else { FORWARD };
        let cosine = HenyeyGreenstein::new(forward).map_or(u, |phase| phase.cosine(u));
        direction.turned(cosine, trail.uniform::<P>())
    }

    /// A shadow ray to the environment: its weight, and where it is delta tracked its chance.
    #[inline(always)]
    fn shadow<P: Precision>(self, ball: &Ball<P>, trail: &mut Trail, place: Place<P>) -> f64 {
        let cosine = trail.uniform::<P>() * 2.0 - 1.0;
        let direction = Place::of([0.0, 0.0, 1.0]).turned(cosine, trail.uniform::<P>());
        let exit = ball.exit(place, direction);
        let ratio = |t: P| ball.extinction(place.plus(direction, t)) * ball.path;
        let stretch = [P::of(0.0), exit, ball.path];
        let is_ratio = self.sought == Sought::Ratio;
        let (weight, chance) = tracked(&mut trail.apart(), stretch, is_ratio, ratio);
        weight.double() * chance
    }

    /// Follows a particle until it is scattered or gone; what it scores is added.
    #[inline(always)]
    fn flight<P: Precision>(
        self,
        ball: &Ball<P>,
        trail: &mut Trail,
        mut particle: Traveller<P>,
        (score, waiting): (&mut f64, &mut Vec<Traveller<P>>),
    ) -> Option<Traveller<P>> {
        let (zero, one, albedo) = (P::of(0.0), P::of(1.0), P::of(self.albedo()));
        let Traveller { place: origin, direction, .. } = particle;
        let exit = ball.exit(origin, direction);
        let mut t = zero;
        loop {
            let weight = particle.weight;
            let flown = ball.fly(trail, weight, [t, exit]);
            match self.sought {
                Sought::Furnace | Sought::Met => *score += flown.gone * weight.double(),
                Sought::Ratio | Sought::Delta if particle.order == 0 => {
                    *score += flown.gone * weight.double();
                }
                Sought::Lambertian => {
                    *score += flown.gone * ((exit - t) * weight).double();
                }
                _ => {}
            }
            let reached = flown.at?;
            if self.sought == Sought::Lambertian {
                *score += trail.likelihood() * ((reached - t) * weight).double();
            }
            t = reached;
            let place = origin.plus(direction, t);
            let ratio = ball.extinction(place) * ball.path;
            let absorbed = particle.weight * ratio * (one - albedo);
            match self.sought {
                Sought::Furnace => *score += trail.likelihood() * absorbed.double(),
                Sought::Infinite => {
                    let away = place.less(ball.centre);
                    *score += trail.likelihood() * (absorbed * away.dot(away)).double();
                }
                _ => {}
            }
            if particle.depth < self.splits {
                particle.depth += 1;
                let weight = particle.weight * albedo * ratio;
                let direction = self.turned(trail, direction);
                let likelihood = trail.likelihood();
                waiting.push(Traveller { place, direction, weight, likelihood, ..particle });
                particle.weight = particle.weight * (one - ratio);
                continue;
            }
            let odds = self.rule.odds(ratio, albedo);
            match trail.decide(&odds) {
                Event::Transmitted => particle.weight = particle.weight * odds.transmit_weight,
                Event::Scattered => {
                    let weight = particle.weight * odds.scatter_weight;
                    if matches!(self.sought, Sought::Ratio | Sought::Delta) {
                        let lit = self.shadow(ball, trail, place);
                        *score += trail.likelihood() * weight.double() * lit;
                    }
                    let direction = self.turned(trail, direction);
                    let order = particle.order + 1;
                    return Some(Traveller { place, direction, weight, order, ..particle });
                }
                Event::Absorbed => return None,
            }
        }
    }
}

impl Estimator for Space {
    fn theory(&self, scene: &Scene) -> Theory {
        let shape: Vec<String> = SHAPE.iter().map(|x| format!("{:e}", x * scene.depth)).collect();
        let ball = format!(
            "volume.radial = {{ centre = [0, 0, 0], radius = {RADIUS}, coefficients = [{}] }}\n\
             ray = {{ origin = [{OFFSET}, 0, -1], direction = [0, 0, 1], length = 2 }}",
            shape.join(", ")
        );
        let sampling = format!("sampling.constant = {{ value = {:e} }}", scene.collisions);
        let rule = format!("rule = \"{}\"", self.rule.name());
        let particle = format!("particle = {{ {rule}, {sampling} }}");
        let shadow = |word: &str| {
            format!(
                "next-event = {{ {rule}, shadow.{word} = {{ sampling = {:e} }}, {sampling} }}",
                scene.collisions
            )
        };
        let environment = "\nlight.environment = {}";
        let (problem, body, estimator) = match self.sought {
            Sought::Furnace if self.splits > 0 => {
                let depth = self.splits;
                ("furnace", ball, format!("splitting = {{ depth = {depth}, {rule}, {sampling} }}"))
            }
            Sought::Furnace => ("furnace", ball, particle),
            Sought::Lambertian => ("lambertian", ball, particle),
            Sought::Infinite => {
                let ray = "ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 1 }";
                let body = format!("volume.constant = {{ extinction = {:e} }}\n{ray}", scene.depth);
                ("infinite-medium", body, particle)
            }
            Sought::Met => ("ball", ball + environment, particle),
            Sought::Ratio => ("ball", ball + environment, shadow("ratio")),
            Sought::Delta => ("ball", ball + environment, shadow("delta")),
        };
        let phase = if self.is_isotropic() {
            "isotropic = {}".to_owned()
        } else {
            format!("henyey-greenstein = {{ g = {FORWARD} }}")
        };
        let text = format!(
            "title = \"t\"\n[problem.{problem}]\n{body}\nalbedo = {}\nphase.{phase}\n\
             estimators = [{{ {estimator} }}]",
            self.albedo()
        );
        let channel = match self.sought {
            Sought::Lambertian => "path length",
            Sought::Infinite => "squared distance",
            _ => "",
        };
        stated(scene, &text, channel)
    }

    fn cost(&self, _: &Scene) -> Option<f64> {
        None
    }

    fn pilots(&self, scene: Scene) -> Scene {
        // With a majorant, neither analog nor weighted walks depend on it.
        let depends = self.splits > 0 || self.sought == Sought::Ratio;
        let few = if depends { f64::INFINITY } else { 4.0 * scene.depth };
        let few = Scene::new(scene.depth, scene.collisions.min(few), scene.from);
        Scene { stated: scene.stated, ..few }
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let (path, sampling) = (P::of(1.0 / scene.collisions), P::of(scene.collisions));
        let has_end = self.sought != Sought::Infinite;
        let ball = Ball { scene, centre: Place::of([scene.from; 3]), path, sampling, has_end };
        let (mut score, mut waiting) = (0.0, Vec::new());
        let mut next = Some(self.start(&ball, trail));
        loop {
            let Some(particle) = next.take().or_else(|| {
                let waited: Traveller<P> = waiting.pop()?;
                trail.resume(waited.likelihood);
                Some(waited)
            }) else {
                return score;
            };
            next = self.flight(&ball, trail, particle, (&mut score, &mut waiting));
        }
    }
}

const fn space(sought: Sought, rule: ParticleRule) -> Space {
    Space { sought, rule, splits: 0 }
}

/// All of them.
pub const ALL: &[Entry] = &[
    ("furnace, analog", &space(Sought::Furnace, ParticleRule::Analog), EVERY),
    ("furnace, weighted", &space(Sought::Furnace, ParticleRule::Weighted), EVERY),
    (
        "furnace, splitting",
        &Space { splits: 3, ..space(Sought::Furnace, ParticleRule::Analog) },
        EVERY,
    ),
    ("lambertian, analog", &space(Sought::Lambertian, ParticleRule::Analog), EVERY),
    ("infinite medium, analog", &space(Sought::Infinite, ParticleRule::Analog), NO_DEPTH),
    ("sphere, particle", &space(Sought::Met, ParticleRule::Analog), EVERY),
    ("sphere, next-event, ratio", &space(Sought::Ratio, ParticleRule::Weighted), EVERY),
    ("sphere, next-event, delta", &space(Sought::Delta, ParticleRule::Analog), EVERY),
];
