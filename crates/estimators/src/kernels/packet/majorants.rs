//! The packet kernel of local-majorant tracking.
//!
//! Specification: draw j is, bit for bit, the draw that the page `transmittance/local_majorant` makes from
//! stream j mod 16. A step is a flight within a segment: no lane waits for those that cross several.

use fearless_simd::{ExtractToken, Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Ends, Numbers, Request, Walks, ends, run};
use crate::kernels::packet::event_queue::{Reader, Row};
use crate::setup::Setup;
use media::Lookups;
use numeric::pack::{self, Task};
use numeric::{self, Lane};

/// The draws of local-majorant tracking, on the hardware of a level; a request is handed back where the
/// hardware is too narrow or no segment has an extinction.
pub fn majorants<'a, P>(
    level: Level,
    setup: &Setup<P>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let row = |(ends, path): ([f64; 2], f64)| {
        numeric::Row([ends[0], ends[1], path, 0.0, 0.0, 0.0, 0.0, 0.0])
    };
    let segments: Vec<numeric::Row> = setup.sampling.stretches().map(row).collect();
    if segments.is_empty() {
        return Some(request);
    }
    let survivor = setup.control_transmittance;
    let task = Local { segments, survivor, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Local<'a, 'r> {
    segments: Vec<numeric::Row>,
    survivor: f64,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Local<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { segments, survivor, medium, request } = self;
        let first = f64x8::splat(simd, 0.0);
        let [t, end, path, ..] = first.columns(&segments);
        let last = f64x8::splat(simd, (segments.len() - 1) as f64);
        let segments = &segments[..];
        let (segment, looked, within) = (first, first, mask64x8::splat(simd, true));
        run(
            simd,
            #[inline(always)]
            || Hops { segments, last, survivor, segment, t, end, path, looked, within },
            #[inline(always)]
            |places| medium.pair(simd, places),
            request,
        );
    }
}

/// The walks.
struct Hops<'a, S: Simd> {
    /// Beginning, end and mean free path of each.
    segments: &'a [numeric::Row],
    last: f64x8<S>,
    survivor: f64,
    segment: f64x8<S>,
    t: f64x8<S>,
    end: f64x8<S>,
    path: f64x8<S>,
    /// How many lookups each has made.
    looked: f64x8<S>,
    /// Which of them have come to a collision, not to the end of their segment.
    within: mask64x8<S>,
}

impl<S: Simd> Walks<S> for Hops<'_, S> {
    type Reader = Survivors;

    #[inline(always)]
    fn reader(&self) -> Survivors {
        Survivors { survivor: self.survivor }
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S> {
        let flown = numbers.depth.times_plus(self.path, self.t);
        self.within = flown.below(self.end);
        self.t = Lane::select(self.within, flown, self.t);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, extinction: f64x8<S>, numbers: &Numbers<S>, row: &mut Row) -> Ends {
        let simd = self.t.token();
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let (t, within) = (self.t, self.within);
        let killed = within & numbers.decision.below(extinction * self.path);
        let inside = within | self.segment.below(self.last);
        let goes_on = inside & !killed;
        self.looked.store_slice(&mut row.0[0]);
        self.looked = Lane::select(goes_on, self.looked + Lane::select(within, one, zero), zero);
        let next = Lane::select(within, self.segment, self.segment + 1.0);
        self.segment = Lane::select(goes_on, next, zero);
        let [begin, end, path, ..] = self.segment.columns(self.segments);
        self.t = Lane::select(within & goes_on, t, begin);
        (self.end, self.path) = (end, path);
        ends(inside, goes_on)
    }
}

/// Reads who passed.
struct Survivors {
    survivor: f64,
}

impl Reader for Survivors {
    const DECIDES: bool = true;

    #[inline(always)]
    fn draw(&self, _: &Row, _: usize, escaped: bool) -> (f64, f64) {
        (if escaped { self.survivor } else { 0.0 }, 0.0)
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // they were counted
    fn lookups(&self, row: &Row, lane: usize, _: u32) -> u32 {
        row.0[0][lane] as u32
    }
}
