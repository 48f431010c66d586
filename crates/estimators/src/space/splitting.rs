//! The driver of one walk that splits.
//!
//! At a collision that splits both the scattered particle and the transmitted one are followed, the scattered one
//! later. The draw is the sum of their scores.

use super::bank::Walk;
use super::particle::Splitting;
use super::tally::Tally;
use super::walk::{InSpace, State, Steps};
use numeric::Single;
use numeric::rng::Random;

/// Makes one draw: follows a walk and the particles that split off to their ends.
#[inline(always)]
pub fn follow<L: Single, T: Tally, S: Steps>(
    walk: &InSpace<T, S>,
    splitting: Splitting,
    look_up: impl Fn(Option<[L; 3]>) -> [L; 2],
    random: &mut impl Random<L>,
) -> State<L, T::Found<L>> {
    let mut state = walk.none(L::of(1.0));
    walk.restart(&mut state, random);
    walk.go_on(&mut state, 1, random);
    // Scattered particles that are followed later, and the splits behind each.
    let mut waiting = Vec::new();
    let (mut depth, mut total) = (0, 0);
    loop {
        let (flight, place) = walk.fly(&mut state, random);
        let met = look_up(<InSpace<T, S>>::inside(&flight).then_some(place));
        let at = walk.score(&mut state, &flight, met, random);
        if at.inside && splitting.splits(depth, total) {
            (depth, total) = (depth + 1, total + 1);
            let straight = walk.split(&mut state, &at);
            let goes_on = !straight.weight.equals(0.0);
            if !state.path.weight.equals(0.0) {
                walk.go_on(&mut state, 1, random);
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
        } else if !walk.decide(&mut state, &at, flight.depth, random) {
            walk.go_on(&mut state, 1, random);
            continue;
        }
        let Some(next) = waiting.pop() else { return state };
        (state.path, depth) = next;
    }
}
