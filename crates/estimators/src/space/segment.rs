//! Segments of null-scattering paths through σ̂ in space, tracked at once from one end to the other.
//!
//! ```text
//! by ratio tracking, to a given end:       T̂ = ∏ (1 − σ_t/σ̂) over the tentative collisions, all of them null
//! by delta tracking, to a real collision:  each collision is real with probability σ_t/σ̂, else null
//! ```
//!
//! The null collisions of a path have the same places by either method. Their densities differ by the probabilities
//! to be null: only delta tracking samples these events. A flight takes a random number, a decision another one.

use media::sampling::{Flights, Flown, MajorantView};
use numeric::geometry::Point;
use numeric::geometry::exit::rows;
use numeric::rng::Random;
use numeric::{Lane, Mask};
use theory::ParticleRule;
use theory::problems::{Albedo, Scene};

/// Segments.
#[derive(Clone, Copy)]
pub struct Segment<L: Lane> {
    /// Lanes that end with a real collision.
    pub collided: L::Mask,
    /// The place of the collision.
    pub place: [L; 3],
    /// `T̂`, where it is tracked.
    pub transmittance: L,
    /// The probability that all collisions before the end are null.
    pub probability: L,
    /// Lookups.
    pub lookups: L,
}

/// A medium and σ̂ in it.
#[derive(Clone, Copy)]
pub struct SampledMedium<'a> {
    /// The medium.
    pub scene: &'a Scene,
    /// σ̂.
    pub ground: &'a MajorantView<'a>,
}

/// A field at places, one lane after the other; 0 outside `which`.
#[inline(always)]
fn each<L: Lane>(place: [L; 3], which: L::Mask, at: impl Fn(Point) -> f64) -> L {
    let ([x, y, z], bits) = (rows(place), which.bits());
    place[0].replaced(
        #[inline(always)]
        |elements| {
            for (lane, element) in elements.iter_mut().enumerate() {
                let is_asked = bits >> lane & 1 == 1;
                *element = if is_asked { at(Point([x[lane], y[lane], z[lane]])) } else { 0.0 };
            }
        },
    )
}

impl SampledMedium<'_> {
    /// The albedo at places of the lanes in `which`.
    #[inline(always)]
    pub fn albedo<L: Lane>(self, place: [L; 3], which: L::Mask) -> L {
        match &self.scene.albedo {
            Albedo::Even(albedo) => place[0].each(*albedo),
            field @ Albedo::Field(..) => each(place, which, |place| field.at(place)),
        }
    }

    /// Ratio tracking of the lanes in `which`, from places in the bounds, over distances; the probabilities of null collisions
    /// are those of a rule.
    #[inline(always)]
    pub fn ratio<L: Lane>(
        self,
        rays: [[L; 3]; 2],
        (which, distance): (L::Mask, L),
        rule: ParticleRule,
        random: &mut impl Random<L>,
    ) -> Segment<L> {
        let (mut flights, mut segment) = self.begin(rays, which);
        let mut on = which;
        while on.any() {
            let (flown, ratio) = self.fly(&mut flights, on, random);
            on &= flown.inside & flights.t.below(distance);
            segment.lookups.count_where(on);
            segment.transmittance.scale_where(on, ratio.one_minus());
            let probabilities = rule.probabilities(ratio, self.albedo(flown.place, on));
            segment.probability.scale_where(on, probabilities.transmit);
        }
        segment
    }

    /// Delta tracking of the lanes in `which`, from places in the bounds or on their boundary.
    #[inline(always)]
    pub fn delta<L: Lane>(
        self,
        rays: [[L; 3]; 2],
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> Segment<L> {
        let (mut flights, mut segment) = self.begin(rays, which);
        let mut on = which;
        while on.any() {
            let (flown, ratio) = self.fly(&mut flights, on, random);
            on &= flown.inside;
            segment.lookups.count_where(on);
            let collides = on & random.uniform_where(on).below(ratio);
            segment.collided |= collides;
            for (axis, place) in segment.place.iter_mut().enumerate() {
                place.set_where(collides, flown.place[axis]);
            }
            on &= !collides;
            segment.probability.scale_where(on, ratio.one_minus());
        }
        segment
    }

    #[inline(always)]
    fn begin<L: Lane>(self, rays: [[L; 3]; 2], which: L::Mask) -> (Flights<L>, Segment<L>) {
        let [origin, direction] = rays;
        let (zero, one) = (origin[0].each(0.0), origin[0].each(1.0));
        let mut flights = Flights::new(zero);
        (flights.origin, flights.direction) = (origin, direction);
        flights.enter(self.ground, which, &self.ground.reach(rays, which));
        let (collided, place) = (which & !which, origin);
        let segment =
            Segment { collided, place, transmittance: one, probability: one, lookups: zero };
        (flights, segment)
    }

    /// Flies to the next tentative collision; returns `σ_t/σ̂` there.
    #[inline(always)]
    fn fly<L: Lane>(
        self,
        flights: &mut Flights<L>,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> (Flown<L>, L) {
        let depth = -random.ln_uniform_where(which);
        let flown = flights.fly(
            self.ground,
            which,
            depth,
            #[inline(always)]
            |here, _| here,
        );
        let field = &*self.scene.volume;
        let extinction = each(flown.place, flown.inside, |place| field.extinction_within(place));
        (flown, extinction / flown.sampling)
    }
}
