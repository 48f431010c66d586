//! Draws, one by one and in a buffer.

use numeric::rng::Streams;

/// One realisation of an estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw<V = [f64; 1]> {
    /// The value, one number per channel.
    pub value: V,
    /// Number of evaluations of σ_t.
    pub lookups: u32,
    /// Relative violation of an identity that every single draw satisfies: rounding where all is well, and 0 where
    /// there is no such identity.
    pub defect: f64,
}

impl<V> Draw<V> {
    /// A draw of an estimator that satisfies no identity draw by draw.
    #[inline(always)]
    pub fn free(value: V, lookups: u32) -> Self {
        Self { value, lookups, defect: 0.0 }
    }
}

/// A buffer of draws, with one array for each of their numbers.
#[derive(Debug, Clone, Default)]
pub struct DrawBuffer {
    /// `values[channel][draw]`.
    pub values: Vec<Vec<f64>>,
    /// `lookups[draw]`.
    pub lookups: Vec<u32>,
    /// `defects[draw]`, see [`Draw::defect`].
    pub defects: Vec<f64>,
    /// Storage of the outcomes of finished walks, which are scored together; kept from request to request.
    pub(crate) outcomes: Vec<f64>,
}

impl DrawBuffer {
    /// Number of draws of one channel in a full buffer. With the results of a check this is half a mebibyte, small
    /// enough for most second-level caches. It is large enough that the lanes of a packet seldom wait for the
    /// slowest one.
    pub const LENGTH: usize = 16_384;

    /// Minimum number of draws in a full buffer, for any number of channels.
    const MIN_LENGTH: usize = Self::LENGTH / 4;

    /// An empty buffer for draws of the given number of channels.
    pub fn new(channels: usize) -> Self {
        Self { values: vec![Vec::new(); channels], ..Self::default() }
    }

    /// Number of draws in a full buffer, given the number of channels.
    pub fn length(channels: usize) -> usize {
        (Self::LENGTH / channels.next_power_of_two()).max(Self::MIN_LENGTH)
    }

    /// Sets the number of channels of the draws.
    pub fn set_channels(&mut self, channels: usize) {
        self.values.resize_with(channels, Vec::new);
    }

    /// Overwrites a draw.
    #[inline(always)]
    pub fn put<V: AsRef<[f64]>>(&mut self, number: usize, draw: &Draw<V>) {
        let values = draw.value.as_ref();
        for (channel, &value) in values.iter().enumerate() {
            // Pictures need fewer channels.
            if let Some(row) = self.values.get_mut(channel) {
                row[number] = value;
            }
        }
        // A value of an earlier request must not pass for one of this draw.
        for row in self.values.iter_mut().skip(values.len()) {
            row[number] = f64::NAN;
        }
        self.lookups[number] = draw.lookups;
        self.defects[number] = draw.defect;
    }

    /// Resizes to `count` draws of one channel; returns values, lookups and defects for overwriting. `None` if
    /// draws have no channel.
    pub fn one_channel(&mut self, count: usize) -> Option<(&mut [f64], &mut [u32], &mut [f64])> {
        self.make_room(count);
        let values = self.values.first_mut()?;
        Some((values, &mut self.lookups, &mut self.defects))
    }

    /// Adds the values of each channel, times a scale, to its sum, and their squares to its sum of squares.
    pub fn add_sums(&self, scale: f64, sums: &mut [f64], squares: &mut [f64]) {
        for (values, (sum, square)) in self.values.iter().zip(sums.iter_mut().zip(squares)) {
            for x in values {
                let x = x * scale;
                *sum += x;
                *square += x * x;
            }
        }
    }

    /// Returns the number of lookups of all draws.
    pub fn all_lookups(&self) -> u64 {
        self.lookups.iter().map(|&lookups| u64::from(lookups)).sum()
    }

    /// Adds the draws of another buffer behind its own.
    pub fn append(&mut self, next: &Self) {
        for (channel, next) in self.values.iter_mut().zip(&next.values) {
            channel.extend_from_slice(next);
        }
        self.lookups.extend_from_slice(&next.lookups);
        self.defects.extend_from_slice(&next.defects);
    }

    /// Repeats the draws until their number is `count`.
    pub fn repeat(&mut self, count: usize) {
        fn cycled<T: Copy>(list: &mut Vec<T>, count: usize) {
            *list = list.iter().copied().cycle().take(count).collect();
        }
        if self.lookups.len() < count {
            self.values.iter_mut().for_each(|channel| cycled(channel, count));
            cycled(&mut self.lookups, count);
            cycled(&mut self.defects, count);
        }
    }

    /// Resizes to `count` draws for overwriting.
    pub fn make_room(&mut self, count: usize) {
        self.values.iter_mut().for_each(|channel| channel.resize(count, 0.0));
        self.lookups.resize(count, 0);
        self.defects.resize(count, 0.0);
    }
}

/// A request for draws.
pub struct Request<'a> {
    /// The streams of the block, as the last request left them.
    pub streams: &'a mut Streams,
    /// The number of draws.
    pub count: usize,
    /// The buffer of the draws.
    pub buffer: &'a mut DrawBuffer,
}
