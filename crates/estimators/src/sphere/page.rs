//! What estimators of several techniques have in common.

use fearless_simd::Level;

use super::combined::{Combined, Sharing, Steps, Subpaths};
use super::{connected, find, packet, predict_by_pilots, predict_together, realisable};
use crate::kernels::packet::Request;
use crate::single_scattering::connection;
use crate::space::Particle;
use crate::space::segment::Tracker;
use crate::{Draw, Refusal, Setup};
use media::Majorants;
use numeric::rng::Stream;
use theory::lit_rod::Densities;
use theory::problems::Sphere;
use theory::problems::sphere::Light;
use theory::single::Tracking;
use theory::sphere::Techniques;
use theory::{Heuristic, Prediction};

/// What the settings of a page say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Page {
    /// How the particle walks.
    pub particle: Particle,
    /// Which techniques share what it finds.
    pub sharing: Sharing,
}

impl Page {
    /// In words, as in `analog, ratio shadow, power`.
    pub fn label(&self) -> String {
        let Sharing { heuristic, shadow, subpaths, .. } = self.sharing;
        let mut words = match subpaths {
            Some(Subpaths::Independent) => vec!["independent subpaths".into()],
            Some(Subpaths::Shared) => vec!["shared subpaths".into()],
            None => {
                let shadow = shadow.map_or("ratio shadow".into(), connection::shadow_label);
                vec![self.particle.label(), shadow]
            }
        };
        if heuristic == Heuristic::Power {
            words.push("power".into());
        }
        words.join(", ")
    }

    /// Knowledge that exact shadow rays need.
    pub fn needs(&self) -> Option<&'static str> {
        self.sharing.shadow.and_then(connection::shadow_needs)
    }

    /// Whether it is unbiased, and judged by something.
    ///
    /// # Errors
    ///
    /// The violated inequality.
    pub fn domain(&self, setup: &Setup<Sphere>) -> Result<(), Refusal> {
        match self.sharing.shadow {
            Some(shadow) => connected(setup, &self.particle, shadow),
            None => realisable(setup, &self.particle),
        }
    }

    /// What theory says of a draw.
    pub fn predict(&self, setup: &Setup<Sphere>) -> Prediction {
        let Sharing { densities, heuristic, shadow, subpaths } = self.sharing;
        let is_distant = matches!(setup.problem.light, Light::Distant(_));
        // Ratio tracking through a majorant is no wilder than delta tracking.
        let shadow = shadow.unwrap_or(Tracking::Exact);
        let techniques = match subpaths {
            Some(Subpaths::Shared) => return predict_by_pilots(setup),
            Some(Subpaths::Independent) if is_distant => return predict_by_pilots(setup),
            Some(Subpaths::Independent) => Techniques::Bidirectional(heuristic),
            None if is_distant => Techniques::NextEvent,
            None => Techniques::Mis(densities, heuristic),
        };
        predict_together(setup, techniques, shadow)
    }

    /// Makes a draw through σ̂, by the steps of someone.
    pub fn draw(
        &self,
        steps: &dyn Steps,
        (sphere, majorants): (&Sphere, &Majorants),
        rng: &mut Stream,
    ) -> Draw {
        let tracker = Tracker { scene: &sphere.scene, majorants };
        let rule = self.particle.rule;
        let mut combined = Combined::new((sphere, tracker), rule, (self.sharing, steps));
        find(&self.particle, &mut combined, (sphere, majorants), rng)
    }

    /// Makes draws by packets: not of connections, and of null-scattering paths where shadow rays have a tracking with
    /// numbers of their own.
    pub fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<Sphere>,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let (rule, sharing) = (self.particle.rule, &self.sharing);
        let is_exact = sharing.densities == Densities::Full && sharing.shadow.is_some();
        let majorants = setup.space.as_deref().filter(|_| sharing.subpaths.is_none() && !is_exact);
        let Some(shadow) = majorants.and_then(|majorants| sharing.tracking(rule, majorants)) else {
            return Some(request);
        };
        packet::share_by_packets(level, self, shadow, setup, request)
    }

    /// The same for an experiment; no number where there is no σ̂.
    pub fn draw_for(&self, steps: &dyn Steps, setup: &Setup<Sphere>, rng: &mut Stream) -> Draw {
        match setup.space.as_deref() {
            Some(majorants) => self.draw(steps, (&setup.problem, majorants), rng),
            None => Draw::free([f64::NAN], 0),
        }
    }
}

/// The plumbing of a page: all that differs is how it reads its settings, as in `pages!(FullMis)`.
macro_rules! pages {
    ($Page:ident) => {
        impl $crate::Estimator<theory::problems::Sphere> for $Page {
            const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;
            const IN_PACKETS: bool = true;

            fn read(settings: &media::catalogue::Settings) -> Option<Self> {
                Self::page(settings).map(Self)
            }

            fn label(&self, _: bool) -> String {
                self.0.label()
            }

            fn needs(&self) -> Option<&'static str> {
                self.0.needs()
            }

            fn domain(
                &self,
                setup: &$crate::Setup<theory::problems::Sphere>,
            ) -> Result<(), $crate::Refusal> {
                self.0.domain(setup)
            }

            fn predict(
                &self,
                setup: &$crate::Setup<theory::problems::Sphere>,
            ) -> theory::Prediction {
                self.0.predict(setup)
            }

            #[inline]
            fn draw(
                &self,
                setup: &$crate::Setup<theory::problems::Sphere>,
                _: &media::Lookups,
                rng: &mut numeric::rng::Stream,
            ) -> $crate::Draw {
                self.0.draw_for(&$crate::sphere::Honest, setup, rng)
            }

            fn draw_packets<'a>(
                &self,
                level: fearless_simd::Level,
                setup: &$crate::Setup<theory::problems::Sphere>,
                _: &media::Lookups,
                request: $crate::kernels::packet::Request<'a>,
            ) -> Option<$crate::kernels::packet::Request<'a>> {
                self.0.draw_packets(level, setup, request)
            }
        }
    };
}
pub(super) use pages;
