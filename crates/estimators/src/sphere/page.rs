//! Estimators with shadow rays: their settings, predictions and draws.

use std::marker::PhantomData;

use fearless_simd::Level;

use super::combined::Combined;
use super::sharing::{Correct, SharedTechniques, Subpaths, WalkEvents};
use super::{connected, realisable};
use crate::space::connection;
use crate::space::walk::InSpace;
use crate::space::{ParticleSettings, draws};
use crate::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits, walks};
use media::Majorants;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::light::Heuristic;
use theory::problems::Sphere;
use theory::problems::ball::BallLight;
use theory::single::Tracking;
use theory::space::sphere::{Techniques, predict};

/// The settings of an estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// The particle.
    pub particle: ParticleSettings,
    /// The techniques that share the vertices of a walk.
    pub sharing: SharedTechniques,
}

impl Method {
    /// Makes a draw through σ̂ by steps.
    pub fn draw(
        &self,
        steps: impl WalkEvents,
        (sphere, majorants): (&Sphere, &Majorants),
        random: &mut Stream,
    ) -> Draw {
        let Self { particle, sharing } = *self;
        let combined =
            Combined::<_, true>::new((sphere, majorants), particle.rule, (sharing, steps));
        let world = (&sphere.scene, majorants);
        draws::draw(&InSpace::new(&combined, particle, world, &[]), random)
    }

    /// Makes a draw of an experiment by steps.
    pub fn draw_for(
        &self,
        steps: impl WalkEvents,
        setup: &Setup<Sphere>,
        random: &mut Stream,
    ) -> Draw {
        self.draw(steps, (&setup.problem, &setup.fields), random)
    }

    /// Makes draws by packets. Not for connections, and not for null-scattering paths where shadow rays have a
    /// tracking with random numbers of their own.
    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<Sphere>,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let Self { particle, sharing } = *self;
        let is_exact = sharing.is_full() && sharing.shadow.is_some();
        let majorants = &*setup.fields;
        let is_tracked = sharing.tracking(particle.rule, majorants).is_some();
        if sharing.subpaths.is_some() || is_exact || !is_tracked {
            return Some(request);
        }
        let (sphere, steps) = (&*setup.problem, (sharing, Correct));
        let combined = Combined::<_, false>::new((sphere, majorants), particle.rule, steps);
        draws::packets(level, &combined, &particle, (&sphere.scene, majorants), request)
    }
}

/// Settings of a page.
pub trait Connecting: Clone + Send + Sync + 'static {
    /// Reads the settings.
    fn read(settings: &Settings) -> Option<Method>;
}

/// An estimator with shadow rays, of a page.
#[derive(Debug, Clone)]
pub struct Connected<P>(Method, PhantomData<P>);

impl<P: Connecting> Estimator<Sphere> for Connected<P> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        P::read(settings).map(|method| Self(method, PhantomData))
    }

    /// The settings are words such as `analog, ratio shadow, power`.
    fn traits(&self) -> Traits {
        let SharedTechniques { shadow, subpaths, .. } = self.0.sharing;
        let mut words = match subpaths {
            Some(Subpaths::Independent) => vec!["independent subpaths".into()],
            Some(Subpaths::Shared) => vec!["shared subpaths".into()],
            None => {
                let shadow = shadow.map_or("ratio shadow".into(), connection::shadow_label);
                vec![self.0.particle.label(), shadow]
            }
        };
        if self.0.sharing.weights().is_some_and(|(_, heuristic)| heuristic == Heuristic::Power) {
            words.push("power".into());
        }
        let needs = shadow.and_then(connection::shadow_needs);
        Traits { settings: words.join(", "), needs, ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Sphere>) -> Result<(), Refusal> {
        match self.0.sharing.shadow {
            Some(shadow) => connected(setup, &self.0.particle, shadow),
            None => realisable(setup, &self.0.particle),
        }
    }

    fn predict(&self, setup: &Setup<Sphere>) -> Prediction {
        let SharedTechniques { techniques, shadow, subpaths } = self.0.sharing;
        let is_distant = matches!(setup.problem.light, BallLight::Distant(_));
        let techniques = match subpaths {
            Some(Subpaths::Shared) => return predict::by_pilots(&setup.problem),
            Some(Subpaths::Independent) if is_distant => return predict::by_pilots(&setup.problem),
            None if is_distant => Techniques::NextEvent,
            _ => techniques,
        };
        // The second moment of ratio tracking through a majorant does not exceed that of delta tracking.
        let shadow = shadow.unwrap_or(Tracking::Exact);
        predict::together(&setup.problem, techniques, shadow)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<Sphere>, request: Request) {
        walks::by(
            kernel,
            setup,
            request,
            |level, _, request| self.0.draw_packets(level, setup, request),
            #[inline(always)]
            |_, random| self.0.draw_for(Correct, setup, random),
        );
    }
}
