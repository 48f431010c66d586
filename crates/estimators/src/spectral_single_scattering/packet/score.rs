//! Draws from what walks have left, eight at a time.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::shadow::inside;
use super::{REST, World};
use crate::kernels::packet::left::{Left, Made};
use crate::setup::walker::Walker;
use crate::space::exit::rows;
use media::Volume;
use media::body::MOST_CHANNELS;
use numeric::geometry::{Point, Ray};
use numeric::pack::WIDTH;
use numeric::{Lane, Span};

/// Makes draws of what walks have left.
#[inline(always)]
pub fn all<S: Simd, const ALL: bool>(simd: S, world: &World<ALL>, left: &Left, mut made: Made) {
    let (media, zero) = (&world.media, f64x8::splat(simd, 0.0));
    let is_balanced = matches!(world.walker, Walker::Mis(_));
    let mut found = [zero; MOST_CHANNELS];
    let found = &mut found[..media.count];
    for first in made.packs() {
        let (hero, length) = (left.row(simd, 0, first), left.row(simd, 1, first));
        let (lookups, s) = (left.row(simd, 2, first), left.row(simd, 3, first));
        let is_lit = zero.at_most(hero);
        let mut through = [zero; MOST_CHANNELS];
        let through = &mut through[..media.count];
        if world.tracks {
            let before = REST + if ALL { media.count } else { 0 };
            for (channel, through) in through.iter_mut().enumerate() {
                *through = left.row(simd, before + channel, first);
            }
        } else {
            exact(world, (s, hero), is_lit, through);
        }
        if ALL {
            for (channel, found) in found.iter_mut().enumerate() {
                *found = left.row(simd, REST + channel, first);
            }
            media.common(hero, [length, lookups], found);
            let mut density = zero;
            for (channel, found) in found.iter_mut().enumerate() {
                let (common, lit) = (*found, &world.problem.channels[channel]);
                density += common * media.chances[channel];
                *found = common * through[channel] * lit.source(s) / zero.each(lit.albedo());
            }
            let density = if is_balanced { density } else { zero.each(1.0) };
            for found in found.iter_mut() {
                *found = Lane::select(is_lit, *found / density, zero);
            }
        } else {
            for (channel, found) in found.iter_mut().enumerate() {
                let (lit, chance) = (&world.problem.channels[channel], media.chances[channel]);
                let alone = lit.source(s) / zero.each(lit.albedo()) * through[channel];
                *found = Lane::select(is_number(hero, channel), alone / zero.each(chance), zero);
            }
        }
        made.write(first, found, [lookups, zero]);
    }
    made.end();
}

/// Which heroes have a number.
#[inline(always)]
fn is_number<S: Simd>(hero: f64x8<S>, channel: usize) -> mask64x8<S> {
    let number = hero.each(channel as f64);
    hero.at_most(number) & number.at_most(hero)
}

/// Transmittances in closed form of shadow rays from distances along the ray, of the heroes alone or, `ALL`, of all
/// channels, for those that a mask names.
#[inline(always)]
fn exact<S: Simd, const ALL: bool>(
    world: &World<ALL>,
    (s, hero): (f64x8<S>, f64x8<S>),
    is_lit: mask64x8<S>,
    through: &mut [f64x8<S>],
) {
    let problem = world.problem;
    let ([from, to], lines) = inside(&problem.channels[0], is_lit, s);
    let is_blocked = is_lit & from.below(to);
    let [origin, direction] = lines;
    let ([a, b, c], [x, y, z]) = (origin, direction);
    let rays = [a, b, c, x, y, z, from, to];
    let lines = [rows(origin), rows(direction)];
    let [from_row, to_row, _] = rows([from, to, to]);
    for (channel, through) in through.iter_mut().enumerate() {
        let lit = &problem.channels[channel];
        let which = if ALL { is_blocked } else { is_blocked & is_number(hero, channel) };
        let known = match lit.volume().single_value() {
            Some(value) => Some((to - from) * value),
            None => world.in_space[channel].depths(&rays),
        };
        let depth = match known {
            Some(depth) => depth,
            None => s.replaced(
                #[inline(always)]
                |depths| {
                    let ends = [&from_row, &to_row];
                    optical_depths(lit.volume(), &lines, ends, which.to_bitmask(), depths);
                },
            ),
        };
        *through = Lane::select(which, (-depth).exp(), s.each(1.0));
    }
}

/// Ray by ray, for those whose bits are set.
#[inline(never)]
fn optical_depths(
    volume: &Volume,
    lines: &[[[f64; WIDTH]; 3]; 2],
    [from, to]: [&[f64; WIDTH]; 2],
    which: u64,
    depths: &mut [f64],
) {
    for (lane, depth) in depths.iter_mut().enumerate().filter(|(lane, _)| which >> lane & 1 == 1) {
        let [origin, direction] = lines.map(|rows| Point(rows.map(|row| row[lane])));
        let (inside, length) = (Span::new(from[lane], to[lane]), f64::INFINITY);
        let profile = volume.along(&Ray { origin, direction, length }, inside);
        *depth = profile.optical_depth(inside).value;
    }
}
