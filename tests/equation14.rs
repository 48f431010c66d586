//! Predictions against the differential equations they solve, integrated without the crate.
//!
//! A walk gains the random factor `W(s, ds)` in every step: 1 without a collision, else the rule's.
//! With `E[W^k] = (1 − r)^k q^{1−k}` at a collision, all raw moments of `X` obey
//!
//! ```text
//! dm_k/ds = −[σ̂ (1 − E[W^k]) + k σ_c] m_k
//! dV/ds = V (w − 2σ_t) + w T²                  (Eq. 14, w of Eqs. 17–20)
//! ```
//!
//! They are solved here by Dormand and Prince's pair of orders 5 and 4, restarted at every break, on
//! fields and rules that are written down a second time. Next-flight and unidirectional MIS are
//! solved from their Volterra equations, by the trapezoid and Richardson's extrapolation.
//!
//! Equation numbers: Szirmay-Kalos et al., *Unbiased Light Transport Estimators for Inhomogeneous
//! Participating Media*, Computer Graphics Forum 36 (2017).

mod common;

use common::differs;
use trueflight::harness::Case;
use trueflight::theory::Prediction;

/// How far a prediction may be from the solution of its equation, relatively.
const TOLERANCE: f64 = 1e-8;
/// Beyond this kurtosis moments are not compared.
const WILDEST: f64 = 1e6;

/// A function of the distance and of a point inside the piece that is meant at a break.
type Function = Box<dyn Fn(f64, f64) -> f64>;

/// A field written twice: as a case has it and as a function.
struct Field {
    text: String,
    breaks: Vec<f64>,
    value: Function,
    /// Whether it has one value, or one value per piece.
    shape: Shape,
}

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Constant(f64),
    Steps,
    Other,
}

fn constant(x: f64) -> Field {
    let text = format!("constant.{} = {x}", "value");
    Field { text, breaks: Vec::new(), value: Box::new(move |_, _| x), shape: Shape::Constant(x) }
}

fn piece(breaks: &[f64], inside: f64) -> usize {
    breaks.partition_point(|&b| b <= inside).clamp(1, breaks.len() - 1) - 1
}

fn steps(breaks: &[f64], values: &[f64]) -> Field {
    let text = format!("piecewise-constant = {{ breaks = {breaks:?}, values = {values:?} }}");
    let (b, v) = (breaks.to_vec(), values.to_vec());
    let value = Box::new(move |_: f64, inside: f64| v[piece(&b, inside)]);
    Field { text, breaks: breaks.to_vec(), value, shape: Shape::Steps }
}

fn through(knots: Vec<f64>, values: Vec<f64>) -> Function {
    Box::new(move |t, inside| {
        let i = piece(&knots, inside);
        let u = (t - knots[i]) / (knots[i + 1] - knots[i]);
        (1.0 - u) * values[i] + u * values[i + 1]
    })
}

fn lines(knots: &[f64], values: &[f64]) -> Field {
    let text = format!("piecewise-linear = {{ knots = {knots:?}, values = {values:?} }}");
    let value = through(knots.to_vec(), values.to_vec());
    Field { text, breaks: knots.to_vec(), value, shape: Shape::Other }
}

fn smooth(text: &str, f: impl Fn(f64) -> f64 + 'static) -> Field {
    let value = Box::new(move |t: f64, _: f64| f(t));
    Field { text: text.into(), breaks: Vec::new(), value, shape: Shape::Other }
}

fn no_control() -> Field {
    Field { text: "none = {}".into(), ..constant(0.0) }
}

/// Lines through σ_t at n points, the ends included.
fn explorers(medium: &Field, length: f64, n: usize) -> Field {
    let knots: Vec<f64> = (0..n).map(|i| length * i as f64 / (n - 1) as f64).collect();
    let values: Vec<f64> = knots.iter().map(|&t| (medium.value)(t, t)).collect();
    let text = format!("explorers.points = {n}");
    let level = n == 2 && values[0] == values[1];
    let shape = if level { Shape::Constant(values[0]) } else { Shape::Other };
    Field { text, breaks: knots.clone(), value: through(knots, values), shape }
}

/// What happens at a collision, from the papers.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    Double,
    Terminating,
    Clamped,
    NonTerminating(f64),
    Adaptive(f64),
    Null,
}

impl Rule {
    /// `q_tran`.
    fn survival(self, r: f64) -> f64 {
        let kept = (1.0 - r).abs();
        let non_terminating = |a: f64| if kept == 0.0 { 0.0 } else { kept / (a * r.abs() + kept) };
        match self {
            Self::Double => 1.0,
            Self::Terminating | Self::Null => kept,
            Self::Clamped => kept.min(1.0),
            Self::NonTerminating(a) => non_terminating(a),
            Self::Adaptive(a) if r >= 1.0 && a * r + kept <= 1.0 => kept,
            Self::Adaptive(a) => non_terminating(a),
        }
    }

    /// `E[W^k] = (1 − r)^k q^{1−k}`, and 0 at r = 1.
    fn power(self, r: f64, k: i32) -> f64 {
        match self.survival(r) {
            0.0 => 0.0,
            q => (1.0 - r).powi(k) * q.powi(1 - k),
        }
    }

    /// The variance introduction density in units of σ̂: Eq. 17, 19, 20, or 18 where the paper has
    /// no formula of its own.
    fn introduced(self, r: f64) -> f64 {
        match self {
            Self::Double => r * r,
            Self::Terminating if r <= 1.0 => r,
            Self::Terminating => r * (3.0 - 2.0 / r),
            Self::NonTerminating(a) => r.abs() * (r.abs() + a * (1.0 - r).abs()),
            Self::Null => r,
            Self::Clamped | Self::Adaptive(_) => 2.0 * r - 1.0 + self.power(r, 2),
        }
    }
}

/// A configuration: what all estimators of one case share.
struct Scene {
    medium: Field,
    sampling: Field,
    control: Field,
    length: f64,
}

impl Scene {
    fn at(&self, t: f64, inside: f64) -> (f64, f64, f64) {
        let [medium, sampling, control] = [&self.medium, &self.sampling, &self.control];
        ((medium.value)(t, inside), (sampling.value)(t, inside), (control.value)(t, inside))
    }

    fn pieces(&self) -> Vec<[f64; 2]> {
        let fields = [&self.medium, &self.sampling, &self.control];
        let mut ends: Vec<f64> = fields.iter().flat_map(|f| f.breaks.clone()).collect();
        ends.extend([0.0, self.length]);
        ends.retain(|&t| (0.0..=self.length).contains(&t));
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// The smallest and the largest residual and r.
    fn ranges(&self, controlled: bool) -> [[f64; 2]; 2] {
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for [from, to] in self.pieces() {
            for i in 0..=2000 {
                let t = from + (to - from) * f64::from(i) / 2000.0;
                let (medium, sampling, control) = self.at(t, 0.5 * (from + to));
                let residual = if controlled { medium - control } else { medium };
                for (range, x) in ranges.iter_mut().zip([residual, residual / sampling]) {
                    *range = [range[0].min(x), range[1].max(x)];
                }
            }
        }
        ranges
    }

    fn case(&self) -> Case {
        let entries: Vec<String> =
            estimators().iter().map(|estimator| format!("{{ {} }}", estimator.text)).collect();
        let medium = self.medium.text.replace("constant.value", "constant.extinction");
        common::case(
            "equation14",
            &format!(
                "title = \"t\"\n[problem.transmittance]\nmedium.{medium}\nspan = [0, {}]\n\
                 sampling.{}\ncontrol.{}\nestimators = [{}]",
                self.length,
                self.sampling.text,
                self.control.text,
                entries.join(", ")
            ),
        )
    }
}

/// Which equation an estimator solves.
#[derive(Clone, Copy, PartialEq)]
enum Law {
    /// Collisions of the residual, the control integrated.
    Product {
        rule: Rule,
        controlled: bool,
    },
    /// Collisions of the residual, the control sampled.
    Decomposition,
    NextFlight,
    UnidirectionalMis,
}

struct Estimator {
    text: &'static str,
    law: Law,
    /// Whether it exists in a scene with the given ranges of residual and r.
    exists: fn(&Scene, [[f64; 2]; 2]) -> bool,
}

fn estimators() -> Vec<Estimator> {
    let product = |rule, controlled| Law::Product { rule, controlled };
    let always = |_: &Scene, _: [[f64; 2]; 2]| true;
    let constant_control =
        |scene: &Scene, _: [[f64; 2]; 2]| matches!(scene.control.shape, Shape::Constant(_));
    let constant_sampling =
        |scene: &Scene, _: [[f64; 2]; 2]| matches!(scene.sampling.shape, Shape::Constant(_));
    vec![
        Estimator { text: "double = {}", law: product(Rule::Double, true), exists: always },
        Estimator { text: "ratio = {}", law: product(Rule::Double, false), exists: always },
        Estimator {
            text: "residual-ratio = {}",
            law: product(Rule::Double, true),
            exists: constant_control,
        },
        Estimator {
            text: "single.rule = \"terminating\"",
            law: product(Rule::Terminating, true),
            exists: |_, [_, r]| r[0] >= 0.0 && r[1] <= 2.0,
        },
        Estimator {
            text: "single.rule = \"clamped\"",
            law: product(Rule::Clamped, true),
            exists: always,
        },
        Estimator {
            text: "single = { rule = \"non-terminating\", albedo = 0.7 }",
            law: product(Rule::NonTerminating(0.7), true),
            exists: always,
        },
        Estimator {
            text: "single = { rule = \"non-terminating\", albedo = 0 }",
            law: product(Rule::NonTerminating(0.0), true),
            exists: always,
        },
        Estimator {
            text: "single = { rule = \"adaptive\", albedo = 0.2 }",
            law: product(Rule::Adaptive(0.2), true),
            exists: always,
        },
        Estimator {
            text: "weighted-delta = {}",
            law: product(Rule::NonTerminating(1.0), false),
            exists: always,
        },
        Estimator {
            text: "woodcock = {}",
            law: product(Rule::Null, false),
            exists: |_, [_, r]| r[1] <= 1.0,
        },
        Estimator {
            text: "local-majorant = {}",
            law: product(Rule::Null, false),
            exists: |scene, [_, r]| r[1] <= 1.0 && scene.sampling.shape != Shape::Other,
        },
        Estimator {
            text: "decomposition = {}",
            law: Law::Decomposition,
            exists: |scene, [residual, r]| {
                let control = scene.control.shape;
                matches!(control, Shape::Constant(c) if c >= 0.0)
                    && residual[0] >= 0.0
                    && r[1] <= 1.0
            },
        },
        Estimator { text: "next-flight = {}", law: Law::NextFlight, exists: constant_sampling },
        Estimator {
            text: "unidirectional-mis = {}",
            law: Law::UnidirectionalMis,
            exists: constant_sampling,
        },
    ]
}

/// What is compared: T, V, the central moments over T^k (k = 2, 3, 4), E[M].
struct Solution {
    mean: f64,
    variance: f64,
    relative: [f64; 3],
    lookups: f64,
}

/// Central moments over T^k, survival, lookups, T and V along the ray.
type State = [f64; 7];

/// The right-hand sides. Central moments in units of `T^k` follow from `M_k = m_k/T^k` with
/// `dM_k/ds = λ_k M_k`, `λ_k = k σ_t − k σ_c − σ̂ (1 − E[W^k])`:
///
/// ```text
/// c₂ = M₂ − 1,  c₃ = M₃ − 3M₂ + 2,  c₄ = M₄ − 4M₃ + 6M₂ − 3
/// ```
fn slope(law: Law, scene: &Scene, t: f64, inside: f64, y: &State) -> State {
    let (medium, sampling, mut control) = scene.at(t, inside);
    let (rule, killing) = match law {
        Law::Product { rule, controlled } => {
            control = if controlled { control } else { 0.0 };
            (rule, 0.0)
        }
        _ => (Rule::Null, control),
    };
    let r = (medium - control) / sampling;
    let lambda = |k: i32| {
        // A sampled control kills whatever k is; an integrated one multiplies X.
        let integrated = if killing == 0.0 { f64::from(k) * control } else { killing };
        f64::from(k) * medium - integrated - sampling * (1.0 - rule.power(r, k))
    };
    let [c2, c3, c4, alive, _, mean, variance] = *y;
    let (m2, m3) = (1.0 + c2, 1.0 + 3.0 * c2 + c3);
    let m4 = 1.0 + 6.0 * c2 + 4.0 * c3 + c4;
    let (l2, l3, l4) = (lambda(2), lambda(3), lambda(4));
    let w = sampling * rule.introduced(r) + killing;
    [
        l2 * m2,
        l3 * m3 - 3.0 * l2 * m2,
        l4 * m4 - 4.0 * l3 * m3 + 6.0 * l2 * m2,
        -(sampling * (1.0 - rule.survival(r)) + killing) * alive,
        sampling * alive,
        -medium * mean,
        variance * (w - 2.0 * medium) + w * mean * mean,
    ]
}

fn solve(law: Law, scene: &Scene) -> Solution {
    let walk = |scale: &State, local: f64| {
        let mut y = [0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        for [from, to] in scene.pieces() {
            let inside = 0.5 * (from + to);
            y = dormand_prince([from, to], y, (scale, local), |t, y| {
                slope(law, scene, t, inside, y)
            });
        }
        y
    };
    // A first walk learns the sizes at the end. What grows beyond 1 multiplies early errors too.
    let sizes = walk(&[1e-3; 7], 1e-6).map(|y| y.abs().clamp(1e-12, 1.0));
    let [c2, c3, c4, _, lookups, mean, variance] = walk(&sizes, 1e-14);
    Solution { mean, variance, relative: [c2, c3, c4], lookups }
}

/// Integrates `y' = f(t, y)` by the pair of J. Dormand and P. Prince, *A family of embedded
/// Runge–Kutta formulae*, J. Comp. Appl. Math. 6 (1980). The error of a step stays below `local` of
/// `y` or of `sizes`, whichever is larger.
fn dormand_prince<const N: usize>(
    [from, to]: [f64; 2],
    mut y: [f64; N],
    (sizes, local): (&[f64; N], f64),
    f: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
    const A: [[f64; 6]; 7] = [
        [0.0; 6],
        [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
        [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
        [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ];
    // The difference of the two orders.
    const E: [f64; 7] = [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339_200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];
    // Kinks of a rule are passed by small steps; the error there is the step's square.
    let least = 1e-8 * (to - from);
    let mut t = from;
    let mut step = (to - from) / 64.0;
    while t < to {
        step = step.min(to - t);
        let mut k = [[0.0; N]; 7];
        let mut next = y;
        for stage in 0..7 {
            next = std::array::from_fn(|i| {
                y[i] + step * (0..stage).map(|j| A[stage][j] * k[j][i]).sum::<f64>()
            });
            k[stage] = f(t + C[stage] * step, &next);
        }
        let error = (0..N).fold(0.0f64, |worst, i| {
            let error = step * (0..7).map(|j| E[j] * k[j][i]).sum::<f64>();
            worst.max((error / sizes[i].max(next[i].abs())).abs())
        });
        if error <= local || step <= least {
            t = if step >= to - t { to } else { t + step };
            y = next;
        }
        step *= (0.9 * (local / error.max(1e-30)).powf(0.2)).clamp(0.2, 4.0);
        step = step.max(least);
    }
    y
}

/// `E[F^k](0)`, k = 1 … 4, of next-flight or unidirectional MIS, on a grid of n steps per piece.
///
/// `F = G + A` with A the weight that goes on: `A_k(x) = ∫ σ̄ e^{−σ̄(y−x)} ρ(y)^k m_k(y) dy`. The
/// kernel is exponential, so that the trapezoid sum at x follows from that at x + h.
fn trapezoid(law: Law, scene: &Scene, sampling: f64, n: usize) -> [f64; 4] {
    const CHOOSE: [[f64; 5]; 5] = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 0.0],
        [1.0, 3.0, 3.0, 1.0, 0.0],
        [1.0, 4.0, 6.0, 4.0, 1.0],
    ];
    // E[F^k] from the moments of what goes on; G is v, or u with 2u at the end of the walk.
    let moment = |k: usize, v: f64, a: &[f64; 5]| {
        let direct = if law == Law::NextFlight { v } else { v / (1.0 + v) };
        let mixed = |j: usize| CHOOSE[k][j] * direct.powi((k - j) as i32) * a[j];
        let on = (1..=k).map(mixed).sum::<f64>();
        let power = direct.powi(k as i32);
        if law == Law::NextFlight {
            power + on
        } else {
            // With probability v the flight passes the end: (2u)^k, and nothing goes on.
            v * 2f64.powi(k as i32) * power + (1.0 - v) * power + on
        }
    };
    let mut a = [0.0; 5];
    for [from, to] in scene.pieces().into_iter().rev() {
        let (step, inside) = ((to - from) / n as f64, 0.5 * (from + to));
        let decay = (-sampling * step).exp();
        let rho = |i: usize| 1.0 - (scene.medium.value)(from + step * i as f64, inside) / sampling;
        let v = |i: usize| (-sampling * (scene.length - from - step * i as f64)).exp();
        for i in (0..n).rev() {
            let (v_far, v_near) = (v(i + 1), v(i));
            let (rho_far, rho_near) = (rho(i + 1), rho(i));
            let far = a;
            for k in 1..=4 {
                let half = 0.5 * step * sampling;
                let beyond = rho_far.powi(k as i32) * moment(k, v_far, &far);
                // m_k(x) holds A_k(x) itself, linearly: solve for it.
                a[k] = 0.0;
                let known = moment(k, v_near, &a);
                let weight = half * rho_near.powi(k as i32);
                let sum = decay * far[k] + half * decay * beyond + weight * known;
                a[k] = sum / (1.0 - weight);
            }
        }
    }
    let start = (-sampling * scene.length).exp();
    std::array::from_fn(|k| moment(k + 1, start, &a))
}

/// Richardson's extrapolation of the trapezoid, whose error is even in the step.
fn volterra(law: Law, scene: &Scene, sampling: f64) -> Solution {
    let mut table: Vec<[f64; 4]> =
        (0..6).map(|level| trapezoid(law, scene, sampling, 40 << level)).collect();
    let mut factor = 4.0;
    while table.len() > 1 {
        let finer = table.windows(2).map(|pair| {
            std::array::from_fn(|k| (factor * pair[1][k] - pair[0][k]) / (factor - 1.0))
        });
        table = finer.collect();
        factor *= 4.0;
    }
    let raw = table[0];
    let mean = raw[0];
    let [m2, m3, m4] = [1, 2, 3].map(|i| raw[i] / mean.powi(i as i32 + 1));
    let relative = [m2 - 1.0, m3 - 3.0 * m2 + 2.0, m4 - 4.0 * m3 + 6.0 * m2 - 3.0];
    let lookups = sampling * scene.length;
    Solution { mean, variance: relative[0] * mean * mean, relative, lookups }
}

fn compare(what: &str, found: &Prediction, expected: &Solution) -> Vec<String> {
    let channel = &found.channels[0];
    let moments = channel.moments.expect("moments");
    let lookups = found.lookups.expect("lookups").mean;
    let [c2, c3, c4] = expected.relative;
    let mut pairs =
        vec![("mean", channel.mean.value, expected.mean), ("lookups", lookups, expected.lookups)];
    if c4 < WILDEST * c2 * c2 {
        pairs.extend([
            ("variance", moments.variance(), expected.variance),
            ("second moment", moments.relative[0], c2),
            ("third moment", moments.relative[1], c3),
            ("fourth moment", moments.relative[2], c4),
        ]);
    }
    let differences = pairs.into_iter().filter_map(|(name, found, expected)| {
        differs(&format!("{what}: {name}"), found, expected, TOLERANCE)
    });
    differences.collect()
}

/// Every estimator in a scene; answers what differs and how many were compared.
fn check(scene: &Scene) -> (Vec<String>, usize) {
    let case = scene.case();
    let mut differences = Vec::new();
    let mut compared = 0;
    for (index, estimator) in estimators().iter().enumerate() {
        let [medium, sampling, control] = [&scene.medium, &scene.sampling, &scene.control];
        let what =
            format!("{} in {}, {}, {}", estimator.text, medium.text, sampling.text, control.text);
        let law = estimator.law;
        let controlled = !matches!(
            law,
            Law::Product { controlled: false, .. } | Law::NextFlight | Law::UnidirectionalMis
        );
        let exists = (estimator.exists)(scene, scene.ranges(controlled));
        let found = case.scenario.predict(index, None);
        assert_eq!(found.is_some(), exists, "whether it exists: {what}");
        let Some(found) = found else { continue };
        let expected = match (law, sampling.shape) {
            (Law::NextFlight | Law::UnidirectionalMis, Shape::Constant(rate)) => {
                volterra(law, scene, rate)
            }
            _ => solve(law, scene),
        };
        differences.extend(compare(&what, &found, &expected));
        compared += 1;
    }
    (differences, compared)
}

fn check_all(scenes: &[Scene], least: usize) {
    let (mut differences, mut compared) = (Vec::new(), 0);
    for scene in scenes {
        let (found, count) = check(scene);
        differences.extend(found);
        compared += count;
    }
    common::none(&differences);
    assert!(compared >= least, "only {compared} predictions were compared");
}

/// All combinations of σ̂ and controls with a medium.
fn scenes(
    medium: fn() -> Field,
    length: f64,
    samplings: &[fn() -> Field],
    controls: &[fn() -> Field],
) -> Vec<Scene> {
    let mut scenes = Vec::new();
    for sampling in samplings {
        for control in controls {
            let (medium, sampling, control) = (medium(), sampling(), control());
            scenes.push(Scene { medium, sampling, control, length });
        }
        let medium = medium();
        for points in [2, 6] {
            let control = explorers(&medium, length, points);
            let (medium, sampling) = (self::twin(&medium), sampling());
            scenes.push(Scene { medium, sampling, control, length });
        }
    }
    scenes
}

/// A second copy of a field that is only looked up.
fn twin(field: &Field) -> Field {
    let known = [homogeneous(), layers(), hills(), atmosphere(), blob(), waves()];
    let mut known = known.into_iter();
    known.find(|other| other.text == field.text).expect("a medium of this file")
}

fn homogeneous() -> Field {
    constant(0.5)
}

fn layers() -> Field {
    steps(&[0.0, 2.0, 3.0, 6.0, 6.5, 10.0], &[0.1, 1.0, 0.4, 0.0, 0.25])
}

fn hills() -> Field {
    lines(&[0.0, 1.0, 2.5, 4.0], &[0.2, 1.5, 0.4, 0.9])
}

fn atmosphere() -> Field {
    smooth("exponential = { extinction = 2.0, rate = 0.7 }", |t| 2.0 * (-0.7 * t).exp())
}

fn blob() -> Field {
    smooth("gaussian = { peak = 1.2, centre = 2.2, width = 0.6 }", |t| {
        let z = (t - 2.2) / 0.6;
        1.2 * (-0.5 * z * z).exp()
    })
}

fn waves() -> Field {
    smooth(
        "sines = { base = 0.8, amplitudes = [0.5, -0.2], frequencies = [1.3, 4.1], \
         phases = [0.4, 1.0] }",
        |t| 0.8 + 0.5 * (1.3 * t + 0.4).sin() - 0.2 * (4.1 * t + 1.0).sin(),
    )
}

#[test]
fn homogeneous_medium() {
    let samplings: [fn() -> Field; 4] = [
        || constant(0.8),
        || constant(0.3),
        || steps(&[0.0, 1.0, 4.0], &[0.4, 0.9]),
        || lines(&[0.0, 4.0], &[0.35, 1.4]),
    ];
    let controls: [fn() -> Field; 4] =
        [no_control, || constant(0.3), || constant(0.7), || constant(-0.1)];
    check_all(&scenes(homogeneous, 4.0, &samplings, &controls), 180);
}

#[test]
fn layers_with_an_empty_one() {
    let samplings: [fn() -> Field; 4] = [
        || constant(1.1),
        || constant(0.4),
        || steps(&[0.0, 2.0, 5.0, 10.0], &[0.25, 1.3, 0.6]),
        || lines(&[0.0, 3.5, 10.0], &[0.3, 1.2, 0.5]),
    ];
    let controls: [fn() -> Field; 2] = [no_control, || constant(0.3)];
    check_all(&scenes(layers, 10.0, &samplings, &controls), 130);
}

#[test]
fn straight_lines() {
    let samplings: [fn() -> Field; 3] =
        [|| constant(1.6), || constant(0.8), || lines(&[0.0, 1.2, 4.0], &[0.5, 1.9, 1.0])];
    let controls: [fn() -> Field; 3] = [no_control, || constant(0.15), || constant(0.9)];
    check_all(&scenes(hills, 4.0, &samplings, &controls), 120);
}

#[test]
fn exponential_atmosphere() {
    let samplings: [fn() -> Field; 3] =
        [|| constant(2.5), || constant(0.9), || lines(&[0.0, 1.5, 5.0], &[2.2, 0.8, 0.3])];
    let controls: [fn() -> Field; 3] = [no_control, || constant(0.05), || constant(0.6)];
    check_all(&scenes(atmosphere, 5.0, &samplings, &controls), 120);
}

#[test]
fn gaussian_blob() {
    let samplings: [fn() -> Field; 3] =
        [|| constant(1.3), || constant(0.7), || lines(&[0.0, 2.2, 4.0], &[0.2, 1.4, 0.3])];
    let controls: [fn() -> Field; 2] = [no_control, || constant(0.4)];
    check_all(&scenes(blob, 4.0, &samplings, &controls), 100);
}

#[test]
fn plane_waves() {
    let samplings: [fn() -> Field; 3] = [
        || constant(1.7),
        || constant(0.9),
        || steps(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], &[1.5, 1.6, 1.4, 0.8, 1.6]),
    ];
    let controls: [fn() -> Field; 2] = [no_control, || constant(0.8)];
    check_all(&scenes(waves, 5.0, &samplings, &controls), 100);
}

/// The ray of Eq. 21 along the axis, from its formula.
fn eq21(t: f64) -> f64 {
    ((1.0 + (1.5 * t).cos()) / 2.0).powi(5) * (2.0 + (0.5 * t).sin()) / 3.0
}

#[test]
fn eq_21_by_equation_14() {
    let case = common::case(
        "eq21",
        "title = \"t\"\n[problem.transmittance]\nvolume.eq21 = {}\n\
         ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }\n\
         sampling.constant.value = 1.0\n\
         estimators = [{ double = {} }, { single.rule = \"terminating\" }, \
         { single = { rule = \"non-terminating\", albedo = 0.7 } }, \
         { double.control.explorers.points = 21 }, { weighted-delta = {} }]",
    );
    let medium = || smooth("eq21", eq21);
    let product = |rule, control| {
        let law = Law::Product { rule, controlled: true };
        solve(law, &Scene { medium: medium(), sampling: constant(1.0), control, length: 20.0 })
    };
    let expected = [
        product(Rule::Double, no_control()),
        product(Rule::Terminating, no_control()),
        product(Rule::NonTerminating(0.7), no_control()),
        product(Rule::Double, explorers(&medium(), 20.0, 21)),
        product(Rule::NonTerminating(1.0), no_control()),
    ];
    let mut differences = Vec::new();
    for (index, expected) in expected.iter().enumerate() {
        let found = case.scenario.predict(index, None).expect("it exists");
        differences.extend(compare(&format!("estimator {index} of Eq. 21"), &found, expected));
    }
    common::none(&differences);
}
