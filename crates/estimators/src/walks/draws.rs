//! Choice of the driver, the course and the lookups for the draws of a request.

use fearless_simd::Level;

use super::{Nowhere, Walk, bank, plain, window};
use crate::setup::{OnRay, Residual};
use crate::{Draw, Estimated, Kernel, Request, Setup};
use media::sampling::{BothWays, FlightOverPieces, FlightWithGaps};
use media::{Control, Extinction, Inlined, Lookups, Piecewise};
use numeric::fused::compiled_once;
use numeric::pack::{self, Hardware, Task};
use numeric::rng::Stream;
use numeric::{Lane, Pair};
use theory::problems::Channels;

/// Maximum number of pieces of σ̂ or of the control for packs. With more, lanes that cross pieces delay the others
/// by more than eight lookups at once gain, unless lookups are costly or σ̂ is constant.
const MAX_PIECES: usize = 8;

/// Returns whether packs are faster than one walk after the other.
fn packets_are_faster<W: Walk>(sampling: &Piecewise, control: &Control, medium: &Lookups) -> bool {
    if !W::IN_PIECES && sampling.with_gaps().is_none() {
        return false;
    }
    if W::IS_NOWHERE || medium.is_costly() || sampling.with_gaps().is_some() {
        return true;
    }
    // Lanes that alternate between walks and shadow rays load other pieces of σ̂ each time.
    let turns = W::PAUSES && !W::IS_FIXED;
    let controls = if let Control::Pieces(pieces) = control { pieces.count() } else { 0 };
    !turns && sampling.count() <= MAX_PIECES && controls <= MAX_PIECES
}

/// Makes the draws of a request: in packets where the kernel and the hardware allow it and that is faster, else one
/// by one.
pub fn fill<P: Estimated<Fields: OnRay>>(
    walk: &impl Walk,
    kernel: Kernel,
    setup: &Setup<P>,
    request: Request,
) where
    P::Value: Channels,
{
    let left = match kernel {
        Kernel::Single => Some(request),
        Kernel::Packets(level) => {
            packets(level, walk, setup, &setup.problem.lookups(level), request)
        }
    };
    if let Some(request) = left {
        in_turn(walk, setup, request);
    }
}

/// Makes the draws of a request one walk after the other.
pub fn in_turn<P: Estimated<Fields: OnRay>>(walk: &impl Walk, setup: &Setup<P>, request: Request)
where
    P::Value: Channels,
{
    let medium = &setup.problem.lookups(Level::new());
    let Request { streams, count, buffer } = request;
    compiled_once(
        #[inline(always)]
        || {
            buffer.make_room(count);
            for number in 0..count {
                let (sampling, random) = (setup.residual().sampling, streams.of_next_draw());
                let draw = plain::through::<f64, _, P::Value>(
                    walk,
                    sampling,
                    #[inline(always)]
                    |channel, t| medium.channel(channel).extinction(t),
                    random,
                );
                buffer.put(number, &draw);
            }
        },
    );
}

/// Makes the draws of a request by packets, and one by one if these return the request.
#[inline(always)]
pub fn by<'r, P: Estimated>(
    kernel: Kernel,
    setup: &Setup<P>,
    request: Request<'r>,
    packets: impl FnOnce(Level, &Lookups, Request<'r>) -> Option<Request<'r>>,
    draw: impl Fn(&Lookups, &mut Stream) -> Draw<P::Value>,
) {
    let left = match kernel {
        Kernel::Single => Some(request),
        Kernel::Packets(level) => packets(level, &setup.problem.lookups(level), request),
    };
    if let Some(request) = left {
        one_by_one(setup, request, draw);
    }
}

/// Makes the draws of a request one after the other by a function, which `#[inline(always)]` compiles with fused multiply-add.
#[inline(always)]
pub fn one_by_one<P: Estimated>(
    setup: &Setup<P>,
    request: Request,
    draw: impl Fn(&Lookups, &mut Stream) -> Draw<P::Value>,
) {
    let medium = setup.problem.lookups(Level::new());
    let Request { streams, count, buffer } = request;
    compiled_once(
        #[inline(always)]
        || {
            buffer.make_room(count);
            for number in 0..count {
                buffer.put(number, &draw(&medium, streams.of_next_draw()));
            }
        },
    );
}

/// Makes the draws of a request in packets. Returns the request where the hardware is too narrow, and where
/// [`super::plain`] is faster.
#[inline(always)] // in the codegen unit of the caller
pub fn packets<'r, P: Estimated<Fields: OnRay>, W: Walk>(
    level: Level,
    walk: &W,
    setup: &Setup<P>,
    medium: &Lookups,
    request: Request<'r>,
) -> Option<Request<'r>> {
    let Residual { sampling, control, .. } = setup.residual();
    if !packets_are_faster::<W>(sampling, control, medium) {
        return Some(request);
    }
    let task = SideBySide { walk, sampling, medium, request };
    pack::on(level, task).err().map(|task| task.request)
}

/// Makes the draws of a request in packets of walks with all their lookups in space. Returns the request where the
/// hardware is too narrow.
pub fn packets_in_space<'r>(
    level: Level,
    walk: &impl Walk,
    request: Request<'r>,
) -> Option<Request<'r>> {
    pack::on(level, DrawsInSpace { walk, request }).err().map(|task| task.request)
}

/// Implements the draws of a page by a walk on its setup, as in `drawn!(self, setup: LitRod => Walk::of(setup))`. A
/// second walk is used for many draws in packets:
/// `drawn!(self, setup: LitRod => Walk::of(setup), Walk::prepared(setup))`.
macro_rules! drawn {
    ($this:ident, $setup:ident: $Problem:ty => $walk:expr) => {
        fn fill(
            &$this,
            kernel: $crate::Kernel,
            $setup: &$crate::Setup<$Problem>,
            request: $crate::Request,
        ) {
            $crate::walks::fill(&$walk, kernel, $setup, request);
        }
    };
    ($this:ident, $setup:ident: $Problem:ty => $walk:expr, $prepared:expr) => {
        fn fill(
            &$this,
            kernel: $crate::Kernel,
            $setup: &$crate::Setup<$Problem>,
            request: $crate::Request,
        ) {
            match kernel {
                $crate::Kernel::Single => $crate::walks::fill(&$walk, kernel, $setup, request),
                $crate::Kernel::Packets(_) => {
                    $crate::walks::fill(&$prepared, kernel, $setup, request);
                }
            }
        }
    };
}
pub(crate) use drawn;

struct SideBySide<'a, 'r, W> {
    walk: &'a W,
    sampling: &'a Piecewise,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl<W: Walk> Task for SideBySide<'_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run<S: Hardware>(self, simd: S) {
        let Self { walk, sampling, medium, request } = self;
        if W::IS_NOWHERE {
            return outlined(simd, *walk, Nowhere, medium, request);
        }
        let zero = simd.splat(0.0);
        let Some(even) = sampling.with_gaps() else {
            if const { W::IN_PIECES && !W::IS_CHROMATIC } {
                outlined(simd, *walk, FlightOverPieces::new(zero, sampling), medium, request);
            }
            return;
        };
        let course = FlightWithGaps::new(zero, even);
        if const { !W::IN_PIECES } {
            // Alone in this function.
            return bank::run(
                simd,
                *walk,
                course,
                #[inline(always)]
                move |_, t| medium.pair(simd, t),
                request,
            );
        }
        if !W::IS_FIXED {
            return outlined(simd, *walk, course, medium, request);
        }
        if let Some(value) = medium.single_value() {
            let value = Pair::splat(simd, value);
            return in_window(
                simd,
                *walk,
                course,
                #[inline(always)]
                move |_| value,
                request,
            );
        }
        match medium.inlined() {
            Some(Inlined::Eq21(field)) if const { W::INLINES_EQ21 && S::IS_ONE_REGISTER } => {
                in_window(
                    simd,
                    *walk,
                    course,
                    #[inline(always)]
                    move |t| each(field, t),
                    request,
                );
            }
            Some(Inlined::Grid(field)) if const { W::INLINES_GRID && S::IS_ONE_REGISTER } => {
                in_window(
                    simd,
                    *walk,
                    course,
                    #[inline(always)]
                    move |t| each(field, t),
                    request,
                );
            }
            _ => outlined(simd, *walk, course, medium, request),
        }
    }
}

struct DrawsInSpace<'a, 'r, W> {
    walk: &'a W,
    request: Request<'r>,
}

impl<W: Walk> Task for DrawsInSpace<'_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run<S: Hardware>(self, simd: S) {
        bank::run(
            simd,
            *self.walk,
            Nowhere,
            #[inline(always)]
            |_, t| t,
            self.request,
        );
    }
}

/// Lookups by calls, in a function of its own for each course: compile time grows as the square of a function's length.
#[inline(always)]
fn outlined<S: Hardware, W: Walk, C: BothWays<S::Pack>>(
    simd: S,
    walk: W,
    course: C,
    medium: &Lookups,
    request: Request,
) {
    if W::IS_FIXED {
        return in_window(
            simd,
            walk,
            course,
            #[inline(always)]
            move |t| medium.pair(simd, t),
            request,
        );
    }
    pack::outlined(
        simd,
        #[inline(always)]
        move || {
            bank::run(
                simd,
                walk,
                course,
                #[inline(always)]
                move |channel, t| medium.channel(channel).pair(simd, t),
                request,
            );
        },
    );
}

#[inline(always)]
fn in_window<S: Hardware, W: Walk, C: BothWays<S::Pack>>(
    simd: S,
    walk: W,
    course: C,
    look_up: impl Fn(Pair<S::Pack>) -> Pair<S::Pack>,
    request: Request,
) {
    pack::outlined(
        simd,
        #[inline(always)]
        move || window::run(simd, walk, course, look_up, request),
    );
}

/// `σ_t` of a field of a known type, with the bits of [`Lookups::pair`].
#[inline(always)]
fn each<L: Lane>(field: &impl media::Extinction, t: Pair<L>) -> Pair<L> {
    Pair(field.extinction(t.0), field.extinction(t.1))
}
