//! Memos of slabs: experiments, rules and powers with equal slabs share their answers.

use super::{EnergyBounds, IncidentLight, Resolution, answers};
use crate::Kernel;
use crate::memo::Memo;
use crate::problems::slab::Incidence;
use media::phase::Phase;
use numeric::{Known, Scalar};

/// Key of a slab: the label of the phase function, which contains every digit of its settings, and the bits of all
/// numbers.
pub(super) type SlabKey = (String, Vec<u64>);

/// Answers to [`cached`].
static ANSWERS: Memo<SlabKey, Option<EnergyBounds>> = Memo::new(4096);
/// Answers for stacks of layers.
pub(super) static STACKS: Memo<SlabKey, Option<Vec<EnergyBounds>>> = Memo::new(1024);
/// Factorial moments of the numbers of collisions in stacks of layers.
pub(super) static COUNTS: Memo<SlabKey, Option<Vec<[Known; 4]>>> = Memo::new(1024);

/// Returns the key of lights and further numbers.
fn key(phase: &Phase, lights: &[IncidentLight], numbers: impl IntoIterator<Item = f64>) -> SlabKey {
    let cosines = lights.iter().map(|light| light.cosine().unwrap_or(-1.0));
    let numbers = std::iter::once(lights.len() as f64).chain(cosines).chain(numbers);
    (phase.label(), numbers.map(f64::to_bits).collect())
}

/// Returns the key of a stack of layers at a resolution.
pub(super) fn of_stack<S: Scalar>(
    phase: &Phase,
    lights: &[IncidentLight],
    slices: &[Kernel<S>],
    resolution: Resolution,
) -> SlabKey {
    let Resolution { faintest, directions, first_layer, gains, peaked } = resolution;
    let counts = [S::TERMS, directions, peaked].map(|count| count as f64);
    let numbers = [faintest, first_layer].into_iter().chain(gains).chain(counts);
    let of_slice = |&Kernel { rate, straight, scattered, score }: &Kernel<S>| {
        let terms = (0..S::TERMS).flat_map(move |i| [straight.term(i), scattered.term(i)]);
        [rate, score].into_iter().chain(terms)
    };
    key(phase, lights, numbers.chain(slices.iter().flat_map(of_slice)))
}

/// Returns the answer; it is computed only once, also if several threads need it.
pub fn cached(incidence: &Incidence, depth: Known, albedo: f64) -> Option<EnergyBounds> {
    let Incidence { light, phase } = incidence;
    let key = key(phase, &[*light], [depth.value, depth.error, albedo]);
    ANSWERS.get(key, || answers(phase, &[*light], depth, albedo)?.pop())
}
