//! The driver of one walk that splits.
//!
//! At a collision that splits both the scattered particle and the transmitted one are followed, the scattered one
//! later. The draw is the sum of their scores.

use super::particle::Splitting;
use super::tally::Tally;
use super::walk::{InSpace, Path};
use crate::Draw;
use crate::walks::Walk;
use crate::walks::plain::{look_up_in_space, scored};
use numeric::ScalarLane;
use numeric::rng::Random;
use theory::problems::Channels;

/// Scattered particles that are followed later, and the number of splits behind each.
pub type Waiting<L> = Vec<(Path<L>, u32)>;

/// Makes one draw: follows a walk and the particles that split off to their ends. `waiting` is empty before and after
/// it; its memory serves many draws.
#[inline(always)]
pub fn follow<L: ScalarLane, V: Channels, T: Tally>(
    walk: &InSpace<T>,
    splitting: Splitting,
    look_up: impl Fn(usize, [L; 3]) -> L,
    random: &mut impl Random<L>,
    waiting: &mut Waiting<L>,
) -> Draw<V> {
    let mut state = walk.begin(L::of(1.0), true, random);
    let (mut depth, mut total, mut lookups) = (0, 0, 0);
    loop {
        let [flight, _] = walk.numbers(&mut state, random);
        walk.advance(&mut state, flight);
        let mut fields = [L::of(0.0); 2];
        let fields = &mut fields[..walk.media()];
        lookups += look_up_in_space(walk, &state, &look_up, fields);
        let at = walk.score(&mut state, fields, random);
        if at.inside && splitting.splits(depth, total) {
            (depth, total) = (depth + 1, total + 1);
            let straight = walk.split(&mut state, &at);
            let goes_on = !straight.weight.equals(0.0);
            if !state.path.weight.equals(0.0) {
                walk.go_on(&mut state, random);
                if goes_on {
                    waiting.push((state.path, depth));
                    state.path = straight;
                }
                continue;
            }
            state.path = straight;
            if goes_on {
                continue;
            }
        } else if !walk.decide(&mut state, &at, random) {
            continue;
        }
        let Some(next) = waiting.pop() else { return scored(walk, &state, false, lookups) };
        (state.path, depth) = next;
        state.ended = false;
    }
}
