//! Memo of answers: experiments of one slab share them.

use super::{Answer, answers};
use crate::memo::Memo;
use crate::problems::slab::Incidence;
use numeric::Known;

/// Key of an answer: the bits of all numbers, and the label of the phase function, which contains every digit of
/// its settings.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    cosine: Option<u64>,
    phase: String,
    depth: [u64; 2],
    albedo: u64,
}

static ANSWERS: Memo<Key, Option<Answer>> = Memo::new(4096);

/// Returns the answer; it is computed only once, also if several threads need it.
pub fn cached(incidence: &Incidence, depth: Known, albedo: f64) -> Option<Answer> {
    let key = Key {
        cosine: incidence.light.cosine().map(f64::to_bits),
        phase: incidence.phase.label(),
        depth: [depth.value.to_bits(), depth.error.to_bits()],
        albedo: albedo.to_bits(),
    };
    ANSWERS.get(key, || answer(incidence, depth, albedo))
}

fn answer(incidence: &Incidence, depth: Known, albedo: f64) -> Option<Answer> {
    answers(&incidence.phase, &[incidence.light], depth, albedo)?.pop()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problems::slab::Light;
    use media::phase::{Phase, isotropic::Isotropic};

    #[test]
    fn what_differs_is_kept_apart() {
        let of = |light, depth: f64, albedo| {
            let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
            let found = cached(&incidence, Known::exact(depth), albedo);
            assert_eq!(found, answer(&incidence, Known::exact(depth), albedo));
            assert_eq!(found, cached(&incidence, Known::exact(depth), albedo));
            found.expect("finite").reflected.value
        };
        let values = [
            of(Light::Diffuse, 0.5, 0.9),
            of(Light::Collimated(0.5), 0.5, 0.9),
            of(Light::Collimated(0.5), 0.6, 0.9),
            of(Light::Collimated(0.5), 0.5, 0.8),
        ];
        for (i, x) in values.iter().enumerate() {
            assert!(values[..i].iter().all(|y| x != y));
        }
    }
}
