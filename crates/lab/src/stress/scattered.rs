//! Single scattering: moments and lookups of its estimators, see `techniques`, in homogeneous media and in fields.

use super::prelude::*;
use super::rays::{even, varying};
use super::rods::lookups;
use super::scattering::{LitRay, lit, lit_field};
use super::techniques::{Estimator, PointTechnique};
use theory::problems::Problem;
use theory::single::{CameraTracking, Tracking};

/// Techniques that take turns where rays are deep.
const TECHNIQUES: usize = 6;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 1e-12 … 10, σ̂/σ_t = 0.5 … 1e4, \
                 light 1e-6 … 10 ℓ away";
    let both = || (shallow(), Choices::any());
    let mut rows = run.fill([8, 96], kinds(range), both, |(setting, choices), seen| {
        homogeneous(setting, choices, &|_| true, seen)
    });
    let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 10 … 1e3, σ̂/σ_t = 0.3 … 1e3, \
                 light 1e-4 … 100 mean free paths away";
    // A ray of many mean free paths takes seconds for all techniques.
    let both = || (deep(), Choices::any());
    rows.extend(run.fill([8, 96], kinds(range), both, |(setting, choices), seen| {
        homogeneous(setting, choices, &|technique| technique == choices.technique, seen)
    }));
    let range = "four fields, controls, light 1e-3 … 10 away, g to 0.8, σ̂ = 0.6 … 5 of the largest; panels of s";
    let of_fields = ["variance", "fourth moment"]
        .map(|what| TrialRow::stated(format!("single scattering in fields, {what}"), range));
    rows.extend(run.fill([8, 144], of_fields, InField::any, in_field));
    rows
}

/// Rows of techniques that scatter at one point, and at many of a walk.
fn kinds(range: &str) -> [TrialRow; 6] {
    let whats = ["variance", "fourth moment", "lookups"];
    std::array::from_fn(|i| {
        let kind = ["at one point", "of walks"][i / 3];
        TrialRow::stated(format!("single scattering {kind}, {}", whats[i % 3]), range)
    })
}

/// A ray and a light beside it.
#[derive(Debug, Clone, Copy)]
struct Setting {
    sigma: f64,
    length: f64,
    distance: f64,
    foot: f64,
    /// `σ̂/σ_t`.
    ratio: f64,
}

fn shallow() -> impl Strategy<Value = Setting> {
    let depth = prop_oneof![1 => sized(-12.0, -3.0), 3 => sized(-3.0, 1.0)];
    let away = prop_oneof![1 => sized(-6.0, -2.0), 3 => sized(-2.0, 1.0)];
    let ratio = prop_oneof![1 => sized(-0.3, 4.0), 3 => sized(-0.3, 1.0)];
    (sized(-1.0, 1.0), depth, away, between(-0.3, 1.3), ratio).prop_map(
        |(length, depth, away, foot, ratio)| {
            let (sigma, distance, foot) = (depth / length, away * length, foot * length);
            Setting { sigma, length, distance, foot, ratio }
        },
    )
}

/// Settings with a light that is not too many mean free paths away.
fn deep() -> impl Strategy<Value = Setting> {
    let ratio = prop_oneof![1 => sized(1.0, 3.0), 3 => sized(-0.5, 1.0)];
    let light = (sized(-4.0, 2.0), sized(-2.0, 2.0), sign());
    (sized(-1.0, 1.0), sized(1.0, 3.0), light, ratio).prop_map(
        |(length, depth, (away, foot, sign), ratio)| {
            let path = length / depth;
            let foot = (foot * path).min(1.3 * length) * sign;
            Setting { sigma: depth / length, length, distance: away * path, foot, ratio }
        },
    )
}

parameters! {
    /// An estimator of a scene; controls and σ̂ of shadow rays are in units of σ_t.
    Choices {
        albedo: f64 = between(0.1, 1.0),
        control: f64 = residual(),
        shadow: Tracking = prop_oneof![
            Just(Tracking::Exact),
            (sized(-0.3, 1.0), residual())
                .prop_map(|(sampling, control)| Tracking::Ratio { sampling, control }),
            sized(0.0, 1.0).prop_map(|sampling| Tracking::Delta { sampling }),
        ],
        count: usize = 1..=8_usize,
        alongs: [usize; 2] = [0..6_usize, 0..6_usize],
        technique: usize = 0..TECHNIQUES,
    }
    /// A scene in a field, and how it is estimated; σ̂ and the control are in units of the largest σ_t.
    InField {
        lit: LitRay = lit_field(),
        scale: f64 = sized(-0.2, 0.7),
        shadow_scale: f64 = sized(-0.2, 0.7),
        kind: usize = 0..12_usize,
        held: f64 = prop_oneof![Just(0.0), between(0.0, 0.8)],
        count: usize = 1..=8_usize,
    }
}

/// A control in one of two.
fn residual() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), between(0.0, 1.2)]
}

fn homogeneous(
    setting: &Setting,
    choices: &Choices,
    is_wanted: &dyn Fn(usize) -> bool,
    seen: &mut Seen,
) -> Option<()> {
    let &Setting { sigma, length, distance, foot, ratio } = setting;
    let &Choices { albedo, control, shadow, count, alongs: chosen, .. } = choices;
    let walk = [sigma * ratio, sigma * control];
    let tracking = match shadow {
        Tracking::Exact => Tracking::Exact,
        Tracking::Ratio { sampling, control } => {
            Tracking::Ratio { sampling: sigma * sampling, control: sigma * control }
        }
        Tracking::Delta { sampling } => Tracking::Delta { sampling: sigma * sampling },
    };
    let problem = lit(sigma, distance, foot, length, albedo)?;
    let estimator = Estimator { problem: &problem, walk, tracking, count };
    let mut alongs = vec![CameraTracking::Exact, CameraTracking::Ratio];
    if ratio >= 1.0 {
        alongs.push(CameraTracking::Delta);
    }
    let [by_angle, by_depth] = chosen.map(|number| alongs[number % alongs.len()]);
    let all: [PointTechnique; TECHNIQUES] = [
        PointTechnique::AtCollisions,
        PointTechnique::Resampled,
        PointTechnique::SharedWalk,
        PointTechnique::Delta,
        PointTechnique::ByAngle(by_angle),
        PointTechnique::ByDepth(by_depth),
    ];
    let ray = even(&estimator, sigma, 4);
    for (number, technique) in all.into_iter().enumerate().filter(|&(i, _)| is_wanted(i)) {
        if technique == PointTechnique::Delta && ratio < 1.0 {
            continue;
        }
        let computed = estimator.found(technique).prediction();
        let (raw, exact) = ray.exact(technique);
        let row = if number < 3 { 3 } else { 0 };
        seen.at(format_args!("{technique:?}"));
        // A spread that rounding hides is not told.
        seen.resolved([row, row + 1], computed.channels[0].moments, &raw);
        match computed.lookups.zip(exact) {
            Some((distribution, exact)) => seen.stated(row + 2, lookups(&distribution), exact),
            None => seen.skip(row + 2),
        }
    }
    Some(())
}

fn in_field(choices: &InField, seen: &mut Seen) -> Option<()> {
    let &InField { ref lit, scale, shadow_scale, kind, held, count } = choices;
    let problem = lit.problem().filter(|problem| !problem.medium().support().is_empty())?;
    let medium = problem.medium();
    let largest = Mesh::new(medium.clone()).largest(&|_, sigma| sigma);
    let largest = largest.map_or(1.0, |(_, largest)| largest);
    let maximum = problem.shadow_majorant();
    let tracking = match kind % 3 {
        0 => Tracking::Exact,
        1 => Tracking::Ratio { sampling: shadow_scale * maximum, control: 0.0 },
        _ => Tracking::Delta { sampling: shadow_scale.max(1.0) * maximum },
    };
    let technique = match kind / 3 {
        0 => PointTechnique::ByAngle(CameraTracking::Exact),
        1 => PointTechnique::ByAngle(CameraTracking::Ratio),
        2 => PointTechnique::AtCollisions,
        _ => PointTechnique::SharedWalk,
    };
    let walk = [scale * largest, held * largest];
    let estimator = Estimator { problem: &problem, walk, tracking, count };
    let (raw, _) = varying(&estimator).exact(technique);
    seen.at(format_args!("{technique:?}, {tracking:?}"));
    let computed = estimator.found(technique).prediction().channels[0].moments;
    seen.resolved([0, 1], computed, &raw);
    Some(())
}
