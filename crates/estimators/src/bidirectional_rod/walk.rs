//! Paths: two subpaths and their connection.
//!
//! ```text
//! the first s vertices by delta tracking from the light, the other r + 2 − s from the sensor, then
//! T̂ between the last ones: exp(−∫σ_t), or ∏ (1 − σ_t/σ̂) by ratio tracking
//! s = 0 and s = r + 2: all of it from one side, a hit of the light or of the sensor
//! ```
//!
//! Independent paths have subpaths of their own. Shared paths begin with one walk from either side. It ends when it
//! is absorbed, leaves, or has been scattered as often as the highest order. All techniques of all orders take its
//! first vertices.

use super::Method;
use super::path::Path;
use super::subpath::{LaneFunctions, RodTracker, Side, Subpath};
use crate::{Draw, Setup};
use media::sampling::{BothWays, FlightOverPieces, FlightWithGaps};
use media::{Extinction, Lookups};
use numeric::fused::compiled_once;
use numeric::pair::PAIR_WIDTH;
use numeric::rng::{Random, Stream};
use numeric::{Lane, Mask, ScalarLane, Span};
use theory::problems::bidirectional_rod::{BidirectionalValues, MAX_CHANNELS, Sensor};
use theory::problems::{BidirectionalRod, Problem};
use theory::rod::bidirectional::Combination;

/// Makes one draw.
#[inline(always)]
pub fn draw(
    method: Method,
    setup: &Setup<BidirectionalRod>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<BidirectionalValues> {
    compiled_once(
        #[inline(always)]
        || {
            let alone = OneLane(medium);
            if let Some(even) = setup.fields.sampling.with_gaps() {
                let begin = FlightWithGaps::new(0.0, even);
                through(
                    method,
                    RodTracker::new(setup, 0.0, [begin, begin.from_end()], alone),
                    random,
                )
            } else {
                let begin = FlightOverPieces::new(0.0, &setup.fields.sampling);
                through(
                    method,
                    RodTracker::new(setup, 0.0, [begin, begin.from_end()], alone),
                    random,
                )
            }
        },
    )
}

#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn through<L: ScalarLane, C: BothWays<L>>(
    method: Method,
    mut tracker: RodTracker<'_, L, C, impl LaneFunctions<L>>,
    random: &mut Stream,
) -> Draw<BidirectionalValues> {
    let count = draw_each(method, &mut tracker, true, random);
    let mut values = BidirectionalValues { at: [0.0; MAX_CHANNELS], count };
    for (value, drawn) in values.at[..count].iter_mut().zip(tracker.values) {
        *value = drawn.double();
    }
    Draw::free(values, tracker.lookups.double() as u32)
}

/// Lookups and exponentials of one lane.
pub struct OneLane<'a>(pub &'a Lookups<'a>);

impl<L: Lane> LaneFunctions<L> for OneLane<'_> {
    #[inline(always)]
    fn extinction(&self, t: L) -> L {
        self.0.extinction(t)
    }

    #[inline(always)]
    fn exp(&self, x: L) -> L {
        x.exp()
    }
}

/// Makes a draw of each lane in `which`: a path of each technique. Returns the number of channels.
#[inline(always)]
pub fn draw_each<L: Lane, C: BothWays<L>>(
    method: Method,
    tracker: &mut RodTracker<'_, L, C, impl LaneFunctions<L>>,
    which: L::Mask,
    random: &mut impl Random<L>,
) -> usize {
    let problem = &*tracker.setup.problem;
    let zero = tracker.lookups.each(0.0);
    (tracker.lookups, tracker.values[0]) = (zero, zero);
    let mut count = 0;
    if method.is_shared {
        let whole = [*problem.orders.end(), 1];
        tracker.walk(Side::Light, whole, which, random);
        tracker.walk(Side::Camera, whole, which, random);
    }
    for order in problem.orders.clone() {
        for s in method.combination.techniques(order) {
            let valid = make_paths(method, tracker, [order, s], which, random);
            let mut value = zero;
            if valid.any() {
                value = L::select(valid, method.value(&tracker.path), zero);
            }
            tracker.values[count] = value;
            count += 1;
        }
    }
    let mut sum = tracker.values[0];
    for &value in &tracker.values[1..count.max(1)] {
        sum = sum + value;
    }
    if !problem.has_shares {
        count = 0;
    }
    if count != 1 {
        tracker.values[count] = sum;
        count += 1;
    }
    count
}

/// Makes a path of each lane in `which` by a technique `[r, s]`, in the tracker. Returns the lanes that have one.
#[inline(always)]
pub fn make_paths<L: Lane, C: BothWays<L>>(
    method: Method,
    tracker: &mut RodTracker<'_, L, C, impl LaneFunctions<L>>,
    [order, s]: [usize; 2],
    which: L::Mask,
    random: &mut impl Random<L>,
) -> L::Mask {
    if !method.is_shared {
        walk_for(tracker, [order, s], which, random);
    }
    (tracker.path.order, tracker.path.light) = (order, s);
    join(tracker, method, which, random)
}

/// Makes the subpaths of a technique `[r, s]`. Lanes with too short a subpath from the light make none from the
/// sensor.
#[inline(always)]
fn walk_for<L: Lane, C: BothWays<L>>(
    tracker: &mut RodTracker<'_, L, C, impl LaneFunctions<L>>,
    [order, s]: [usize; 2],
    which: L::Mask,
    random: &mut impl Random<L>,
) {
    let [light, camera] = match s {
        0 => [[0, 0], [order, 1]],
        _ if s == order + 2 => [[order, 1], [0, 0]],
        _ => [[s - 1, 0], [order + 1 - s, 0]],
    };
    tracker.walk(Side::Light, light, which, random);
    let is_whole = tracker.subpaths[Side::Light as usize].reached[light[0]];
    tracker.walk(Side::Camera, camera, is_whole, random);
}

/// Joins the first vertices of two subpaths by a technique. Returns the lanes with a path: both subpaths have
/// enough vertices, a hit reaches its end, and the transmittance is not 0.
#[inline(always)]
fn join<L: Lane, C: BothWays<L>>(
    tracker: &mut RodTracker<'_, L, C, impl LaneFunctions<L>>,
    method: Method,
    which: L::Mask,
    random: &mut impl Random<L>,
) -> L::Mask {
    let (problem, path) = (&*tracker.setup.problem, &mut tracker.path);
    let (order, s) = (path.order, path.light);
    let is_transmitted = problem.sensor == Sensor::Transmitted;
    let is_hit = s == 0 || s == order + 2;
    // Scatterings that each of the two makes.
    let from_light = s.saturating_sub(1).min(order);
    let from_camera = order - from_light;
    let [light, camera] = &tracker.subpaths;
    let mut valid = which & light.reached[from_light] & camera.reached[from_camera];
    if s == 0 {
        valid &= camera.left[order] & !camera.is_forward[order];
    } else if is_hit {
        let is_forward = light.is_forward[order];
        valid &= light.left[order] & if is_transmitted { is_forward } else { !is_forward };
    }
    if !valid.any() {
        return valid;
    }
    gather(tracker.setup, [light, camera], path);
    if !is_hit && method.is_tracked {
        let (from, to) = (light.places[from_light], path.at[s]);
        let flying = (valid, path.is_forward[s - 1]);
        tracker.path.transmittance[s - 1] = tracker.connect(from, to, flying, random);
    }
    if !method.is_tracked {
        attenuate(problem, method, (&mut tracker.path, &tracker.field), valid);
    }
    if !is_hit {
        let result = tracker.path.transmittance[s - 1];
        valid &= result.each(0.0).below(result);
    }
    valid
}

/// Gathers the vertices of paths before they are connected.
#[inline(always)]
fn gather<L: Lane, P>(
    setup: &Setup<BidirectionalRod>,
    [light, camera]: [&Subpath<L, P>; 2],
    path: &mut Path<L>,
) {
    let (problem, support) = (&*setup.problem, setup.fields.mesh.support());
    let (order, s, one) = (path.order, path.light, path.at[0].each(1.0));
    let (all, is_transmitted) = (one.at_most(one), problem.sensor == Sensor::Transmitted);
    let from_light = s.saturating_sub(1).min(order);
    let from_camera = order - from_light;
    path.at[0] = one.each(support.from);
    path.at[order + 1] = one.each(if is_transmitted { support.to } else { support.from });
    for i in 0..from_light {
        path.at[i + 1] = light.at[i];
    }
    for i in 0..from_camera {
        path.at[order - i] = camera.at[i];
    }
    // A hit has one more segment than scatterings.
    for j in 0..from_light + usize::from(s == order + 2) {
        path.is_forward[j] = light.is_forward[j];
        path.transmittance[j] = light.nulls[j];
    }
    for j in 0..from_camera + usize::from(s == 0) {
        path.is_forward[order - j] = !camera.is_forward[j];
        path.transmittance[order - j] = camera.nulls[j];
    }
    if s >= 1 && s <= order + 1 {
        path.is_forward[s - 1] = match s {
            _ if s == order + 1 && is_transmitted => all,
            _ if s == order + 1 => !all,
            1 => all,
            _ => path.at[s - 1].below(path.at[s]),
        };
        path.transmittance[s - 1] = one;
    }
    for i in 0..order {
        let turns = path.is_forward[i] ^ path.is_forward[i + 1];
        let (on, back) = (one.each(problem.forward), one.each(1.0 - problem.forward));
        path.phase[i] = L::select(turns, back, on);
    }
}

/// `T̂` in closed form: of the connection, or of all segments where weights ask for them.
#[inline(always)]
fn attenuate<L: Lane>(
    problem: &BidirectionalRod,
    method: Method,
    (path, field): (&mut Path<L>, &impl LaneFunctions<L>),
    which: L::Mask,
) {
    let is_connected = path.light >= 1 && path.light <= path.order + 1;
    if matches!(method.combination, Combination::Full(_)) {
        for j in (0..=path.order).filter(|j| !is_connected || j + 1 != path.light) {
            let ends = [path.at[j], path.at[j + 1]];
            path.transmittance[j] = field.exp(minus_depths(problem, ends, which));
        }
    }
    if is_connected {
        let ends = [path.at[path.light - 1], path.at[path.light]];
        path.transmittance[path.light - 1] = field.exp(minus_depths(problem, ends, which));
    }
}

/// Minus the optical depths between distances, of the lanes in `which`; 0 in the others.
#[inline(always)]
fn minus_depths<L: Lane>(problem: &BidirectionalRod, [a, b]: [L; 2], which: L::Mask) -> L {
    let (mut from, mut to, mut result) = ([0.0; PAIR_WIDTH], [0.0; PAIR_WIDTH], [0.0; PAIR_WIDTH]);
    a.or_less(b).store(&mut from);
    a.or_more(b).store(&mut to);
    let mut bits = which.bits();
    while bits != 0 {
        let lane = bits.trailing_zeros() as usize % PAIR_WIDTH;
        bits &= bits - 1;
        result[lane] = -problem.medium().optical_depth(Span::new(from[lane], to[lane])).value;
    }
    a.load(&result)
}
