//! Conversion of a case to a scene, problem by problem.
//!
//! | problem | scene |
//! |---|---|
//! | `transmittance` | the field as layers along the ray, or the grid itself, black, in front of light from all sides |
//! | `furnace` | the field in a box, white, in light from all sides; the ray begins outside |
//! | `slab` without `light` | layers between mirrors, which is an infinite slab; light from above (reflectance) or below (transmittance) |
//! | `single-scattering` | the field in a box with a point light; the ray extends to its exit from the box |
//! | `ball` | a homogeneous ball in light from all sides, or about a black sphere that shines |
//!
//! The case has one channel or several, at the end of the ray only. A homogeneous medium stays homogeneous, in a box or
//! a ball.

use std::slice;
use std::sync::Arc;

use super::fields::{ExportReader, MediumFields, Unsuitable, lobe, one_phase, unread};
use super::scene::{ChannelMedium, ExportedLight, ExportedScene, ExportedView};
use super::{ExportError, ExportOptions, Target, single};
use crate::case::sweep::SweptQuantity;
use crate::case::{CaseText, Catalogue, forms};
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use media::{Body, Medium, Volume};
use numeric::geometry::{Bounds, Point, Ray};
use theory::problems::ball::{BallLight, Sought};
use theory::problems::slab::{Incidence, IncidentLight as Side};
use theory::problems::{
    ChromaticSlab, Furnace, Problem, SingleScattering, Slab, SpectralFurnace,
    SpectralSingleScattering, SpectralSlab, SpectralTransmittance, Sphere, Transmittance,
};

/// Reads a case as a scene.
pub fn read(
    catalogue: &Catalogue,
    source: &CaseText,
    target: Target,
    wishes: &ExportOptions,
) -> Result<ExportedScene, ExportError> {
    let case = catalogue.read(source)?;
    let reader = ExportReader { name: source.name.clone(), target, wishes };
    let (scenario, body) = (&case.scenario, case.scenario.body());
    let scene = if scenario.problem::<Transmittance>().is_some()
        || scenario.problem::<SpectralTransmittance>().is_some()
    {
        reader.transmittance(body)
    } else if let Some(furnace) = scenario.problem::<Furnace>() {
        reader.furnace(body, furnace)
    } else if let Some(furnace) = scenario.problem::<SpectralFurnace>() {
        reader.spectral_furnace(body, furnace)
    } else if let Some(slab) = scenario.problem::<Slab>() {
        reader.slab(slab)
    } else if let Some(slab) = scenario.problem::<SpectralSlab>() {
        reader.spectral_slab(slab)
    } else if let Some(slab) = scenario.problem::<ChromaticSlab>() {
        reader.chromatic_slab(slab)
    } else if let Some(scattering) = scenario.problem::<SingleScattering>() {
        reader.single_scattering(body, slice::from_ref(scattering).iter())
    } else if let Some(scattering) = scenario.problem::<SpectralSingleScattering>() {
        reader.single_scattering(body, scattering.channels.iter().map(|channel| &**channel))
    } else if let Some(sphere) = scenario.problem::<Sphere>() {
        reader.sphere(body, sphere)
    } else {
        let settings = case.spec.problem().map_or(&[][..], |(_, settings)| settings);
        let requested =
            forms::chosen_form(&case.problem, settings).map_or(String::new(), |form| form.title);
        Err((
            format!("renderers do not answer what `{requested}` asks"),
            "take a case of transmittance, furnace, slab or single-scattering (of one channel or several), or ball",
        ))
    };
    let swept = case.sweep.as_ref().map(|axis| axis.what);
    let varies = match swept {
        Some(SweptQuantity::Albedo) => {
            !["transmittance", "furnace"].contains(&case.problem.as_str())
        }
        Some(SweptQuantity::Density | SweptQuantity::AlbedoScale | SweptQuantity::Contrast) => true,
        _ => false,
    };
    let checked = scene.and_then(|scene| {
        if varies {
            return Err(("it sweeps its medium".into(), "leave `sweep` out of a copy of the case"));
        }
        if !scene.channels.iter().all(|channel| channel.field.is_extinction()) {
            let why = "a sample of σ_t is no number of single precision from 0 to 3e38";
            return Err((why.into(), "take other units of length"));
        }
        if scene.peak() == 0.0 {
            return Err(("the sampled field is empty".into(), "take more --cells, or another ray"));
        }
        if scene.has_mirrors && target == Target::Pbrt {
            let why =
                "mirrors make a box an infinite slab, and those of pbrt reflect 0.9999 at most";
            return Err((why.into(), "take a case of another problem, such as furnace/eq21"));
        }
        if target == Target::Pbrt && matches!(scene.phase, Phase::Rayleigh(_)) {
            let cure = "take a case with `phase.isotropic` or `phase.henyey-greenstein`";
            return Err(("pbrt has no Rayleigh scattering".into(), cure));
        }
        if target == Target::Pbrt && wishes.heterogeneous {
            let why = "pbrt's heterogeneous media are grids, which fall to zero at their border";
            return Err((why.into(), "leave --heterogeneous out"));
        }
        Ok(scene)
    });
    checked.map_err(|(why, cure)| ExportError::Unsuitable {
        case: source.name.clone(),
        target: target.name(),
        why,
        cure: cure.into(),
    })
}

impl ExportReader<'_> {
    /// Returns a black scene with one picture, in light from all sides.
    fn scene(
        &self,
        problem: &'static str,
        fields: MediumFields,
        ray: [Point; 2],
        light: ExportedLight,
    ) -> ExportedScene {
        let [eye, direction] = ray.map(|point| Point(point.0.map(single)));
        let name = if problem == "transmittance" { problem } else { "radiance" };
        let MediumFields { shape, fields } = fields;
        let is_inside = shape.contains(eye.0);
        let channels: Vec<ChannelMedium> =
            fields.into_iter().map(|field| ChannelMedium { field, albedo: 0.0 }).collect();
        let mut scene = ExportedScene {
            case: self.name.clone(),
            problem,
            target: self.target,
            shape,
            channels,
            is_heterogeneous: false,
            phase: Phase::Isotropic(Isotropic),
            eye,
            direction,
            is_inside,
            has_mirrors: false,
            scatterings: None,
            views: vec![ExportedView { name, light }],
            notes: Vec::new(),
        };
        scene.is_heterogeneous = self.wishes.heterogeneous && scene.grids().is_empty();
        scene.notes.extend(self.remarks(&scene));
        scene
    }

    fn transmittance(&self, body: &Body) -> Result<ExportedScene, Unsuitable> {
        let bodies = self.chosen(body.channels().iter().collect())?;
        let media: Vec<Medium> = bodies.iter().map(|body| body.medium()).collect();
        if media[0].support().is_empty() {
            return Err(("the ray misses the medium".into(), "take a ray that meets it"));
        }
        let own = self.own_grids(body)?;
        let ends_outside = |volume: &Volume, ray: &Ray| {
            let [low, high] = [ray.origin, ray.at(ray.length)];
            [low, high].iter().all(|&end| !volume.bounds().contains(end.0))
        };
        let mut volumes: Vec<Arc<Volume>> = Vec::new();
        let mut crossing = None;
        for body in &bodies {
            if let Body::Volume { volume, ray, .. } = body
                && own.is_some()
                && ends_outside(&**volume, ray)
            {
                volumes.push(volume.clone());
                crossing = Some(ray);
            }
        }
        let light = ExportedLight::Everywhere;
        if let (Some(ray), true) = (crossing, volumes.len() == bodies.len()) {
            let fields = self.in_space(&volumes, own)?;
            return Ok(self.scene("transmittance", fields, [ray.origin, ray.direction], light));
        }
        let fields = self.along(&media);
        let eye = Point([0.0, 0.0, -fields.length() / 8.0]);
        Ok(self.scene("transmittance", fields, [eye, Point([0.0, 0.0, 1.0])], light))
    }

    fn furnace(&self, body: &Body, furnace: &Furnace) -> Result<ExportedScene, Unsuitable> {
        let volumes = slice::from_ref(&furnace.scene.volume);
        let fields = self.in_space(volumes, self.own_grids(body)?)?;
        let is_white = furnace.scene.albedo.even() == Some(1.0);
        let ray = [furnace.entry, furnace.direction];
        Ok(self.white(fields, ray, lobe(furnace.scene.phase), is_white))
    }

    fn spectral_furnace(
        &self,
        body: &Body,
        furnace: &SpectralFurnace,
    ) -> Result<ExportedScene, Unsuitable> {
        let own = self.own_grids(body)?;
        let channels = self.chosen(furnace.channels.iter().collect())?;
        let volumes: Vec<Arc<Volume>> = channels.iter().map(|one| one.volume.clone()).collect();
        let fields = self.in_space(&volumes, own)?;
        let is_white = channels.iter().all(|channel| channel.albedo == 1.0);
        let phase = channels[0].phase;
        let ray = [furnace.entry, furnace.direction];
        let mut scene = self.white(fields, ray, lobe(phase), is_white);
        if channels.iter().any(|channel| channel.phase != phase) {
            let note = "all channels have the phase function of the first: that of a renderer is grey, and the radiance is 1 with any";
            scene.notes.push(note.into());
        }
        Ok(scene)
    }

    /// Returns a white medium in light from all sides, viewed from outside.
    fn white(
        &self,
        fields: MediumFields,
        ray: [Point; 2],
        phase: Phase,
        is_white: bool,
    ) -> ExportedScene {
        let mut scene = self.scene("furnace", fields, ray, ExportedLight::Everywhere);
        let bounds = scene.bounds();
        let diagonal = (bounds.high - bounds.low).norm();
        let way = scene.direction * (2.0 * diagonal);
        let ray =
            Ray { origin: scene.eye - way, direction: scene.direction, length: f64::INFINITY };
        let entry = ray.at(Bounds::Box(bounds).clip(&ray).from);
        scene.eye = Point((entry - scene.direction * (0.25 * diagonal)).0.map(single));
        scene.is_inside = false;
        scene.phase = phase;
        scene.channels.iter_mut().for_each(|channel| channel.albedo = 1.0);
        scene.notes.push("the ray begins outside the box".to_owned());
        if !is_white {
            let note = "the medium is white here: absorbing ones would have to emit light";
            scene.notes.push(note.into());
        }
        scene
    }

    fn slab(&self, slab: &Slab) -> Result<ExportedScene, Unsuitable> {
        self.layers(vec![(slab.medium().clone(), slab.albedo, slab.incidence)])
    }

    fn spectral_slab(&self, slab: &SpectralSlab) -> Result<ExportedScene, Unsuitable> {
        let albedos = slab.colours.albedos.iter();
        let channel = |&albedo: &f64| (slab.medium().clone(), albedo, slab.incidence);
        self.layers(albedos.map(channel).collect())
    }

    fn chromatic_slab(&self, slab: &ChromaticSlab) -> Result<ExportedScene, Unsuitable> {
        let albedos = slab.colours.albedos.iter().copied();
        let channels = slab.media().iter().cloned().zip(albedos).zip(&slab.incidences);
        self.layers(channels.map(|((medium, albedo), &light)| (medium, albedo, light)).collect())
    }

    /// Returns an infinite slab from the medium, albedo, and incidence of each channel.
    fn layers(&self, channels: Vec<(Medium, f64, Incidence)>) -> Result<ExportedScene, Unsuitable> {
        let channels = self.chosen(channels)?;
        let phases: Vec<Phase> = channels.iter().map(|channel| channel.2.phase).collect();
        let Side::Collimated(cosine) = channels[0].2.light else {
            let cure = "take one with `incidence.collimated`, such as slab/known-bugs";
            return Err(("its light is diffuse, and a pixel has one direction".into(), cure));
        };
        let phase = one_phase(&phases)?;
        let media: Vec<Medium> = channels.iter().map(|channel| channel.0.clone()).collect();
        let fields = self.along(&media);
        let direction = Point([(1.0 - cosine * cosine).sqrt(), 0.0, cosine]);
        let eye = direction * (-fields.length() / 8.0);
        let mut scene = self.scene("slab", fields, [eye, direction], ExportedLight::Above);
        for (channel, (_, albedo, _)) in scene.channels.iter_mut().zip(channels) {
            channel.albedo = single(albedo);
        }
        let views =
            [("reflectance", ExportedLight::Above), ("transmittance", ExportedLight::Below)];
        let views = views.map(|(name, light)| ExportedView { name, light }).into();
        Ok(ExportedScene { phase, has_mirrors: true, views, ..scene })
    }

    /// Returns a medium beside a point light with at most one scattering, channel by channel.
    fn single_scattering<'a>(
        &self,
        body: &Body,
        channels: impl Iterator<Item = &'a SingleScattering> + Clone,
    ) -> Result<ExportedScene, Unsuitable> {
        let lamp = channels.clone().next().map(SingleScattering::lamp).ok_or_else(unread)?;
        let own = self.own_grids(body)?;
        let mut scatterers = Vec::new();
        for (body, channel) in body.channels().iter().zip(channels) {
            let Body::Volume { volume, ray, .. } = body else { return Err(unread()) };
            scatterers.push((volume.clone(), ray, channel.albedo(), channel.phase()));
        }
        let chosen = self.chosen(scatterers)?;
        let phases: Vec<Phase> = chosen.iter().map(|&(.., phase)| phase).collect();
        let volumes: Vec<Arc<Volume>> = chosen.iter().map(|(volume, ..)| volume.clone()).collect();
        let (phase, ray) = (one_phase(&phases)?, chosen[0].1);
        let fields = self.in_space(&volumes, own)?;
        let light = ExportedLight::Point {
            position: Point(lamp.position.0.map(single)),
            power: single(lamp.power),
        };
        let mut scene = self.scene("single-scattering", fields, [ray.origin, ray.direction], light);
        if Bounds::Box(scene.bounds()).contains(ray.at(ray.length).0) {
            scene.notes.push("the ray goes on to where it leaves the box".into());
        }
        for (channel, (_, _, albedo, _)) in scene.channels.iter_mut().zip(chosen) {
            channel.albedo = single(albedo);
        }
        Ok(ExportedScene { phase, scatterings: Some(1), ..scene })
    }

    fn sphere(&self, body: &Body, sphere: &Sphere) -> Result<ExportedScene, Unsuitable> {
        let Body::Volume { ray, .. } = body else { return Err(unread()) };
        let cure = "take a homogeneous one that asks for the radiance, such as ball/black-light";
        if sphere.sought == Sought::MeanIntensity {
            return Err((
                "a pixel is a radiance, and the case asks for all directions".into(),
                cure,
            ));
        }
        let fields = self.in_space(slice::from_ref(&sphere.scene.volume), self.own_grids(body)?)?;
        if !matches!(fields.shape, Bounds::Sphere { .. }) {
            let why = "a ball whose σ_t varies is none once it is sampled to a grid";
            return Err((why.into(), cure));
        }
        let light = match sphere.light {
            BallLight::BlackSphere(radius) => ExportedLight::Core { radius: single(radius) },
            BallLight::Environment | BallLight::Distant(_) => ExportedLight::Everywhere,
        };
        let albedo = sphere.scene.albedo.even().unwrap_or_default();
        let mut scene = self.scene("ball", fields, [ray.origin, ray.direction], light);
        scene.channels[0].albedo = single(albedo);
        Ok(scene)
    }
}
