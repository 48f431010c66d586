//! One pixel of one estimator: what theory expects of it, and its draws.

use std::sync::Arc;

use super::scene::{Called, Scene};
use super::subject::Subject;
use super::view::View;
use crate::catalogue::{number, rounded};
use crate::estimators::{DrawBuffer, Kernel, Order, Refusal, Setup, Site};
use crate::geometry::Ray;
use crate::harness::written::Written;
use crate::media::{Body, Control, Majorants};
use crate::rng::Address;
use crate::theory::Mesh;

/// Panels of 16 nodes on each ray, for what theory expects of its draws.
const PANELS: usize = 16;
/// A pixel of every so many columns and rows makes pilot draws.
const PILOTS_EVERY: usize = 2;
/// So many pilot draws even in the smallest picture: their mean is what a draw costs to a few hundredths.
const LEAST_PILOTS: u64 = 2048;

/// More draws at a pixel than this are a mistake in the picture.
const MOST_DRAWS: f64 = 1e7;
/// Fewer draws than this are made one by one.
const FEW: u64 = 32;

/// No pilot rays: recipes that learn are not read.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// A covered pixel.
pub struct Seen<P> {
    /// The problem of its ray.
    pub problem: Arc<P>,
    /// The sky behind it, or 1 where that is not seen.
    pub sky: f64,
    mesh: Arc<Mesh>,
    body: Body,
    /// Where a control is fitted that several pixels share; `None` for a pixel that fits its own.
    leader: Option<(Body, Mesh)>,
    pixel: usize,
}

impl<P: Subject> Seen<P> {
    /// The pixel of a number; `None` where its ray is not allowed.
    pub fn new(view: &View, shared: &P::Shared, pixel: usize) -> Option<Self> {
        let ray = view.covered(pixel)?;
        let problem = Arc::new(P::at(shared, &view.volume, &ray)?);
        let panels = if P::ALONG_RAY { PANELS } else { 1 };
        let mesh = Mesh::even(problem.medium().clone(), panels);
        let body = |ray: Ray| {
            let (name, volume) = (view.medium.clone(), view.volume.clone());
            Body::Volume { name, volume, ray }
        };
        let leader = Some(view.leader(pixel)).filter(|&leader| leader != pixel);
        let leader = leader.and_then(|leader| view.covered(leader)).map(|ray| {
            let body = body(ray);
            let mesh = Mesh::even(body.medium(), 1);
            (body, mesh)
        });
        let sky = if P::BEFORE_SKY { view.behind(pixel) } else { 1.0 };
        Some(Self { problem, sky, mesh: Arc::new(mesh), body: body(ray), leader, pixel })
    }
}

/// An estimator of a picture.
pub struct Listed<'a, P> {
    /// As written.
    pub written: &'a Written<P>,
    /// Its name.
    pub called: Called,
    /// Lookups per pixel that it is to take.
    pub lookups: u64,
    /// σ̂ in space, for draws that leave the ray: the same for all pixels.
    pub space: Option<Arc<Majorants>>,
    /// Where its random numbers are found, but for the pixel: those of pilots, and those of the image.
    pub addresses: [Address; 2],
}

/// What is expected of a draw at a pixel.
#[derive(Debug, Clone)]
pub struct Forecast {
    /// Its lookups; `None` where no pilot was drawn.
    lookups: Option<f64>,
    /// Its variance, by theory.
    variance: Option<f64>,
    /// By how much its mean is off, by theory.
    bias: f64,
    /// Whether the pixel fits its own control.
    leads: bool,
    /// The lookups of the pilot.
    pilots: u64,
}

/// What the draws of a pixel came to.
#[derive(Debug, Clone, Copy)]
pub struct Pixel {
    draws: u64,
    sum: f64,
    squares: f64,
    lookups: u64,
}

/// How many draws each pixel makes: fixed before the first.
#[derive(Debug, Clone)]
pub struct Plan {
    draws: f64,
    /// The lookups of a control, for each pixel.
    points: Vec<u64>,
    pilots: u64,
    variances: Vec<f64>,
    biases: Vec<f64>,
}

/// What an estimator found: a number for each covered pixel.
#[derive(Debug, Clone, Default)]
pub struct Exposed {
    /// The pixels' values.
    pub values: Vec<f64>,
    /// Their squared standard errors, measured; not a number where there is one draw only.
    pub square_errors: Vec<f64>,
    /// Their expected squared errors by theory; empty where it is not asked.
    pub predicted: Vec<f64>,
    /// Draws.
    pub draws: Vec<u64>,
    /// Lookups.
    pub lookups: Vec<u64>,
    /// Lookups of all pilots.
    pub pilots: u64,
}

impl<P: Subject> Scene<P> {
    fn setup(&self, seen: &Seen<P>, listed: &Listed<P>) -> Result<Setup<P>, Refusal> {
        let written = listed.written;
        if !P::ALONG_RAY {
            let recipe = self.sampling_of(written);
            let setup = Setup::new(seen.problem.clone(), seen.mesh.clone(), None, Control::None);
            return match &listed.space {
                Some(space) => Ok(Setup { space: Some(space.clone()), ..setup }),
                None => setup.in_space(None, recipe, 1.0),
            };
        }
        let site = Site { body: &seen.body, mesh: &seen.mesh, address: NOWHERE };
        let control = self.with_control(written, |recipe| match &seen.leader {
            Some((body, mesh)) if recipe.lookups() > 0 => {
                let fitted = recipe.prepare(&Site { body, mesh, ..site })?;
                Ok(match fitted {
                    Control::Pieces(pieces) => Control::Pieces(pieces.on(seen.mesh.support())),
                    other => other,
                })
            }
            _ => recipe.prepare(&site),
        })?;
        let sampling = self.sampling_of(written).map(|recipe| recipe.prepare(&site, &control));
        let setup =
            Setup::new(seen.problem.clone(), seen.mesh.clone(), sampling.transpose()?, control);
        let setup = if written.entry.skips() { setup.skipping() } else { setup };
        Ok(Setup { laws: false, ..setup })
    }

    /// What a draw is expected to cost and to be spread by; or why the estimator is refused.
    pub(super) fn forecast(
        &self,
        number: usize,
        seen: &Seen<P>,
        listed: &Listed<P>,
    ) -> Result<Forecast, String> {
        let written = listed.written;
        let [column, row] = [seen.pixel % self.view.size[0], seen.pixel / self.view.size[0]];
        let refused = |refusal: Refusal| format!("pixel ({column}, {row}) {refusal}");
        let setup = self.setup(seen, listed).map_err(refused)?;
        if !written.expect_biased {
            written.entry.domain(&setup).map_err(refused)?;
        }
        let leads = seen.leader.is_none();
        if P::IS_PREDICTED {
            let prediction = written.entry.predict(&setup);
            let channel = &prediction.channels[0];
            return Ok(Forecast {
                lookups: prediction.lookups.map(|lookups| lookups.mean),
                variance: channel.moments.map(|m| m.variance() * seen.sky * seen.sky),
                bias: (channel.mean.value - channel.truth.value) * seen.sky,
                leads,
                pilots: 0,
            });
        }
        let is_pilot = [column, row].iter().all(|at| at % PILOTS_EVERY == 0);
        let address = Address { block: number as u64, ..listed.addresses[0] };
        let pixels: usize = self.view.size.iter().map(|size| size.div_ceil(PILOTS_EVERY)).product();
        let draws = LEAST_PILOTS.div_ceil(pixels as u64);
        let lookups = is_pilot.then(|| Self::drawn(seen, written, setup, draws, address).lookups);
        let pilots = lookups.unwrap_or(0);
        let lookups = lookups.map(|lookups| lookups as f64 / draws as f64);
        Ok(Forecast { lookups, variance: None, bias: 0.0, leads, pilots })
    }

    /// So many draws at a pixel.
    pub(super) fn draw(
        &self,
        number: usize,
        seen: &Seen<P>,
        listed: &Listed<P>,
        draws: u64,
    ) -> Option<Pixel> {
        let setup = self.setup(seen, listed).ok()?;
        let address = Address { block: number as u64, ..listed.addresses[1] };
        Some(Self::drawn(seen, listed.written, setup, draws, address))
    }

    fn drawn(
        seen: &Seen<P>,
        written: &Written<P>,
        setup: Setup<P>,
        draws: u64,
        address: Address,
    ) -> Pixel {
        let experiment = written.entry.experiment(setup, Order::Along);
        let mut streams = address.streams();
        let mut buffer = DrawBuffer::new(1);
        let mut pixel = Pixel { draws, sum: 0.0, squares: 0.0, lookups: 0 };
        // The same draws either way: packs of eight walk many steps at once, which few draws do not fill.
        let kernel =
            if draws < FEW { Kernel::Single } else { Kernel::Packets(fearless_simd::Level::new()) };
        let mut left = draws;
        while left > 0 {
            let count = left.min(DrawBuffer::LENGTH as u64);
            #[expect(clippy::cast_possible_truncation)] // at most a buffer's length
            experiment.fill_by(kernel, &mut streams, count as usize, &mut buffer);
            for x in &buffer.values[0] {
                let x = x * seen.sky;
                pixel.sum += x;
                pixel.squares += x * x;
            }
            pixel.lookups += buffer.lookups.iter().map(|&n| u64::from(n)).sum::<u64>();
            left -= count;
        }
        pixel
    }
}

impl Plan {
    /// Shares `budget` lookups per pixel out among draws.
    ///
    /// # Errors
    ///
    /// Why the estimator is refused at a pixel, or that a draw costs more than there is.
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
            let least = number((expected + control).ceil());
            return Err(format!("a draw takes {least} lookups at a pixel, and there are {budget}"));
        }
        if draws > MOST_DRAWS {
            let (expected, draws) = (rounded(expected), rounded(draws));
            return Err(format!(
                "a draw takes {expected} lookups: {draws} draws a pixel are too many"
            ));
        }
        Ok(Self { draws, points: fitted, pilots, variances, biases })
    }

    /// The draws of the covered pixel of a number: the whole part of their share so far.
    #[must_use]
    pub fn draws_of(&self, number: usize) -> u64 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // far below 2⁵³
        let until = |n: usize| (self.draws * n as f64).floor() as u64;
        until(number + 1) - until(number)
    }

    /// Gathers what pixels came to.
    #[must_use]
    pub fn expose(&self, pixels: &[Pixel]) -> Exposed {
        let spread = |pixel: &Pixel| {
            let n = pixel.draws as f64;
            let mean = pixel.sum / n;
            if n < 2.0 { f64::NAN } else { (pixel.squares / n - mean * mean).max(0.0) / (n - 1.0) }
        };
        let predicted = self.variances.iter().zip(&self.biases).zip(pixels);
        let lookups = pixels.iter().zip(&self.points);
        Exposed {
            values: pixels.iter().map(|pixel| pixel.sum / pixel.draws as f64).collect(),
            square_errors: pixels.iter().map(spread).collect(),
            predicted: predicted.map(|((v, b), p)| v / p.draws as f64 + b * b).collect(),
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
        let (lookups, variance) = (Some(lookups), Some(1.0));
        Forecast { lookups, variance, bias: 0.0, leads: true, pilots: 0 }
    }

    #[test]
    fn pixels_share_the_draws_evenly() {
        let forecasts: [Asked; 2] = [Ok(of(6.0)), Ok(of(10.0))];
        let plan = Plan::new(forecasts.iter(), 4, 24).expect("2.5 draws");
        let draws: Vec<u64> = (0..6).map(|i| plan.draws_of(i)).collect();
        assert_eq!(draws, [2, 3, 2, 3, 2, 3]);
    }

    #[test]
    fn a_shared_control_is_paid_once() {
        let follower: Asked = Ok(Forecast { leads: false, ..of(5.0) });
        let plan = Plan::new([Ok(of(5.0)), follower].iter(), 20, 20).expect("2 draws");
        assert_eq!((plan.draws, plan.points), (2.0, vec![20, 0]));
    }

    #[test]
    fn a_draw_that_costs_more_than_there_is_and_one_that_costs_nothing_are_refused() {
        let error = Plan::new([Ok(of(30.0))].iter(), 0, 20).expect_err("too dear");
        assert!(error.contains("30 lookups"), "{error}");
        let error = Plan::new([Ok(of(0.0))].iter(), 0, 20).expect_err("free");
        assert!(error.contains("looks nothing up"), "{error}");
        let refused = Err("pixel (0, 0) needs more".to_owned());
        let error = Plan::new([refused].iter(), 0, 20).expect_err("refused");
        assert!(error.contains("pixel (0, 0)"), "{error}");
    }

    #[test]
    fn a_pixel_knows_its_standard_error() {
        let plan = Plan::new([Ok(of(5.0))].iter(), 0, 20).expect("4 draws");
        let pixel = Pixel { draws: 4, sum: 2.0, squares: 2.0, lookups: 18 };
        let exposed = plan.expose(&[pixel]);
        // 0, 0, 1, 1: s² = 1/3, over 4 draws.
        assert!((exposed.square_errors[0] - 1.0 / 12.0).abs() < 1e-15);
        assert_eq!((exposed.values[0], exposed.predicted[0]), (0.5, 0.25));
    }
}
