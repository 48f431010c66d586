//! The driver of one walk, with one lookup at a time.

use std::marker::PhantomData;

use super::{MAX_OUTCOME, MAX_SCORED, Met, Nowhere, Route, SOME_LEFT, Scores, Walk};
use crate::kernels::Draw;
use media::body::MOST_CHANNELS;
use media::course::{BothWays, Even, Pieces};
use media::{Extinction, Lookups, Piecewise};
use numeric::Single;
use numeric::fused::{Loop, in_own_rounding};
use numeric::geometry::Point;
use numeric::rng::{Random, Stream};
use theory::problems::Channels;

/// Makes one draw.
#[inline(always)]
pub fn draw<V: Channels>(
    walk: &impl Walk,
    sampling: &Piecewise,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<V> {
    in_own_rounding(One { walk, sampling, medium, random, values: PhantomData })
}

struct One<'a, W, V> {
    walk: &'a W,
    sampling: &'a Piecewise,
    medium: &'a Lookups<'a>,
    random: &'a mut Stream,
    values: PhantomData<V>,
}

impl<W: Walk, V: Channels> Loop for One<'_, W, V> {
    type Output = Draw<V>;

    #[inline(always)]
    fn run<L: Single>(self) -> Draw<V> {
        let Self { walk, sampling, medium, random, .. } = self;
        through::<L, W, V>(
            walk,
            sampling,
            #[inline(always)]
            |channel, t| medium.channel(channel).extinction(t),
            random,
        )
    }
}

/// Makes one draw in any lane type of a single walk, given σ_t of a channel at a distance.
#[inline(always)]
pub fn through<L: Single, W: Walk, V: Channels>(
    walk: &W,
    sampling: &Piecewise,
    look_up: impl Fn(usize, L) -> L,
    random: &mut impl Random<L>,
) -> Draw<V> {
    if W::IS_NOWHERE {
        return follow(walk, Nowhere, look_up, random);
    }
    match sampling.even() {
        Some(even) => follow(walk, Even::new(L::of(0.0), even), look_up, random),
        None => follow(walk, Pieces::new(L::of(0.0), sampling), look_up, random),
    }
}

#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
fn follow<L: Single, W: Walk, V: Channels>(
    walk: &W,
    course: impl BothWays<L>,
    look_up: impl Fn(usize, L) -> L,
    random: &mut impl Random<L>,
) -> Draw<V> {
    let (zero, one) = (L::of(0.0), L::of(1.0));
    let mut state = walk.begin(one, true, random);
    let mut route = Route::new(course);
    let (mut lookups, mut extinctions) = (0, [zero; MOST_CHANNELS]);
    let extinctions = &mut extinctions[..walk.media()];
    let mut sums = [zero; MAX_SCORED];
    let left = loop {
        let [depth, number] = walk.numbers(&mut state, random);
        if W::IS_CHROMATIC {
            route.here.change(walk.mean_free_path(&state, &route));
        }
        let inside = walk.fly(&mut state, &mut route, depth);
        let mut on_shadow = [zero; MOST_CHANNELS];
        if W::CASTS {
            lookups += look_up_shadow(walk, &state, &mut on_shadow);
        }
        let (mut t, mut mean_free_path) = (zero, zero);
        if inside {
            lookups += 1;
            t = walk.distance(&state, &route);
            mean_free_path = walk.mean_free_path(&state, &route);
            for (channel, found) in extinctions.iter_mut().enumerate() {
                *found = look_up(channel, t);
            }
        } else if !W::PAUSES {
            break true;
        }
        let extinction = extinctions[0];
        let (extinctions, on_shadow) = (&*extinctions, &on_shadow[..]);
        let met = Met { inside, t, mean_free_path, extinction, extinctions, on_shadow, number };
        let goes_on = walk.collide(&mut state, &mut route, &met, random);
        if W::SCORES == Scores::Often && walk.scores(&state, !goes_on) {
            let (found, _) = score(walk, &state, true, zero);
            for (sum, found) in sums.iter_mut().zip(found) {
                *sum = *sum + found;
            }
        }
        if !goes_on {
            break !inside;
        }
    };
    if W::CASTS {
        lookups = walk.lookups(&state, L::of(f64::from(lookups))).double() as u32;
    }
    let count = walk.channels();
    match W::SCORES {
        Scores::AtOnce => {
            let value = |channel| walk.value(&state, left, channel).double();
            let defect = if W::HAS_DEFECT { walk.defect(&state, zero).double() } else { 0.0 };
            Draw { value: V::of(count, value), lookups, defect }
        }
        Scores::Later => {
            let (found, defect) = score(walk, &state, left, L::of(f64::from(lookups)));
            let value = V::of(count, |channel| found[channel].double());
            Draw { value, lookups, defect: defect.double() }
        }
        Scores::Often => Draw::free(V::of(count, |channel| sums[channel].double()), lookups),
    }
}

/// The score of the numbers that a walk leaves, and its defect.
#[inline(always)]
fn score<L: Single, W: Walk>(
    walk: &W,
    state: &W::State<L>,
    left: bool,
    lookups: L,
) -> ([L; MAX_SCORED], L) {
    let (mut numbers, mut values) = ([lookups; MAX_OUTCOME], [lookups; MAX_SCORED]);
    let (mut count, mut some) = (0, [lookups; SOME_LEFT]);
    for &number in walk.leaves(state, &mut some).into_iter().flatten() {
        numbers[count] = number;
        count += 1;
    }
    let defect = walk.score(&numbers[..count], left, lookups, &mut values[..walk.channels()]);
    (values, defect)
}

/// Looks σ_t up on a shadow ray, if there is one; returns the number of lookups.
#[inline(always)]
fn look_up_shadow<L: Single, W: Walk>(
    walk: &W,
    state: &W::State<L>,
    found: &mut [L; MOST_CHANNELS],
) -> u32 {
    let (inside, place) = walk.on_shadow_rays(state);
    if inside {
        for (channel, found) in found[..walk.media()].iter_mut().enumerate() {
            let [x, y, z] = place;
            let place = Point([x.double(), y.double(), z.double()]);
            *found = L::of(walk.shadow_extinction(channel, place));
        }
    }
    u32::from(inside)
}
