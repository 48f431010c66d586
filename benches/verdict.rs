//! Number of draws until a pass: the built-in suite, judged with many seeds.
//!
//! ```text
//! cargo bench --bench verdict              # 24 seeds, about 10 minutes on two cores
//! cargo bench --bench verdict -- 4         # so many seeds
//! ```
//!
//! A scalar of relative variance V and tolerance ε typically passes after 17 V/ε² draws. Each case's figure is the
//! number of draws of all its scalars in units of that, as `trueflight run` shows it for one seed. One seed of a case
//! with few scalars is little evidence: they pass early or late together.

use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::draw::run;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::plan::options::DRAWS;
use trueflight::record::build;

fn main() {
    let wished = std::env::args().skip(1).find_map(|word| word.parse().ok());
    let seeds: u64 = wished.unwrap_or(24);
    let cases: Vec<Case> = suite::suite()
        .iter()
        .map(|source| Case::read(source).expect("the built-in cases have no mistakes"))
        .collect();
    let options = Options { draws: Amount::CaseOr(DRAWS), ..Options::default() };
    let mut plan = Plan::new(&cases, &options);
    let mut paces: Vec<(String, Vec<f64>)> = Vec::new();
    for seed in 1..=seeds {
        plan.reseed(seed);
        let draws = run::draw(&plan, &|_| {});
        let record = build::judged(&plan, &draws, 0.0);
        for case in &record.results.cases {
            let Some(pace) = case.pace else { continue };
            match paces.iter_mut().find(|(name, _)| *name == case.name) {
                Some((_, paces)) => paces.push(pace),
                None => paces.push((case.name.clone(), vec![pace])),
            }
        }
    }
    println!("case,seeds,mean,standard_error,least,most");
    for (name, mut paces) in paces {
        paces.sort_by(f64::total_cmp);
        let n = paces.len() as f64;
        let mean = paces.iter().sum::<f64>() / n;
        let spread = paces.iter().map(|pace| (pace - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let (minimum, maximum) = (paces[0], paces[paces.len() - 1]);
        println!("{name},{n},{mean:.3},{:.3},{minimum:.3},{maximum:.3}", (spread / n).sqrt());
    }
}
