//! The walk from the camera to one scattering, and on to the light, by delta tracking; a shadow ray from there.
//!
//! ```text
//! fly down through σ̂;  at a tentative collision, r = σ_t/σ̂:  null, 1 − r;  absorbed: the end;  scattered, a r:
//!   a direction μ to the light is chosen, the score of a shadow ray along it is added, q = p(μ)/p_nee
//!   a direction μ is drawn from p;  unless it meets the light the walk ends;  ρ ← q
//!   fly on along it:  null, 1 − r: ρ ← ρ (1 − r), where null collisions are part of ρ;  real: the end
//!   leaving: the weight of a hit is added
//! ```
//!
//! A flight of optical depth u along a direction of cosine μ goes u μ deep. It takes two random numbers, that of a shadow
//! ray too; a scattering takes one for each direction that is chosen or drawn. Who seeks no hits draws none.
//! Eight at a time: [`super::packet`].

use crate::lit_rod::walk::{Steps, Way, transmittance};
use crate::{Draw, Setup};
use media::phase::Phase;
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::ParticleRule;
use theory::lit_rod::Shadow;
use theory::particle::Event;
use theory::problems::LitSlab;

/// What directions are worth, which a known bug may replace; the steps along them are those of rods.
pub trait Directions {
    /// The phase function of a chosen direction.
    #[inline(always)]
    fn scattered(&self, phase: &Phase, cosine: f64) -> f64 {
        phase.value(cosine)
    }

    /// `1/p_nee` of a chosen direction, from what is right.
    #[inline(always)]
    fn spread(&self, right: f64, cosine: f64) -> f64 {
        let _ = cosine;
        right
    }

    /// The same of a direction that was drawn.
    #[inline(always)]
    fn spread_of_hit(&self, right: f64) -> f64 {
        right
    }

    /// How deep a shadow ray flies in a unit of optical depth.
    #[inline(always)]
    fn slant(&self, cosine: f64) -> f64 {
        cosine
    }
}

/// The right ones.
pub struct Right;

impl Directions for Right {}

/// Makes one draw.
#[inline(always)]
pub fn draw(
    (steps, directions): (&impl Steps, &impl Directions),
    setup: &Setup<LitSlab>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    let LitSlab { albedo, phase, light, .. } = &*setup.problem;
    let techniques = steps.techniques();
    let mut cursor = setup.sampling.begin();
    let mut lookups = 0;
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else {
            return Draw::free([0.0], lookups);
        };
        lookups += 1;
        let real = medium.extinction(cursor.t) * (1.0 / sampling);
        match ParticleRule::Analog.odds(real, *albedo).decide(number) {
            Event::Transmitted => {}
            Event::Scattered => break,
            Event::Absorbed => return Draw::free([0.0], lookups),
        }
    }
    let before = setup.problem.end() - cursor.t;
    let mut score = 0.0;
    let chosen = techniques.shadow.map(|shadow| {
        let number = if light.can_be_hit() { rng.uniform() } else { 0.0 };
        (shadow, light.chosen(number, before))
    });
    let drawn = techniques.has_hits().then(|| phase.cosine(rng.uniform()));
    if let Some((shadow, [cosine, spread])) = chosen {
        let density = directions.scattered(phase, cosine) * directions.spread(spread, cosine);
        let found = if shadow == Shadow::Exact {
            transmittance(setup, cursor.t, directions.slant(cosine))
        } else {
            let is_delta = shadow == Shadow::Delta;
            let way = Way {
                is_delta,
                cosine: directions.slant(cosine),
                albedo: |_| *albedo,
                sampling: &setup.sampling,
                end: setup.mesh.support().to,
            };
            let mut ray = cursor;
            let (found, cast) = way.track(steps, medium, (&mut ray, rng));
            lookups += cast;
            found
        };
        score += steps.connected(density, found, *albedo);
    }
    let Some(cosine) = drawn.filter(|&cosine| light.is_met(cosine, before)) else {
        return Draw::free([score], lookups);
    };
    let density = phase.value(cosine) * directions.spread_of_hit(light.spread(cosine, before));
    let is_exact = techniques.shadow == Some(Shadow::Exact);
    let found = if is_exact { transmittance(setup, cursor.t, cosine) } else { 0.0 };
    let mut ratio = techniques.ratio(density, found);
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth * cosine) else {
            return Draw::free([score + steps.hit(ratio)], lookups);
        };
        lookups += 1;
        let real = medium.extinction(cursor.t) * (1.0 / sampling);
        if number < real {
            return Draw::free([score], lookups);
        }
        ratio = steps.after_null(ratio, 1.0 - real);
    }
}
