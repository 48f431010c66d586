//! Plans of estimators of single scattering, as data: techniques, domains, predictions and draws.

use std::marker::PhantomData;

use fearless_simd::Level;

use super::interactions::Interactions;
use super::main_part::{self, MainPart};
pub use super::points::{Absorption, Vertices};
use super::ray_setup::RaySetup;
use super::shadow::require_shadow;
use super::shared::Shared;
use super::vertices::ToVertices;
use crate::setup::Residual;
use crate::space::connection;
use crate::space::shadow::ShadowRays;
use crate::walks::{self, Walk};
use crate::{Estimator, Inputs, Kernel, Knowledge, Refusal, Request, Setup, Traits};
use media::catalogue::Settings;
use media::{Control, Lookups};
use numeric::geometry::Bounds;
use theory::Prediction;
use theory::problems::{Problem, SingleScattering};
use theory::single::predict::DENSITY;
use theory::single::{
    Camera, CameraTracking, Mis, NullPaths, RayNode, RayScene, TechniqueMoments, Tracking,
    walks as along,
};

/// An estimator: its technique, and its shadow rays.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// Choice of scattering points.
    pub technique: Technique,
    /// Tracking of the transmittance of a shadow ray.
    pub shadow: Tracking,
}

/// Choice of scattering points.
#[derive(Debug, Clone, Copy)]
pub enum Technique {
    /// Points that are chosen one after the other.
    Vertices(Vertices),
    /// All interaction points of a walk.
    Interactions,
    /// One of the interaction points.
    Resampled,
    /// A number of points from the light, with one walk past all of them.
    Shared(usize),
}

impl Vertices {
    fn domain(self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        match (self.main, self.light) {
            (true, true) => main_part::require_straight(setup)?,
            (true, false) => main_part::require(setup)?,
            _ => {}
        }
        if self.collision.is_some() || self.camera == CameraTracking::Delta {
            setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")
        } else if self.camera == CameraTracking::Ratio {
            setup.residual().require_coverage()
        } else {
            Ok(())
        }
    }

    /// Runs the walk.
    #[inline(always)]
    fn run<R: Run>(self, ground: RaySetup, run: R) -> R::Output {
        match (self.is_chosen(), self.collision.is_some()) {
            (true, false) => run.run(&ToVertices::<true, false>::new(ground, self)),
            (true, true) => run.run(&ToVertices::<true, true>::new(ground, self)),
            _ => run.run(&ToVertices::<false, true>::new(ground, self)),
        }
    }

    fn predict(self, setup: &Setup<SingleScattering>, shadow: Tracking) -> Prediction {
        let Some(absorption) = self.collision else {
            return self.points(setup, shadow).prediction();
        };
        if !self.light {
            return at_collisions(setup, absorption, shadow).prediction();
        }
        let nulls = (self.camera == CameraTracking::Ratio)
            .then(|| NullPaths::new(&setup.fields.mesh, &setup.fields.sampling, self.heuristic));
        let scene = &scene(setup, self.camera, shadow);
        let (collisions, heuristic) = (absorption.collisions(setup), self.heuristic);
        let [first, second] = Mis { scene, collisions, heuristic, nulls }.points();
        let result = if self.is_one { first.either(&second) } else { first.plus(&second) };
        result.prediction()
    }

    /// The moments of points from the light, from the main part, or from both.
    fn points(self, setup: &Setup<SingleScattering>, shadow: Tracking) -> TechniqueMoments {
        let main = if self.main { MainPart::of(setup) } else { None };
        let from_light = |node: &RayNode| setup.problem.equiangular_density_beyond(node.along);
        let from_main = |node: &RayNode| main.map_or(0.0, |main| main.density(node.s));
        let sum = |node: &RayNode| {
            let light = if self.light { from_light(node) } else { 0.0 };
            light + from_main(node)
        };
        let kinks = || if self.main { setup.fields.control.breaks() } else { Vec::new() };
        let scene = scene(setup, self.camera, shadow);
        let of = |density: &dyn Fn(&RayNode) -> f64| {
            let technique = theory::single::ScoredDensity {
                density,
                gain: &|node| node.extinction * node.source / sum(node),
                blur: &|node| main.map_or(DENSITY, |main| main.blur(node.s)),
                by_collisions: None,
                weighted: None,
            };
            TechniqueMoments::of(&scene, &technique, kinks())
        };
        match (self.light, self.main) {
            (true, true) => of(&from_light).plus(&of(&from_main)),
            (true, false) => of(&from_light),
            _ => of(&from_main),
        }
    }
}

/// The moments of first real collisions as scattering points.
pub fn at_collisions(
    setup: &Setup<SingleScattering>,
    absorption: Absorption,
    shadow: Tracking,
) -> TechniqueMoments {
    absorption.collisions(setup).points(&scene(setup, CameraTracking::Exact, shadow))
}

/// The setup for theory.
fn scene(
    setup: &Setup<SingleScattering>,
    camera: CameraTracking,
    shadow: Tracking,
) -> RayScene<'_> {
    let camera =
        Camera::new(&setup.fields.mesh, &setup.fields.sampling, &setup.fields.control, camera);
    RayScene::new(&setup.problem, camera, shadow)
}

impl Plan {
    /// Reads `shadow`.
    pub fn read(technique: Option<Technique>, settings: &Settings) -> Option<Self> {
        let shadow = connection::read_shadow(settings);
        Some(Self { technique: technique?, shadow: shadow? })
    }

    fn label(&self) -> String {
        let technique = match &self.technique {
            Technique::Vertices(vertices) => vertices.label(),
            Technique::Shared(points) => format!("{points} points, "),
            _ => String::new(),
        };
        technique + &connection::shadow_label(self.shadow)
    }

    fn needs(&self) -> Option<Knowledge> {
        let is_exact = matches!(&self.technique, Technique::Vertices(vertices)
            if vertices.is_chosen() && vertices.camera == CameraTracking::Exact);
        is_exact.then_some(Knowledge::OpticalDepth).or(connection::shadow_needs(self.shadow))
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        match &self.technique {
            Technique::Vertices(vertices) => vertices.domain(setup)?,
            Technique::Shared(_) => setup.residual().require_coverage()?,
            // σ̂ must reach wherever the residual is not zero, and wherever there is anything to scatter.
            Technique::Interactions | Technique::Resampled => {
                setup.residual().require_coverage()?;
                if !setup.fields.control.is_none() {
                    let scattering = Residual { control: &Control::None, ..setup.residual() };
                    scattering.require_coverage()?;
                }
            }
        }
        require_shadow(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let scene = || scene(setup, CameraTracking::Ratio, self.shadow);
        match &self.technique {
            Technique::Vertices(vertices) => vertices.predict(setup, self.shadow),
            Technique::Interactions => along::at_collisions(&scene()).prediction(),
            Technique::Resampled => {
                along::resampled(&scene(), self.shadow == Tracking::Exact).prediction()
            }
            Technique::Shared(points) => {
                let density = |node: &RayNode| setup.problem.equiangular_density_beyond(node.along);
                along::at_points(&scene(), *points, &density).prediction()
            }
        }
    }

    /// Runs the walk of the plan.
    #[inline(always)]
    fn run<R: Run>(&self, ground: RaySetup, run: R) -> R::Output {
        match self.technique {
            Technique::Vertices(vertices) => vertices.run(ground, run),
            Technique::Interactions => run.run(&Interactions::<false> { ground }),
            Technique::Resampled => run.run(&Interactions::<true> { ground }),
            Technique::Shared(points) => run.run(&Shared { ground, points }),
        }
    }

    /// Runs the walk of the plan on a setup, one walk after the other.
    #[inline(always)]
    pub fn run_on<R: Run>(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        run: R,
    ) -> R::Output {
        let volume = setup.problem.volume();
        let rays = ShadowRays::new(volume, volume.bounds(), self.shadow);
        self.run(RaySetup::new(setup, medium, &rays, &[]), run)
    }

    /// Makes the draws of a request: compiled once for all pages.
    fn fill(&self, kernel: Kernel, setup: &Setup<SingleScattering>, request: Request) {
        let left = match kernel {
            Kernel::Single => Some(request),
            Kernel::Packets(level) => {
                let medium = &setup.problem.lookups(level);
                self.draw_packets(level, setup, medium, request)
            }
        };
        if let Some(request) = left {
            let medium = &setup.problem.lookups(Level::new());
            self.run_on(setup, medium, InTurn { setup, request });
        }
    }

    /// Makes the draws of a request in packets. Returns the request where the hardware is too narrow, where σ̂ has
    /// several values, and where one draw after the other is faster.
    fn draw_packets<'r>(
        &self,
        level: Level,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        request: Request<'r>,
    ) -> Option<Request<'r>> {
        let (volume, shadow) = (setup.problem.volume(), self.shadow);
        let is_single = setup.fields.control.single_value().is_some();
        // Packets do not pay for one cheap sample alone, nor for a main part of many pieces beside a tracked
        // camera.
        let is_slow = matches!(self.technique, Technique::Vertices(plan)
            if plan.is_one && shadow == Tracking::Exact && !medium.is_costly()
                || plan.main && plan.camera != CameraTracking::Exact && !is_single);
        if is_slow {
            return Some(request);
        }
        let rays = ShadowRays::new(volume, volume.bounds(), shadow);
        let fields = [volume.batches(level, matches!(rays.bounds, Bounds::Box(_)))];
        let ground = RaySetup::new(setup, medium, &rays, &fields);
        self.run(ground, SideBySide { level, setup, medium, request })
    }
}

/// A use of a walk.
pub trait Run {
    /// Result of the use.
    type Output;

    /// Uses the walk.
    fn run(self, walk: &impl Walk) -> Self::Output;
}

/// A use that makes the draws of a request one walk after the other.
struct InTurn<'a, 'r> {
    setup: &'a Setup<SingleScattering>,
    request: Request<'r>,
}

impl Run for InTurn<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self, walk: &impl Walk) {
        walks::in_turn(walk, self.setup, self.request);
    }
}

/// A use that makes the draws of a request in packets.
struct SideBySide<'a, 'r> {
    level: Level,
    setup: &'a Setup<SingleScattering>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl<'r> Run for SideBySide<'_, 'r> {
    type Output = Option<Request<'r>>;

    #[inline(always)]
    fn run(self, walk: &impl Walk) -> Self::Output {
        walks::packets(self.level, walk, self.setup, self.medium, self.request)
    }
}

/// The plan of a page of the catalogue.
pub trait Planned: Clone + Send + Sync + 'static {
    /// Inputs of the estimator, unless its settings say otherwise.
    const INPUTS: Inputs;

    /// Reads the settings.
    fn read(settings: &Settings) -> Option<Plan>;
}

/// An estimator by a plan.
#[derive(Debug, Clone)]
pub struct ByPlan<P>(Plan, PhantomData<P>);

impl<P: Planned> Estimator<SingleScattering> for ByPlan<P> {
    const INPUTS: Inputs = P::INPUTS;

    fn read(settings: &Settings) -> Option<Self> {
        P::read(settings).map(|plan| Self(plan, PhantomData))
    }

    fn traits(&self) -> Traits {
        let inputs = match &self.0.technique {
            Technique::Vertices(vertices) => vertices.inputs(),
            _ => Inputs::BOTH,
        };
        let (settings, needs) = (self.0.label(), self.0.needs());
        Traits { inputs, settings, needs, ..Traits::of(P::INPUTS) }
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        self.0.domain(setup)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        self.0.predict(setup)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<SingleScattering>, request: Request) {
        self.0.fill(kernel, setup, request);
    }
}
