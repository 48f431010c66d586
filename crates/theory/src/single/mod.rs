//! Single scattering of a point light: the radiance, and all moments of its estimates.
//!
//! A draw that scatters at one point s, found with density p, is a product of three factors that
//! are independent once s is known: the gain `σ_t S/p`, the transmittance from the ray's origin and
//! that of the shadow ray. Hence, for every k,
//!
//! ```text
//! E[X^k] = ∫ p (σ_t S/p)^k E[T̂(s)^k] E[T̂_shadow(s)^k] ds,   S = a p(cos θ) Φ/(4π r²)
//! ```
//!
//! where the moments of a tracked transmittance are those of a Poisson product, integrals along its segment. Where
//! two techniques are weighted by the densities of whole null-scattering paths, weights depend on the walk from the
//! origin, too ([`mis`]). Draws that scatter at several points of one walk obey a chain of such integrals
//! ([`chain`]). Where a part of the answer has no closed form, the whole is a quadrature in one variable, adaptive
//! to a bound that is stated. In media of many pieces shadow rays are interpolated, and the error is estimated
//! ([`shadows`]).

pub mod camera;
pub mod chain;
pub mod collisions;
pub mod mis;
pub mod null_path;
pub mod predict;
pub mod quick;
pub mod scene;
pub mod segment;
pub mod shadows;
pub mod spectral;
pub mod walks;

pub use camera::Camera;
pub use collisions::Collisions;
pub use mis::Mis;
pub use null_path::NullPaths;
pub use predict::{ScoredDensity, TechniqueMoments};
pub use scene::{RayNode, RayScene};
pub use segment::{Segment, Tracking};

/// Estimate of the transmittance from the ray's origin to a scattering point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameraTracking {
    /// In closed form.
    Exact,
    /// By ratio tracking through σ̂, or residual ratio tracking where there is a control.
    Ratio,
    /// By delta tracking through σ̂: 1 or 0.
    Delta,
}
