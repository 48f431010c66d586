//! Draws of closures, and the closures that make them.

/// A draw: one value or several, with or without the number of lookups of σ_t.
pub trait Sample: Send {
    /// The number of values.
    const VALUES: usize;
    /// True if it comes with the number of lookups.
    const HAS_LOOKUPS: bool = false;

    /// Adds the draw to one column for each value.
    fn append(&self, columns: &mut [Vec<f64>]);

    /// The number of lookups, if it is given.
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

/// A closure that makes one draw a call.
#[derive(Debug, Clone)]
pub struct Closure<F> {
    pub(super) draw: F,
}

/// A factory of such closures, which makes one for each thread.
#[derive(Debug, Clone)]
pub struct Factory<M> {
    pub(super) make: M,
    pub(super) threads: Option<usize>,
}
