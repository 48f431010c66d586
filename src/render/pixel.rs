//! One pixel of one estimator: what theory expects of it, and its draws.

use std::sync::Arc;

use super::budget::{Forecast, PixelDraws};
use super::subject::{AnyRay, RayOf, SubjectKind};
use super::view::View;
use crate::estimators::{DrawBuffer, Experiment, Kernel, Refusal, Site};
use crate::geometry::Ray;
use crate::harness::estimator::{Estimators, ParsedEstimator};
use crate::harness::problem::Parts;
use crate::media::{Body, Control, Majorants};
use crate::numeric::Known;
use crate::rng::Address;
use crate::theory::Mesh;

/// Panels of 16 nodes on each ray, for what theory expects of its draws.
const PANELS: usize = 16;
/// A pixel of every so many columns and rows makes pilot draws.
const PILOTS_EVERY: usize = 2;
/// So many pilot draws even in the smallest picture: their mean is what a draw costs to a few hundredths.
const LEAST_PILOTS: u64 = 2048;
/// Fewer draws than this are made one by one.
const FEW: u64 = 32;

/// No pilot rays: recipes that learn are not read.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// How an estimator is called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// With its settings.
    pub estimator: String,
    /// σ̂ in words.
    pub sampling: String,
    /// The control in words.
    pub control: String,
}

/// An estimator of a picture.
pub struct Listed<'a> {
    /// As parsed.
    pub parsed: &'a ParsedEstimator,
    /// Its number among those that the subject read.
    pub index: usize,
    /// Its name.
    pub label: Label,
    /// Lookups per pixel that it is to take.
    pub lookups: u64,
    /// σ̂ in space, for draws that leave the ray: the same for all pixels.
    pub space: Option<Arc<Majorants>>,
    /// Where its random numbers are found, but for the pixel: those of pilots, and those of the image.
    pub addresses: [Address; 2],
}

/// A covered pixel.
pub struct Pixel<'a> {
    view: &'a View,
    kind: &'a SubjectKind,
    ray: Box<dyn AnyRay>,
    /// The sky behind it, or 1 where that is not seen.
    sky: f64,
    mesh: Arc<Mesh>,
    body: Body,
    /// Where a control is fitted that several pixels share; `None` for a pixel that fits its own.
    leader: Option<(Body, Mesh)>,
    index: usize,
}

impl<'a> Pixel<'a> {
    /// The pixel of a number; `None` where its ray is not allowed.
    pub fn new(
        view: &'a View,
        kind: &'a SubjectKind,
        ray_of: &RayOf,
        index: usize,
    ) -> Option<Self> {
        let along = view.covered(index)?;
        let ray = ray_of(&view.volume, &along)?;
        let panels = if kind.along_ray { PANELS } else { 1 };
        let mesh = Arc::new(Mesh::even(ray.medium().clone(), panels));
        let body = |ray: Ray| {
            let (name, volume) = (view.medium.clone(), view.volume.clone());
            Body::Volume { name, volume, ray }
        };
        let leader = Some(view.leader(index)).filter(|&leader| leader != index);
        let leader = leader.and_then(|leader| view.covered(leader)).map(|ray| {
            let body = body(ray);
            let mesh = Mesh::even(body.medium(), 1);
            (body, mesh)
        });
        let sky = if kind.before_sky { view.behind(index) } else { 1.0 };
        Some(Self { view, kind, ray, sky, mesh, body: body(along), leader, index })
    }

    /// The exact answer, or that of a quadrature with so many panels.
    pub fn answer(&self, panels: Option<usize>) -> Option<Known> {
        let found = panels.map_or_else(|| self.ray.exact(), |n| self.ray.by_quadrature(n));
        found.map(|known| Known::new(known.value * self.sky, known.error * self.sky))
    }

    fn parts<'b>(
        &'b self,
        estimators: &'b Estimators,
        parsed: &'b ParsedEstimator,
    ) -> Result<Parts<'b>, Refusal> {
        let mesh = &self.mesh;
        let recipe = estimators.sampling_of(parsed);
        let (sampling, control) = if self.kind.along_ray {
            let site = Site { body: &self.body, mesh, address: NOWHERE };
            let recipe_of_control = estimators.control_of(parsed);
            let control = match &self.leader {
                Some((body, mesh)) if recipe_of_control.lookups() > 0 => {
                    match recipe_of_control.prepare(&Site { body, mesh, ..site })? {
                        Control::Pieces(pieces) => Control::Pieces(pieces.on(self.mesh.support())),
                        other => other,
                    }
                }
                _ => recipe_of_control.prepare(&site)?,
            };
            (recipe.map(|recipe| recipe.prepare(&site, &control)).transpose()?, control)
        } else {
            (None, Control::None)
        };
        Ok(Parts {
            mesh,
            sampling,
            further: Vec::new(),
            control,
            constant: None,
            recipe,
            factor: 1.0,
            albedo: None,
        })
    }

    /// What a draw is expected to cost and to be spread by, at the covered pixel of a number.
    ///
    /// # Errors
    ///
    /// Why the estimator is refused.
    pub fn forecast(
        &self,
        number: usize,
        estimators: &Estimators,
        listed: &Listed,
    ) -> Result<Forecast, String> {
        let [column, row] = [self.index % self.view.size[0], self.index / self.view.size[0]];
        let refused = |refusal: Refusal| format!("pixel ({column}, {row}) {refusal}");
        let parts = self.parts(estimators, listed.parsed).map_err(refused)?;
        let ask = [!listed.parsed.expect_biased, self.kind.is_predicted];
        let prepared = self.ray.prepare(listed.index, parts, listed.space.as_ref(), ask);
        let (prediction, experiment) = prepared.map_err(refused)?;
        let leads = self.leader.is_none();
        if let Some(prediction) = prediction {
            let channel = &prediction.channels[0];
            return Ok(Forecast {
                lookups: prediction.lookups.map(|lookups| lookups.mean),
                variance: channel.moments.map(|m| m.variance() * self.sky * self.sky),
                bias: (channel.mean.value - channel.truth.value) * self.sky,
                leads,
                pilots: 0,
            });
        }
        let is_pilot = [column, row].iter().all(|at| at % PILOTS_EVERY == 0);
        let address = Address { block: number as u64, ..listed.addresses[0] };
        let pixels: usize = self.view.size.iter().map(|size| size.div_ceil(PILOTS_EVERY)).product();
        let draws = LEAST_PILOTS.div_ceil(pixels as u64);
        let lookups = is_pilot.then(|| self.drawn(&*experiment, draws, address).lookups);
        let pilots = lookups.unwrap_or(0);
        let lookups = lookups.map(|lookups| lookups as f64 / draws as f64);
        Ok(Forecast { lookups, variance: None, bias: 0.0, leads, pilots })
    }

    /// So many draws at the covered pixel of a number.
    pub fn draw(
        &self,
        number: usize,
        estimators: &Estimators,
        listed: &Listed,
        draws: u64,
    ) -> Option<PixelDraws> {
        let parts = self.parts(estimators, listed.parsed).ok()?;
        let space = listed.space.as_ref();
        let prepared = self.ray.prepare(listed.index, parts, space, [false; 2]);
        let address = Address { block: number as u64, ..listed.addresses[1] };
        Some(self.drawn(&*prepared.ok()?.1, draws, address))
    }

    fn drawn(&self, experiment: &dyn Experiment, draws: u64, address: Address) -> PixelDraws {
        let mut streams = address.streams();
        let mut buffer = DrawBuffer::new(1);
        let mut pixel = PixelDraws { draws, sum: 0.0, squares: 0.0, lookups: 0 };
        // The same draws either way: packs of eight walk many steps at once, which few draws do not fill.
        let kernel =
            if draws < FEW { Kernel::Single } else { Kernel::Packets(fearless_simd::Level::new()) };
        let mut left = draws;
        while left > 0 {
            let count = left.min(DrawBuffer::LENGTH as u64);
            #[expect(clippy::cast_possible_truncation)] // at most a buffer's length
            experiment.fill_by(kernel, &mut streams, count as usize, &mut buffer);
            for x in &buffer.values[0] {
                let x = x * self.sky;
                pixel.sum += x;
                pixel.squares += x * x;
            }
            pixel.lookups += buffer.lookups.iter().map(|&n| u64::from(n)).sum::<u64>();
            left -= count;
        }
        pixel
    }
}
