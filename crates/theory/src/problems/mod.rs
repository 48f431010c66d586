//! What is sought: each problem knows its own exact answer. Floor 2.

pub mod bidirectional_rod;
pub mod chromatic_slab;
pub mod free_flight;
pub mod furnace;
pub mod infinite_medium;
pub mod lambertian;
pub mod lit_rod;
pub mod lit_slab;
pub mod rod;
pub mod single_scattering;
pub mod slab;
pub mod spectral_furnace;
pub mod spectral_lit_rod;
pub mod spectral_rod;
pub mod spectral_single_scattering;
pub mod spectral_slab;
pub mod spectral_transmittance;
pub mod sphere;
pub mod transmittance;
pub mod transmittance_curve;

use fearless_simd::Level;

use media::body::RayNeed;
use media::catalogue::{Domain, PageList, Settings, Value};
use media::{Body, Lookups, Medium, Volume};

pub mod multiple_scattering;
pub mod scene;
pub mod sky;

pub use bidirectional_rod::BidirectionalRod;
pub use chromatic_slab::ChromaticSlab;
pub use free_flight::FreeFlight;
pub use furnace::Furnace;
pub use infinite_medium::InfiniteMedium;
pub use lambertian::Lambertian;
pub use lit_rod::LitRod;
pub use lit_slab::LitSlab;
pub use multiple_scattering::MultipleScattering;
pub use rod::Rod;
pub use scene::{Albedo, Scene};
pub use single_scattering::SingleScattering;
pub use sky::Sky;
pub use slab::Slab;
pub use spectral_furnace::SpectralFurnace;
pub use spectral_lit_rod::SpectralLitRod;
pub use spectral_rod::SpectralRod;
pub use spectral_single_scattering::SpectralSingleScattering;
pub use spectral_slab::SpectralSlab;
pub use spectral_transmittance::SpectralTransmittance;
pub use sphere::Sphere;
pub use transmittance::Transmittance;
pub use transmittance_curve::TransmittanceCurve;

/// Hands every problem, in the order of the design, to another macro. From its one line here come the
/// module, the name in case files, the reader of its cases, and its rows in `trueflight list`.
#[macro_export]
macro_rules! each_problem {
    ($then:ident) => {
        $then! {
            transmittance::Transmittance,
            free_flight::FreeFlight,
            transmittance_curve::TransmittanceCurve,
            spectral_transmittance::SpectralTransmittance,
            rod::Rod,
            spectral_rod::SpectralRod,
            lit_rod::LitRod,
            lit_slab::LitSlab,
            spectral_lit_rod::SpectralLitRod,
            slab::Slab,
            spectral_slab::SpectralSlab,
            chromatic_slab::ChromaticSlab,
            single_scattering::SingleScattering,
            spectral_single_scattering::SpectralSingleScattering,
            furnace::Furnace,
            spectral_furnace::SpectralFurnace,
            lambertian::Lambertian,
            infinite_medium::InfiniteMedium,
            sphere::Sphere,
            bidirectional_rod::BidirectionalRod,
        }
    };
}
pub use each_problem;

macro_rules! pages {
    ($($module:ident :: $Problem:ident,)*) => {
        /// Every problem.
        pub const CATALOGUE: PageList =
            PageList { name: "problems", pages: &[$(media::page!($module)),*] };

        $(impl Named for $Problem {
            const MODULE: &'static str = stringify!($module);
        })*
    };
}
each_problem!(pages);

/// A problem's name.
pub trait Named {
    /// That of its module, as in `single_scattering`.
    const MODULE: &'static str;
}

/// Multiple scattering is sought in pictures only.
impl Named for MultipleScattering {
    const MODULE: &'static str = "pictures of multiple_scattering";
}

/// An integral along one ray.
///
/// Estimators are written for one problem, so that a wrong pairing does not compile.
pub trait Problem: Send + Sync + Sized + 'static {
    /// What one draw is: one number per channel.
    type Value: Copy + AsRef<[f64]>;

    /// What it asks of the ray through a volume.
    const RAY: RayNeed = RayNeed::Whole;
    /// Whether its medium may have several channels (wavelengths).
    const SPECTRAL: bool = false;

    /// Reads what the problem needs beside the field, which is absent after a mistake.
    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self>;

    /// The field along the ray.
    fn medium(&self) -> &Medium;

    /// The field of each channel along the ray, that of [`Problem::medium`] first.
    fn media(&self) -> &[Medium] {
        std::slice::from_ref(self.medium())
    }

    /// Their lookups, for kernels on the hardware of a level.
    fn lookups(&self, level: Level) -> Lookups<'_> {
        Lookups::of_channels(self.medium(), &self.media()[1..], level)
    }

    /// The field in space that particles walk through, for problems that take σ̂ in space.
    fn volume(&self) -> Option<&Volume> {
        None
    }

    /// The same problem in a medium of another albedo; `None` if the answer does not depend on it.
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

/// What problems have in common whose particles walk through a `scene`.
macro_rules! in_space {
    () => {
        fn medium(&self) -> &Medium {
            &self.medium
        }

        fn volume(&self) -> Option<&media::Volume> {
            Some(&*self.scene.volume)
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
    /// How many.
    pub count: usize,
}

/// Numbers, one per channel.
pub trait Channels {
    /// So many, one after the other.
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
