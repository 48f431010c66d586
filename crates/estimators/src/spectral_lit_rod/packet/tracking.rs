//! Walks through one σ̂ for all channels, eight side by side: the packet kernel of [`super::super::spectral_tracking`].
//!
//! Specification: draw j is, bit for bit, the draw that the page makes from stream j mod 16.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::Page;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Particles, Slots};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::left;
use crate::setup::heroes::Heroes;
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::{self, Task};
use theory::problems::SpectralLitRod;
use theory::spectral::Chances;

/// The draws by chances, on the hardware of a level; a request is handed back where the hardware is too narrow.
pub fn walks<'a>(
    level: Level,
    chances: Chances,
    setup: &Setup<SpectralLitRod>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let page = Page::of_channels(&Heroes::Uniform, setup);
    let task = Walks { page: &page, chances, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Walks<'a, 'r> {
    page: &'a Page<'a>,
    chances: Chances,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { page, chances, medium, request } = self;
        let support = page.setup.mesh.support();
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let (all, from) = (mask64x8::splat(simd, true), zero.each(support.from));
        let fresh = Tracked {
            page,
            chances,
            keep: Keep::new(simd),
            from,
            to: zero.each(support.to),
            way: from,
            number: zero,
            inside: all,
            goes_on: all,
            weights: [one; MOST_CHANNELS],
            shares: [[zero; 3]; MOST_CHANNELS],
            lookups: zero,
        };
        bank::run(
            simd,
            #[inline(always)]
            |_| fresh,
            [[zero; MOST_CHANNELS]; 2],
            #[inline(always)]
            |places, found| bank::of_channels(simd, medium, page.media.count, places, found),
            request,
        );
    }
}

/// Eight walks.
#[derive(Clone, Copy)]
struct Tracked<'a, S: Simd> {
    page: &'a Page<'a>,
    chances: Chances,
    keep: Keep<S>,
    from: f64x8<S>,
    to: f64x8<S>,
    way: f64x8<S>,
    number: f64x8<S>,
    inside: mask64x8<S>,
    goes_on: mask64x8<S>,
    /// The weight of each channel.
    weights: [f64x8<S>; MOST_CHANNELS],
    /// `μ_n/μ̄`, `μ_s/μ̄` and `μ_a/μ̄` of each.
    shares: [[f64x8<S>; 3]; MOST_CHANNELS],
    lookups: f64x8<S>,
}

impl<S: Simd> Particles<S> for Tracked<'_, S> {
    type Found = [f64x8<S>; MOST_CHANNELS];

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        let depth = -numbers.ln_uniform();
        self.number = numbers.uniform();
        self.way = depth.times_plus(depth.each(self.page.paths[0]), self.way);
        self.inside = self.way.below(self.to);
        // Beyond the end there is no field to look at.
        Lane::select(self.inside, self.way, self.from)
    }

    #[inline(always)]
    fn collide(&mut self, found: &Self::Found, _: &mut Numbers<S>) -> u64 {
        let Self { page, keep, inside, number, .. } = *self;
        let (count, one) = (page.media.count, number.each(1.0));
        let lookups = self.lookups + 1.0;
        keep.put(&mut self.lookups, inside, lookups);
        let t = Lane::select(inside, self.way, self.from);
        for (channel, &found) in found[..count].iter().enumerate() {
            let real = found / one.each(page.media.majorants[0]);
            let scattered = real * page.albedo(channel, t);
            self.shares[channel] = [one - real, scattered, real - scattered];
        }
        let [null, scattered, _] = self.chances.of_events(
            count,
            #[inline(always)]
            |channel| self.shares[channel],
            &self.weights,
        );
        let is_real = null.at_most(number);
        let absorbed = inside & (null + scattered).at_most(number);
        let chance = Lane::select(is_real, scattered, null);
        for channel in 0..count {
            let [n, s, _] = self.shares[channel];
            let weight = self.weights[channel] * (Lane::select(is_real, s, n) / chance);
            // An absorbed walk brings nothing.
            let weight = Lane::select(absorbed, one.each(0.0), weight);
            keep.put(&mut self.weights[channel], inside, weight);
        }
        self.goes_on = inside & !absorbed;
        (!self.goes_on).to_bitmask()
    }

    #[inline(always)]
    fn collect(&mut self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let weights = &self.weights[..self.page.media.count];
        left::draws(weights, &self.lookups, (ended, slots), buffer)
    }

    #[inline(always)]
    fn restart(&mut self, _: &mut Numbers<S>) {
        let (ended, keep, one) = (!self.goes_on, self.keep, self.way.each(1.0));
        keep.put(&mut self.way, ended, self.from);
        keep.put(&mut self.lookups, ended, one.each(0.0));
        for weight in &mut self.weights[..self.page.media.count] {
            keep.put(weight, ended, one);
        }
    }
}
