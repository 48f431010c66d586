//! Draws of an experiment, summed up, and their error after growing numbers of draws.
//!
//! ```text
//! error(n) = √(mean over rounds of (mean of the round's first n draws − T)²),  n = 64, 128, …
//! ```
//!
//! Rounds are independent, so that the error over several is smoother than |mean − T| of one. Where
//! theory has a variance, it should follow √(V/n).

use crate::plan::PlannedExperiment;
use estimators::DrawBuffer;
use gate::stats::Tally;

/// The first point of a curve.
const FIRST: u64 = 64;

/// Draws of all rounds.
#[derive(Debug, Clone)]
pub struct BenchDraws {
    /// Numbers of draws at which the error is looked at.
    pub looks: Vec<u64>,
    /// One entry per channel.
    pub channels: Vec<ChannelSample>,
    /// Lookups of all draws, as they are.
    pub lookups: Tally,
    /// Number of draws of this round so far.
    drawn: u64,
}

/// Draws of one channel.
#[derive(Debug, Clone)]
pub struct ChannelSample {
    /// The exact answer.
    truth: f64,
    /// Draws of all rounds, about the truth and in units of it.
    pub tally: Tally,
    /// `errors[round][look]`: (mean − T)/T, signed.
    pub errors: Vec<Vec<f64>>,
    /// Draws of this round, as in `tally`.
    round: Tally,
}

/// Error over the rounds after a number of draws, relative to the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Error {
    /// Root mean square.
    pub typical: f64,
    /// Minimum over the rounds.
    pub least: f64,
    /// Maximum over the rounds.
    pub most: f64,
}

impl BenchDraws {
    /// Returns an empty sample for an experiment that makes this number of draws in a round.
    pub fn of(planned: &PlannedExperiment, draws: u64) -> Self {
        let truths = planned.outcome.as_ref().map_or_else(
            |_| Vec::new(),
            |ready| ready.prediction.channels.iter().map(|channel| channel.truth.value).collect(),
        );
        Self::about(&truths, draws)
    }

    /// Returns an empty sample about these truths, one per channel.
    pub fn about(truths: &[f64], draws: u64) -> Self {
        let doubled = std::iter::successors(Some(FIRST), |n| n.checked_mul(2));
        let mut looks: Vec<u64> = doubled.take_while(|&n| n < draws).collect();
        looks.push(draws);
        let channel = |&truth: &f64| ChannelSample {
            truth,
            tally: Tally::default(),
            errors: Vec::new(),
            round: Tally::default(),
        };
        let channels = truths.iter().map(channel).collect();
        Self { looks, channels, lookups: Tally::default(), drawn: 0 }
    }

    /// Begins a round.
    pub fn begin(&mut self) {
        self.drawn = 0;
        for channel in &mut self.channels {
            channel.round = Tally::default();
            channel.errors.push(Vec::with_capacity(self.looks.len()));
        }
    }

    /// Adds draws of the round, and looks at the error where a look is due.
    pub fn absorb(&mut self, buffer: &DrawBuffer) {
        let (before, count) = (self.drawn, buffer.lookups.len() as u64);
        let mut at = 0;
        let due = |look: &&u64| (before + 1..=before + count).contains(look);
        let looks = self.looks.iter().filter(due).map(|look| (look - before, true));
        for (end, is_look) in looks.chain([(count, false)]) {
            #[allow(clippy::cast_possible_truncation)] // within a buffer
            let part = at as usize..end as usize;
            for (channel, values) in self.channels.iter_mut().zip(&buffer.values) {
                let truth = channel.truth;
                channel.round.merge(&Tally::of(&values[part.clone()], truth, truth));
                if is_look && let Some(errors) = channel.errors.last_mut() {
                    errors.extend(channel.round.moments().map(|moments| moments.mean));
                }
            }
            at = end;
        }
        self.drawn += count;
        let counts: Vec<f64> = buffer.lookups.iter().map(|&lookups| f64::from(lookups)).collect();
        self.lookups.merge(&Tally::of(&counts, 0.0, 1.0));
    }

    /// Ends a round.
    pub fn end(&mut self) {
        for channel in &mut self.channels {
            channel.tally.merge(&channel.round);
        }
    }
}

impl ChannelSample {
    /// Returns the error at a look; `None` before the first round has reached it.
    pub fn error(&self, look: usize) -> Option<Error> {
        let sizes = || self.errors.iter().filter_map(|round| Some(round.get(look)?.abs()));
        let n = sizes().count();
        let typical = (sizes().map(|size| size * size).sum::<f64>() / n as f64).sqrt();
        let least = sizes().reduce(f64::min)?;
        let most = sizes().reduce(f64::max)?;
        Some(Error { typical, least, most })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn buffer(values: &[f64]) -> DrawBuffer {
        let mut buffer = DrawBuffer::new(1);
        buffer.values[0].extend(values);
        buffer.lookups.extend(values.iter().map(|_| 3));
        buffer
    }

    #[test]
    fn looks_fall_where_they_are_due_however_the_draws_arrive() {
        let values: Vec<f64> = (0..200_u32).map(|i| 2.0 + f64::from(i % 7)).collect();
        let mean = |n: usize| values[..n].iter().sum::<f64>() / n as f64;
        for length in [200, 64, 37] {
            let mut sample = BenchDraws::about(&[2.0], 200);
            assert_eq!(sample.looks, [64, 128, 200]);
            sample.begin();
            values.chunks(length).for_each(|chunk| sample.absorb(&buffer(chunk)));
            sample.end();
            for (look, n) in [64, 128, 200].into_iter().enumerate() {
                let result = sample.channels[0].error(look).expect("a round").typical;
                assert!((result - (mean(n) - 2.0) / 2.0).abs() < 1e-14, "{length}, {n}: {result}");
            }
            assert_eq!(sample.channels[0].tally.draws, 200);
            assert_eq!(sample.lookups.moments().map(|moments| moments.mean), Some(3.0));
        }
    }

    #[test]
    fn the_error_of_several_rounds_is_the_root_of_the_mean_square() {
        let mut sample = BenchDraws::about(&[1.0], 2);
        for values in [[1.3, 1.3], [0.6, 0.6]] {
            sample.begin();
            sample.absorb(&buffer(&values));
            sample.end();
        }
        let error = sample.channels[0].error(0).expect("two rounds");
        assert!((error.typical - (0.125_f64).sqrt()).abs() < 1e-15);
        assert!((error.least - 0.3).abs() < 1e-15 && (error.most - 0.4).abs() < 1e-15);
    }
}
