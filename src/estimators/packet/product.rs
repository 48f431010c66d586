//! The packet kernel of the product walk.
//!
//! Specification: draw j is, bit for bit, the draw that [`crate::estimators::walk::product`] makes from
//! stream j mod 8.

use fearless_simd::{Level, Simd, SimdBase, f64x8, u64x8};

use super::{Ends, Request, Walks, ends, pays, run};
use crate::estimators::Setup;
use crate::estimators::ledger::{Reader, Row};
use crate::estimators::rules::Collision;
use crate::estimators::walk::Books;
use crate::media::course::{Course, Even, Pieces};
use crate::media::{Control, Extinction, Piecewise};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task};
use crate::rng::Xoshiro;

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
        let weight = f64x8::splat(simd, begin);
        let from = f64x8::splat(simd, sampling.begin().t);
        let books = Books::open(weight);
        let control = Subtracted::new(simd, control);
        if let Some(even) = sampling.even() {
            let course = Even::new(simd, even);
            let walks = Products { rule, medium, control, begin, from, course, weight, books };
            run(simd, walks, request);
        } else {
            let course = Pieces::new(simd, sampling);
            let walks = Products { rule, medium, control, begin, from, course, weight, books };
            run(simd, walks, request);
        }
    }
}

/// σ_c as the walks ask for it.
pub(in crate::estimators) struct Subtracted<'a, S: Simd> {
    control: &'a Control,
    /// Its value, where there is only one.
    constant: Option<f64x8<S>>,
}

impl<'a, S: Simd> Subtracted<'a, S> {
    /// What does not change is found here, not in every step.
    #[inline(always)]
    pub(in crate::estimators) fn new(simd: S, control: &'a Control) -> Self {
        let constant = control.single_value().map(|value| f64x8::splat(simd, value));
        Self { control, constant }
    }

    #[inline(always)]
    pub(in crate::estimators) fn at(&self, t: f64x8<S>) -> f64x8<S> {
        match self.constant {
            Some(constant) => constant,
            None => self.control.extinction(t),
        }
    }
}

/// The walks of a product estimator.
struct Products<'a, S: Simd, M, R, C> {
    rule: &'a R,
    medium: &'a M,
    control: Subtracted<'a, S>,
    begin: f64,
    from: f64x8<S>,
    course: C,
    weight: f64x8<S>,
    books: Books<f64x8<S>>,
}

impl<S, M, R, C> Walks<S> for Products<'_, S, M, R, C>
where
    S: Simd,
    M: Extinction,
    R: Collision,
    C: Course<S>,
{
    const WORDS: usize = if R::DECIDES { 2 } else { 1 };
    type Reader = Weights;

    #[inline(always)]
    fn reader(&self) -> Weights {
        Weights { begin: self.begin }
    }

    #[inline(always)]
    fn step(&mut self, streams: &mut Xoshiro<u64x8<S>>, row: &mut Row) -> Ends {
        let inside = self.course.fly(-streams.ln_uniform());
        // Beyond the end there is no field to look at.
        let t = Lane::select(inside, self.course.reached(), self.from);
        let residual = self.medium.extinction(t) - self.control.at(t);
        let ratio = residual * self.course.mean_free_path();
        let outcome = self.rule.at(ratio);
        let goes_on = if R::DECIDES {
            let killed = outcome.survival.at_most(streams.uniform());
            inside & !killed
        } else {
            inside
        };
        let (weight, books) = (self.weight, self.books);
        weight.store_slice(&mut row.0[0]);
        books.handed_over.store_slice(&mut row.0[1]);
        books.turnover.store_slice(&mut row.0[2]);
        let (fresh, mut booked) = (Books::open(books.begin), books);
        booked.hand_over(weight, self.rule.due(ratio, outcome.survival));
        self.weight = Lane::select(goes_on, weight * outcome.weight, fresh.begin);
        self.books.handed_over = Lane::select(goes_on, booked.handed_over, fresh.handed_over);
        self.books.turnover = Lane::select(goes_on, booked.turnover, fresh.turnover);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }
}

/// Reads weights and books.
struct Weights {
    begin: f64,
}

impl Reader for Weights {
    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64) {
        let [weights, handed_over, turnover] = &row.0;
        let (handed_over, turnover) = (handed_over[lane], turnover[lane]);
        let books = Books { begin: self.begin, handed_over, turnover };
        (if escaped { weights[lane] } else { 0.0 }, books.defect(weights[lane]))
    }
}
