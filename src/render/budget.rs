//! Numbers of draws of pixels, and sums over their draws.

use numeric::digits::{number, rounded};

/// Maximum number of channels of a pixel: red, green and blue.
pub const MAX_CHANNELS: usize = 3;

/// Number for each channel of a pixel; a grey one uses the first only.
pub type Colour = [f64; MAX_CHANNELS];

/// Largest number of draws at a pixel; more are a mistake in the picture.
const MAX_DRAWS: f64 = 1e7;

/// Expected properties of a draw at a pixel.
#[derive(Debug, Clone)]
pub struct Forecast {
    /// Its lookups; `None` if no pilot was drawn.
    pub lookups: Option<f64>,
    /// Its variance in each channel, by theory.
    pub variance: Option<Colour>,
    /// Bias of its mean in each channel, by theory.
    pub bias: Colour,
    /// True if the pixel fits its own control.
    pub leads: bool,
    /// The lookups of the pilot.
    pub pilots: u64,
}

/// Sums over the draws of a pixel.
#[derive(Debug, Clone, Copy)]
pub struct PixelDraws {
    /// Number of draws.
    pub draws: u64,
    /// The sum of their values.
    pub sum: Colour,
    /// The sum of their squares.
    pub squares: Colour,
    /// The sum of their lookups.
    pub lookups: u64,
}

/// Number of draws of each pixel, fixed before the first.
#[derive(Debug, Clone)]
pub struct PixelPlan {
    draws: f64,
    /// The lookups of a control, for each pixel.
    points: Vec<u64>,
    pilots: u64,
    variances: Vec<Colour>,
    biases: Vec<Colour>,
}

/// Results of an estimator at the covered pixels.
#[derive(Debug, Clone, Default)]
pub struct PixelValues {
    /// Values of the pixels, all channels of one pixel before those of the next.
    pub values: Vec<f64>,
    /// Their squared standard errors, measured; NaN for a single draw.
    pub square_errors: Vec<f64>,
    /// Their expected squared errors by theory; empty if theory does not know them.
    pub predicted: Vec<f64>,
    /// Draws.
    pub draws: Vec<u64>,
    /// Lookups.
    pub lookups: Vec<u64>,
    /// Lookups of all pilots.
    pub pilots: u64,
}

impl PixelPlan {
    /// Shares `budget` lookups per pixel among draws.
    pub fn new<'a>(
        forecasts: impl Iterator<Item = &'a Result<Forecast, String>>,
        points: usize,
        budget: u64,
    ) -> Result<Self, String> {
        let (mut fitted, mut pilots) = (Vec::new(), 0);
        let (mut lookups, mut counted) = (0.0, 0.0);
        let (mut variances, mut biases) = (Vec::new(), Vec::new());
        for forecast in forecasts {
            let forecast = forecast.as_ref().map_err(String::clone)?;
            if let Some(expected) = forecast.lookups {
                lookups += expected;
                counted += 1.0;
            }
            variances.extend(forecast.variance);
            biases.push(forecast.bias);
            fitted.push(if forecast.leads { points as u64 } else { 0 });
            pilots += forecast.pilots;
        }
        if variances.len() < biases.len() {
            variances.clear();
        }
        if counted == 0.0 {
            return Err("no pixel is covered, or none by a pilot".into());
        }
        let expected = lookups / counted;
        if expected.is_nan() || expected <= 0.0 {
            return Err("it looks nothing up: there is nothing to compare at".into());
        }
        let control = fitted.iter().sum::<u64>() as f64 / fitted.len() as f64;
        let draws = (budget as f64 - control) / expected;
        if draws.is_nan() || draws < 1.0 {
            let minimum = number((expected + control).ceil());
            return Err(format!(
                "a draw takes {minimum} lookups at a pixel, and there are {budget}"
            ));
        }
        if draws > MAX_DRAWS {
            let (expected, draws) = (rounded(expected), rounded(draws));
            return Err(format!(
                "a draw takes {expected} lookups: {draws} draws a pixel are too many"
            ));
        }
        Ok(Self { draws, points: fitted, pilots, variances, biases })
    }

    /// Returns the number of draws of a covered pixel: the whole part of its accumulated share.
    pub fn draws_of(&self, number: usize) -> u64 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // far below 2⁵³
        let until = |n: usize| (self.draws * n as f64).floor() as u64;
        until(number + 1) - until(number)
    }

    /// Returns the values of pixels from the sums over their draws.
    pub fn gather(&self, channels: usize, pixels: &[PixelDraws]) -> PixelValues {
        let spread = |pixel: &PixelDraws, c: usize| {
            let n = pixel.draws as f64;
            let mean = pixel.sum[c] / n;
            let square = pixel.squares[c] / n;
            if n < 2.0 { f64::NAN } else { (square - mean * mean).max(0.0) / (n - 1.0) }
        };
        let each = |f: &dyn Fn(&PixelDraws, usize) -> f64| {
            pixels.iter().flat_map(|pixel| (0..channels).map(|c| f(pixel, c))).collect()
        };
        let predicted = self.variances.iter().zip(&self.biases).zip(pixels);
        let lookups = pixels.iter().zip(&self.points);
        PixelValues {
            values: each(&|pixel, c| pixel.sum[c] / pixel.draws as f64),
            square_errors: each(&spread),
            predicted: predicted
                .flat_map(|((v, b), p)| {
                    (0..channels).map(move |c| v[c] / p.draws as f64 + b[c] * b[c])
                })
                .collect(),
            draws: pixels.iter().map(|pixel| pixel.draws).collect(),
            lookups: lookups.map(|(pixel, points)| pixel.lookups + points).collect(),
            pilots: self.pilots,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Asked = Result<Forecast, String>;

    fn of(lookups: f64) -> Forecast {
        let (lookups, variance) = (Some(lookups), Some([1.0; 3]));
        Forecast { lookups, variance, bias: [0.0; 3], leads: true, pilots: 0 }
    }

    #[test]
    fn pixels_share_the_draws_evenly() {
        let forecasts: [Asked; 2] = [Ok(of(6.0)), Ok(of(10.0))];
        let plan = PixelPlan::new(forecasts.iter(), 4, 24).expect("2.5 draws");
        let draws: Vec<u64> = (0..6).map(|i| plan.draws_of(i)).collect();
        assert_eq!(draws, [2, 3, 2, 3, 2, 3]);
    }

    #[test]
    fn a_shared_control_is_paid_once() {
        let follower: Asked = Ok(Forecast { leads: false, ..of(5.0) });
        let plan = PixelPlan::new([Ok(of(5.0)), follower].iter(), 20, 20).expect("2 draws");
        assert_eq!((plan.draws, plan.points), (2.0, vec![20, 0]));
    }

    #[test]
    fn a_draw_that_costs_more_than_there_is_and_one_that_costs_nothing_are_refused() {
        let error = PixelPlan::new([Ok(of(30.0))].iter(), 0, 20).expect_err("too dear");
        assert!(error.contains("30 lookups"), "{error}");
        let error = PixelPlan::new([Ok(of(0.0))].iter(), 0, 20).expect_err("free");
        assert!(error.contains("looks nothing up"), "{error}");
        let refused = Err("pixel (0, 0) needs more".to_owned());
        let error = PixelPlan::new([refused].iter(), 0, 20).expect_err("refused");
        assert!(error.contains("pixel (0, 0)"), "{error}");
    }

    #[test]
    fn a_pixel_knows_its_standard_error() {
        let plan = PixelPlan::new([Ok(of(5.0))].iter(), 0, 20).expect("4 draws");
        let pixel =
            PixelDraws { draws: 4, sum: [2.0, 4.0, 0.0], squares: [2.0, 4.0, 0.0], lookups: 18 };
        let actual = plan.gather(3, &[pixel]);
        // 0, 0, 1, 1: s² = 1/3, over 4 draws; then four times 1, and four times 0.
        assert!((actual.square_errors[0] - 1.0 / 12.0).abs() < 1e-15);
        assert_eq!(actual.square_errors[1..], [0.0; 2]);
        assert_eq!((actual.values, actual.predicted), (vec![0.5, 1.0, 0.0], vec![0.25; 3]));
    }
}
