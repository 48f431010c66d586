//! Time saved by skipping work that a scene does not need: each pair drawn with and without skips, in turn, in one
//! process, on one thread.
//!
//! ```text
//! cargo bench --bench skips
//! ```
//!
//! A field of 1e-300 in place of 0 disables the skip and changes no draw except for the lookups that cannot matter.
//! `tests/it/skips.rs`, `packets` and `verdicts` test that skips change no number.

use cpu_time::ProcessTime;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::draw::run;
use trueflight::draw::store::{Header, Store};
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;

/// Draws per experiment.
const DRAWS: u64 = 1 << 17;
/// Rounds; the median counts.
const ROUNDS: usize = 7;

/// Cases with equal answers, with and without skips.
struct Pair {
    name: &'static str,
    skipping: Vec<Case>,
    whole: Vec<Case>,
}

fn case(name: &str, text: &str) -> Case {
    let text = format!("title = \"t\"\n[problem.transmittance]\n{text}\n");
    let source = CaseText { name: name.into(), path: format!("{name}.toml").into(), text };
    Case::read(&source).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Returns a piecewise constant medium of these values on pieces of length 1, by ratio tracking.
fn layers(values: &str, nothing: &str) -> Case {
    let values = values.replace('_', nothing);
    let count = values.split(',').count();
    let breaks: Vec<String> = (0..=count).map(|i| i.to_string()).collect();
    let breaks = breaks.join(", ");
    case(
        "layers",
        &format!(
            "medium.piecewise-constant = {{ breaks = [{breaks}], values = [{values}] }}
            span = [0, {count}]
            estimators = [{{ ratio.sampling.constant.value = 1.5 }}]"
        ),
    )
}

fn residual(control: &str) -> Case {
    case(
        "residual",
        &format!(
            "medium.constant.extinction = 0.8
            span = [0, 5]
            estimators = [{{ double = {{ control.constant.value = {control}, \
             sampling.constant.value = 2 }} }}]"
        ),
    )
}

fn eq21(name: &str, estimators: &str) -> Case {
    case(
        name,
        &format!(
            "volume.eq21 = {{}}
            ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }}
            sampling.constant.value = 1
            estimators = [{estimators}]"
        ),
    )
}

fn main() {
    let both = "{ ratio = {} }, { double = {} }";
    let pairs = [
        Pair {
            name: "a ray clipped to where the field is (1 of 4)",
            skipping: vec![layers("_, 1, _, _", "0")],
            whole: vec![layers("_, 1, _, _", "1e-300")],
        },
        Pair {
            name: "a gap flown over (2 of 4)",
            skipping: vec![layers("0.7, _, _, 1.3", "0")],
            whole: vec![layers("0.7, _, _, 1.3", "1e-300")],
        },
        Pair {
            name: "a residual of 0",
            skipping: vec![residual("0.8")],
            whole: vec![residual("0.8000000000000002")],
        },
        Pair {
            name: "ratio and double are the same",
            skipping: vec![eq21("both", both)],
            whole: vec![eq21("ratio", "{ ratio = {} }"), eq21("double", "{ double = {} }")],
        },
    ];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(|| {
        println!("{:<46} {:>9} {:>9} {:>8}", "", "ns, with", "without", "ratio");
        for pair in &pairs {
            let plans = [&pair.skipping, &pair.whole].map(|cases| plan(cases));
            report(pair.name, || plans.each_ref().map(|plan| time(plan, &Store::default())));
        }
        let cases = [eq21("kept", both)];
        let plan = plan(&cases);
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("draws.bin");
        let mut kept = Store::new(Header::new(&plan, "this program", &[], None));
        kept.finish(&path, &run::draw(&plan, &|_| {})).expect("written");
        kept.reuse(&path, false).expect("it can be read");
        report("an experiment drawn by an earlier run", || {
            [time(&plan, &kept), time(&plan, &Store::default())]
        });
    });
}

fn plan(cases: &[Case]) -> Plan<'_> {
    Plan::new(cases, &Options { draws: Amount::Exactly(DRAWS), fixed: true, ..Options::default() })
}

/// Returns the processor seconds of the drawing.
fn time(plan: &Plan, kept: &Store) -> f64 {
    let begin = ProcessTime::now();
    std::hint::black_box(run::draw_with(plan, kept, &|_| {}));
    begin.elapsed().as_secs_f64()
}

fn report(name: &str, mut round: impl FnMut() -> [f64; 2]) {
    let rounds: Vec<[f64; 2]> = (0..ROUNDS).map(|_| round()).collect();
    let median = |value: fn(&[f64; 2]) -> f64| {
        let mut values: Vec<f64> = rounds.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        values[ROUNDS / 2]
    };
    let [with, without] =
        [median(|round| round[0]), median(|round| round[1])].map(|s| 1e9 * s / DRAWS as f64);
    let ratio = median(|round| round[1] / round[0]);
    println!("{name:<46} {with:>9.2} {without:>9.2} {ratio:>8.1}");
}
