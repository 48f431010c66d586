//! What a closure may return for one draw.

/// One draw: a value, or several, with the number of lookups of σ_t that it took or without.
pub trait Sample: Send {
    /// How many values it has.
    const VALUES: usize;
    /// Whether it tells the number of lookups.
    const HAS_LOOKUPS: bool = false;

    /// Adds the draw to one column for each value.
    fn append(&self, columns: &mut [Vec<f64>]);

    /// The number of lookups, where it is told.
    fn lookups(&self) -> f64 {
        0.0
    }
}

impl Sample for f64 {
    const VALUES: usize = 1;

    #[inline(always)]
    fn append(&self, columns: &mut [Vec<f64>]) {
        columns[0].push(*self);
    }
}

impl Sample for f32 {
    const VALUES: usize = 1;

    #[inline(always)]
    fn append(&self, columns: &mut [Vec<f64>]) {
        columns[0].push(f64::from(*self));
    }
}

/// The channels of a coloured draw.
impl<const K: usize> Sample for [f64; K] {
    const VALUES: usize = K;

    #[inline(always)]
    fn append(&self, columns: &mut [Vec<f64>]) {
        for (column, value) in columns.iter_mut().zip(self) {
            column.push(*value);
        }
    }
}

/// A draw with its number of lookups.
impl<S: Sample> Sample for (S, u64) {
    const VALUES: usize = S::VALUES;
    const HAS_LOOKUPS: bool = true;

    #[inline(always)]
    fn append(&self, columns: &mut [Vec<f64>]) {
        self.0.append(columns);
    }

    #[inline(always)]
    fn lookups(&self) -> f64 {
        self.1 as f64
    }
}
