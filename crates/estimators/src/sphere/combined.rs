//! A walk from the eye whose hits, shadow rays and connections share the paths that each of them can make.
//!
//! A path ends with a scattering y, before it perhaps with another one x, and its last segment leads to the light. What
//! comes before x is the same for all techniques. Relative to a walk that hits the light, they make it with the
//! densities
//!
//! ```text
//! hit           1, or 0 for a distant light
//! shadow ray    1/(q ν),  q = p(ω)/p_nee = Ω/4π of the light as seen from y
//! connection    4 d²/(a ρ² ν'),  d the distance of x and y, ρ the radius of the light's surface: of the black sphere, or
//!               of the ball, through which an environment and a distant light shine
//! ```
//!
//! ν and ν' are the chances of the null collisions of the last segment and of that between x and y. Densities of
//! directions leave them out (ν = 1); where transmittances are exact, `ν = T`. In the last density is
//! `f/p = a p p G/p_e T̂`: light leaves by Lambert's law with density `cos θ/(4π²ρ²)`, phase functions are 1/4π, and
//! `G = 1/d²`. A connection needs both x and y: a camera has no scattering before the first one, but a place whose mean
//! intensity is sought counts as a scattering of weight 1. What was never scattered can be hit only, and its weight is 1.
//!
//! A vertex of the light is the first real collision y of a particle that sets out from its surface; y is connected to
//! the scatterings x of the walk by ratio tracking.

use super::connect::{Connect, Finder, Honest, ShadowRay, is_met, meets};
use super::emission;
use crate::single_scattering::connection;
use crate::space::segment::Tracker;
use crate::space::tally::Collision;
use crate::space::{Scattering, Sink};
use media::Majorants;
use numeric::geometry::{Point, Ray};
use numeric::rng::Stream;
use theory::lit_rod::Densities;
use theory::problems::Sphere;
use theory::problems::sphere::Light;
use theory::single::Tracking;
use theory::{Heuristic, ParticleRule};

/// Which vertices of the light a walk is connected with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subpaths {
    /// Each of its scatterings with one of its own.
    Independent,
    /// All of them with the same one.
    Shared,
}

/// Which techniques share, and by which densities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sharing {
    /// What densities know.
    pub densities: Densities,
    /// How weights are made of them.
    pub heuristic: Heuristic,
    /// How shadow rays are tracked; by ratio tracking through the σ̂ of the walk, where nothing is said.
    pub shadow: Option<Tracking>,
    /// Which connections there are, if any.
    pub subpaths: Option<Subpaths>,
}

impl Sharing {
    /// The tracking of shadow rays with numbers of their own: also through one σ̂ of the walk, where the chance of all
    /// collisions of a shadow ray to be null is its tracked transmittance.
    pub fn tracking(&self, rule: ParticleRule, majorants: &Majorants) -> Option<Tracking> {
        let is_its_own = !matches!(rule, ParticleRule::NonTerminating | ParticleRule::Adaptive);
        let of_walk = majorants.single_value().filter(|_| is_its_own);
        self.shadow.or(of_walk.map(|sampling| Tracking::Ratio { sampling, control: 0.0 }))
    }
}

/// The steps that a known bug may replace.
pub trait Steps: Sync {
    /// The chance of a null collision, as densities of the walk have it.
    fn chance(&self, right: f64) -> f64 {
        right
    }

    /// The chances of null collisions with which a segment begins, from those of the one before.
    fn segment(&self, before: f64) -> f64 {
        let _ = before;
        1.0
    }

    /// The weight of a hit, a shadow ray or a connection: 0, 1 or 2.
    fn weight(&self, heuristic: Heuristic, own: usize, densities: [f64; 3]) -> f64 {
        heuristic.weight(own, densities)
    }

    /// The weight of what was never scattered.
    fn unscattered(&self) -> f64 {
        1.0
    }

    /// What a shadow ray of some transmittance scores, but for its weight.
    fn lit(&self, right: f64, transmittance: f64) -> f64 {
        let _ = transmittance;
        right
    }

    /// The density of a connection of two scatterings of the walk, whose squared distance is given.
    fn linked(&self, right: f64, square: f64) -> f64 {
        let _ = square;
        right
    }

    /// What a connection scores, but for its weight.
    fn connected(&self, right: f64, link: &Link) -> f64 {
        let _ = link;
        right
    }

    /// Whether the black sphere is between the ends of a connection.
    fn is_hidden(&self, right: bool) -> bool {
        right
    }

    /// The cosine with the normal of light that leaves its surface, of a uniform number: the law of Lambert.
    fn cosine(&self, number: f64) -> f64 {
        (1.0 - number).sqrt()
    }
}

impl Steps for Honest {}

/// q, the share of all directions in which the light is seen.
fn share(sphere: &Sphere, place: Point) -> f64 {
    match sphere.light {
        Light::BlackSphere(core) => Honest.share(core, (sphere.centre - place).norm()),
        Light::Environment | Light::Distant(_) => 1.0,
    }
}

/// A connection.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// d.
    pub distance: f64,
    /// a at the vertex of the light.
    pub albedo: f64,
    /// T̂.
    pub transmittance: f64,
}

/// A scattering of the walk, or the place whose mean intensity is sought.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    place: Point,
    /// q.
    share: f64,
    /// The density of a connection of it with the one before.
    linked: f64,
}

/// A real collision of a particle from the light.
#[derive(Debug, Clone, Copy)]
struct Emitted {
    place: Point,
    /// The density of a shadow ray from it.
    lit: f64,
}

/// The chances of the null collisions of a segment in flight.
#[derive(Debug, Clone, Copy)]
struct Nulls {
    /// Up to the last collision but one.
    before: f64,
    /// Of the last one, which may turn out to be real.
    last: f64,
}

/// A walk that shares.
pub struct Combined<'a> {
    sphere: &'a Sphere,
    tracker: Tracker<'a>,
    rule: ParticleRule,
    sharing: Sharing,
    tracking: Option<Tracking>,
    steps: &'a dyn Steps,
    last: Option<Vertex>,
    nulls: Nulls,
    /// Whether a particle has set out from the light, and its vertex, if it came to one.
    has_emitted: bool,
    emitted: Option<Emitted>,
    found: f64,
}

impl<'a> Combined<'a> {
    /// By the steps of someone.
    pub fn new(
        (sphere, tracker): (&'a Sphere, Tracker<'a>),
        rule: ParticleRule,
        (sharing, steps): (Sharing, &'a dyn Steps),
    ) -> Self {
        let nulls = Nulls { before: 1.0, last: 1.0 };
        let tracking = sharing.tracking(rule, tracker.majorants);
        Self {
            sphere,
            tracker,
            rule,
            sharing,
            tracking,
            steps,
            last: None,
            nulls,
            has_emitted: false,
            emitted: None,
            found: 0.0,
        }
    }

    /// Whether densities hold the chances of null collisions.
    fn has_nulls(&self) -> bool {
        self.sharing.densities == Densities::Full && self.sharing.shadow.is_none()
    }

    /// The density of a hit.
    fn hit(&self) -> f64 {
        if matches!(self.sphere.light, Light::Distant(_)) { 0.0 } else { 1.0 }
    }

    /// `4 d²/(a ρ²)`; a is that where light was scattered first.
    fn apart(&self, square: f64, first: Point) -> f64 {
        let radius = emission::radius(self.sphere);
        let albedo = self.sphere.scene.albedo.at(first);
        // Two that are one point share nothing; a number keeps it from being 0/0.
        4.0 * square.max(1e-200) / (albedo * radius * radius)
    }

    /// The walk is at a vertex, with a weight.
    fn at_vertex(&mut self, place: Point, weight: f64, rng: &mut Stream) -> u32 {
        let linked = match (self.sharing.subpaths, self.last) {
            (Some(_), Some(before)) => {
                let away = place - before.place;
                let square = away.dot(away);
                self.steps.linked(self.apart(square, place) / self.nulls.before, square)
            }
            _ => 0.0,
        };
        let Nulls { before, last } = self.nulls;
        self.nulls = Nulls { before: self.steps.segment(before * last), last: 1.0 };
        let vertex = Vertex { place, share: share(self.sphere, place), linked };
        self.last = Some(vertex);
        if weight == 0.0 {
            return 0;
        }
        let lookups = self.cast(&vertex, weight, rng);
        lookups + self.connect(place, weight, rng)
    }

    /// Casts a shadow ray from a vertex.
    fn cast(&mut self, vertex: &Vertex, weight: f64, rng: &mut Stream) -> u32 {
        let ray = ShadowRay::cast(self.sphere, &Honest, vertex.place, rng);
        let (through, chance, lookups) = match self.tracking {
            Some(shadow) => {
                let (through, lookups) = ray.transmittance(self.sphere, shadow, rng);
                (through, through, lookups)
            }
            None if ray.inside.is_empty() => (1.0, 1.0, 0),
            None => {
                let found = self.tracker.ratio(&ray.ray, ray.inside.to, self.rule, rng);
                (found.transmittance, found.chance, found.lookups)
            }
        };
        if through != 0.0 {
            let chance = if self.sharing.densities == Densities::Full { chance } else { 1.0 };
            let densities = [self.hit(), 1.0 / (vertex.share * chance), vertex.linked];
            let worth = self.steps.lit(weight * ray.share * through, through);
            self.found += worth * self.steps.weight(self.sharing.heuristic, 1, densities);
        }
        lookups
    }

    /// Connects a vertex with one of the light.
    fn connect(&mut self, place: Point, weight: f64, rng: &mut Stream) -> u32 {
        let Some(subpaths) = self.sharing.subpaths else { return 0 };
        let mut lookups = 0;
        if !self.has_emitted || subpaths == Subpaths::Independent {
            (self.emitted, lookups) = self.emit(rng);
            self.has_emitted = true;
        }
        let Some(Emitted { place: first, lit }) = self.emitted else { return lookups };
        let away = first - place;
        let distance = away.norm();
        let Some(direction) = away.normalised() else { return lookups };
        let hidden = match self.sphere.light {
            Light::BlackSphere(core) => meets(place, direction, self.sphere.centre, core)
                .is_some_and(|stop| stop < distance),
            Light::Environment | Light::Distant(_) => false,
        };
        if self.steps.is_hidden(hidden) {
            return lookups;
        }
        let ray = Ray { origin: place, direction, length: distance };
        let found = self.tracker.ratio(&ray, distance, self.rule, rng);
        lookups += found.lookups;
        let transmittance = found.transmittance;
        if transmittance != 0.0 {
            let apart = self.apart(distance * distance, first);
            let densities = [self.hit(), lit, apart / found.chance];
            let link = Link { distance, albedo: self.sphere.scene.albedo.at(first), transmittance };
            let worth = self.steps.connected(weight * transmittance / apart, &link);
            self.found += worth * self.steps.weight(self.sharing.heuristic, 2, densities);
        }
        lookups
    }

    /// A particle sets out from the light; what its first real collision is worth to connections, if there is one.
    fn emit(&self, rng: &mut Stream) -> (Option<Emitted>, u32) {
        let ray = emission::ray(self.sphere, |number| self.steps.cosine(number), rng);
        let flown = self.tracker.delta(&ray, rng);
        let emitted = flown.collision.map(|place| {
            let share = share(self.sphere, place);
            Emitted { place, lit: 1.0 / (share * self.steps.chance(flown.chance)) }
        });
        (emitted, flown.lookups)
    }
}

impl Finder for Combined<'_> {
    fn begin(&mut self, sought: Option<Point>, rng: &mut Stream) -> u32 {
        sought.map_or(0, |place| self.at_vertex(place, 1.0, rng))
    }

    fn found(&self) -> f64 {
        self.found
    }
}

impl Sink for Combined<'_> {
    fn collided(&mut self, at: &Collision<f64>) {
        if self.has_nulls() {
            let chance = self.rule.odds(at.ratio, at.albedo).transmit;
            let Nulls { before, last } = self.nulls;
            self.nulls = Nulls { before: before * last, last: self.steps.chance(chance) };
        }
    }

    fn scattered(&mut self, at: &Scattering, rng: &mut Stream) -> u32 {
        self.at_vertex(at.place, at.weight, rng)
    }

    fn escaped(&mut self, at: Point, direction: Point, weight: f64, _: u32) {
        if !is_met(self.sphere, at) {
            return;
        }
        let Some(Vertex { place, share, linked }) = self.last else {
            self.found += weight * self.steps.unscattered();
            return;
        };
        let chance = match self.sharing {
            Sharing { densities: Densities::Directional, .. } => 1.0,
            Sharing { shadow: None, .. } => self.nulls.before * self.nulls.last,
            Sharing { shadow: Some(_), .. } => {
                let sphere = self.sphere;
                let ray = Ray { origin: place, direction, length: (at - place).norm() };
                let inside = sphere.scene.volume.bounds().clip(&ray);
                connection::exact(&*sphere.scene.volume, &ray, inside)
            }
        };
        let densities = [self.hit(), 1.0 / (share * chance), linked];
        self.found += weight * self.steps.weight(self.sharing.heuristic, 0, densities);
    }
}
