//! The two transmittances of a scattering point: from the ray's origin, and from the light.
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `camera` | `"exact"`, `"ratio"` (residual ratio where there is a control) or `"delta"`, through σ̂ | `"exact"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, each one number | `"exact"` |
//!
//! The exact ones evaluate optical depths, never σ_t: no lookups. They are theory, which uses the platform's
//! library: the last bits of draws with one may differ between machines.
//!
//! A shadow ray is clipped to the bounds of the volume and walked from the scattering point. It costs no lookup
//! where σ_t = 0 at the scattering point, or where it misses the bounds. No ray is cast where delta tracking ended
//! on the way to the point. One is cast where a tracked weight has become 0, because the probability of that
//! depends on the rounding of σ̂ and σ_t.

use crate::Knowledge;
use media::Volume;
use media::catalogue::{Domain, Settings};
use numeric::geometry::Ray;
use numeric::{Lane, Span};
use theory::single::Tracking;

/// Reads `shadow`.
pub fn read_shadow(settings: &Settings) -> Option<Tracking> {
    if !settings.has("shadow") {
        return Some(Tracking::Exact);
    }
    let names = ["exact", "ratio", "delta"].map(str::to_owned);
    let (index, tracking) = settings.chosen("shadow", &names)?;
    let read = match index {
        0 => Some(Tracking::Exact),
        1 => {
            let sampling = tracking.number("sampling", Domain::Positive);
            let control = tracking.number_or("control", Domain::NonNegative, 0.0);
            sampling.zip(control).map(|(sampling, control)| Tracking::Ratio { sampling, control })
        }
        _ => tracking
            .number("sampling", Domain::Positive)
            .map(|sampling| Tracking::Delta { sampling }),
    };
    tracking.close();
    read
}

/// A shadow in words.
pub fn shadow_label(shadow: Tracking) -> String {
    match shadow {
        Tracking::Exact => "exact shadow".into(),
        Tracking::Ratio { sampling, control: 0.0 } => format!("ratio shadow {sampling}"),
        Tracking::Ratio { sampling, control } => {
            format!("residual ratio shadow {sampling}, {control}")
        }
        Tracking::Delta { sampling } => format!("delta shadow {sampling}"),
    }
}

/// Known quantities that exact shadow rays need.
pub fn shadow_needs(shadow: Tracking) -> Option<Knowledge> {
    (shadow == Tracking::Exact).then_some(Knowledge::OpticalDepth)
}

/// The transmittance of an interval of a ray within the bounds of a volume, in closed form.
pub fn exact(volume: &Volume, ray: &Ray, inside: Span) -> f64 {
    Lane::exp(-volume.along(ray, inside).optical_depth(inside).value)
}
