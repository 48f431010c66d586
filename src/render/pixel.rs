//! One pixel of one estimator: its expected properties, and its draws.

use std::sync::{Arc, OnceLock};

use super::budget::{Colour, Forecast, PixelDraws};
use super::subject::{AnyRay, RayOf, SubjectKind};
use super::view::View;
use crate::case::estimator::{Estimators, ParsedEstimator};
use crate::case::id::EstimatorName;
use estimators::recipes::sampling;
use estimators::setup::{Parts, Space};
use estimators::{DrawBuffer, Experiment, Kernel, Refusal, Site};
use media::{Body, Control, Medium, Volume};
use numeric::Known;
use numeric::rng::Address;
use theory::Mesh;

/// Number of panels of 16 nodes on each ray, for predictions.
const PANELS: usize = 16;
/// Distance of the pixels that make pilot draws, in columns and in rows.
const PILOTS_EVERY: usize = 2;
/// Smallest number of pilot draws in a picture: their mean is the cost of a draw to a few hundredths.
const MIN_PILOTS: u64 = 2048;
/// Number of draws below which they are made one by one.
const MIN_PACKET_DRAWS: u64 = 32;

/// Address without pilot rays: pictures take no recipes that learn.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// Names of an estimator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The estimator with its settings.
    pub estimator: EstimatorName,
    /// σ̂ in words.
    pub sampling: String,
    /// The control in words.
    pub control: String,
}

/// Estimator of a picture.
pub struct Listed<'a> {
    /// As parsed.
    pub parsed: &'a ParsedEstimator,
    /// Index among the estimators that the subject read.
    pub index: usize,
    /// Its name.
    pub label: Label,
    /// Budget of lookups per pixel.
    pub lookups: u64,
    /// σ̂ in space, for draws that leave the ray: the same for all pixels, and made for the first.
    pub space: OnceLock<Result<Space, Refusal>>,
    /// Addresses of its random numbers, but for the pixel: those of pilots, and those of the image.
    pub addresses: [Address; 2],
}

/// Covered pixel.
pub struct Pixel<'a> {
    view: &'a View,
    kind: &'a SubjectKind,
    ray: Box<dyn AnyRay>,
    /// Radiance of the sky behind it, or 1 if that is not visible.
    sky: f64,
    /// The field of each channel.
    meshes: Vec<Arc<Mesh>>,
    bodies: Vec<Body>,
    /// Shared ray to which a control is fitted; `None` for a pixel that fits its own.
    leader: Option<(Body, Mesh)>,
    index: usize,
}

impl<'a> Pixel<'a> {
    /// Prepares the pixel of a number; `None` if its ray is not allowed.
    pub fn new(
        view: &'a View,
        kind: &'a SubjectKind,
        ray_of: &RayOf,
        index: usize,
    ) -> Option<Self> {
        let along = view.covered(index)?;
        let ray = ray_of(&view.volumes, &along)?;
        let panels = if kind.along_ray { PANELS } else { 1 };
        let mesh = |medium: &Medium| Arc::new(Mesh::even(medium.clone(), panels));
        let meshes = ray.media().iter().map(mesh).collect();
        let leader = Some(view.leader(index)).filter(|&leader| leader != index);
        let leader = leader.and_then(|leader| view.covered(leader)).map(|ray| {
            let body = view.bodies(ray).swap_remove(0);
            let mesh = Mesh::even(body.medium(), 1);
            (body, mesh)
        });
        let sky = if kind.before_sky { view.behind(index) } else { 1.0 };
        Some(Self { view, kind, ray, sky, meshes, bodies: view.bodies(along), leader, index })
    }

    /// Returns the exact answer in each channel, or that of a quadrature with `panels` panels.
    pub fn answer(&self, panels: Option<usize>) -> Option<Vec<Known>> {
        let actual = panels.map_or_else(|| self.ray.exact(), |n| self.ray.by_quadrature(n))?;
        let seen = |known: Known| known * self.sky;
        Some(actual.into_iter().map(seen).collect())
    }

    fn parts<'b>(
        &'b self,
        estimators: &'b Estimators,
        listed: &'b Listed,
    ) -> Result<Parts<'b>, Refusal> {
        let recipe = estimators.sampling_of(listed.parsed);
        let along_ray = recipe.filter(|_| self.kind.along_ray);
        let control = if self.kind.along_ray {
            let site = Site { body: &self.bodies[0], mesh: &self.meshes[0], address: NOWHERE };
            let recipe = estimators.control_of(listed.parsed);
            match &self.leader {
                Some((body, mesh)) if recipe.lookups() > 0 => {
                    match recipe.prepare(&Site { body, mesh, ..site })? {
                        Control::Pieces(pieces) => Control::Pieces(pieces.on(mesh.support())),
                        other => other,
                    }
                }
                _ => recipe.prepare(&site)?,
            }
        } else {
            Control::None
        };
        let channels = self.meshes.iter().zip(&self.bodies).enumerate();
        let channels = channels.map(|(channel, (mesh, body))| {
            let site = Site { body, mesh, address: NOWHERE };
            let own = along_ray.map(|recipe| sampling::of_channel(recipe, channel));
            Ok((mesh.clone(), own.map(|own| own.prepare(&site, &control)).transpose()?))
        });
        let channels = channels.collect::<Result<_, Refusal>>()?;
        let space = Box::new(move |volume: &Volume| {
            let made = || sampling::in_space(recipe, volume).map(Arc::new);
            listed.space.get_or_init(made).clone()
        });
        Ok(Parts { channels, control, space, albedo: None, distributions: false })
    }

    /// Returns the expected cost and spread of a draw at the covered pixel of a number.
    pub fn forecast(
        &self,
        number: usize,
        estimators: &Estimators,
        listed: &Listed,
    ) -> Result<Forecast, String> {
        let [column, row] = [self.index % self.view.size[0], self.index / self.view.size[0]];
        let refused = |refusal: Refusal| format!("pixel ({column}, {row}) {refusal}");
        let parts = self.parts(estimators, listed).map_err(refused)?;
        let joined = self.ray.join(listed.index, parts).map_err(refused)?;
        if !listed.parsed.expect_biased {
            joined.domain().map_err(refused)?;
        }
        let prediction = self.kind.is_predicted.then(|| joined.predict());
        let leads = self.leader.is_none();
        let known = prediction.and_then(|actual| Some((actual.lookups?.mean, actual.channels)));
        if let Some((lookups, channels)) = known {
            let (mut variance, mut bias) = (Some(Colour::default()), Colour::default());
            for (c, channel) in channels.iter().take(self.kind.channels).enumerate() {
                bias[c] = (channel.mean.value - channel.truth.value) * self.sky;
                variance = variance.zip(channel.moments).map(|(mut all, moments)| {
                    all[c] = moments.variance() * self.sky * self.sky;
                    all
                });
            }
            return Ok(Forecast { lookups: Some(lookups), variance, bias, leads, pilots: 0 });
        }
        let is_pilot = [column, row].iter().all(|at| at % PILOTS_EVERY == 0);
        let address = Address { block: number as u64, ..listed.addresses[0] };
        let pixels: usize = self.view.size.iter().map(|size| size.div_ceil(PILOTS_EVERY)).product();
        let draws = MIN_PILOTS.div_ceil(pixels as u64);
        let lookups = is_pilot.then(|| self.drawn(&*joined, draws, address).lookups);
        let pilots = lookups.unwrap_or(0);
        let lookups = lookups.map(|lookups| lookups as f64 / draws as f64);
        Ok(Forecast { lookups, variance: None, bias: Colour::default(), leads, pilots })
    }

    /// Returns the sums over draws at the covered pixel of a number.
    pub fn draw(
        &self,
        number: usize,
        estimators: &Estimators,
        listed: &Listed,
        draws: u64,
    ) -> Option<PixelDraws> {
        let parts = self.parts(estimators, listed).ok()?;
        let joined = self.ray.join(listed.index, parts).ok()?;
        let address = Address { block: number as u64, ..listed.addresses[1] };
        Some(self.drawn(&*joined, draws, address))
    }

    fn drawn(&self, experiment: &dyn Experiment, draws: u64, address: Address) -> PixelDraws {
        let mut streams = address.streams();
        // Values after those of the picture's channels, such as a luminance, are not shown.
        let mut buffer = DrawBuffer::new(self.kind.channels);
        let (sum, squares) = (Colour::default(), Colour::default());
        let mut pixel = PixelDraws { draws, sum, squares, lookups: 0 };
        // Both kernels make the same draws: packs of eight need many draws to be filled.
        let kernel = if draws < MIN_PACKET_DRAWS {
            Kernel::Single
        } else {
            Kernel::Packets(fearless_simd::Level::new())
        };
        let mut left = draws;
        while left > 0 {
            let count = left.min(DrawBuffer::LENGTH as u64);
            #[expect(clippy::cast_possible_truncation)] // at most a buffer's length
            experiment.fill_by(kernel, &mut streams, count as usize, &mut buffer);
            buffer.add_sums(self.sky, &mut pixel.sum, &mut pixel.squares);
            pixel.lookups += buffer.all_lookups();
            left -= count;
        }
        pixel
    }
}
