//! The driver of one walk, with one lookup at a time.

use super::{Met, Nowhere, Route, Walk};
use crate::kernels::Draw;
use media::body::MOST_CHANNELS;
use media::course::{BothWays, Even, Pieces};
use media::{Extinction, Lookups, Piecewise};
use numeric::geometry::Point;
use numeric::lane::fuses;
use numeric::rng::{Random, Stream};
use numeric::{Fused, Plain, Single};
use theory::problems::Channels;

/// Makes one draw.
#[inline(always)]
pub fn draw<V: Channels>(
    walk: &impl Walk,
    sampling: &Piecewise,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<V> {
    if fuses() {
        through::<Fused, V>(walk, sampling, medium, random)
    } else {
        through::<Plain, V>(walk, sampling, medium, random)
    }
}

/// Makes one draw of a walk that keeps its own position.
#[inline(always)]
pub fn draw_nowhere<V: Channels>(
    walk: &impl Walk,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<V> {
    if fuses() {
        follow::<Fused, _, V>(walk, Nowhere, medium, random)
    } else {
        follow::<Plain, _, V>(walk, Nowhere, medium, random)
    }
}

/// Makes one draw in any lane of one number.
#[inline(always)]
pub fn through<L: Single, V: Channels>(
    walk: &impl Walk,
    sampling: &Piecewise,
    medium: &Lookups,
    random: &mut impl Random<L>,
) -> Draw<V> {
    match sampling.even() {
        Some(even) => follow(walk, Even::new(L::of(0.0), even), medium, random),
        None => follow(walk, Pieces::new(L::of(0.0), sampling), medium, random),
    }
}

#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
fn follow<L: Single, W: Walk, V: Channels>(
    walk: &W,
    course: impl BothWays<L>,
    medium: &Lookups,
    random: &mut impl Random<L>,
) -> Draw<V> {
    let (zero, one) = (L::of(0.0), L::of(1.0));
    let mut state = walk.begin(one, true, random);
    let mut route = Route::new(course);
    let mut lookups = 0;
    let left = loop {
        let [depth, number] = walk.numbers(&mut state, random);
        let inside = walk.fly(&mut state, &mut route, depth);
        let mut on_shadow = [zero; MOST_CHANNELS];
        if W::CASTS {
            lookups += look_up_shadow(walk, &state, &mut on_shadow);
        }
        let (t, on_shadow) = (zero, &on_shadow[..]);
        let mut met = Met { inside, t, mean_free_path: t, extinction: t, on_shadow, number };
        if inside {
            lookups += 1;
            met.t = walk.distance(&state, &route);
            met.mean_free_path = walk.mean_free_path(&state, &route);
            met.extinction = medium.extinction(met.t);
        } else if !W::PAUSES {
            break true;
        }
        if !walk.collide(&mut state, &mut route, &met, random) {
            break !inside;
        }
    };
    if W::CASTS {
        lookups = walk.lookups(&state, L::of(f64::from(lookups))).double() as u32;
    }
    let value = |channel| walk.value(&state, left, channel).double();
    let defect = if W::HAS_DEFECT { walk.defect(&state, zero).double() } else { 0.0 };
    Draw { value: V::of(walk.channels(), value), lookups, defect }
}

/// Looks σ_t up on a shadow ray, if there is one; answers the number of lookups.
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
