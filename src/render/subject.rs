//! Subjects of pictures: the ray of every pixel has its own problem.

use std::sync::Arc;

use super::budget::MAX_CHANNELS;
use super::scene::Reference;
use super::view::View;
use crate::case::estimator::{Defaults, Estimators};
use estimators::setup::Parts;
use estimators::trial::{Entry, Joined};
use estimators::{Estimated, Refusal, Setup};
use media::catalogue::Settings;
use media::phase::Phase;
use media::{Body, Medium, Volume};
use numeric::geometry::Ray;
use numeric::{Known, Lane};
use theory::Mesh;
use theory::problems::options::chosen;
use theory::problems::scene::read_albedo;
use theory::problems::single_scattering::{Lit, OnTheLine};
use theory::problems::{
    Albedo, MultipleScattering, Problem, ProblemOption, Scene, SingleScattering, Sky,
    SpectralTransmittance, Transmittance,
};
use theory::single::quick;

/// Problem that pictures show.
pub trait PictureSubject: Estimated {
    /// Data that all its rays share, beside the volume.
    type Shared: Send + Sync;

    /// True if draws weight the light of the sky behind the volume.
    const BEFORE_SKY: bool;
    /// True if the sky is visible beside the volume; otherwise it is black there.
    const SHOWS_SKY: bool;
    /// True if its draws walk along the ray: estimators may then skip its empty pieces.
    const ALONG_RAY: bool = true;
    /// True if theory is fast enough to predict every pixel.
    const IS_PREDICTED: bool;

    /// Reads the data that all rays share.
    fn read_shared(settings: &Settings, view: Option<&View>) -> Option<Self::Shared>;

    /// Validates a ray; the error is the mistake and its cure.
    fn allows(shared: &Self::Shared, ray: &Ray) -> Result<(), [String; 2]> {
        let _ = (shared, ray);
        Ok(())
    }

    /// Returns the problem of one ray; `None` if the ray is not allowed.
    fn at(shared: &Self::Shared, volumes: &[Arc<Volume>], ray: &Ray) -> Option<Self>;

    /// Returns whether [`Subject::exact`] knows all answers.
    fn has_exact(shared: &Self::Shared) -> bool {
        let _ = shared;
        false
    }

    /// Returns the exact answer in each channel, from closed forms; `None` without closed forms.
    fn exact(&self) -> Option<Vec<Known>> {
        None
    }

    /// Returns the answer in each channel by a quadrature of `2 panels` panels with 16 nodes, with the difference to
    /// one of `panels` panels as its error; `None` if the problem has no quadrature.
    fn by_quadrature(&self, panels: usize) -> Option<Vec<Known>> {
        let _ = panels;
        None
    }
}

/// Subject of the catalogue, before a picture is read.
#[allow(clippy::struct_excessive_bools)] // one for each constant of the trait
pub struct SubjectKind {
    /// Its name in picture files.
    pub name: &'static str,
    /// Options that choose the form.
    pub options: &'static [ProblemOption],
    /// Value of [`Subject::BEFORE_SKY`].
    pub before_sky: bool,
    /// Value of [`Subject::SHOWS_SKY`].
    pub shows_sky: bool,
    /// Value of [`Subject::ALONG_RAY`].
    pub along_ray: bool,
    /// Value of [`Subject::IS_PREDICTED`].
    pub is_predicted: bool,
    /// Number of channels of a pixel: 1, or 3 if the medium has three.
    pub channels: usize,
    /// Its reader.
    pub read: Read,
}

/// Reads the data that all rays share, the estimators and the reference; `None` after a mistake.
pub type Read =
    fn(&Settings, Option<&View>, Option<&Body>, Defaults) -> Option<(RayOf, Estimators, Reference)>;

/// Returns the problem of one ray with the estimators of the picture; `None` if the ray is not allowed.
pub type RayOf = Box<dyn Fn(&[Arc<Volume>], &Ray) -> Option<Box<dyn AnyRay>> + Send + Sync>;

/// All subjects, in the order of the catalogue.
pub static SUBJECTS: [SubjectKind; 4] = [
    SubjectKind::of::<Transmittance>("transmittance"),
    SubjectKind::of::<SpectralTransmittance>("transmittance"),
    SubjectKind::of::<SingleScattering>("single-scattering"),
    SubjectKind::of::<MultipleScattering>("multiple-scattering"),
];

/// Returns the subject of a name in the form that settings ask for; `None` after a mistake.
pub fn kind(name: &str, settings: &Settings) -> Option<&'static SubjectKind> {
    let forms: Vec<_> = SUBJECTS.iter().filter(|kind| kind.name == name).collect();
    let options: Vec<_> = forms.iter().map(|kind| kind.options).collect();
    chosen(&options, settings).map(|form| forms[form])
}

impl SubjectKind {
    const fn of<P: PictureSubject>(name: &'static str) -> Self {
        Self {
            name,
            options: P::OPTIONS,
            before_sky: P::BEFORE_SKY,
            shows_sky: P::SHOWS_SKY,
            along_ray: P::ALONG_RAY,
            is_predicted: P::IS_PREDICTED,
            channels: if P::SPECTRAL { MAX_CHANNELS } else { 1 },
            read: read::<P>,
        }
    }
}

fn read<P: PictureSubject>(
    settings: &Settings,
    view: Option<&View>,
    body: Option<&Body>,
    defaults: Defaults,
) -> Option<(RayOf, Estimators, Reference)> {
    let shared = P::read_shared(settings, view);
    if let (Some(view), Some(shared)) = (view, &shared) {
        let rays = (0..view.pixels()).filter_map(|pixel| view.covered(pixel));
        let refused = rays.map(|ray| P::allows(shared, &ray)).find_map(Result::err);
        if let Some([actual, help]) = refused {
            settings.fault("light", actual, help);
        }
    }
    let estimators = Estimators::read::<P>(settings, body, defaults);
    // Unreadable settings were already reported.
    let has_exact = shared.as_ref().is_none_or(P::has_exact);
    let reference = Reference::read::<P>(settings, has_exact, body, defaults);
    let (shared, (estimators, mut entries)) = (shared?, estimators?);
    let (reference, entry) = reference?;
    entries.extend(entry);
    let entries = Arc::new(entries);
    let ray_of: RayOf = Box::new(move |volumes, ray| {
        let problem = Arc::new(P::at(&shared, volumes, ray)?);
        Some(Box::new(OneRay { problem, entries: entries.clone() }))
    });
    Some((ray_of, estimators, reference))
}

/// Problem of one ray, without its type.
pub trait AnyRay {
    /// Returns the field of each channel along the ray.
    fn media(&self) -> &[Medium];

    /// Returns [`Subject::exact`].
    fn exact(&self) -> Option<Vec<Known>>;

    /// Returns [`Subject::by_quadrature`].
    fn by_quadrature(&self, panels: usize) -> Option<Vec<Known>>;

    /// Joins an estimator of the picture with its setup on the ray.
    fn join(&self, estimator: usize, parts: Parts) -> Result<Box<dyn Joined>, Refusal>;
}

struct OneRay<P> {
    problem: Arc<P>,
    entries: Arc<Vec<Box<dyn Entry<P>>>>,
}

impl<P: PictureSubject> AnyRay for OneRay<P> {
    fn media(&self) -> &[Medium] {
        self.problem.media()
    }

    fn exact(&self) -> Option<Vec<Known>> {
        PictureSubject::exact(&*self.problem)
    }

    fn by_quadrature(&self, panels: usize) -> Option<Vec<Known>> {
        PictureSubject::by_quadrature(&*self.problem, panels)
    }

    fn join(&self, estimator: usize, parts: Parts) -> Result<Box<dyn Joined>, Refusal> {
        Ok(self.entries[estimator].join(Setup::new(&self.problem, parts)?))
    }
}

impl PictureSubject for Transmittance {
    type Shared = ();

    const BEFORE_SKY: bool = true;
    const SHOWS_SKY: bool = true;
    const IS_PREDICTED: bool = true;

    fn read_shared(_: &Settings, _: Option<&View>) -> Option<()> {
        Some(())
    }

    fn at((): &(), volumes: &[Arc<Volume>], ray: &Ray) -> Option<Self> {
        Some(Self::new(along(&*volumes[0], ray)))
    }

    fn has_exact((): &()) -> bool {
        true
    }

    fn exact(&self) -> Option<Vec<Known>> {
        Some(vec![exact_transmittance(self.medium())])
    }

    fn by_quadrature(&self, panels: usize) -> Option<Vec<Known>> {
        Some(vec![transmittance_by_quadrature(self.medium(), panels)])
    }
}

impl PictureSubject for SpectralTransmittance {
    type Shared = ();

    const BEFORE_SKY: bool = true;
    const SHOWS_SKY: bool = true;
    const IS_PREDICTED: bool = false;

    fn read_shared(_: &Settings, _: Option<&View>) -> Option<()> {
        Some(())
    }

    fn at((): &(), volumes: &[Arc<Volume>], ray: &Ray) -> Option<Self> {
        Some(Self::new(volumes.iter().map(|volume| along(&**volume, ray)).collect()))
    }

    fn has_exact((): &()) -> bool {
        true
    }

    fn exact(&self) -> Option<Vec<Known>> {
        Some(self.media().iter().map(exact_transmittance).collect())
    }

    fn by_quadrature(&self, panels: usize) -> Option<Vec<Known>> {
        let answer = |medium| transmittance_by_quadrature(medium, panels);
        Some(self.media().iter().map(answer).collect())
    }
}

/// Returns a volume along a ray.
fn along(volume: &Volume, ray: &Ray) -> Medium {
    let support = volume.bounds().clip(ray);
    Medium::new(volume.along(ray, support), ray.span(), support)
}

fn exact_transmittance(medium: &Medium) -> Known {
    medium.optical_depth(medium.support()).exp_neg()
}

fn transmittance_by_quadrature(medium: &Medium, panels: usize) -> Known {
    let transmittance =
        |panels: usize| Lane::exp(-Mesh::even(medium.clone(), panels).optical_depth().value);
    let fine = transmittance(2 * panels);
    Known::estimated(fine, (fine - transmittance(panels)).abs())
}

impl PictureSubject for SingleScattering {
    type Shared = Lit;

    const BEFORE_SKY: bool = false;
    const SHOWS_SKY: bool = false;
    const IS_PREDICTED: bool = false;

    fn read_shared(settings: &Settings, _: Option<&View>) -> Option<Lit> {
        Lit::read(settings)
    }

    fn allows(shared: &Lit, ray: &Ray) -> Result<(), [String; 2]> {
        shared.lamp.seen_from(ray).map(drop).map_err(|OnTheLine(distance)| {
            let actual = format!("the light is {distance:e} away from the line of a pixel's ray");
            [actual, "move it a little: on the ray the radiance is infinite".into()]
        })
    }

    fn at(shared: &Lit, volumes: &[Arc<Volume>], ray: &Ray) -> Option<Self> {
        Self::new(volumes[0].clone(), *ray, shared.lamp, shared.albedo, shared.phase).ok()
    }

    fn by_quadrature(&self, panels: usize) -> Option<Vec<Known>> {
        Some(vec![quick::radiance(self, panels)])
    }
}

impl PictureSubject for MultipleScattering {
    type Shared = Sunlit;

    const BEFORE_SKY: bool = false;
    const SHOWS_SKY: bool = true;
    const ALONG_RAY: bool = false;
    const IS_PREDICTED: bool = false;

    fn read_shared(settings: &Settings, view: Option<&View>) -> Option<Sunlit> {
        let phase = Phase::read(settings);
        let albedo = read_albedo(settings, view.map(|view| &*view.volumes[0]));
        Some(Sunlit { albedo: albedo?, phase: phase?, sky: view?.sky })
    }

    fn at(shared: &Sunlit, volumes: &[Arc<Volume>], ray: &Ray) -> Option<Self> {
        let (albedo, phase) = (shared.albedo.clone(), shared.phase);
        Some(Self::new(Scene { volume: volumes[0].clone(), albedo, phase }, shared.sky, *ray))
    }

    /// A white furnace absorbs nothing, and is as bright as its walls.
    fn has_exact(shared: &Sunlit) -> bool {
        shared.albedo.even() == Some(1.0) && matches!(shared.sky, Sky::Constant { .. })
    }

    fn exact(&self) -> Option<Vec<Known>> {
        Some(vec![Known::exact(self.background())])
    }
}

/// Sky, and the scattering of the medium.
pub struct Sunlit {
    albedo: Albedo,
    phase: Phase,
    sky: Sky,
}
