//! Eight draws side by side: the packet kernel of the product walk and of the free flight.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk::product`] or the page
//! `free_flight/woodcock` makes from stream j mod 8.
//!
//! Each lane walks its own walk. A walk that ends begins anew at once, so that no lane waits, and
//! every lane makes a number of draws that was fixed beforehand: to stop when enough draws are done
//! would prefer short walks, which is a bias. Steps have no branches. They are noted row by row; after
//! [`STEPS`] of them the rows are searched for walks that ended, and those become draws. A lane that
//! has made its draws walks on until the others have; its stream is then set back to where its last
//! draw left it.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8, u64x8};

use super::ledger::{Ledger, Notes, Reader, Row, STEPS};
use super::rules::Collision;
use super::walk::Books;
use super::{DrawBuffer, Setup};
use crate::media::course::{Course, Even, Pieces};
use crate::media::{Control, Extinction, Piecewise};
use crate::numeric::pack::{self, Task, WIDTH};
use crate::numeric::{Lane, Span};
use crate::problems::Problem;
use crate::rng::{LANES, Lanes, Streams, Xoshiro};

/// With more pieces of σ̂ than this, lanes that cross them hold the others up for longer than eight
/// lookups at once gain, unless lookups are costly.
const MOST_PIECES: usize = 12;
/// The same of the control, where σ̂ has several pieces, too.
const MOST_CONTROL_PIECES: usize = 8;

/// Whether packets are faster than one draw after the other.
pub(super) fn pays<M: Extinction>(sampling: &Piecewise, control: &Control) -> bool {
    let controls = if let Control::Pieces(pieces) = control { pieces.count() } else { 0 };
    let few = sampling.count() <= MOST_PIECES && controls <= MOST_CONTROL_PIECES;
    M::IS_COSTLY || sampling.even().is_some() || few
}

/// What is to be drawn.
pub struct Request<'a> {
    /// The streams of the block, where the draws before left them.
    pub streams: &'a mut Streams,
    /// How many draws.
    pub count: usize,
    /// Where they go.
    pub buffer: &'a mut DrawBuffer,
}

/// Which walks ended in a step, as bits, and which of them because they reached the end.
struct Ends {
    ended: u64,
    escaped: u64,
}

/// Eight walks.
trait Walks<S: Simd> {
    /// How many words of its stream a step takes.
    const WORDS: usize;

    /// What reads their rows.
    type Reader: Reader;

    /// What reads their rows.
    fn reader(&self) -> Self::Reader;

    /// One step of each; walks that end begin anew.
    fn step(&mut self, streams: &mut Xoshiro<u64x8<S>>, row: &mut Row) -> Ends;
}

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

/// Free flights by Woodcock tracking, on the hardware of a level, or handed back likewise.
pub fn flight<'a, P: Problem, M: Extinction>(
    level: Level,
    setup: &Setup<P>,
    medium: &M,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays::<M>(&setup.sampling, &Control::None) {
        return Some(request);
    }
    let ray = setup.problem.medium().span();
    let task = Flight { sampling: &setup.sampling, ray, medium, request };
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
pub(super) struct Subtracted<'a, S: Simd> {
    control: &'a Control,
    /// Its value, where there is only one.
    constant: Option<f64x8<S>>,
}

impl<'a, S: Simd> Subtracted<'a, S> {
    /// What does not change is found here, not in every step.
    #[inline(always)]
    pub(super) fn new(simd: S, control: &'a Control) -> Self {
        let constant = control.single_value().map(|value| f64x8::splat(simd, value));
        Self { control, constant }
    }

    #[inline(always)]
    pub(super) fn at(&self, t: f64x8<S>) -> f64x8<S> {
        match self.constant {
            Some(constant) => constant,
            None => self.control.extinction(t),
        }
    }
}

struct Flight<'a, 'r, M> {
    sampling: &'a Piecewise,
    ray: Span,
    medium: &'a M,
    request: Request<'r>,
}

impl<M: Extinction> Task for Flight<'_, '_, M> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { sampling, ray, medium, request } = self;
        let from = f64x8::splat(simd, sampling.begin().t);
        if let Some(even) = sampling.even() {
            let course = Even::new(simd, even);
            run(simd, Flights { medium, ray, from, course }, request);
        } else {
            let course = Pieces::new(simd, sampling);
            run(simd, Flights { medium, ray, from, course }, request);
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

/// The walks of free flights.
struct Flights<'a, S: Simd, M, C> {
    medium: &'a M,
    ray: Span,
    from: f64x8<S>,
    course: C,
}

impl<S: Simd, M: Extinction, C: Course<S>> Walks<S> for Flights<'_, S, M, C> {
    const WORDS: usize = 2;
    type Reader = Distances;

    #[inline(always)]
    fn reader(&self) -> Distances {
        Distances { ray: self.ray }
    }

    #[inline(always)]
    fn step(&mut self, streams: &mut Xoshiro<u64x8<S>>, row: &mut Row) -> Ends {
        let inside = self.course.fly(-streams.ln_uniform());
        let t = Lane::select(inside, self.course.reached(), self.from);
        let ratio = self.medium.extinction(t) * self.course.mean_free_path();
        let goes_on = inside & !streams.uniform().below(ratio);
        t.store_slice(&mut row.0[0]);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }
}

/// Reads distances.
struct Distances {
    ray: Span,
}

impl Reader for Distances {
    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64) {
        (if escaped { self.ray.length() } else { row.0[0][lane] - self.ray.from }, 0.0)
    }
}

#[inline(always)]
fn ends<S: Simd>(inside: mask64x8<S>, goes_on: mask64x8<S>) -> Ends {
    Ends { ended: (!goes_on).to_bitmask(), escaped: (!inside).to_bitmask() }
}

/// Walks until every lane has made its draws.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // eight bits of a mask
fn run<S: Simd, W: Walks<S>>(simd: S, mut walks: W, request: Request) {
    let Request { streams, count, buffer } = request;
    let Some(mut ledger) = Ledger::open(count, streams.turn, buffer) else { return };
    let reader = walks.reader();
    let mut numbers = Lanes::of(&streams.lanes).awake(simd);
    let mut rows = [Row::default(); STEPS];
    while ledger.is_open() {
        let before = numbers;
        let mut notes = Notes::default();
        for (step, row) in rows.iter_mut().enumerate() {
            let ends = walks.step(&mut numbers, row);
            notes.ended[step / 8][step % 8] = ends.ended as u8;
            notes.escaped[step / 8][step % 8] = ends.escaped as u8;
        }
        let over = ledger.collect(&reader, &rows, &notes);
        if over != [0; WIDTH] {
            let before = before.at_rest().apart();
            for ((stream, before), steps) in streams.lanes.iter_mut().zip(before).zip(over) {
                if steps > 0 {
                    *stream = before;
                    for _ in 0..steps * W::WORDS {
                        stream.word();
                    }
                }
            }
        }
    }
    streams.turn = (streams.turn + count) % LANES;
}
