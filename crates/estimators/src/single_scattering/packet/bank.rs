//! The loop of all techniques.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Pages, Sums, collisions, interactions, mis, points, shared};
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Slots};
use crate::kernels::packet::left;
use crate::single_scattering::main_part::MainPart;
use crate::single_scattering::technique::{Kind, Sharing};
use crate::space::exit;
use crate::space::shadow::{Found, Light, ShadowRays, Shadows};
use crate::space::tally::add_where;
use crate::{DrawBuffer, Setup};
use media::course::Even;
use media::{Batches, Lookups, even};
use numeric::geometry::Bounds;
use numeric::pack::{self, Task, WIDTH};
use numeric::rng::{LANES, Streams};
use numeric::twin::PAIR;
use numeric::{Lane, Twin};
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Tracking};

/// So many lanes of a pack cast their shadow rays together: to find where they lead costs more than a step. While
/// fewer wait for it, others are on their way.
const TOGETHER: u32 = 4;

/// The draws of a technique, on the hardware of a level; a request is handed back where that is too narrow,
/// where σ̂ has several values, and where one draw after the other is faster.
pub fn walks<'a>(
    level: Level,
    setup: &Setup<SingleScattering>,
    (kind, tracking): (Kind, Tracking),
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let Some(even) = setup.sampling.even() else { return Some(request) };
    let main = match kind {
        Kind::Points { from_main: true, .. } => match MainPart::of(setup) {
            None => return Some(request),
            main => main,
        },
        _ => None,
    };
    let volume = setup.problem.volume();
    let rays = ShadowRays::new(volume, volume.bounds(), tracking);
    let is_box = matches!(rays.bounds, Bounds::Box(_));
    let is_tracked = matches!(kind, Kind::Points { camera, .. } if camera != CameraTracking::Exact);
    let is_single = setup.control.single_value().is_some();
    // One cheap sample alone, and a main part of many pieces beside a tracked camera
    // do not pay.
    let is_one = matches!(kind, Kind::SourceAndCollision(Sharing { is_one: true, .. }));
    let is_cheap = is_one && tracking == Tracking::Exact && !medium.is_costly();
    if is_cheap || (main.is_some() && is_tracked && !is_single) {
        return Some(request);
    }
    let in_space = volume.batches(level, is_box);
    let (support, extinction) = (setup.problem.medium().support(), medium.single_value());
    let constants = extinction.zip(setup.control.single_value());
    let kept = constants.map(|(extinction, control)| 1.0 - (extinction - control) / even.value);
    let world = World { setup, support, extinction, kept };
    let frame = Frame { world, even, rays, in_space, medium };
    match kind {
        Kind::Points { camera, from_source, .. } => {
            frame.make(level, points::Technique { camera, from_source, main }, request)
        }
        Kind::Collision(absorption) => {
            frame.make(level, collisions::Technique { absorption }, request)
        }
        Kind::SourceAndCollision(sharing) => frame.make(level, mis::Technique { sharing }, request),
        Kind::Interactions => frame.make(level, interactions::Technique::<false>, request),
        Kind::Resampled => frame.make(level, interactions::Technique::<true>, request),
        Kind::Shared(count) => frame.make(level, shared::Technique { count }, request),
    }
}

/// What all techniques work on.
struct Frame<'a> {
    world: World<'a>,
    even: &'a even::Even,
    rays: ShadowRays<'a>,
    in_space: Batches<'a>,
    medium: &'a Lookups<'a>,
}

impl<'a> Frame<'a> {
    /// One function for each technique: compilers take the square of its length.
    fn make<'r, P: Pages<'a>>(
        self,
        level: Level,
        pages: P,
        request: Request<'r>,
    ) -> Option<Request<'r>> {
        let task = Walks { frame: self, pages, request };
        pack::on_wide(level, task).err().map(|task| task.request)
    }
}

struct Walks<'a, 'r, P> {
    frame: Frame<'a>,
    pages: P,
    request: Request<'r>,
}

impl<'a, P: Pages<'a>> Task for Walks<'a, '_, P> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { frame: Frame { world, even, rays, in_space, medium }, pages, request } = self;
        let walk = Walk::new(simd, Even::new(f64x8::splat(simd, 0.0), even), world.support.from);
        let Request { streams, count, buffer } = request;
        buffer.make_room(count);
        let turn = streams.turn;
        let [first, second] = streams.packs();
        let (mut slots, mut others) = (Slots::new(count, turn, 0), Slots::new(count, turn, 1));
        // Two names, not an array: what an index reaches lies in memory, and there AVX2 chooses by stores that cost
        // more than all else.
        let mut first = Pack::begin(simd, pages.page(simd, world, walk), first.awake(simd));
        let mut second = Pack::begin(simd, pages.page(simd, world, walk), second.awake(simd));
        while slots.are_open() || others.are_open() {
            let mut points = [[0.0; PAIR]; 3];
            let places = Twin(first.fly(&rays, 0, &mut points), second.fly(&rays, 1, &mut points));
            let on_ray = medium.pair(simd, places);
            let casts = first.casts | second.casts;
            let on_shadow = match casts.to_bitmask() {
                0 => on_ray,
                _ => in_space.pair(simd, &points),
            };
            first.collide(&world, (&rays, &in_space), (on_ray.0, on_shadow.0));
            first.go_on(0, &mut slots, streams, buffer);
            second.collide(&world, (&rays, &in_space), (on_ray.1, on_shadow.1));
            second.go_on(1, &mut others, streams, buffer);
        }
        streams.turn = (turn + count) % LANES;
    }
}

/// Eight walks.
struct Pack<S: Simd, P> {
    page: P,
    numbers: Numbers<S>,
    sums: Sums<S>,
    shadows: Shadows<f64x8<S>>,
    /// Where shadow rays begin.
    origin: exit::Points<S>,
    /// Where they have come to in this step.
    place: exit::Points<S>,
    inside: mask64x8<S>,
    /// Who was on a shadow ray in this step.
    casts: mask64x8<S>,
    /// Who is to cast a shadow ray, and from which distance.
    aiming: mask64x8<S>,
    from: f64x8<S>,
    /// Who has found light, and how much.
    lit: mask64x8<S>,
    light: f64x8<S>,
}

impl<S: Simd, P: Page<S>> Pack<S, P> {
    #[inline(always)]
    fn begin(simd: S, mut page: P, mut numbers: Numbers<S>) -> Self {
        const { assert!(TOGETHER + P::LIT + P::DONE < 8 + 3, "all lanes may wait for each other") };
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        let mut sums = Sums { value: zero, lookups: zero };
        page.begin(&mut numbers, !none, &mut sums);
        let shadows = Shadows::new(zero);
        let (origin, place) = ([zero; 3], [zero; 3]);
        Self {
            page,
            numbers,
            sums,
            shadows,
            origin,
            place,
            inside: none,
            casts: none,
            aiming: none,
            from: zero,
            lit: none,
            light: zero,
        }
    }

    /// All fly on; answers where they are on the ray, and writes where they are on their shadow rays.
    #[inline(always)]
    fn fly(&mut self, rays: &ShadowRays, number: usize, points: &mut [[f64; PAIR]; 3]) -> f64x8<S> {
        self.casts = self.shadows.on;
        let flies = self.page.flies() & !(self.casts | self.aiming | self.lit);
        let moves = flies | self.casts;
        let mut depth = self.from.each(0.0);
        if moves.to_bitmask() != 0 {
            depth = -self.numbers.ln_uniform_where(moves);
        }
        // With nobody on a shadow ray, too: it costs less than a branch that no machine foresees.
        if rays.tracking != Tracking::Exact {
            (self.place, self.inside) = self.shadows.fly(rays, self.origin, depth);
            for (axis, row) in points.iter_mut().enumerate() {
                self.place[axis].store_slice(&mut row[number * WIDTH..][..WIDTH]);
            }
        }
        self.page.fly(&mut self.numbers, flies, depth)
    }

    /// What becomes of each, given σ_t on the ray and on the shadow rays.
    #[inline(always)]
    fn collide(
        &mut self,
        world: &World,
        (rays, in_space): (&ShadowRays, &Batches),
        (extinction, on_shadow): (f64x8<S>, f64x8<S>),
    ) {
        let (numbers, one) = (&mut self.numbers, extinction.each(1.0));
        let held = self.casts | self.aiming | self.lit;
        let (aims, from) = self.page.collide(numbers, !held, extinction, &mut self.sums);
        let nobody = aims & !aims;
        let mut found: Found<S> = (nobody, one);
        if rays.tracking != Tracking::Exact {
            let inside = self.casts & self.inside;
            add_where(&mut self.sums.lookups, inside, one);
            found = self.shadows.collide(rays, numbers, (self.place, inside), on_shadow);
        }
        self.from = Lane::select(aims, from, self.from);
        self.aiming |= aims;
        if self.aiming.to_bitmask().count_ones() >= TOGETHER {
            let casts = self.aiming;
            self.aiming = nobody;
            let (origin, direction, distance) = world.setup.problem.to_light(self.from);
            for (axis, to) in self.origin.iter_mut().enumerate() {
                *to = Lane::select(casts, origin[axis], *to);
            }
            let light = Light { direction, share: one, distance };
            let ends = exit::ends(&rays.bounds, [origin, direction], casts);
            let from = (origin, one);
            let ((which, through), _) =
                self.shadows.cast((rays, Some(in_space)), casts, &light, from, ends);
            // What a ray that was cast before has found, and what one finds at once.
            found = (found.0 | which, Lane::select(which, through, found.1));
        }
        self.lit |= found.0;
        self.light = Lane::select(found.0, found.1, self.light);
        if self.lit.to_bitmask().count_ones() >= P::LIT {
            self.page.lit((self.lit, self.light), &mut self.sums);
            self.lit = nobody;
        }
    }

    /// Who has made its draw begins the next one.
    #[inline(always)]
    fn go_on(
        &mut self,
        number: usize,
        slots: &mut Slots,
        streams: &mut Streams,
        buffer: &mut DrawBuffer,
    ) {
        if self.page.done().to_bitmask().count_ones() < P::DONE {
            return;
        }
        let [ended, begins] = self.page.finish();
        if ended.any_true() {
            let Sums { value, lookups } = self.sums;
            let over = left::draws(&[value], &lookups, (ended.to_bitmask(), slots), buffer);
            bank::leave(streams, number, over, self.numbers);
            let zero = value.each(0.0);
            self.sums.value = Lane::select(ended, zero, value);
            self.sums.lookups = Lane::select(ended, zero, lookups);
        }
        if begins.any_true() {
            self.page.begin(&mut self.numbers, begins, &mut self.sums);
        }
    }
}
