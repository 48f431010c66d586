//! Free flights of another program: conventions for a flight that leaves.
//!
//! ```text
//! S, anything beyond it, +∞, −1   the flight leaves the ray: it counts as the ray's length S
//! NaN, any other negative number  no distance: the draw fails, and the message explains the convention
//! ```
//!
//! A number that rounding may have moved below S counts as S. If no flight leaves although many should, and another
//! number comes in their place, such as 0 or the last collision, the message names that number.

use crate::stats::ties;
use numeric::digits::short;
use numeric::order;

/// A flight that leaves, as written by a program that has no other mark.
const LEFT: f64 = -1.0;
/// Error of a distance in single precision, relative to the positions of which it is the difference: four
/// roundings.
const SINGLE: f64 = 2.4e-7;
/// Minimum number of flights that are evidence of a wrong convention.
const FEWEST: f64 = 20.0;

/// Properties of flights along a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayFlights {
    /// S, the length of the ray.
    pub length: f64,
    /// The position of the ray's beginning: it limits the resolution of positions.
    pub from: f64,
    /// The probability that a flight leaves.
    pub escape: f64,
}

/// Flights with marks on those that leave.
pub(super) struct Marked {
    /// Marked by the length of the ray.
    pub(super) at_end: Vec<f64>,
    /// Marked by infinity.
    pub(super) beyond: Vec<f64>,
}

/// Flights, with the findings from their first block.
pub(super) struct FlightFindings {
    flights: RayFlights,
    rounding: f64,
    /// Distance from which on a flight has left; found from the first block.
    near: Option<f64>,
    left: u64,
    seen: u64,
    /// True if all flights are numbers of single precision.
    pub(super) is_single: bool,
    /// The most frequent number among the first flights that do not leave, and its share, if it comes ten times as
    /// often as any other.
    most_frequent: (f64, f64),
}

impl FlightFindings {
    pub(super) fn new(flights: RayFlights, rounding: f64) -> Self {
        let (near, left, seen, most_frequent) = (None, 0, 0, (f64::NAN, 0.0));
        Self { flights, rounding, near, left, seen, is_single: true, most_frequent }
    }

    /// The flights, once with the ray's length in place of all that leave, and once with infinity.
    pub(super) fn marked(&mut self, block: &[f64]) -> Marked {
        let RayFlights { length, from, .. } = self.flights;
        self.is_single &= ties::all_single_precision(block);
        let single = if self.is_single { SINGLE } else { 0.0 };
        let slack = self.rounding.max(single) * (from.abs() + length);
        let is_first = self.near.is_none();
        let near = *self.near.get_or_insert(length - slack);
        let leaves = |x: f64| x >= near || is_left(x);
        let put = |left: f64| -> Vec<f64> {
            block.iter().map(|&x| if leaves(x) { left } else { x }).collect()
        };
        let marked = Marked { at_end: put(length), beyond: put(f64::INFINITY) };
        let stay: Vec<f64> = block.iter().copied().filter(|&x| !leaves(x)).collect();
        self.seen += block.len() as u64;
        self.left += (block.len() - stay.len()) as u64;
        if is_first && !block.is_empty() {
            let (x, times) = most_frequent(stay);
            self.most_frequent = (x, times as f64 / block.len() as f64);
        }
        marked
    }

    /// Message if flights that leave cannot be distinguished from distances.
    pub(super) fn wrong(&self) -> Option<String> {
        let (x, share) = self.most_frequent;
        let RayFlights { escape, .. } = self.flights;
        let is_shown = escape * self.seen as f64 >= FEWEST && share * self.seen as f64 >= FEWEST;
        let is_that_of_leaving = 0.5 * escape <= share && share <= 2.0 * escape;
        if self.left > 0 || !is_shown || !is_that_of_leaving {
            return None;
        }
        let percent = |share: f64| short(100.0 * share, 3);
        Some(format!(
            "flights that leave: there are none, although {} % should leave, and {} % of the first draws are {x}; {}",
            percent(escape),
            percent(share),
            self.cure()
        ))
    }

    /// Conventions for a flight that leaves, in words.
    pub(super) fn cure(&self) -> String {
        format!(
            "write a flight that leaves as {}, the length of the ray, as a larger number, inf or -1",
            self.flights.length
        )
    }
}

#[allow(clippy::float_cmp)] // a mark, not a result
fn is_left(x: f64) -> bool {
    x == LEFT
}

/// The number that comes ten times as often as any other, and its count; a count of 0 without such a number.
fn most_frequent(mut values: Vec<f64>) -> (f64, usize) {
    order::ascend(&mut values);
    let (mut maximum, mut second) = ((f64::NAN, 0), 0);
    for group in values.chunk_by(|a, b| a == b) {
        if group.len() > maximum.1 {
            (maximum, second) = ((group[0], group.len()), maximum.1);
        } else {
            second = second.max(group.len());
        }
    }
    if maximum.1 >= 10 * second { maximum } else { (f64::NAN, 0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLIGHTS: RayFlights = RayFlights { length: 0.7, from: 0.0, escape: 0.25 };
    const INFINITY: f64 = f64::INFINITY;

    fn beyond(ends: &mut FlightFindings, block: &[f64]) -> Vec<f64> {
        ends.marked(block).beyond
    }

    #[test]
    fn every_way_to_write_a_flight_that_leaves_is_read() {
        let mut ends = FlightFindings::new(FLIGHTS, 1e-12);
        let marked = ends.marked(&[0.1, 0.7, 0.70001, f64::MAX, INFINITY, -1.0]);
        assert_eq!(marked.at_end, [0.1, 0.7, 0.7, 0.7, 0.7, 0.7]);
        assert_eq!(marked.beyond, [0.1, INFINITY, INFINITY, INFINITY, INFINITY, INFINITY]);
        // A number that is no distance stays.
        assert_eq!(beyond(&mut ends, &[-0.5, -INFINITY, 0.0]), [-0.5, -INFINITY, 0.0]);
        assert!(beyond(&mut ends, &[f64::NAN])[0].is_nan());
    }

    #[test]
    fn rounding_to_single_precision_moves_no_flight_from_the_end() {
        let short = f64::from(0.7f32);
        assert!(short < 0.7);
        let mut ends = FlightFindings::new(FLIGHTS, 1e-12);
        assert_eq!(beyond(&mut ends, &[0.25, short]), [0.25, INFINITY]);
        // Beside doubles it is a collision next to the end.
        let mut ends = FlightFindings::new(FLIGHTS, 1e-12);
        assert_eq!(beyond(&mut ends, &[0.1, short]), [0.1, short]);
    }

    #[test]
    fn a_number_in_place_of_the_flights_that_leave_is_named() {
        let flights = |left: f64| -> Vec<f64> {
            (0..400).map(|i| if i % 4 == 0 { left } else { 1e-3 * f64::from(i) }).collect()
        };
        for wrong in [0.0, 0.5] {
            let mut ends = FlightFindings::new(FLIGHTS, 1e-12);
            ends.marked(&flights(wrong));
            let said = ends.wrong().expect("a wrong convention");
            assert!(said.contains(&format!("25 % of the first draws are {wrong};")), "{said}");
        }
        let mut ends = FlightFindings::new(FLIGHTS, 1e-12);
        ends.marked(&flights(0.7));
        assert_eq!(ends.wrong(), None);
        // Many frequent numbers are no sign of a wrong convention.
        let mut ends = FlightFindings::new(FLIGHTS, 1e-12);
        ends.marked(&[0.1, 0.2, 0.3].repeat(200));
        assert_eq!(ends.wrong(), None);
    }
}
