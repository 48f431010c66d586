//! The packet kernel of the product walk.
//!
//! Specification: draw j is, bit for bit, the draw that [`crate::kernels::walk::product`] makes from
//! stream j mod 16.

use std::marker::PhantomData;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::survival::Survivals;
use super::{Ends, Numbers, Request, Walks, ends, extinctions, pays, run};
use crate::kernels::packet::event_queue::{Reader, Row};
use crate::kernels::walk::Invariant;
use crate::setup::Setup;
use media::course::{Course, Even, Pieces};
use media::{Control, Inlined, Lookups, Piecewise};
use numeric::pack::{self, Task};
use numeric::{Lane, Twin};
use theory::rules::{Collision, Met};

/// The draws of a product estimator, on the hardware of a level; a request is handed back where the
/// hardware is too narrow or one draw after the other is faster.
pub fn product<'a, P, R: Collision>(
    level: Level,
    setup: &Setup<P>,
    rule: &R,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let (sampling, control) = (&setup.sampling, &setup.control);
    if !pays(medium, sampling, control) {
        return Some(request);
    }
    let begin = setup.control_transmittance;
    let task = Product { sampling, control, begin, rule, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Product<'a, 'r, R> {
    sampling: &'a Piecewise,
    control: &'a Control,
    begin: f64,
    rule: &'a R,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl<R: Collision> Task for Product<'_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let (sampling, medium) = (self.sampling, self.medium);
        let Some(even) = sampling.even() else {
            return self.through(
                simd,
                Pieces::new(simd, sampling),
                #[inline(always)]
                move |places| medium.pair(simd, places),
            );
        };
        let course = Even::new(simd, even);
        if let (Some(value), Some(control)) = (medium.single_value(), self.control.single_value()) {
            let residual = Twin::splat(simd, value - control);
            return walk(
                simd,
                self.site(),
                course,
                #[inline(always)]
                move |_| residual,
                self.request,
            );
        }
        match medium.inlined() {
            Some(Inlined::Eq21(field)) if const { pack::is_one_register::<S>() && !R::WEIGHS } => {
                self.through(
                    simd,
                    course,
                    #[inline(always)]
                    move |places| extinctions(field, places),
                );
            }
            Some(Inlined::Grid(field)) if const { pack::is_one_register::<S>() && !R::DECIDES } => {
                self.through(
                    simd,
                    course,
                    #[inline(always)]
                    move |places| extinctions(field, places),
                );
            }
            _ => self.through(
                simd,
                course,
                #[inline(always)]
                move |places| medium.pair(simd, places),
            ),
        }
    }
}

impl<'a, R: Collision> Product<'a, '_, R> {
    #[inline(always)]
    fn site(&self) -> Site<'a, R> {
        Site { rule: self.rule, begin: self.begin }
    }

    /// Walks a course through the medium and its control; `look_up` answers σ_t.
    #[inline(always)]
    fn through<S: Simd, C: Course<S> + Copy>(
        self,
        simd: S,
        course: C,
        look_up: impl Fn(Twin<f64x8<S>>) -> Twin<f64x8<S>> + Copy,
    ) {
        let subtracted = Subtracted::new(simd, self.control);
        walk(
            simd,
            self.site(),
            course,
            #[inline(always)]
            move |places| subtracted.from(look_up(places), places),
            self.request,
        );
    }
}

/// Walks without an invariant where that is enough, else with one.
#[inline(always)]
fn walk<S: Simd, R: Collision, C: Course<S> + Copy>(
    simd: S,
    site: Site<R>,
    course: C,
    residual: impl Fn(Twin<f64x8<S>>) -> Twin<f64x8<S>> + Copy,
    request: Request,
) {
    let Request { streams, count, buffer } = request;
    let all = mask64x8::splat(simd, true);
    if R::DECIDES && !R::WEIGHS {
        let before = streams.clone();
        let request = Request { streams: &mut *streams, count, buffer: &mut *buffer };
        let is_done = pack::outlined(
            simd,
            #[inline(always)]
            move || {
                run(
                    simd,
                    #[inline(always)]
                    || Survivals::new(site, course, all),
                    residual,
                    request,
                )
            },
        );
        if is_done {
            return;
        }
        *streams = before;
    }
    let weight = f64x8::splat(simd, site.begin);
    let invariant = Invariant::open(weight);
    pack::outlined(
        simd,
        #[inline(always)]
        move || {
            run(
                simd,
                #[inline(always)]
                || Products { site, course, inside: all, weight, invariant },
                residual,
                Request { streams, count, buffer },
            )
        },
    );
}

/// σ_c as the walks ask for it.
#[derive(Clone, Copy)]
pub struct Subtracted<'a, S: Simd> {
    control: &'a Control,
    /// Its value, where there is only one.
    constant: Option<f64x8<S>>,
}

impl<'a, S: Simd> Subtracted<'a, S> {
    /// What does not change is found here, not in every step.
    #[inline(always)]
    pub fn new(simd: S, control: &'a Control) -> Self {
        let constant = control.single_value().map(|value| f64x8::splat(simd, value));
        Self { control, constant }
    }

    /// At the places reached.
    #[inline(always)]
    pub fn at(&self, t: f64x8<S>) -> f64x8<S> {
        match self.constant {
            Some(constant) => constant,
            None => self.control.extinction(t),
        }
    }

    /// `σ_t − σ_c` at the places reached, given σ_t.
    #[inline(always)]
    fn from(&self, extinction: Twin<f64x8<S>>, t: Twin<f64x8<S>>) -> Twin<f64x8<S>> {
        Twin(extinction.0 - self.at(t.0), extinction.1 - self.at(t.1))
    }
}

/// What the walks of a product estimator meet.
pub(super) struct Site<'a, R> {
    pub rule: &'a R,
    pub begin: f64,
}

impl<R> Clone for Site<'_, R> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Site<'_, R> {}

/// What is met at the places reached, given `σ_t − σ_c`. Beyond the end it means nothing, and nobody asks for it.
#[inline(always)]
pub(super) fn met<S: Simd>(course: &impl Course<S>, residual: f64x8<S>) -> Met<f64x8<S>> {
    Met { residual, sampling: course.sampling(), mean_free_path: course.mean_free_path() }
}

/// The walks of a product estimator.
struct Products<'a, S: Simd, R, C> {
    site: Site<'a, R>,
    course: C,
    inside: mask64x8<S>,
    weight: f64x8<S>,
    invariant: Invariant<f64x8<S>>,
}

impl<S: Simd, R: Collision, C: Course<S>> Walks<S> for Products<'_, S, R, C> {
    type Reader = Weights<R>;

    #[inline(always)]
    fn reader(&self) -> Weights<R> {
        Weights(PhantomData)
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S> {
        self.inside = self.course.fly(numbers.depth);
        self.course.reached()
    }

    #[inline(always)]
    fn collide(&mut self, residual: f64x8<S>, numbers: &Numbers<S>, row: &mut Row) -> Ends {
        let inside = self.inside;
        let met = met(&self.course, residual);
        let (ratio, outcome) = (met.ratio(), self.site.rule.at(met.ratio()));
        let goes_on = if R::DECIDES {
            inside & !self.site.rule.kills(&met, numbers.decision)
        } else {
            inside
        };
        let (weight, invariant) = (self.weight, self.invariant);
        weight.store_slice(&mut row.0[0]);
        invariant.defect(weight).store_slice(&mut row.0[1]);
        let (fresh, mut after) = (Invariant::open(invariant.begin), invariant);
        after.take(weight, self.site.rule.due(ratio, outcome.survival));
        self.weight = Lane::select(goes_on, weight * outcome.weight, fresh.begin);
        self.invariant.taken = Lane::select(goes_on, after.taken, fresh.taken);
        self.invariant.scale = Lane::select(goes_on, after.scale, fresh.scale);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }
}

/// Reads weights and the defects of their invariants.
struct Weights<R>(PhantomData<R>);

impl<R: Collision> Reader for Weights<R> {
    const DECIDES: bool = R::DECIDES;

    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64) {
        let [weights, defects] = &row.0;
        (if escaped { weights[lane] } else { 0.0 }, defects[lane])
    }
}
