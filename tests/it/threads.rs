//! Results are the same to the byte on any number of threads.

use crate::common::{case, judged, options};
use trueflight::case::Case;

const DRAWS: u64 = 50_000;

/// Returns cases with sweeps, controls, pilot rays, whole distributions and many channels.
fn cases() -> Vec<Case> {
    vec![
        case(
            "sweep",
            "title = \"a sweep\"
            [problem.transmittance]
            medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }
            span = [0, 4]
            sweep.sampling.values = [0.6, 1.6]
            estimators = [
                { woodcock = {} }, { ratio = {} }, { residual-ratio = {} }, { next-flight = {} },
                { single = { rule = \"adaptive\", albedo = 0.3 } }, { regular = {} },
                { double.control.explorers.points = 5 },
                { local-majorant.sampling.local-majorants.segments = 8 },
                { ratio.sampling.pilot.rays = 16 },
            ]",
        ),
        case(
            "eq21",
            "title = \"a volume\"
            [problem.transmittance]
            volume.eq21 = {}
            ray = { origin = [1, 0, -3], direction = [0, 0.1, 1], length = 30 }
            sampling.constant.value = 1.1
            estimators = [{ woodcock = {} }, { unidirectional-mis = {} }, { decomposition = {} }]",
        ),
        case(
            "flight",
            "title = \"free flight\"
            [problem.free-flight]
            medium.exponential = { extinction = 2, rate = 0.7 }
            span = [0, 3]
            sampling.constant.value = 2
            estimators = [{ woodcock = {} }, { inversion = {} }]",
        ),
        case(
            "curve",
            "title = \"a curve\"
            [problem.transmittance]
            medium.gaussian = { peak = 1.5, centre = 2, width = 0.7 }
            span = [0, 4]
            sampling.constant.value = 1.2
            estimators = [{ double = {} }, { double.control.explorers.points = 9 }]",
        ),
        case(
            "rod",
            "title = \"a rod\"
            [problem.rod]
            medium.constant.extinction = 1
            span = [0, 2]
            absorbed = true
            sampling.constant.value = 1.2
            sweep.albedo.values = [0.4, 0.9]
            estimators = [{ analog = {} }, { adaptive.sampling.constant.value = 0.8 }]",
        ),
        case(
            "slab",
            "title = \"a slab\"
            [problem.slab]
            medium.constant.extinction = 1
            span = [0, 1]
            albedo = 0.8
            phase.rayleigh = {}
            incidence.collimated.cosine = 0.5
            sampling.constant.value = 1.2
            estimators = [{ analog = {} }, { non-terminating = {} }]",
        ),
    ]
}

/// Returns the results part of a record drawn on a pool of its own, as text.
fn on(threads: usize, seed: u64) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let record = pool.install(|| judged(&cases(), &options(seed, DRAWS)));
    assert_eq!(record.timing.threads, threads);
    serde_json::to_string_pretty(&record.results).expect("JSON")
}

#[test]
fn results_are_byte_identical_on_1_2_and_7_threads() {
    let alone = on(1, 1);
    for threads in [2, 7] {
        let together = on(threads, 1);
        let differing = alone.lines().zip(together.lines()).find(|(a, b)| a != b);
        assert_eq!(differing, None, "{threads} threads");
        assert_eq!(alone.len(), together.len());
    }
}

#[test]
fn another_seed_makes_other_draws() {
    assert_ne!(on(2, 2), on(2, 3));
}

#[test]
fn an_experiment_keeps_its_draws_when_others_leave() {
    let all = cases();
    let together = judged(&all, &options(1, 20_000));
    for (index, case) in cases().into_iter().enumerate() {
        let alone = judged(&[case], &options(1, 20_000));
        let means = |record: &trueflight::record::Record, at: usize| {
            let rows = record.results.cases[at].rows();
            rows.map(|row| row.mean.map(f64::to_bits)).collect::<Vec<_>>()
        };
        assert_eq!(means(&together, index), means(&alone, 0), "{}", all[index].name);
    }
}
