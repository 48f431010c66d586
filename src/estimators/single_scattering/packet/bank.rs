//! The loop of all techniques.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::collisions::Collisions;
use super::interactions::Interactions;
use super::mis::Mis;
use super::points::Points;
use super::shared::Shared;
use super::walk::{Walk, World};
use super::{Page, Sums};
use crate::estimators::single_scattering::delta_tracking::Absorption;
use crate::estimators::single_scattering::main_part::MainPart;
use crate::estimators::single_scattering::source_delta_mis::Sharing;
use crate::estimators::space::exit;
use crate::estimators::space::shadow::{Found, Light, ShadowRays, Shadows};
use crate::estimators::{DrawBuffer, Setup};
use crate::geometry::Bounds;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Slot, Slots};
use crate::media::course::Even;
use crate::media::{Batches, Lookups, even};
use crate::numeric::pack::{self, Task, WIDTH};
use crate::numeric::twin::PAIR;
use crate::numeric::{Lane, Twin};
use crate::problems::{Problem, SingleScattering};
use crate::rng::{LANES, PACKS};
use crate::theory::single::{CameraTracking, Tracking};

/// So many lanes of a pack cast their shadow rays together: to find where they lead costs more than a step. While
/// fewer wait for it, others are on their way.
const TOGETHER: u32 = 4;

/// A technique.
#[derive(Clone, Copy)]
pub enum Kind {
    /// Points from the light, from the main part of the control, or from both, each with a camera.
    Points {
        /// How the transmittance from the ray's origin is found.
        camera: CameraTracking,
        /// Whether points come from the light.
        from_source: bool,
        /// Whether points come from the main part.
        from_main: bool,
    },
    /// The first real collision.
    Collision(Absorption),
    /// A point from the light, the first real collision, or both.
    SourceAndCollision(Sharing),
    /// All interaction points.
    Interactions,
    /// One of them.
    Resampled,
    /// So many points on one walk.
    Shared(usize),
}

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
    let bounds = volume.bounds();
    let rays = ShadowRays { volume, bounds, tracking };
    let is_box = matches!(bounds, Bounds::Box(_));
    let is_tracked = matches!(kind, Kind::Points { camera, .. } if camera != CameraTracking::Exact);
    let is_single = setup.control.single_value().is_some();
    // One cheap sample alone, clipped lookups of shadow rays, and a main part of many pieces beside a tracked camera
    // do not pay.
    let is_one = matches!(kind, Kind::SourceAndCollision(Sharing { is_one: true, .. }));
    let is_cheap = is_one && tracking == Tracking::Exact && !medium.is_costly();
    let is_clipped = is_box && tracking != Tracking::Exact;
    if is_cheap || is_clipped || (main.is_some() && is_tracked && !is_single) {
        return Some(request);
    }
    let in_space = volume.batches(level, is_box);
    let (support, extinction) = (setup.problem.medium().support(), medium.single_value());
    let world = World { setup, support, extinction };
    let task = Walks { world, even, main, kind, rays, in_space, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Walks<'a, 'r> {
    world: World<'a>,
    even: &'a even::Even,
    main: Option<MainPart<'a>>,
    kind: Kind,
    rays: ShadowRays<'a>,
    in_space: Batches<'a>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Walks<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let (world, main) = (self.world, self.main);
        let walk = Walk::new(simd, Even::new(simd, self.even), world.support.from);
        let start = (world, walk);
        match self.kind {
            Kind::Points { camera, from_source, .. } => self.make(
                simd,
                #[inline(always)]
                || Points::new(simd, start, camera, from_source, main),
            ),
            Kind::Collision(absorption) => self.make(
                simd,
                #[inline(always)]
                || Collisions::new(simd, start, absorption),
            ),
            Kind::SourceAndCollision(sharing) => self.make(
                simd,
                #[inline(always)]
                || Mis::new(simd, start, sharing),
            ),
            Kind::Interactions => self.make(
                simd,
                #[inline(always)]
                || Interactions::<S, false>::new(simd, start),
            ),
            Kind::Resampled => self.make(
                simd,
                #[inline(always)]
                || Interactions::<S, true>::new(simd, start),
            ),
            Kind::Shared(count) => self.make(
                simd,
                #[inline(always)]
                || Shared::new(simd, start, count),
            ),
        }
    }
}

impl Walks<'_, '_> {
    #[inline(always)]
    fn make<S: Simd, P: Page<S>>(self, simd: S, page: impl Fn() -> P) {
        let Self { world, rays, in_space, medium, request, .. } = self;
        let Request { streams, count, buffer } = request;
        buffer.make_room(count);
        let lanes = streams.packs();
        let mut packs: [Pack<S, P>; PACKS] = std::array::from_fn(
            #[inline(always)]
            |pack| {
                let slots = Slots::new(count, streams.turn, pack);
                Pack::begin(simd, page(), lanes[pack].awake(simd), slots)
            },
        );
        while packs.iter().any(|pack| pack.slots.are_open()) {
            let mut points = [[0.0; PAIR]; 3];
            let [first, second] = &mut packs;
            let places = Twin(first.fly(&rays, 0, &mut points), second.fly(&rays, 1, &mut points));
            let on_ray = medium.pair(simd, places);
            let casts = first.casts | second.casts;
            let on_shadow = match casts.to_bitmask() {
                0 => on_ray,
                _ => in_space.pair(simd, &points),
            };
            let found = [(on_ray.0, on_shadow.0), (on_ray.1, on_shadow.1)];
            for (number, pack) in packs.iter_mut().enumerate() {
                pack.collide(&world, &rays, found[number]);
                let [ended, begins] = pack.page.finish();
                if ended.to_bitmask() != 0 {
                    let over = pack.collect(ended, buffer);
                    bank::leave(streams, number, over, pack.numbers);
                }
                if begins.to_bitmask() != 0 {
                    pack.page.begin(&mut pack.numbers, begins);
                }
            }
        }
        streams.turn = (streams.turn + count) % LANES;
    }
}

/// Eight walks.
struct Pack<S: Simd, P> {
    page: P,
    numbers: Numbers<S>,
    slots: Slots,
    sums: Sums<S>,
    shadows: Shadows<S>,
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
}

impl<S: Simd, P: Page<S>> Pack<S, P> {
    #[inline(always)]
    fn begin(simd: S, mut page: P, mut numbers: Numbers<S>, slots: Slots) -> Self {
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        page.begin(&mut numbers, !none);
        let (sums, shadows) = (Sums { value: zero, lookups: zero }, Shadows::new(simd));
        let (origin, place) = ([zero; 3], [zero; 3]);
        let (inside, casts, aiming) = (none, none, none);
        Self {
            page,
            numbers,
            slots,
            sums,
            shadows,
            origin,
            place,
            inside,
            casts,
            aiming,
            from: zero,
        }
    }

    /// All fly on; answers where they are on the ray, and writes where they are on their shadow rays.
    #[inline(always)]
    fn fly(&mut self, rays: &ShadowRays, number: usize, points: &mut [[f64; PAIR]; 3]) -> f64x8<S> {
        self.casts = self.shadows.on;
        let flies = self.page.flies() & !(self.casts | self.aiming);
        let depth = match (flies | self.casts).to_bitmask() {
            0 => self.sums.value.each(0.0),
            0xff => -self.numbers.ln_uniform(),
            _ => -self.numbers.ln_uniform_where(flies | self.casts),
        };
        if self.casts.to_bitmask() != 0 {
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
        rays: &ShadowRays,
        (extinction, on_shadow): (f64x8<S>, f64x8<S>),
    ) {
        let (numbers, one) = (&mut self.numbers, extinction.each(1.0));
        let held = self.casts | self.aiming;
        let (aims, from) = self.page.collide(numbers, !held, extinction, &mut self.sums);
        let nobody = aims & !aims;
        let mut found: Found<S> = (nobody, one);
        if self.casts.to_bitmask() != 0 {
            let inside = self.casts & self.inside;
            self.sums.lookups = Lane::select(inside, self.sums.lookups + 1.0, self.sums.lookups);
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
            let (which, through) = self.shadows.cast(rays, casts, &light, (origin, one));
            // What a ray that was cast before has found, and what one finds at once.
            found = (found.0 | which, Lane::select(which, through, found.1));
        }
        if found.0.to_bitmask() != 0 {
            self.page.lit(found, &mut self.sums);
        }
    }

    /// Makes draws of those that a mask names; answers whose last ones these are.
    #[inline(always)]
    fn collect(&mut self, ended: mask64x8<S>, buffer: &mut DrawBuffer) -> u64 {
        let mut rows = [[0.0; WIDTH]; 2];
        self.sums.value.store_slice(&mut rows[0]);
        self.sums.lookups.store_slice(&mut rows[1]);
        let zero = self.sums.value.each(0.0);
        self.sums.value = Lane::select(ended, zero, self.sums.value);
        self.sums.lookups = Lane::select(ended, zero, self.sums.lookups);
        write(&rows, ended.to_bitmask(), &mut self.slots, buffer)
    }
}

#[inline(never)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn write(
    [values, lookups]: &[[f64; WIDTH]; 2],
    ended: u64,
    slots: &mut Slots,
    buffer: &mut DrawBuffer,
) -> u64 {
    let DrawBuffer { values: channels, lookups: counts, defects } = buffer;
    slots.fill(ended, |Slot { lane, draw, .. }| {
        if let [channel] = &mut channels[..] {
            channel[draw] = values[lane];
        }
        counts[draw] = lookups[lane] as u32;
        defects[draw] = 0.0;
    })
}
