//! Problems: the quantities that estimators answer, each with the settings of its cases.

pub mod ball;
pub mod bidirectional_rod;
pub mod channels;
pub mod free_flight;
pub mod furnace;
pub mod infinite_medium;
pub mod lambertian;
pub mod lit_rod;
pub mod lit_slab;
pub mod options;
pub mod rod;
pub mod scene;
pub mod single_scattering;
pub mod sky;
pub mod slab;
pub mod transmittance;

use fearless_simd::Level;

use media::body::{MAX_CHANNELS, RayNeed};
use media::catalogue::{Domain, Page, Settings, Value};
use media::{Body, Lookups, Medium};

pub use ball::{MultipleScattering, Sphere};
pub use bidirectional_rod::BidirectionalRod;
pub use free_flight::FreeFlight;
pub use furnace::{Furnace, SpectralFurnace};
pub use infinite_medium::InfiniteMedium;
pub use lambertian::Lambertian;
pub use lit_rod::{LitRod, SpectralLitRod};
pub use lit_slab::LitSlab;
pub use options::ProblemOption;
pub use rod::{Rod, SpectralRod};
pub use scene::{Albedo, Scene};
pub use single_scattering::{SingleScattering, SpectralSingleScattering};
pub use sky::Sky;
pub use slab::{ChromaticSlab, Slab, SpectralSlab};
pub use transmittance::{SpectralTransmittance, Transmittance, TransmittanceCurve};

/// Lists every problem with its forms, in the order of the catalogue. A form is the type of the draws that a case's
/// options ask for; the first has no options. From the line of a problem come its page and its name in case files, and
/// from that of a form its estimators.
///
/// `each_problem!(Kind::of)` is an array of problems. Each is a `Vec` of `Kind::of::<Form>()`, one for each of its forms, in
/// their order. No function can return it, because forms are types.
#[macro_export]
macro_rules! each_problem {
    ($($then:tt)+) => {
        $crate::of_problems! {
            $($then)+:
            transmittance: Transmittance TransmittanceCurve SpectralTransmittance,
            free_flight: FreeFlight,
            rod: Rod LitRod SpectralRod SpectralLitRod BidirectionalRod,
            slab: Slab LitSlab SpectralSlab ChromaticSlab,
            single_scattering: SingleScattering SpectralSingleScattering,
            furnace: Furnace SpectralFurnace,
            lambertian: Lambertian,
            infinite_medium: InfiniteMedium,
            ball: Sphere,
        }
    };
}
pub use each_problem;

/// Makes what [`each_problem!`] is asked for from its list.
#[macro_export]
#[doc(hidden)]
macro_rules! of_problems {
    (pages: $($module:ident: $($Form:ident)*,)*) => {
        /// Every problem.
        pub const CATALOGUE: &[Page] = &[$(media::page!($module)),*];

        $($(impl Named for $Form {
            const MODULE: &'static str = stringify!($module);
        })*)*
    };
    ($Kind:ident::$of:ident: $($module:ident: $($Form:ident)*,)*) => {
        [$(vec![$($Kind::$of::<$crate::problems::$Form>()),*]),*]
    };
}
each_problem!(pages);

/// Names of the problems in case files, in the order of the catalogue.
pub fn names() -> Vec<String> {
    CATALOGUE.iter().map(Page::name).collect()
}

/// The name of a problem.
pub trait Named: Problem {
    /// Module of the problem's page, as in `single_scattering`.
    const MODULE: &'static str;

    /// Name of the form, as in `rod with light`; that of the problem where the form has no options.
    fn title() -> String {
        let name = Self::MODULE.replace('_', "-");
        let options = options::joined(Self::OPTIONS, ProblemOption::name);
        options.map_or(name.clone(), |options| format!("{name} with {options}"))
    }
}

/// Multiple scattering is sought in pictures only.
impl Named for MultipleScattering {
    const MODULE: &'static str = "pictures of multiple_scattering";
}

/// An integral along one ray.
///
/// Estimators are written for one problem, so that a wrong pairing does not compile.
pub trait Problem: Send + Sync + Sized + 'static {
    /// Type of a draw: one number per channel.
    type Value: Copy + AsRef<[f64]>;

    /// The options of a case that choose this form of the problem.
    const OPTIONS: &'static [ProblemOption] = &[];
    /// Requirement on the ray through a volume.
    const RAY: RayNeed = RayNeed::Whole;
    /// True if each channel (wavelength) has a medium of its own.
    const SPECTRAL: bool = options::has_media(Self::OPTIONS);

    /// Reads what the problem needs beside the field, which is absent after a mistake.
    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self>;

    /// The field of each channel along the ray.
    fn media(&self) -> &[Medium];

    /// The field along the ray, of the first channel.
    fn medium(&self) -> &Medium {
        &self.media()[0]
    }

    /// Lookups of all fields, for kernels on the hardware of a level.
    fn lookups(&self, level: Level) -> Lookups<'_> {
        Lookups::of_channels(self.medium(), &self.media()[1..], level)
    }

    /// A copy in a medium of another albedo; `None` if the answer does not depend on it.
    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        let _ = albedo;
        None
    }

    /// The logarithm of what draws are multiplied by, where values of the given optical depth
    /// would otherwise underflow; 0 for all others.
    fn log_unit(&self, depth: f64) -> f64 {
        let _ = depth;
        0.0
    }

    /// The distance that each channel of a draw is about, for problems that are seen from the side.
    fn distances(&self) -> Vec<f64> {
        vec![self.medium().span().to]
    }
}

/// Methods of problems with particles that walk through a `scene`.
macro_rules! in_space {
    () => {
        fn media(&self) -> &[Medium] {
            std::slice::from_ref(&self.medium)
        }

        fn with_albedo(&self, albedo: f64) -> Option<Self> {
            Some(Self { scene: self.scene.with_albedo(albedo), ..self.clone() })
        }
    };
}
use in_space;

/// The values of one draw, at most N.
#[derive(Debug, Clone, Copy)]
pub struct Values<const N: usize> {
    /// The values; the first `count` are meant.
    pub at: [f64; N],
    /// Number of values.
    pub count: usize,
}

/// The values of one draw, one for each channel (wavelength).
pub type ChannelValues = Values<MAX_CHANNELS>;

/// Numbers, one per channel.
pub trait Channels {
    /// Values of the first `count` channels.
    fn of(count: usize, value: impl Fn(usize) -> f64) -> Self;
}

impl<const N: usize> Channels for [f64; N] {
    #[inline(always)]
    fn of(count: usize, value: impl Fn(usize) -> f64) -> Self {
        let mut at = [0.0; N];
        for (number, at) in at[..count].iter_mut().enumerate() {
            *at = value(number);
        }
        at
    }
}

impl<const N: usize> Channels for Values<N> {
    #[inline(always)]
    fn of(count: usize, value: impl Fn(usize) -> f64) -> Self {
        Self { at: Channels::of(count, value), count }
    }
}

impl<const N: usize> AsRef<[f64]> for Values<N> {
    fn as_ref(&self) -> &[f64] {
        &self.at[..self.count]
    }
}

/// The albedo of a case that sweeps it, and need not give one.
fn default_albedo(settings: &Settings) -> Option<f64> {
    let Value::Table(sweep) = &settings.entry("sweep")?.node.value else { return None };
    sweep.iter().any(|entry| entry.key == "albedo").then_some(0.5)
}

/// A number in `[0, 1]`, which must be given where it has no default.
fn number(settings: &Settings, key: &'static str, default: Option<f64>) -> Option<f64> {
    match default {
        Some(default) => settings.number_or(key, Domain::Unit, default),
        None => settings.number(key, Domain::Unit),
    }
}
