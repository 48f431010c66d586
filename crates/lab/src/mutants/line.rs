//! Any walk along a ray, with one wrong step.
//!
//! [`draw`] is the loop of one walk, as [`walks::plain`] has it, with a [`Slip`] beside each step:
//!
//! ```text
//! begin
//! repeat
//!     depth, number    the optical depth of a flight, and the uniform number of the decision at its end
//!     fly              a walk that leaves the medium ends
//!     lookup, found    the distance at which σ_t is looked up, and σ_t there
//!     used, place      σ_t and the distance with which the walk collides
//!     collide          some walks end
//!     ends             others end wrongly
//! value                the score
//! ```
//!
//! A slip has a function for a number that it changes: of the walk so far ([`Notes`]), and of the correct number.
//! [`RIGHT`] changes none; with it the walk is the control. Changes of σ_t after its lookup (`used`) and of the score
//! break the invariant of a product estimator, and count as its defect. Slips of several families are at the end.

use estimators::setup::ControlledLine;
use estimators::walks::{Route, TentativeCollision, Walk};
use estimators::{Draw, Estimated, Setup};
use media::sampling::{BothWays, FlightOverPieces, FlightWithGaps};
use media::{Control, Extinction, Lookups, Piecewise};
use numeric::fused::compiled_once;
use numeric::rng::{Random, Stream};
use numeric::{Lane, ScalarLane, Span};
use theory::problems::Channels;

/// Function of the walk so far and of the correct number, which returns a wrong one; `None` for the correct one.
pub type NumberChange = Option<fn(&mut Notes, f64) -> f64>;

/// Function of the walk so far and of further uniform numbers, which returns the end of a walk that should go on, if it
/// ends.
pub type EndFunction = fn(&Notes, &mut dyn FnMut() -> f64) -> Option<End>;

/// A wrong step.
#[derive(Clone, Copy)]
pub struct Slip {
    /// The optical depth of a flight.
    pub depth: NumberChange,
    /// The uniform number of the decision at its end.
    pub number: NumberChange,
    /// True if the first flight beyond the end collides at the end.
    pub collides_at_end: bool,
    /// The distance at which σ_t is looked up.
    pub lookup: NumberChange,
    /// σ_t there.
    pub computed: NumberChange,
    /// σ_t with which the walk collides.
    pub used: NumberChange,
    /// The distance of the collision, in functions of the distance.
    pub place: NumberChange,
    /// The end.
    pub ends: Option<EndFunction>,
    /// The score.
    pub score: Option<fn(&Notes, f64) -> f64>,
}

/// A wrong end of a walk.
#[derive(Clone, Copy, PartialEq)]
pub enum End {
    /// It counts as a walk that left the medium.
    Passed,
    /// It counts as a walk that ended at its last collision.
    Collided,
    /// It scores 0.
    Lost,
}

/// The control: no step is wrong.
pub const RIGHT: Slip = Slip {
    depth: None,
    number: None,
    collides_at_end: false,
    lookup: None,
    computed: None,
    used: None,
    place: None,
    ends: None,
    score: None,
};

/// A walk so far.
pub struct Notes<'a> {
    /// The whole ray, and the part of it with a medium.
    pub ray: Span,
    pub support: Span,
    pub sampling: &'a Piecewise,
    pub control: &'a Control,
    /// The distance of the last collision, or of the beginning.
    pub from: f64,
    /// The distance of the walk, and `1/σ̂` there.
    pub t: f64,
    pub mean_free_path: f64,
    /// The optical depth of the flight.
    pub depth: f64,
    pub collisions: u32,
    /// `∏ (1 − r)`.
    pub weight: f64,
    /// The score of the walk at its beginning, and before its last collision.
    pub first: f64,
    pub before: f64,
    /// True if a flight went beyond the end, and if the walk left the medium.
    pub is_beyond: bool,
    pub has_left: bool,
    /// Numbers that a slip keeps for later steps.
    pub kept: Vec<f64>,
}

impl Notes<'_> {
    /// Returns the correct number or the wrong one.
    #[inline(always)]
    fn changed(&mut self, change: NumberChange, right: f64) -> f64 {
        change.map_or(right, |change| change(self, right))
    }

    /// The uniform number of the flight.
    pub fn uniform(&self) -> f64 {
        Lane::exp(-self.depth).one_minus()
    }

    /// `∫σ_c` between distances.
    pub fn control_depth(&self, from: f64, to: f64) -> f64 {
        let begin = self.support.from;
        self.control.depths(begin, to) - self.control.depths(begin, from)
    }
}

/// Makes a draw of a walk with a slip.
pub fn draw<P: Estimated<Fields = ControlledLine, Value: Channels>>(
    walk: impl Walk,
    slip: &Slip,
    setup: &Setup<P>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw<P::Value> {
    compiled_once(
        #[inline(always)]
        || MutantDraw { walk, slip, setup, medium, random }.draw(),
    )
}

struct MutantDraw<'a, W, P: Estimated> {
    walk: W,
    slip: &'a Slip,
    setup: &'a Setup<P>,
    medium: &'a Lookups<'a>,
    random: &'a mut Stream,
}

impl<W: Walk, P: Estimated<Fields = ControlledLine, Value: Channels>> MutantDraw<'_, W, P> {
    #[inline(always)]
    fn draw(self) -> Draw<P::Value> {
        let sampling = &self.setup.fields.sampling;
        match sampling.with_gaps() {
            Some(even) => self.along(FlightWithGaps::new(0.0, even)),
            None => self.along(FlightOverPieces::new(0.0, sampling)),
        }
    }

    #[inline(always)]
    fn along<L: ScalarLane>(self, course: impl BothWays<L>) -> Draw<P::Value> {
        let Self { walk, slip, setup, medium, random } = self;
        let (zero, support) = (L::of(0.0), setup.fields.mesh.support());
        let mut state = walk.begin(L::of(1.0), true, random);
        let mut route = Route::new(course);
        let notes = &mut Notes::new(setup, walk.value(&state, true, 0).double());
        let (mut lookups, mut broken) = (0, 0.0);
        let end = loop {
            let [depth, number] = walk.numbers(&mut state, random);
            notes.depth = depth.double();
            if slip.depth.is_some() {
                notes.t = walk.distance(&state, &route).double();
                notes.mean_free_path = walk.mean_free_path(&state, &route).double();
            }
            let depth = L::of(notes.changed(slip.depth, depth.double()));
            let number = L::of(notes.changed(slip.number, number.double()));
            let mut inside = walk.fly(&mut state, &mut route, depth);
            if slip.collides_at_end {
                (inside, notes.is_beyond) = (!notes.is_beyond, notes.is_beyond || !inside);
            }
            let (mut t, mut mean_free_path, mut extinction) = (zero, zero, zero);
            if inside {
                lookups += 1;
                mean_free_path = walk.mean_free_path(&state, &route);
                notes.mean_free_path = mean_free_path.double();
                notes.t = walk.distance(&state, &route).double();
                let place = if notes.is_beyond { support.to } else { notes.t };
                let place = L::of(notes.changed(slip.lookup, place));
                let computed = medium.extinction(place).double();
                let computed = notes.changed(slip.computed, computed);
                let used = notes.changed(slip.used, computed);
                broken += (used - computed).abs() * notes.mean_free_path;
                extinction = L::of(used);
                t = L::of(notes.changed(slip.place, notes.t));
                if slip.score.is_some() {
                    notes.before = walk.value(&state, true, 0).double();
                }
            } else if !W::PAUSES {
                break None;
            }
            let (extinctions, in_space) = (&[extinction][..], &[][..]);
            let collided = TentativeCollision {
                inside,
                t,
                mean_free_path,
                extinction,
                extinctions,
                in_space,
                number,
            };
            let before = state;
            let goes_on = walk.collide(&mut state, &mut route, &collided, random);
            if W::IS_FIXED && !goes_on {
                state = before;
            }
            if inside {
                notes.weight *= (extinction * mean_free_path).double().one_minus();
                notes.from = notes.t;
                notes.collisions += 1;
            }
            if !goes_on {
                break inside.then_some(End::Collided);
            }
            if let Some(ends) = slip.ends {
                let end = ends(notes, &mut || Random::<L>::uniform(random).double());
                if end.is_some() {
                    break end;
                }
            }
        };
        notes.has_left = end.is_none();
        let notes = &*notes;
        let score = |has_left, channel| {
            let right = walk.value(&state, has_left, channel).double();
            [right, slip.score.map_or(right, |wrong| wrong(notes, right))]
        };
        let mut defect = 0.0;
        if W::HAS_DEFECT {
            let [right, wrong] = score(true, 0);
            let moved = if slip.score.is_some() { (wrong - right).abs() } else { 0.0 };
            defect = walk.defect(&state, zero).double() + broken + moved;
        }
        let has_left = matches!(end, None | Some(End::Passed));
        let value = P::Value::of(walk.channels(), |channel| {
            let [_, wrong] = score(has_left, channel);
            if end == Some(End::Lost) { 0.0 } else { wrong }
        });
        Draw { value, lookups, defect }
    }
}

impl<'a> Notes<'a> {
    /// A walk at its beginning, with its score there.
    fn new<P: Estimated<Fields = ControlledLine>>(setup: &'a Setup<P>, first: f64) -> Self {
        let support = setup.fields.mesh.support();
        Self {
            ray: setup.problem.medium().span(),
            support,
            sampling: &setup.fields.sampling,
            control: &setup.fields.control,
            from: support.from,
            t: support.from,
            mean_free_path: f64::NAN,
            depth: f64::NAN,
            collisions: 0,
            weight: 1.0,
            first,
            before: first,
            is_beyond: false,
            has_left: false,
            kept: Vec::new(),
        }
    }
}

/// A number in single precision.
#[allow(clippy::cast_possible_truncation)] // the bug
pub fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Flights by log2 in the place of ln.
pub const LOG2: Slip = Slip { depth: Some(|_, depth| depth * std::f64::consts::LOG2_E), ..RIGHT };
/// Flights through σ̂ as it is where they begin.
pub const AS_CONSTANT: Slip = Slip {
    depth: Some(|walk, depth| {
        let (sampling, knots) = (walk.sampling, walk.sampling.knots());
        let to = depth / sampling.value(walk.from) + walk.from;
        let through = sampling.depths(knots[0], to) - sampling.depths(knots[0], walk.from);
        if to < knots[knots.len() - 1] { through } else { f64::INFINITY }
    }),
    ..RIGHT
};
/// Lookups where the flight began.
pub const AT_PREVIOUS: Slip = Slip { lookup: Some(|walk, _| walk.from), ..RIGHT };
/// Lookups at the middle of the flight.
pub const AT_MIDPOINT: Slip = Slip { lookup: Some(|walk, t| (walk.from + t) * 0.5), ..RIGHT };
/// Lookups in the medium from end to beginning.
pub const REVERSED: Slip =
    Slip { lookup: Some(|walk, t| -t + (walk.support.from + walk.support.to)), ..RIGHT };
/// σ_t of a channel that is thinner by a fifth.
pub const OF_ANOTHER_CHANNEL: Slip = Slip { computed: Some(|_, computed| computed * 0.8), ..RIGHT };
/// No effect of the first collision.
pub const FIRST_SKIPPED: Slip = Slip {
    used: Some(|walk, computed| if walk.collisions == 0 { 0.0 } else { computed }),
    ..RIGHT
};
/// Functions of the distance of a collision take the distance of the collision before it.
pub const OF_LAST_COLLISION: Slip = Slip { place: Some(|walk, _| walk.from), ..RIGHT };
/// A lookup, without effect, after the flight that leaves the medium.
pub const LATE_END: Slip = Slip {
    collides_at_end: true,
    computed: Some(|walk, computed| if walk.is_beyond { 0.0 } else { computed }),
    ..RIGHT
};
/// Decisions by the number of the flight.
pub const SHARED: Slip = Slip { number: Some(|walk, _| walk.uniform()), ..RIGHT };
/// Decisions by the number of the flight before, the first by its own.
pub const STALE: Slip = Slip {
    number: Some(|walk, number| {
        let stale = walk.kept.pop().unwrap_or(number);
        walk.kept.push(walk.uniform());
        stale
    }),
    ..RIGHT
};
/// All decisions by the number of the first.
pub const ONE_FOR_ALL: Slip = Slip {
    number: Some(|walk, number| {
        if walk.kept.is_empty() {
            walk.kept.push(number);
        }
        walk.kept[0]
    }),
    ..RIGHT
};
