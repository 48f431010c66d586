//! Where mutants are shown: experiments of the built-in suite.
//!
//! Most stand on the cases called `known-bugs`, made for this: an asymmetric medium, dense at both ends, and
//! estimators for every regime of `r = (σ_t − σ_c)/σ̂`.

/// One experiment of a case of the built-in suite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The case.
    pub case: &'static str,
    /// Which estimator of the case, from 0.
    pub index: usize,
    /// The same estimator by the name that tables give it.
    pub estimator: &'static str,
    /// Where in the sweep, in cases that have one.
    pub swept: Option<f64>,
}

const fn on(case: &'static str, index: usize, estimator: &'static str) -> Target {
    Target { case, index, estimator, swept: None }
}

/// In the case that was made for mutants.
const fn transmittance(index: usize, estimator: &'static str) -> Target {
    on("transmittance/known-bugs", index, estimator)
}

/// `σ̂ = 1.2`, a majorant.
pub const WOODCOCK: Target = transmittance(0, "woodcock");
/// `σ̂ = 0.6`, `0.67 ≤ r ≤ 1.83`.
pub const BELOW: Target = transmittance(1, "ratio");
/// `σ̂ = 30`: 90 lookups a draw, a relative standard deviation of a quarter.
pub const DENSE: Target = transmittance(2, "ratio");
/// A linear σ̂.
pub const LINEAR: Target = transmittance(3, "ratio");
/// A piecewise-constant σ̂.
pub const STEPS: Target = transmittance(4, "ratio");
/// A control through five points, `σ̂ = 0.5`.
pub const EXPLORERS: Target = transmittance(5, "double");
/// `σ_c = 0.9`, `σ̂ = 1`, `−0.5 ≤ r ≤ 0.2`.
pub const NEGATIVE: Target = transmittance(6, "residual-ratio");
/// `σ̂ = 0.6`, `0.67 ≤ r ≤ 1.83`.
pub const TERMINATING: Target = transmittance(7, "single (terminating)");
/// `σ_c = 0.55`, `σ̂ = 0.22`, `−0.7 ≤ r ≤ 2.5`.
pub const CLAMPED: Target = transmittance(8, "single (clamped)");
/// `a = 0.7`, `σ̂ = 0.6`, `0.67 ≤ r ≤ 1.83`.
pub const NON_TERMINATING: Target = transmittance(9, "single (non-terminating, a=0.7)");
/// `a = 0.7`, `σ_c = 0.55`, `σ̂ = 0.4`, `−0.4 ≤ r ≤ 1.4`.
pub const ADAPTIVE: Target = transmittance(10, "single (adaptive, a=0.7)");
/// `σ_c = 0.3`, `σ̂ = 0.9`.
pub const DECOMPOSITION: Target = transmittance(11, "decomposition");
/// Three segments.
pub const LOCAL_MAJORANT: Target = transmittance(12, "local-majorant");
/// `σ̂ = 1`.
pub const NEXT_FLIGHT: Target = transmittance(13, "next-flight");
/// `σ̂ = 1`.
pub const MIS: Target = transmittance(14, "unidirectional-mis");
/// An optical depth of 110, nearly all of it in the control.
pub const DEEP: Target = on("transmittance/deep", 0, "residual-ratio");
/// `r = 1` and `r = 0` exactly, albedo 0.
pub const RATIO_ONE: Target = Target {
    swept: Some(0.0),
    ..on("transmittance/ratio-exactly-one", 0, "single (non-terminating)")
};
/// Free flight through a constant majorant, on a line that begins at 1.
pub const FLIGHT: Target = on("free-flight/known-bugs", 0, "woodcock");
/// Free flight through a linear majorant.
pub const FLIGHT_LINEAR: Target = on("free-flight/known-bugs", 1, "woodcock");
/// The curve without a control.
pub const CURVE: Target = on("transmittance/curve-known-bugs", 0, "double");
/// The curve with a control whose knots are not on the ends.
pub const CURVE_CONTROL: Target = on("transmittance/curve-known-bugs", 1, "double");
/// `σ̂ = 1.6`, `a` from 0.9 to 0.5 and `p_f` from 0.8 to 0.3 along the rod.
pub const ROD_TERMINATING: Target = on("rod/known-bugs", 0, "terminating");
/// `σ̂ = 1.6`.
pub const ROD_ANALOG: Target = on("rod/known-bugs", 1, "analog");
/// `σ̂ = 1.6`.
pub const ROD_WEIGHTED: Target = on("rod/known-bugs", 2, "weighted");
/// `σ̂ = 0.9`, below σ_t at both ends.
pub const ROD_NON_TERMINATING: Target = on("rod/known-bugs", 3, "non-terminating");
/// `σ̂ = 0.9`, below σ_t at both ends.
pub const ROD_ADAPTIVE: Target = on("rod/known-bugs", 4, "adaptive");
/// `σ̂ = 2.4`, `a = 0.6`, roulette below 1/2.
pub const ROD_ROULETTE: Target = on("rod/roulette", 0, "roulette (below 0.5)");
/// Extinction that rises to the emitter, `p_f = 0.4`, `σ̂ = 1.25`.
pub const LIT_NEXT_EVENT_DELTA: Target = on("rod/lit-rising", 2, "next-event (delta shadow)");
/// The same.
pub const LIT_NEXT_EVENT: Target = on("rod/lit-rising", 3, "next-event (ratio shadow)");
/// The same.
pub const LIT_DIRECTIONAL: Target = on("rod/lit-rising", 4, "directional-mis (delta shadow)");
/// The same.
pub const LIT_FULL: Target = on("rod/lit-rising", 6, "full-mis (ratio shadow)");
/// A wide disc close behind a slab whose extinction rises, g = 0.6, `σ̂ = 1.5`.
pub const LIT_SLAB_NEXT_EVENT: Target = on("slab/lit-known-bugs", 3, "next-event (ratio shadow)");
/// The same.
pub const LIT_SLAB_DIRECTIONAL: Target =
    on("slab/lit-known-bugs", 4, "directional-mis (delta shadow)");
/// The same.
pub const LIT_SLAB_FULL: Target = on("slab/lit-known-bugs", 6, "full-mis (ratio shadow)");
/// The same slab, a beam.
pub const LIT_SLAB_DISTANT: Target = on("slab/lit-distant", 3, "full-mis (ratio shadow)");
/// Single scattering in a homogeneous ball, light outside, exact transmittances.
pub const SINGLE_EXACT: Target =
    on("single-scattering/known-bugs", 0, "source-driven (exact camera, exact shadow)");
/// The same with a ratio-tracked camera.
pub const SINGLE_RATIO: Target =
    on("single-scattering/known-bugs", 1, "source-driven (ratio camera, exact shadow)");
/// The same with ratio-tracked shadow rays.
pub const SINGLE_SHADOW: Target =
    on("single-scattering/known-bugs", 2, "source-driven (exact camera, ratio shadow 1.5)");
/// Equiangular points and delta tracking by null-scattering paths, `σ̂ = 1.2`.
pub const SINGLE_NULL_PATHS: Target = on(
    "single-scattering/known-bugs",
    3,
    "source-delta-mis (null paths, analog, ratio shadow 1.5)",
);
/// One of both.
pub const SINGLE_ONE_SAMPLE: Target = on(
    "single-scattering/known-bugs",
    4,
    "source-delta-mis (null paths, analog, one sample, ratio shadow 1.5)",
);
/// By the power heuristic.
pub const SINGLE_POWER: Target = on(
    "single-scattering/known-bugs",
    5,
    "source-delta-mis (null paths, analog, power, ratio shadow 1.5)",
);
/// Henyey–Greenstein, g = 0.6, light at μ₀ = 0.6, `σ̂ = 1.2`.
pub const SLAB_ANALOG: Target = on("slab/known-bugs", 0, "analog");
/// `σ̂ = 1.2`.
pub const SLAB_WEIGHTED: Target = on("slab/known-bugs", 1, "weighted");
/// `σ̂ = 0.9`, below σ_t at both ends.
pub const SLAB_NON_TERMINATING: Target = on("slab/known-bugs", 2, "non-terminating");
/// `σ̂ = 0.9`, below σ_t at both ends.
pub const SLAB_ADAPTIVE: Target = on("slab/known-bugs", 3, "adaptive");
/// Diffuse light, a σ̂ in steps.
pub const SLAB_DIFFUSE: Target = on("slab/known-bugs-diffuse", 0, "non-terminating");
/// A thin ball, a = 0.9, `r = 1.15`.
pub const FURNACE_BELOW: Target = on("furnace/known-bugs", 0, "particle (non-terminating)");
/// `σ̂ = 1.2`.
pub const FURNACE_NON_TERMINATING: Target =
    on("furnace/known-bugs", 1, "particle (non-terminating)");
/// `σ̂ = 1.2`, roulette below 0.8.
pub const FURNACE_ROULETTE: Target =
    on("furnace/known-bugs", 2, "particle (non-terminating, roulette 0.8)");
/// `σ̂ = 1.2`.
pub const FURNACE_ANALOG: Target = on("furnace/known-bugs", 3, "particle (analog)");
/// Eq. 21, a = 1, `σ̂ = 1`.
pub const LAMBERTIAN: Target = on("lambertian/known-bugs", 0, "particle (non-terminating)");
/// A dense half and a thin one, a cell each.
pub const LAMBERTIAN_CELLS: Target = on("lambertian/known-bugs-cells", 0, "particle (analog)");
/// Henyey–Greenstein, g = 0.6, a = 0.7.
pub const INFINITE_ANALOG: Target = on("infinite-medium/known-bugs", 0, "particle (analog)");
/// Roulette below 0.5.
pub const INFINITE_WEIGHTED: Target =
    on("infinite-medium/known-bugs", 1, "particle (weighted, roulette 0.5)");
/// A weighted walk in a ball, ratio-tracked shadow rays to a black light sphere.
pub const SPHERE_LAMP: Target = on("ball/known-bugs", 0, "next-event (weighted, ratio shadow 2)");
/// The same with exact shadow rays.
pub const SPHERE_LAMP_EXACT: Target =
    on("ball/known-bugs", 1, "next-event (weighted, exact shadow)");
/// The same ball in an environment.
pub const SPHERE_SKY: Target = on("ball/environment", 0, "next-event (weighted, ratio shadow 2)");
/// A black light sphere in a ball that thins out, by directions.
pub const SPHERE_DIRECTIONAL: Target =
    on("ball/known-bugs-paths", 0, "directional-mis (analog, delta shadow 2.5)");
/// The same by null-scattering paths.
pub const SPHERE_FULL: Target = on("ball/known-bugs-paths", 1, "full-mis (analog, ratio shadow)");
/// The same, the power heuristic.
pub const SPHERE_POWER: Target =
    on("ball/known-bugs-paths", 2, "full-mis (analog, ratio shadow, power)");
/// The same, with connections.
pub const SPHERE_BIDIRECTIONAL: Target =
    on("ball/known-bugs-paths", 3, "bidirectional (independent subpaths)");
/// In an environment, by null-scattering paths.
pub const SPHERE_FULL_SKY: Target = on("ball/techniques", 3, "full-mis (analog, ratio shadow)");
/// The same with connections.
pub const SPHERE_BIDIRECTIONAL_SKY: Target =
    on("ball/techniques", 6, "bidirectional (independent subpaths)");
/// Three layers in three channels, one channel a draw.
pub const SPECTRAL_INDEPENDENT: Target =
    on("transmittance/spectral-layers", 0, "independent (delta)");
/// All channels by one walk, `σ̂ = 1.6, 1.1, 1.9`.
pub const SPECTRAL_MIS_RATIO: Target =
    on("transmittance/spectral-layers", 4, "spectral-mis (ratio)");
/// The same by delta tracking.
pub const SPECTRAL_MIS_DELTA: Target =
    on("transmittance/spectral-layers", 5, "spectral-mis (delta)");
/// `σ̂ = 1.9` for all channels.
pub const SPECTRAL_MAXIMUM: Target =
    on("transmittance/spectral-layers", 9, "spectral-tracking (maximum)");
/// `σ̂ = 1.9` for all channels.
pub const SPECTRAL_HISTORY: Target =
    on("transmittance/spectral-layers", 10, "spectral-tracking (history)");
/// Albedos .99, .5 and .1, `p_f = .75`, an optical length of 2.
pub const SPECTRAL_ROD_MIS: Target = on("rod/spectral-three-albedos", 1, "spectral-mis");
/// The same with a thin rod of albedos .6, .5 and .4.
pub const SPECTRAL_ROD_TRACKING: Target =
    on("rod/spectral-near-albedos", 1, "spectral-tracking (average)");
/// A slab of albedos .9, .5 and .2, σ̂ above σ_t.
pub const SPECTRAL_SLAB_MIS: Target = on("slab/spectral-known-bugs", 3, "spectral-mis");
/// The same.
pub const SPECTRAL_SLAB_TRACKING: Target =
    on("slab/spectral-known-bugs", 1, "spectral-tracking (average)");
/// The same scattering a point light once, exact shadow rays.
pub const SPECTRAL_SINGLE_EXACT: Target =
    on("single-scattering/spectral-known-bugs", 2, "spectral-mis (exact shadow)");
/// Tracked shadow rays.
pub const SPECTRAL_SINGLE_RATIO: Target =
    on("single-scattering/spectral-known-bugs", 3, "spectral-mis (ratio shadow)");
/// The walk of a hero without multiple importance sampling, tracked shadow rays.
pub const SPECTRAL_SINGLE_HERO: Target =
    on("single-scattering/spectral-without-mis", 1, "hero (ratio shadow, hero 0.3 0.3 0.4)");
/// All channels together.
pub const SPECTRAL_SINGLE_TRACKING: Target =
    on("single-scattering/spectral-without-mis", 2, "spectral-tracking (exact shadow, average)");
/// All channels together in a slab.
pub const CHROMATIC_SLAB_TRACKING: Target =
    on("slab/chromatic-like-colours", 3, "spectral-tracking (average)");
/// All channels together in a furnace.
pub const SPECTRAL_FURNACE_TRACKING: Target =
    on("furnace/spectral-like-colours", 4, "spectral-tracking (maximum)");
/// Three channels of different σ_t, σ̂, albedo and phase function in a slab, light from aslant.
pub const CHROMATIC_SLAB: Target = on("slab/chromatic-three-colours", 1, "spectral-mis");
/// Three channels of different σ_t, σ̂, albedo and phase function in a furnace.
pub const SPECTRAL_FURNACE: Target = on("furnace/spectral-known-bugs", 1, "spectral-mis");
/// Three channels of different σ_t, σ̂, albedo and `p_f`, a σ̂ that touches its σ_t, hits alone.
pub const SPECTRAL_LIT_HITS: Target = on("rod/spectral-lit-three-colours", 1, "spectral-mis");
/// The same by hits and shadow rays.
pub const SPECTRAL_LIT_FULL: Target = on("rod/spectral-lit-three-colours", 2, "next-event-mis");
/// Both orders of a rod by all techniques, exact connections.
pub const BIDIRECTIONAL_FULL: Target =
    on("rod/bidirectional-known-bugs", 0, "full-mis (exact connection)");
/// The same with ratio-tracked connections.
pub const BIDIRECTIONAL_TRACKED: Target =
    on("rod/bidirectional-known-bugs", 1, "full-mis (ratio connection)");
/// Directional weights.
pub const BIDIRECTIONAL_DIRECTIONAL: Target =
    on("rod/bidirectional-known-bugs", 2, "directional-mis (exact connection)");
/// One technique: a connection between two scatterings.
pub const BIDIRECTIONAL_TECHNIQUE: Target =
    on("rod/bidirectional-known-bugs", 3, "technique (s=2, exact connection)");
