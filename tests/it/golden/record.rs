//! A made-up run: one of each verdict, and names, reasons and numbers that reports trip over.

use trueflight::case::names::EstimatorName;
use trueflight::case::sweep::What;
use trueflight::plan::ExperimentId;
use trueflight::plan::id::{Number, SamplingName, SweepPoint};
use trueflight::record::baseline::{
    Change, ChannelId, Comparison, Drift, LeftOut, Measured, Quantity, Rules, Sequel,
};
use trueflight::record::{
    Anatomy, Best, CaseRecord, ChannelRecord, Course, Curve, CurvePoint, ExperimentRecord, Finding,
    Gate, GateFinding, MeasuredPoint, Record, Results, SCHEMA, Score, Spent, Suspect, Sweep,
    Timing, Verdict,
};

/// The estimators in the order of the case.
const LISTED: [&str; 5] =
    ["woodcock", "residual-ratio", "single(non-terminating, a=0.7)", "regular", "double"];

/// An identity in the sweep of σ̂, or outside of it.
fn id(estimator: &str, control: &str, swept: Option<f64>) -> ExperimentId {
    ExperimentId {
        case: "transmittance/eq21-sweep".to_owned(),
        problem: "transmittance".to_owned(),
        estimator: EstimatorName { name: estimator.to_owned(), settings: String::new() },
        sampling: SamplingName {
            constant: swept.map(Number),
            kind: swept.map_or("", |_| "constant").to_owned(),
        },
        control: control.to_owned(),
        swept: swept.map(|value| SweepPoint { what: What::Sampling, value: Number(value) }),
        namesake: 1,
    }
}

/// An experiment without channels.
fn named(estimator: &str, control: &str, swept: Option<f64>) -> ExperimentRecord {
    ExperimentRecord {
        id: id(estimator, control, swept),
        label: estimator.to_owned(),
        listed: LISTED.iter().position(|name| *name == estimator).expect("it is listed"),
        ..ExperimentRecord::default()
    }
}

/// Made-up laws of variance and lookups against the sampling extinction.
fn law(estimator: &str, sampling: f64) -> (f64, f64) {
    match estimator {
        "woodcock" => (0.125, 2.0 * sampling),
        "residual-ratio" => (0.02 / sampling, 5.0 * sampling),
        _ => (0.05 / sampling + 0.01 * sampling, 4.0 * sampling),
    }
}

/// One point of a sweep, with round numbers.
fn drawn(estimator: &str, control: &str, swept: f64, z: f64) -> ExperimentRecord {
    let (variance, lookups) = law(estimator, swept);
    let is_residual = estimator == "residual-ratio";
    let channel = ChannelRecord {
        mean: Some(0.135 + 1e-4 * z),
        standard_error: Some(1e-4),
        truth: Some(0.135),
        truth_error: Some(1e-17),
        z_mean: Some(z),
        variance: Some(variance * 1.01),
        predicted_variance: Some(variance),
        z_variance: Some(1.25),
        variance_deviation: Some(variance * 0.008),
        losses: Some([2.0, 1.5, 1.25, 1.125]),
        relative_moments: [Some(3.5), Some(12.25), None],
        moments_error: Some(1.5e-10),
        rare_event_size: Some(15.5),
        eighth_moment_ratio: Some(40.5),
        predicted_skewness: Some(0.75),
        predicted_kurtosis: Some(12.5),
        detectable_bias: Some(0.003),
        fom: Some(1.0 / (variance * lookups)),
        predicted_fom: Some(1.0 / (variance * lookups)),
        best: Some(Best {
            sampling: 1.2,
            fom: Some(2.5),
            kind: if is_residual { "90 % of the limit" } else { "optimum" }.to_owned(),
            limit: is_residual.then_some(2.75),
        }),
        verdict: Some(Verdict::Pass),
        ..ChannelRecord::default()
    };
    ExperimentRecord {
        draws: Some(1_048_576),
        drawn: Some(if swept > 1.0 { 262_144 } else { 2_097_152 }),
        command: format!(
            "trueflight run transmittance/eq21-sweep --filter \"*:{estimator}\" --seed 1"
        ),
        lookups_per_draw: Some(lookups * 0.999),
        predicted_lookups: Some(lookups),
        z_lookups: Some(-0.5),
        lookups_deviation: Some(lookups * 0.002),
        lookups_variance: Some(lookups),
        lookups_pmf: vec![0.25, 0.5, 0.25],
        stable_share: Some(0.8),
        setup_lookups: Some(if control.starts_with("explorers") { 3 } else { 0 }),
        needs: if is_residual { "τ".to_owned() } else { String::new() },
        spent: Spent { seconds: Some(0.25), is_reused: false },
        channels: vec![channel],
        ..named(estimator, control, Some(swept))
    }
}

fn judged(mut one: ExperimentRecord, verdict: Verdict, reason: &str) -> ExperimentRecord {
    for channel in &mut one.channels {
        channel.verdict = Some(verdict);
        reason.clone_into(&mut channel.reason);
    }
    one
}

/// The command that decides it.
fn with_decide(mut one: ExperimentRecord, decide: &str) -> ExperimentRecord {
    decide.clone_into(&mut one.channels[0].decide);
    one
}

/// What the gate says of the mean, with a number that no JSON can hold.
fn gate_finding(verdict: Verdict, reason: &str, ln_e: f64) -> Finding {
    Finding {
        check: "mean".to_owned(),
        what: "the mean".to_owned(),
        expects_bias: false,
        channel: String::new(),
        z: Some(7.5),
        p: None,
        gate: Some(GateFinding {
            tolerance: 0.003,
            variance: 2.5,
            mean: 0.025,
            planned: 1e6,
            draws: 262_144,
            ln_e,
            ln_e_limit: 8.5,
            ln_p: [-12.0, 40.0],
            ln_p_limit: 4.6,
            needed: (verdict == Verdict::Inconclusive).then_some(f64::INFINITY),
            is_decided: verdict == Verdict::Fail,
        }),
        path: vec![[4096.0, -0.25], [131_072.0, 0.5], [262_144.0, ln_e]],
        block: Some(15),
        verdict,
        reason: reason.to_owned(),
    }
}

/// A law that fails in one channel, beside a check of the whole experiment that both rows repeat.
fn failed_law(channel: &str) -> Finding {
    Finding {
        check: "curve".to_owned(),
        what: "the increments".to_owned(),
        channel: channel.to_owned(),
        z: None,
        p: Some(1e-9),
        gate: None,
        path: Vec::new(),
        block: None,
        ..gate_finding(Verdict::Fail, "the increments differ from theory: p = 1e-9", 0.0)
    }
}

fn refused(estimator: &str, swept: f64) -> ExperimentRecord {
    let reason = "the majorant is 0.9: below it the chance of a real collision would exceed 1";
    let course = Course {
        t: vec![0.0, 1.0, 2.0, 3.0],
        extinction: vec![0.2, 0.9, 0.6, 0.1],
        control: Vec::new(),
        sampling: vec![swept; 4],
        at: Some(1.0),
    };
    let mut row = ExperimentRecord {
        courses: vec![course],
        channels: vec![ChannelRecord::default()],
        ..named(estimator, "", Some(swept))
    };
    row.id.sampling.kind = String::new();
    judged(row, Verdict::Refused, reason)
}

fn sweep() -> CaseRecord {
    let (single, doubt) = ("single(non-terminating, a=0.7)", "at 1e6 draws a bias of 3 % hides");
    let off = "the mean is off by +2.5 % (measured 0.1384, expected 0.1350), z = +7.50 over 262144 draws; 100 % | sure";
    let failed = ExperimentRecord {
        findings: vec![gate_finding(Verdict::Fail, off, 31.25)],
        stream: Some(11),
        ..drawn("residual-ratio", "constant 0.4", 2.0, 7.5)
    };
    let decide = "trueflight check transmittance/eq21-sweep --filter '*:single' --draws 3.1e6";
    let mut unsure = ExperimentRecord {
        findings: vec![gate_finding(Verdict::Inconclusive, doubt, 1.5)],
        stream: Some(12),
        ..with_decide(drawn(single, "", 0.5, -1.5), decide)
    };
    unsure.channels[0].not_normal = vec![Score::Mean, Score::Variance];
    let regular = ChannelRecord {
        mean: Some(0.135),
        truth: Some(0.135),
        variance: Some(0.0),
        predicted_variance: Some(0.0),
        verdict: Some(Verdict::Pass),
        ..ChannelRecord::default()
    };
    let regular = ExperimentRecord {
        draws: Some(1),
        lookups_per_draw: Some(12.0),
        predicted_lookups: Some(12.0),
        spent: Spent { seconds: Some(0.25), is_reused: false },
        channels: vec![regular],
        ..named("regular", "", None)
    };
    let curve = |estimator: &str, control: &str, from: f64, [optimum, limit]: [Option<f64>; 2]| {
        let point = |x: f64| {
            let (variance, lookups) = law(estimator, x);
            CurvePoint { x, variance, lookups, fom: 1.0 / (variance * lookups), setup_lookups: 0 }
        };
        Curve {
            estimator: estimator.to_owned(),
            control: control.to_owned(),
            channel: String::new(),
            points: [0.5, 0.75, 1.0, 1.5, 2.0]
                .into_iter()
                .filter(|x| *x >= from)
                .map(point)
                .collect(),
            optimum: optimum.map(point),
            listed: LISTED.iter().position(|name| *name == estimator).expect("it is listed"),
            best: optimum.map(|sampling| Best {
                sampling,
                fom: Some(point(sampling).fom),
                kind: if limit.is_some() { "90 % of the limit" } else { "optimum" }.to_owned(),
                limit,
            }),
        }
    };
    let mut case = CaseRecord {
        name: "transmittance/eq21-sweep".to_owned(),
        path: "./cases/transmittance/eq21-sweep.toml".to_owned(),
        visible_bias: Some([0.003, 0.0125]),
        pace: Some(1.0625),
        title: "Eq. 21, central ray, \"quoted\" & <tagged>".to_owned(),
        problem: "transmittance".to_owned(),
        medium: "eq21".to_owned(),
        draws_per_ray: Some(1),
        experiments: vec![
            refused("woodcock", 0.5),
            drawn("residual-ratio", "constant 0.4", 0.5, 0.25),
            judged(unsure, Verdict::Inconclusive, doubt),
            drawn("woodcock", "", 2.0, 1.0),
            judged(failed, Verdict::Fail, off),
            judged(
                with_decide(drawn(single, "", 2.0, -0.125), decide),
                Verdict::Inconclusive,
                doubt,
            ),
            regular,
        ],
        sweep: Some(Sweep {
            what: "sampling".to_owned(),
            axis: "sampling extinction σ\u{302} [1/length]".to_owned(),
            log: true,
            z_limit: Some(4.42),
            curves: vec![
                curve("woodcock", "", 1.0, [Some(1.0), None]),
                curve("residual-ratio", "constant 0.4", 0.5, [Some(0.9), Some(12.0)]),
                curve(single, "", 0.5, [Some(1.5), None]),
            ],
        }),
        anatomy: None,
        ..CaseRecord::default()
    };
    case.name_experiments();
    case
}

fn ray() -> CaseRecord {
    let transmittance = vec![1.0, 0.7, 0.4, 0.3, 0.28];
    let channel = |t: f64, mean: f64| ChannelRecord {
        channel: format!("T({t})"),
        truth: Some(mean),
        ..drawn("double", "explorers(3)", 1.0, 0.5).channels.swap_remove(0)
    };
    let experiment = |stream: u64, channels: Vec<ChannelRecord>| {
        let mut id = id("double", "explorers(3)", None);
        "curve/figure5".clone_into(&mut id.case);
        "transmittance-curve".clone_into(&mut id.problem);
        "piecewise-linear".clone_into(&mut id.sampling.kind);
        id.namesake = usize::try_from(stream - 20).expect("a small number");
        ExperimentRecord {
            id,
            stream: Some(stream),
            spent: Spent { seconds: Some(0.5), is_reused: true },
            channels,
            ..drawn("double", "explorers(3)", 1.0, 0.5)
        }
    };
    let weak = "kurtosis 8.1e4: 3e9 draws would be needed";
    let mut first = experiment(21, vec![channel(2.0, 0.4), channel(4.0, 0.28)]);
    let second = &mut first.channels[1];
    (second.verdict, second.reason) = (Some(Verdict::Underpowered), weak.to_owned());
    let law = [failed_law(""), failed_law("T(6)"), failed_law("T(8)")];
    let reason = law[0].reason.clone();
    let failed = experiment(22, vec![channel(6.0, 0.25), channel(8.0, 0.25)]);
    let failed = ExperimentRecord { findings: law.to_vec(), ..failed };
    let failed = judged(failed, Verdict::Fail, &reason);
    let measured = |t, mean| MeasuredPoint { t, mean, standard_error: 0.01, deviation: 0.1 };
    let anatomy_of = first.id.clone();
    let mut case = CaseRecord {
        name: "curve/figure5".to_owned(),
        path: "cases/curve/figure5.toml".to_owned(),
        visible_bias: Some([0.05; 2]),
        pace: None,
        title: "Figure 5: a double particle".to_owned(),
        problem: "transmittance-curve".to_owned(),
        medium: "noise".to_owned(),
        draws_per_ray: Some(16),
        experiments: vec![first, failed],
        sweep: None,
        anatomy: Some(Anatomy {
            experiment: anatomy_of,
            t: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            extinction: vec![0.2, 0.5, 0.6, 0.3, 0.1],
            control: vec![0.2, 0.4, 0.6, 0.35, 0.1],
            residual: vec![0.0, 0.1, 0.0, -0.05, 0.0],
            sampling: vec![0.25; 5],
            deviation: vec![0.0, 0.05, 0.1, 0.1, 0.1],
            explorers: vec![[0.0, 0.2], [2.0, 0.6], [4.0, 0.1]],
            collisions: vec![[0.75, 0.43], [3.2, 0.26]],
            walks: vec![vec![1.0, 0.65, 0.35, 0.3, 0.3], vec![1.0, 0.8, 0.5, -20.0, 0.2]],
            measured: vec![measured(2.0, 0.41), measured(4.0, 0.27)],
            transmittance,
        }),
        ..CaseRecord::default()
    };
    case.name_experiments();
    case
}

/// What changed since a stored run: one of each kind.
fn comparison() -> Comparison {
    let command = "trueflight run transmittance/eq21-sweep --filter \"*:ratio\" --seed 1";
    let channel = |experiment: ExperimentId, channel: &str| ChannelId {
        experiment,
        channel: channel.to_owned(),
    };
    let plain =
        |name: &str| channel(ExperimentId { case: "case".to_owned(), ..id(name, "", None) }, "");
    let measured = |value: f64| Measured { value, error: Some(0.001) };
    let change = |quantity, ratio: f64| Change {
        id: channel(id("ratio", "", Some(0.5)), ""),
        quantity,
        before: measured(0.125),
        now: measured(0.125 * ratio),
        ratio,
        interval: (quantity != Quantity::Time).then_some([0.95 * ratio, 1.05 * ratio]),
        is_regression: ratio > 1.0,
        command: command.to_owned(),
    };
    Comparison {
        name: "main".to_owned(),
        rules: Rules { alpha: 0.01, time_tolerance: Some(0.25) },
        sequel: Sequel::Run(3),
        compared: 12,
        times: 1,
        multiplied: 40,
        blunt: 1,
        left_out: LeftOut {
            blunt: vec![channel(id("woodcock", "", Some(2.0)), "")],
            brief: (1..=10).map(|i| plain(&format!("brief {i}"))).collect(),
            ..LeftOut::default()
        },
        changes: vec![
            change(Quantity::Variance, 1.5),
            change(Quantity::Lookups, 0.5),
            change(Quantity::Time, 2.0),
        ],
        drifts: vec![Drift {
            id: channel(
                ExperimentId { case: "curve/figure5".to_owned(), ..id("double", "", None) },
                "T(4)",
            ),
            check: "mean: the mean".to_owned(),
            ln_e: 9.25,
            limit: 8.5,
            command: command.to_owned(),
        }],
        added: vec![plain("new")],
        missing: Vec::new(),
        rewritten: vec![plain("old")],
    }
}

/// A record with everything in it that a report may meet.
pub fn record() -> Record {
    let suspect = |check: &str, ln_e| Suspect {
        case: "transmittance/eq21-sweep".to_owned(),
        experiment: "residual-ratio at 2".to_owned(),
        check: check.to_owned(),
        ln_e,
    };
    let gate = Gate {
        scalars: 14,
        laws: 7,
        biased: 1,
        beta: 0.01,
        ln_e_limit: 8.5,
        ln_p_limit: 4.6,
        ln_mean_e: Some(28.6),
        smallest_margin: Some(-22.75),
        worst_bias: Some(0.0125),
        variance_assumed: 2,
        triage: vec![suspect("mean", 31.25), suspect("lookups", 9.125)],
    };
    let results = Results {
        schema: SCHEMA,
        version: "0.1.0".to_owned(),
        seed: 1,
        alpha: 0.01,
        streams: "PCG by address".to_owned(),
        gate,
        cut_by_time: false,
        cut_by_budget: true,
        cases: vec![sweep(), ray()],
    };
    Record {
        results,
        timing: Timing { threads: 2, level: "avx2".into(), seconds: 2.25 },
        comparison: Some(comparison()),
    }
}
