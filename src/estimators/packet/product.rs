//! The packet kernel of the product walk.
//!
//! Specification: draw j is, bit for bit, the draw that [`crate::estimators::walk::product`] makes from
//! stream j mod 16.

use std::marker::PhantomData;

use fearless_simd::{Level, Simd, SimdBase, f64x8};

use super::survival::Survivals;
use super::{Ends, Numbers, Request, Walks, ends, pays, run};
use crate::estimators::Setup;
use crate::estimators::ledger::{Reader, Row};
use crate::estimators::rules::{Collision, Met};
use crate::estimators::walk::Books;
use crate::media::course::{Course, Even, Pieces};
use crate::media::{Control, Extinction, Piecewise};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task};

/// The draws of a product estimator, on the hardware of a level; a request is handed back where the
/// hardware is too narrow or one draw after the other is faster.
pub fn product<'a, P, M: Extinction, R: Collision>(
    level: Level,
    setup: &Setup<P>,
    rule: &R,
    medium: &M,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let (sampling, control) = (&setup.sampling, &setup.control);
    if !pays::<M>(sampling, control) {
        return Some(request);
    }
    let begin = setup.control_transmittance;
    let task = Product { sampling, control, begin, rule, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Product<'a, 'r, M, R> {
    sampling: &'a Piecewise,
    control: &'a Control,
    begin: f64,
    rule: &'a R,
    medium: &'a M,
    request: Request<'r>,
}

impl<M: Extinction, R: Collision> Task for Product<'_, '_, M, R> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { sampling, control, begin, rule, medium, request } = self;
        let from = f64x8::splat(simd, sampling.begin().t);
        let site = Site { rule, medium, control: Any::new(simd, control), begin, from };
        match (sampling.even(), site.control.constant) {
            (Some(even), Some(value)) => {
                walk(simd, site.less(Constant(value)), Even::new(simd, even), request);
            }
            (Some(even), None) => walk(simd, site, Even::new(simd, even), request),
            (None, _) => walk(simd, site, Pieces::new(simd, sampling), request),
        }
    }
}

/// Walks without books where that is enough, else with them.
#[inline(always)]
fn walk<S: Simd, M: Extinction, R: Collision, K: Subtracted<S>, C: Course<S> + Copy>(
    simd: S,
    site: Site<S, M, R, K>,
    course: C,
    request: Request,
) {
    let Request { streams, count, buffer } = request;
    if R::DECIDES && !R::WEIGHS {
        let before = streams.clone();
        let request = Request { streams: &mut *streams, count, buffer: &mut *buffer };
        let is_done = run(
            simd,
            #[inline(always)]
            || Survivals::new(site, course),
            request,
        );
        if is_done {
            return;
        }
        *streams = before;
    }
    let weight = f64x8::splat(simd, site.begin);
    let books = Books::open(weight);
    run(
        simd,
        #[inline(always)]
        || Products { site, course, weight, books },
        Request { streams, count, buffer },
    );
}

/// σ_c as the walks ask for it.
pub(in crate::estimators) trait Subtracted<S: Simd>: Copy {
    /// At the places reached.
    fn at(&self, t: f64x8<S>) -> f64x8<S>;
}

/// One value: a branch in every step, even if it always goes one way, would keep the walks out of registers.
#[derive(Clone, Copy)]
struct Constant<S: Simd>(f64x8<S>);

impl<S: Simd> Subtracted<S> for Constant<S> {
    #[inline(always)]
    fn at(&self, _: f64x8<S>) -> f64x8<S> {
        self.0
    }
}

/// Any.
#[derive(Clone, Copy)]
pub(in crate::estimators) struct Any<'a, S: Simd> {
    control: &'a Control,
    /// Its value, where there is only one.
    constant: Option<f64x8<S>>,
}

impl<'a, S: Simd> Any<'a, S> {
    /// What does not change is found here, not in every step.
    #[inline(always)]
    pub(in crate::estimators) fn new(simd: S, control: &'a Control) -> Self {
        let constant = control.single_value().map(|value| f64x8::splat(simd, value));
        Self { control, constant }
    }
}

impl<S: Simd> Subtracted<S> for Any<'_, S> {
    #[inline(always)]
    fn at(&self, t: f64x8<S>) -> f64x8<S> {
        match self.constant {
            Some(constant) => constant,
            None => self.control.extinction(t),
        }
    }
}

/// What the walks of a product estimator meet.
pub(super) struct Site<'a, S: Simd, M, R, K> {
    pub rule: &'a R,
    medium: &'a M,
    control: K,
    pub begin: f64,
    from: f64x8<S>,
}

impl<S: Simd, M, R, K: Copy> Clone for Site<'_, S, M, R, K> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd, M, R, K: Copy> Copy for Site<'_, S, M, R, K> {}

impl<'a, S: Simd, M, R, K> Site<'a, S, M, R, K> {
    #[inline(always)]
    pub(super) fn zero(&self) -> f64x8<S> {
        self.from.each(0.0)
    }

    /// The same with another σ_c.
    #[inline(always)]
    fn less<L>(&self, control: L) -> Site<'a, S, M, R, L> {
        let Self { rule, medium, begin, from, .. } = *self;
        Site { rule, medium, control, begin, from }
    }
}

impl<S: Simd, M: Extinction, R, K: Subtracted<S>> Site<'_, S, M, R, K> {
    /// What is met at the places reached. Beyond the end it means nothing, and nobody asks for it.
    #[inline(always)]
    pub(super) fn met<C: Course<S>>(&self, course: &C) -> Met<f64x8<S>> {
        let t = course.reached();
        let residual = self.medium.extinction(t) - self.control.at(t);
        Met { residual, sampling: course.sampling(), mean_free_path: course.mean_free_path() }
    }
}

/// The walks of a product estimator.
struct Products<'a, S: Simd, M, R, K, C> {
    site: Site<'a, S, M, R, K>,
    course: C,
    weight: f64x8<S>,
    books: Books<f64x8<S>>,
}

impl<S, M, R, K, C> Walks<S> for Products<'_, S, M, R, K, C>
where
    S: Simd,
    M: Extinction,
    R: Collision,
    K: Subtracted<S>,
    C: Course<S>,
{
    type Reader = Weights<R>;

    #[inline(always)]
    fn reader(&self) -> Weights<R> {
        Weights(PhantomData)
    }

    #[inline(always)]
    fn step(&mut self, numbers: Numbers<S>, row: &mut Row) -> Ends {
        let inside = self.course.fly(numbers.depth);
        let met = self.site.met(&self.course);
        let (ratio, outcome) = (met.ratio(), self.site.rule.at(met.ratio()));
        let goes_on = if R::DECIDES {
            inside & !self.site.rule.kills(&met, numbers.decision)
        } else {
            inside
        };
        let (weight, books) = (self.weight, self.books);
        weight.store_slice(&mut row.0[0]);
        books.defect(weight).store_slice(&mut row.0[1]);
        let (fresh, mut booked) = (Books::open(books.begin), books);
        booked.hand_over(weight, self.site.rule.due(ratio, outcome.survival));
        self.weight = Lane::select(goes_on, weight * outcome.weight, fresh.begin);
        self.books.handed_over = Lane::select(goes_on, booked.handed_over, fresh.handed_over);
        self.books.turnover = Lane::select(goes_on, booked.turnover, fresh.turnover);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }
}

/// Reads weights and what their books lack.
struct Weights<R>(PhantomData<R>);

impl<R: Collision> Reader for Weights<R> {
    const DECIDES: bool = R::DECIDES;

    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64) {
        let [weights, defects] = &row.0;
        (if escaped { weights[lane] } else { 0.0 }, defects[lane])
    }
}
