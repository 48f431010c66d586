//! The driver of one walk, with one lookup at a time.

use super::{MAX_OUTCOME, MAX_SCORED, Nowhere, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use crate::Draw;
use media::body::MAX_CHANNELS;
use media::sampling::{BothWays, FlightOverPieces, FlightWithGaps};
use media::{Extinction, Lookups, Piecewise};
use numeric::ScalarLane;
use numeric::fused::compiled_once;
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
    compiled_once(
        #[inline(always)]
        || {
            through::<f64, _, V>(
                walk,
                sampling,
                #[inline(always)]
                |channel, t| medium.channel(channel).extinction(t),
                random,
            )
        },
    )
}

/// Makes one draw in any lane type of a single walk, given σ_t of a channel at a distance.
#[inline(always)]
pub fn through<L: ScalarLane, W: Walk, V: Channels>(
    walk: &W,
    sampling: &Piecewise,
    on_ray: impl Fn(usize, L) -> L,
    random: &mut impl Random<L>,
) -> Draw<V> {
    let in_space = in_doubles(walk);
    if W::IS_NOWHERE {
        return follow(walk, Nowhere, (on_ray, in_space), random);
    }
    match sampling.with_gaps() {
        Some(even) => {
            follow(walk, FlightWithGaps::new(L::of(0.0), even), (on_ray, in_space), random)
        }
        None => {
            follow(walk, FlightOverPieces::new(L::of(0.0), sampling), (on_ray, in_space), random)
        }
    }
}

/// Makes one draw of a walk with all its lookups in space, given the value of a field at a place.
#[inline(always)]
pub fn in_space<L: ScalarLane, V: Channels>(
    walk: &impl Walk,
    look_up: impl Fn(usize, [L; 3]) -> L,
    random: &mut impl Random<L>,
) -> Draw<V> {
    follow(walk, Nowhere, (|_, t| t, look_up), random)
}

/// The values of a walk's own fields in space.
#[inline(always)]
pub fn in_doubles<L: ScalarLane>(walk: &impl Walk) -> impl Fn(usize, [L; 3]) -> L {
    #[inline(always)]
    |number, [x, y, z]| L::of(walk.field(number, Point([x.double(), y.double(), z.double()])))
}

#[inline(always)]
fn follow<L: ScalarLane, W: Walk, V: Channels>(
    walk: &W,
    course: impl BothWays<L>,
    (on_ray, in_space): (impl Fn(usize, L) -> L, impl Fn(usize, [L; 3]) -> L),
    random: &mut impl Random<L>,
) -> Draw<V> {
    let (zero, one) = (L::of(0.0), L::of(1.0));
    let mut state = walk.begin(one, true, random);
    let mut route = Route::new(course);
    let (mut lookups, mut extinctions) = (0, [zero; MAX_CHANNELS]);
    let extinctions = &mut extinctions[..walk.media()];
    let mut sums = [zero; MAX_SCORED];
    let left = loop {
        let [depth, number] = walk.numbers(&mut state, random);
        if W::ON_RAY && W::IS_CHROMATIC {
            route.here.change(walk.mean_free_path(&state, &route));
        }
        let inside = walk.fly(&mut state, &mut route, depth);
        let mut there = [zero; MAX_CHANNELS];
        let there = &mut there[..walk.media()];
        if W::IN_SPACE {
            lookups += look_up_in_space(walk, &state, &in_space, there);
        }
        let (mut t, mut mean_free_path) = (zero, zero);
        if W::ON_RAY && inside {
            lookups += 1;
            t = walk.distance(&state, &route);
            mean_free_path = walk.mean_free_path(&state, &route);
            for (channel, result) in extinctions.iter_mut().enumerate() {
                *result = on_ray(channel, t);
            }
        }
        if !inside && !W::PAUSES {
            break true;
        }
        let extinction = extinctions[0];
        let (extinctions, in_space) = (&*extinctions, &*there);
        let collided = TentativeCollision {
            inside,
            t,
            mean_free_path,
            extinction,
            extinctions,
            in_space,
            number,
        };
        let before = state;
        let goes_on = walk.collide(&mut state, &mut route, &collided, random);
        if W::IS_FIXED && !goes_on {
            state = before;
        }
        if W::SCORES == Scores::Often && walk.scores(&state, !goes_on) {
            let (result, _) = score(walk, &state, true, zero);
            for (sum, result) in sums.iter_mut().zip(result) {
                *sum = *sum + result;
            }
        }
        if !goes_on {
            break !inside;
        }
    };
    match W::SCORES {
        Scores::AtOnce => scored(walk, &state, left, lookups),
        Scores::Later => {
            let lookups = counted(walk, &state, lookups);
            let (result, defect) = score(walk, &state, left, L::of(f64::from(lookups)));
            let value = V::of(walk.channels(), |channel| result[channel].double());
            Draw { value, lookups, defect: defect.double() }
        }
        Scores::Often => {
            let lookups = counted(walk, &state, lookups);
            Draw::free(V::of(walk.channels(), |channel| sums[channel].double()), lookups)
        }
    }
}

/// The draw of a walk that has ended and is scored at once.
#[inline(always)]
pub fn scored<L: ScalarLane, W: Walk, V: Channels>(
    walk: &W,
    state: &W::State<L>,
    left: bool,
    lookups: u32,
) -> Draw<V> {
    let value = V::of(walk.channels(), |channel| walk.value(state, left, channel).double());
    let defect = if W::HAS_DEFECT { walk.defect(state, L::of(0.0)).double() } else { 0.0 };
    Draw { value, lookups: counted(walk, state, lookups), defect }
}

/// The number of lookups of a walk, given those that its driver counted.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn counted<L: ScalarLane, W: Walk>(walk: &W, state: &W::State<L>, lookups: u32) -> u32 {
    if !W::PAUSES {
        return lookups;
    }
    walk.lookups(state, L::of(f64::from(lookups))).double() as u32
}

/// The score of the numbers that a walk leaves, and its defect.
#[inline(always)]
fn score<L: ScalarLane, W: Walk>(
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

/// Looks fields up in space, if the walk has a collision there; returns the number of lookups.
#[inline(always)]
pub fn look_up_in_space<L: ScalarLane, W: Walk>(
    walk: &W,
    state: &W::State<L>,
    look_up: &impl Fn(usize, [L; 3]) -> L,
    result: &mut [L],
) -> u32 {
    let (inside, place) = walk.in_space(state);
    if inside {
        for (number, result) in result.iter_mut().enumerate() {
            *result = look_up(number, place);
        }
    }
    u32::from(inside)
}
