//! An estimator on a problem, with its type erased: what the harness drives.

use fearless_simd::Level;

use super::{DrawBuffer, Estimator, Inputs, RayView, Refusal, Setup};
use crate::kernels::order_free::{self, OrderFree};
use crate::kernels::packet::Request;
use crate::recipes::controls;
use media::even::Even;
use media::{Lookups, Placement};
use numeric::pack::in_fused_code;
use numeric::rng::{Address, Lanes, Streams};
use theory::Prediction;
use theory::problems::Problem;

/// In which order the collisions of a draw come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Order {
    /// One after the other along the ray, as any renderer walks.
    #[default]
    Along,
    /// As they like, by estimators that do not care: other draws, equal in law.
    Free,
}

impl Order {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Along, Self::Free];

    /// The word in cases and arguments.
    pub fn word(self) -> &'static str {
        match self {
            Self::Along => "ordered",
            Self::Free => "order-free",
        }
    }

    /// The order of that name.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|order| order.word() == word)
    }
}

/// How draws are made: the same draws either way, unless they are order-free.
#[derive(Debug, Clone, Copy)]
pub enum Kernel {
    /// One after the other and along the ray, whatever the estimator offers.
    Single,
    /// Eight at a time on the hardware of this level, by estimators that can.
    Packets(Level),
}

/// An estimator on a problem.
pub trait Experiment: Send + Sync {
    /// Replaces the buffer's draws by the next `count` of the block: one virtual call a buffer.
    fn fill_by(&self, kernel: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer);

    /// The same with the best that the machine has.
    fn fill(&self, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        self.fill_by(Kernel::Packets(Level::new()), streams, count, buffer);
    }

    /// See [`Estimator::HAS_INVARIANT`]; order-free draws have none.
    fn has_invariant(&self) -> bool {
        false
    }

    /// In which order the collisions of its draws come.
    fn order(&self) -> Order {
        Order::Along
    }

    /// The share of the ray's support, or in space of the box about the volume, on which σ̂ is 0 because
    /// nothing is to be found there.
    fn skipped(&self) -> f64 {
        0.0
    }

    /// Where on the ray any place is as likely as any other to be that of a collision, in words that are
    /// empty for the whole support: experiments with the same places on the same medium can share
    /// their lookups. `None` where that cannot be.
    fn even_places(&self) -> Option<String> {
        None
    }

    /// So many order-free draws, to be made by [`Experiment::draw_order_free`]; `None` where there are none.
    fn order_free<'a>(
        &'a self,
        request: order_free::Request<'a>,
    ) -> Option<Box<dyn OrderFree + 'a>> {
        let _ = request;
        None
    }

    /// Makes order-free draws of this experiment, or of several that share their lookups with it.
    fn draw_order_free(&self, level: Level, places: &Lanes, requests: &mut [&mut dyn OrderFree]) {
        let _ = (level, places, requests);
    }
}

/// An estimator as written in a case, with its type erased.
pub trait Entry<P: Problem>: Send + Sync {
    /// See [`Estimator::inputs`].
    fn inputs(&self) -> Inputs;
    /// See [`Estimator::INPUTS`].
    fn may_take(&self) -> Inputs;
    /// See [`Estimator::label`].
    fn label(&self, albedo: bool) -> String;
    /// See [`Estimator::with_albedo`].
    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>>;
    /// See [`Estimator::without_control`].
    fn without_control(&self) -> Option<&'static str>;
    /// See [`Estimator::default_control`].
    fn default_control(&self) -> Option<Box<dyn controls::Recipe>>;
    /// See [`Estimator::needs`].
    fn needs(&self) -> Option<&'static str>;
    /// See [`Estimator::domain`].
    ///
    /// # Errors
    ///
    /// The violated inequality and where on the ray.
    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal>;
    /// See [`Estimator::predict`].
    fn predict(&self, setup: &Setup<P>) -> Prediction;
    /// See [`Estimator::ray_view`].
    fn ray_view(&self, setup: &Setup<P>, address: Address) -> Option<RayView>;
    /// See [`Estimator::SKIPS`].
    fn skips(&self) -> bool;
    /// See [`Estimator::ORDER_FREE`].
    fn is_order_free(&self) -> bool;
    /// Joins the estimator and its setup. The order is along the ray where it cannot be free.
    fn experiment(&self, setup: Setup<P>, order: Order) -> Box<dyn Experiment>;
}

impl<P: Problem, E: Estimator<P>> Entry<P> for E {
    fn inputs(&self) -> Inputs {
        Estimator::inputs(self)
    }

    fn may_take(&self) -> Inputs {
        Self::INPUTS
    }

    fn label(&self, albedo: bool) -> String {
        Estimator::label(self, albedo)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>> {
        Estimator::with_albedo(self, albedo).map(|page| Box::new(page) as Box<dyn Entry<P>>)
    }

    fn without_control(&self) -> Option<&'static str> {
        E::without_control()
    }

    fn default_control(&self) -> Option<Box<dyn controls::Recipe>> {
        E::default_control()
    }

    fn needs(&self) -> Option<&'static str> {
        Estimator::needs(self)
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        Estimator::domain(self, setup)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        Estimator::predict(self, setup)
    }

    fn ray_view(&self, setup: &Setup<P>, address: Address) -> Option<RayView> {
        Estimator::ray_view(self, setup, address)
    }

    fn skips(&self) -> bool {
        E::SKIPS
    }

    fn is_order_free(&self) -> bool {
        E::ORDER_FREE
    }

    fn experiment(&self, setup: Setup<P>, order: Order) -> Box<dyn Experiment> {
        let order = if E::ORDER_FREE { order } else { Order::Along };
        Box::new(Trial { estimator: self.clone(), setup, order })
    }
}

struct Trial<P, E> {
    estimator: E,
    setup: Setup<P>,
    order: Order,
}

impl<P: Problem, E: Estimator<P>> Experiment for Trial<P, E> {
    fn fill_by(
        &self,
        kernel: Kernel,
        streams: &mut Streams,
        count: usize,
        buffer: &mut DrawBuffer,
    ) {
        if let (Kernel::Packets(level), Order::Free) = (kernel, self.order) {
            let places = streams.places();
            let request = order_free::Request { counts: &mut streams.counts, count, buffer };
            if let Some(mut walks) = self.order_free(request) {
                self.draw_order_free(level, &places, &mut [&mut *walks]);
            }
            return;
        }
        let request = Request { streams, count, buffer };
        let left = match kernel {
            Kernel::Packets(level) if E::IN_PACKETS => {
                let medium = self.setup.problem.lookups(level);
                self.estimator.draw_packets(level, &self.setup, &medium, request)
            }
            _ => Some(request),
        };
        if let Some(mut request) = left {
            let medium = self.setup.problem.lookups(Level::new());
            in_fused_code(
                #[inline(always)]
                || self.one_by_one(&medium, &mut request),
            );
        }
    }

    fn has_invariant(&self) -> bool {
        E::HAS_INVARIANT && self.order == Order::Along
    }

    fn order(&self) -> Order {
        self.order
    }

    fn skipped(&self) -> f64 {
        self.setup.skipped
    }

    fn even_places(&self) -> Option<String> {
        let even = self.setup.sampling.even().filter(|_| self.order == Order::Free)?;
        let is_whole = self.setup.sampling.single_value().is_some();
        let Even { from, to, gaps, .. } = even;
        Some(if is_whole { String::new() } else { format!("|{from}|{to}|{gaps:?}") })
    }

    fn order_free<'a>(
        &'a self,
        request: order_free::Request<'a>,
    ) -> Option<Box<dyn OrderFree + 'a>> {
        self.estimator.order_free(&self.setup, request)
    }

    fn draw_order_free(&self, level: Level, places: &Lanes, requests: &mut [&mut dyn OrderFree]) {
        let placement = Placement::new(&self.setup.sampling);
        let medium = self.setup.problem.lookups(level);
        order_free::draw(level, &medium, &placement, places, requests);
    }
}

impl<P: Problem, E: Estimator<P>> Trial<P, E> {
    #[inline(always)]
    fn one_by_one(&self, medium: &Lookups, request: &mut Request) {
        request.buffer.clear();
        for _ in 0..request.count {
            let stream = request.streams.of_next_draw();
            request.buffer.push(&self.estimator.draw(&self.setup, medium, stream));
        }
    }
}
