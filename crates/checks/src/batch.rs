//! Batch of draws, counted if they take few values.
//!
//! Walks that end as 0 or 1, products of equal factors, and the numbers of lookups of most experiments take far fewer
//! values than there are draws. A check then observes each value once.

use std::cell::OnceCell;

use estimators::DrawBuffer;
use gate::stats::{Census, Tally};
use numeric::fused::in_fused_code;

/// Number of draws that are observed at once.
const PART: usize = 1024;

/// Appends a y for each of the draws to the second argument.
pub type Observer<T> = Box<dyn Fn(&T, &mut Vec<f64>) + Send + Sync>;

/// Function of a draw that a check observes.
pub enum Observe {
    /// Value of one channel.
    Value(usize, Observer<[f64]>),
    /// Number of lookups.
    Lookups(Observer<[u32]>),
    /// Draw as a whole.
    Draw(Observer<DrawBuffer>),
}

impl Observe {
    /// Observes `f` of each value of a channel with the vector registers of the hardware: `f` must be inlined.
    pub fn each_value(channel: usize, f: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        let observer = move |values: &[f64], y: &mut Vec<f64>| {
            // Not by `extend`, which is compiled for the baseline target.
            let first = y.len();
            y.resize(first + values.len(), 0.0);
            in_fused_code(
                #[inline(always)]
                || y[first..].iter_mut().zip(values).for_each(|(y, &x)| *y = f(x)),
            );
        };
        Self::Value(channel, Box::new(observer))
    }
}

/// Draws with counts of their values.
pub struct Batch<'a> {
    /// The draws.
    pub draws: &'a DrawBuffer,
    /// Counts of each channel's values; `None` where they are many.
    pub values: Vec<Option<Census<f64>>>,
    /// Counts of the numbers of lookups; `None` where they are many.
    pub lookups: Option<Census<u32>>,
    /// Number of draws in each class of the experiment's distances, counted on first use.
    distances: OnceCell<Vec<f64>>,
}

impl<'a> Batch<'a> {
    /// Counts the values of each channel and the numbers of lookups, where they are few.
    pub fn new(draws: &'a DrawBuffer) -> Self {
        let values = draws.values.iter().map(|values| Census::<f64>::of(values)).collect();
        let lookups = Census::<u32>::of(&draws.lookups);
        Self { draws, values, lookups, distances: OnceCell::new() }
    }

    /// Passes the y of each value with its count, or the y of each draw, to a callback. Draws come in parts that stay
    /// in the cache; `y` is the buffer.
    pub fn observe(
        &self,
        observe: &Observe,
        y: &mut Vec<f64>,
        mut absorb: impl FnMut(&mut [f64], Option<&[f64]>),
    ) {
        match observe {
            Observe::Value(channel, observer) => {
                let (values, census) = (&self.draws.values[*channel], &self.values[*channel]);
                in_parts(values, census.as_ref(), observer, y, &mut absorb);
            }
            Observe::Lookups(observer) => {
                let (lookups, census) = (&self.draws.lookups, &self.lookups);
                in_parts(lookups, census.as_ref(), observer, y, &mut absorb);
            }
            Observe::Draw(observer) => {
                y.clear();
                observer(self.draws, y);
                absorb(y, None);
            }
        }
    }

    /// Adds the number of draws in each class of the experiment's distances, counted once for all checks.
    pub fn add_distances(&self, count: impl Fn(&DrawBuffer) -> Vec<f64>, sums: &mut [f64]) {
        let counts = self.distances.get_or_init(|| count(self.draws));
        debug_assert_eq!(
            sums.len(),
            counts.len(),
            "an experiment has one distribution of distances"
        );
        sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
    }

    /// Returns the tally of a channel.
    pub fn tally(&self, channel: usize, shift: f64, scale: f64) -> Tally {
        match &self.values[channel] {
            Some(census) => Tally::counted(census, shift, scale),
            None => Tally::of(&self.draws.values[channel], shift, scale),
        }
    }

    /// Returns the tally of the lookups about their expected number.
    pub fn tally_of_lookups(&self, expected: f64) -> Tally {
        if let Some(census) = &self.lookups {
            return Tally::counted(census, expected, 1.0);
        }
        let counts: Vec<f64> = self.draws.lookups.iter().map(|&n| f64::from(n)).collect();
        Tally::of(&counts, expected, 1.0)
    }
}

/// Passes each value with its count to a callback, or each draw with a count of 1.
pub fn each_value<T: Copy>(census: Option<&Census<T>>, draws: &[T], mut count: impl FnMut(T, f64)) {
    match census {
        Some(census) => census.values.iter().zip(&census.times).for_each(|(&x, &n)| count(x, n)),
        None => draws.iter().for_each(|&x| count(x, 1.0)),
    }
}

fn in_parts<T>(
    draws: &[T],
    census: Option<&Census<T>>,
    observer: &Observer<[T]>,
    y: &mut Vec<f64>,
    absorb: &mut impl FnMut(&mut [f64], Option<&[f64]>),
) {
    let mut see = |part: &[T], times: Option<&[f64]>| {
        y.clear();
        observer(part, y);
        absorb(y, times);
    };
    match census {
        Some(census) => see(&census.values, Some(&census.times)),
        None => draws.chunks(PART).for_each(|part| see(part, None)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimators::Draw;

    fn buffer(value: impl Fn(u32) -> f64) -> DrawBuffer {
        let mut buffer = DrawBuffer::new(1);
        buffer.make_room(500);
        (0..500).for_each(|i| buffer.put(i as usize, &Draw::free([value(i)], i % 5)));
        buffer
    }

    /// Returns the sum of the y's, from counted values or from draws.
    fn sum(batch: &Batch, observe: &Observe) -> (bool, f64) {
        let (mut few, mut sum) = (false, 0.0);
        batch.observe(observe, &mut Vec::new(), |y, times| {
            few = times.is_some();
            let times = |i: usize| times.map_or(1.0, |times| times[i]);
            sum += y.iter().enumerate().map(|(i, y)| y * times(i)).sum::<f64>();
        });
        (few, sum)
    }

    #[test]
    fn few_values_and_many_give_the_same_sums() {
        let (few, many) = (buffer(|i| f64::from(i % 3)), buffer(|i| f64::from(i).sqrt()));
        let value = Observe::Value(0, Box::new(|x, y| y.extend(x.iter().map(|x| x + 1.0))));
        let lookups =
            Observe::Lookups(Box::new(|n, y| y.extend(n.iter().map(|&n| f64::from(n) - 1.0))));
        let draw = Observe::Draw(Box::new(|draws, y| y.extend(&draws.values[0])));
        let batch = Batch::new(&few);
        assert_eq!(sum(&batch, &value), (true, 999.0));
        assert_eq!(sum(&batch, &lookups), (true, 500.0));
        assert_eq!(sum(&batch, &draw), (false, 499.0));
        assert_eq!(batch.tally(0, 0.0, 1.0).moments().map(|m| m.mean), Some(499.0 / 500.0));
        assert_eq!(batch.tally_of_lookups(2.0).moments().map(|m| m.mean), Some(0.0));
        let batch = Batch::new(&many);
        let plain: f64 = many.values[0].iter().map(|x| x + 1.0).sum();
        assert_eq!(sum(&batch, &value), (false, plain));
    }
}
