//! How a number y, whose mean is 0 when all is well, comes from a draw.

use estimators::DrawBuffer;
use numeric::pack::in_fused_code;

/// Adds a y for each of the draws to the second argument.
pub type Observer<T> = Box<dyn Fn(&T, &mut Vec<f64>) + Send + Sync>;

/// How a y comes from a draw.
pub enum Observe {
    /// From the value of one channel.
    Value(usize, Observer<[f64]>),
    /// From the number of lookups.
    Lookups(Observer<[u32]>),
    /// From the draw as a whole.
    Draw(Observer<DrawBuffer>),
}

impl Observe {
    /// `f` of each value of a channel, on the hardware's registers: `f` must be inlined.
    pub fn each_value(channel: usize, f: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        let observer = move |values: &[f64], y: &mut Vec<f64>| {
            // Not extended: that is compiled for the least machine.
            let first = y.len();
            y.resize(first + values.len(), 0.0);
            in_fused_code(
                #[inline(always)]
                || y[first..].iter_mut().zip(values).for_each(|(y, &x)| *y = f(x)),
            );
        };
        Self::Value(channel, Box::new(observer))
    }

    /// A y for each draw of a buffer.
    pub fn each(&self, draws: &DrawBuffer, y: &mut Vec<f64>) {
        match self {
            Self::Value(channel, observer) => observer(&draws.values[*channel], y),
            Self::Lookups(observer) => observer(&draws.lookups, y),
            Self::Draw(observer) => observer(draws, y),
        }
    }
}
