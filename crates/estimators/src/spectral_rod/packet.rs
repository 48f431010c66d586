//! Walks through coloured bodies side by side: the packet kernel of [`super::walk`], for rods and slabs.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream j mod 16.
//!
//! Eight analog walks count their scatterings; a rod is a slab with two directions, of cosines 1 and −1. What a walk is
//! worth in each channel depends on its hero and on that count alone, and stands in a table.

use std::f64::consts::TAU;

use fearless_simd::{ExtractToken, Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::Coloured;
use super::walk::Scores;
use crate::kernels::packet::bank::{Numbers, Particles, Slot, Slots};
use crate::kernels::packet::hero::{Law, number_of_hero};
use crate::kernels::packet::{Request, line};
use crate::slab::walk::{entering, turned};
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use media::course::BothWays;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::Lane;
use numeric::pack::WIDTH;
use theory::ParticleRule;
use theory::problems::slab::{Incidence, Light};
use theory::problems::spectral_rod::{Colours, End};

/// Orders below this stand in the table.
const TABLE: u32 = 16;

/// Where walks take place.
#[derive(Clone, Copy)]
pub enum Place<'a> {
    /// In a rod, where scattering keeps the direction with a probability.
    Rod(f64),
    /// In a slab.
    Slab(&'a Incidence),
}

/// The draws of a page, on the hardware of a level; a request is handed back where the hardware is too narrow or one
/// draw after the other is faster.
pub fn walks<'a, P: Coloured>(
    level: Level,
    setup: &Setup<P>,
    page: &dyn Scores,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let worth = Worth::new(page, setup.problem.colours());
    let walks = Walks { place: setup.problem.place(), worth: &worth };
    line::walks(level, &walks, &setup.sampling, medium, request)
}

/// Whose walks they are, and what they are worth in all channels.
struct Worth<'a> {
    page: &'a dyn Scores,
    colours: &'a Colours,
    /// The law of the hero, if one is chosen.
    law: Option<Law>,
    /// The chance of each hero to be scattered at a real collision.
    chances: Vec<f64>,
    /// By order and hero.
    table: Vec<[f64; MOST_CHANNELS]>,
}

impl<'a> Worth<'a> {
    fn new(page: &'a dyn Scores, colours: &'a Colours) -> Self {
        let albedos = &colours.albedos;
        let law = page.heroes().map(|heroes| Law::new(heroes, albedos.len()));
        let count = if law.is_some() { albedos.len() } else { 1 };
        let chances = (0..count).map(|hero| page.chance(albedos, hero)).collect();
        let of = |order| (0..count).map(move |hero| page.weights(albedos, hero, order));
        let table = (0..TABLE).flat_map(of).collect();
        Self { page, colours, law, chances, table }
    }

    fn weights(&self, hero: usize, order: usize) -> [f64; MOST_CHANNELS] {
        let known = self.table.get(order * self.chances.len() + hero);
        known.copied().unwrap_or_else(|| {
            let order = u32::try_from(order).unwrap_or(u32::MAX);
            self.page.weights(&self.colours.albedos, hero, order)
        })
    }
}

struct Walks<'a> {
    place: Place<'a>,
    worth: &'a Worth<'a>,
}

impl<'a> line::Walks for Walks<'a> {
    type Pack<S: Simd, C: BothWays<f64x8<S>>> = InBody<'a, S, C>;

    #[inline(always)]
    fn begin<S: Simd, C: BothWays<f64x8<S>>>(
        &self,
        course: C,
        from: f64x8<S>,
        numbers: &mut Numbers<S>,
    ) -> Self::Pack<S, C> {
        let Self { place, worth } = *self;
        let all = mask64x8::splat(from.token(), true);
        let zero = from.each(0.0);
        let mut walks = InBody {
            place,
            worth,
            from,
            course,
            number: zero,
            inside: all,
            is_down: all,
            goes_on: all,
            cosine: zero,
            hero: zero,
            chance: zero,
            order: zero,
        };
        walks.enter(all, numbers);
        walks
    }
}

/// Eight particles in a body.
struct InBody<'a, S: Simd, C> {
    place: Place<'a>,
    worth: &'a Worth<'a>,
    from: f64x8<S>,
    course: C,
    number: f64x8<S>,
    inside: mask64x8<S>,
    is_down: mask64x8<S>,
    goes_on: mask64x8<S>,
    cosine: f64x8<S>,
    /// The number of each hero.
    hero: f64x8<S>,
    /// Its chance to be scattered at a real collision.
    chance: f64x8<S>,
    order: f64x8<S>,
}

impl<S: Simd, C: BothWays<f64x8<S>>> InBody<'_, S, C> {
    /// Some of them enter.
    #[inline(always)]
    fn enter(&mut self, which: mask64x8<S>, numbers: &mut Numbers<S>) {
        let (zero, one) = (self.from.each(0.0), self.from.each(1.0));
        let Worth { law, chances, .. } = self.worth;
        let hero = match law {
            Some(law) => law.choose(numbers.uniform_where(which)),
            None => zero,
        };
        self.hero = Lane::select(which, hero, self.hero);
        self.chance = Lane::select(which, number_of_hero(hero, chances), self.chance);
        self.order = Lane::select(which, zero, self.order);
        let light = match self.place {
            Place::Rod(_) => Light::Collimated(1.0),
            Place::Slab(incidence) => incidence.light,
        };
        self.cosine = Lane::select(
            which,
            entering(light, &ParticleRule::Analog, which, one, numbers),
            self.cosine,
        );
    }

    /// Who is scattered, and who passes.
    #[inline(always)]
    fn decide(&self, extinction: f64x8<S>) -> [mask64x8<S>; 2] {
        let Self { number, inside, chance, .. } = *self;
        if matches!(self.place, Place::Rod(_)) {
            let ratio = extinction / self.course.sampling();
            let null = ratio.each(1.0) - ratio;
            let passes = inside & number.below(null);
            [inside & !passes & number.below(null + chance * ratio), passes]
        } else {
            let odds = ParticleRule::Analog.odds(extinction * self.course.mean_free_path(), chance);
            let is_scattered = inside & number.below(odds.scatter);
            [is_scattered, inside & !is_scattered & number.below(odds.scatter + odds.transmit)]
        }
    }

    /// The cosines of those that are scattered.
    #[inline(always)]
    fn turned(&self, is_scattered: mask64x8<S>, numbers: &mut Numbers<S>) -> f64x8<S> {
        let number = numbers.uniform_where(is_scattered);
        let phase = match self.place {
            Place::Rod(forward) => {
                let keeps = number.below(number.each(forward));
                return Lane::select(keeps, self.cosine, -self.cosine);
            }
            Place::Slab(incidence) => &incidence.phase,
        };
        let deflection = phase.cosine(number);
        if *phase == Phase::Isotropic(Isotropic) {
            return deflection;
        }
        let azimuth = (numbers.uniform_where(is_scattered) * TAU).cos();
        turned(self.cosine, deflection, azimuth)
    }
}

impl<S: Simd, C: BothWays<f64x8<S>>> Particles<S> for InBody<'_, S, C> {
    type Found = f64x8<S>;

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let length = -numbers.ln_uniform();
        self.number = numbers.uniform();
        self.is_down = length.each(0.0).below(self.cosine);
        self.inside = self.course.fly_either_way(length * self.cosine.size(), self.is_down);
        // Beyond both ends there is no field to look at.
        Lane::select(self.inside, self.course.reached(), self.from)
    }

    #[inline(always)]
    fn collide(&mut self, &extinction: &f64x8<S>, numbers: &mut Numbers<S>) -> u64 {
        let [is_scattered, passes] = self.decide(extinction);
        let cosine = self.turned(is_scattered, numbers);
        self.cosine = Lane::select(is_scattered, cosine, self.cosine);
        self.order = Lane::select(is_scattered, self.order + 1.0, self.order);
        self.goes_on = is_scattered | passes;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&mut self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let (inside, is_down) = (self.inside.to_bitmask(), self.is_down.to_bitmask());
        let mut ends = Ends { inside, is_down, hero: [0.0; WIDTH], order: [0.0; WIDTH] };
        self.hero.store_slice(&mut ends.hero);
        self.order.store_slice(&mut ends.order);
        ends.collect(slots, ended, self.worth, buffer)
    }

    #[inline(always)]
    fn restart(&mut self, numbers: &mut Numbers<S>) {
        let ended = !self.goes_on;
        self.enter(ended, numbers);
        self.course.restart(ended);
    }
}

/// What eight walks have come to.
#[repr(align(64))]
struct Ends {
    /// Who ended inside, and who was going down, as bits.
    inside: u64,
    is_down: u64,
    hero: [f64; WIDTH],
    order: [f64; WIDTH],
}

impl Ends {
    /// Makes draws of those that ended.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts, one bit
    fn collect(
        &self,
        slots: &mut Slots,
        ended: u64,
        worth: &Worth,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        slots.fill(ended, |Slot { lane, draw, steps }| {
            let is_inside = self.inside >> lane & 1;
            let end = match (is_inside, self.is_down >> lane & 1) {
                (1, _) => None,
                (_, 1) => Some(End::Transmitted),
                _ => Some(End::Reflected),
            };
            let weights = worth.weights(self.hero[lane] as usize, self.order[lane] as usize);
            for (number, &(seen, channel)) in worth.colours.seen.iter().enumerate() {
                buffer.values[number][draw] =
                    if end == Some(seen) { weights[channel] } else { 0.0 };
            }
            buffer.defects[draw] = 0.0;
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps + is_inside as u32;
        })
    }
}
