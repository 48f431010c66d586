//! Every known bug is caught by the check it names, on the experiment it names, within a million
//! draws; and its honest twin, the same code without the bug, makes the estimator's own draws.

mod common;

use std::collections::BTreeSet;

use common::options;
use rayon::prelude::*;
use trueflight::estimators::{DrawBuffer, Experiment};
use trueflight::harness::mutation::{self, Walk};
use trueflight::harness::plan::BLOCK;
use trueflight::harness::plan::Planned;
use trueflight::harness::{Case, Plan, suite};
use trueflight::mutants::{self, About, StreamMutant};
use trueflight::rng::{Address, Stream};
use trueflight::theory::{Law, Prediction};

/// Draws of each mutant, in blocks.
const BLOCKS: u64 = 64;
/// A mutant is beyond this.
const CAUGHT: f64 = 7.0;
/// Right draws are below this.
const QUIET: f64 = 5.5;

/// The cases that mutants stand on.
fn cases() -> Vec<Case> {
    let named: BTreeSet<&str> = mutants::all().iter().map(|m| m.target.case).collect();
    let source =
        |name: &&str| suite::find(name).unwrap_or_else(|| panic!("{name} is not built in"));
    named.iter().map(|name| Case::read(&source(name)).expect("a case")).collect()
}

/// Sums over the draws of one experiment, as each check wants them.
struct Sums<'a> {
    prediction: &'a Prediction,
    draws: f64,
    value: Vec<[f64; 2]>,
    products: Vec<f64>,
    lookups: f64,
    bins: Vec<f64>,
    defect: f64,
    ties: f64,
    beyond_f32: f64,
}

impl<'a> Sums<'a> {
    fn of(prediction: &'a Prediction, experiment: &dyn Experiment, address: Address) -> Self {
        let bins = match &prediction.law {
            Some(Law::Distances { bins, .. }) => bins.len() + 2,
            _ => 0,
        };
        let mut sums = Self {
            prediction,
            draws: 0.0,
            value: vec![[0.0; 2]; prediction.channels.len()],
            products: vec![0.0; prediction.covariances.len()],
            lookups: 0.0,
            bins: vec![0.0; bins],
            defect: 0.0,
            ties: 0.0,
            beyond_f32: 0.0,
        };
        let mut buffer = DrawBuffer::new(prediction.channels.len());
        for block in 0..BLOCKS {
            let mut rng = Address { block, ..address }.stream();
            let mut distances = Vec::new();
            for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
                experiment.fill(&mut rng, DrawBuffer::LENGTH, &mut buffer);
                sums.add(&buffer, &mut distances);
            }
            distances.sort_by(f64::total_cmp);
            sums.ties += distances.windows(2).filter(|pair| pair[0] == pair[1]).count() as f64;
        }
        sums
    }

    fn add(&mut self, buffer: &DrawBuffer, distances: &mut Vec<f64>) {
        self.draws += buffer.lookups.len() as f64;
        self.lookups += buffer.lookups.iter().map(|&n| f64::from(n)).sum::<f64>();
        self.defect = buffer.defects.iter().copied().fold(self.defect, f64::max);
        let away = |channel: usize, i: usize| {
            buffer.values[channel][i] - self.prediction.channels[channel].mean.value
        };
        for i in 0..buffer.lookups.len() {
            for (channel, sums) in self.value.iter_mut().enumerate() {
                sums[0] += away(channel, i);
                sums[1] += away(channel, i).powi(2);
            }
            for (sum, covariance) in self.products.iter_mut().zip(&self.prediction.covariances) {
                *sum += away(covariance.pair[0], i) * away(covariance.pair[1], i);
            }
        }
        let Some(Law::Distances { bins, end, .. }) = &self.prediction.law else { return };
        for &s in &buffer.values[0] {
            let inside = bins.partition_point(|&bin| bin <= s);
            self.bins[if s >= *end { bins.len() + 1 } else { inside }] += 1.0;
        }
        let inner = buffer.values[0].iter().copied().filter(|s| s < end);
        #[allow(clippy::cast_possible_truncation)] // the question
        let representable = |s: &f64| f64::from(*s as f32) == *s;
        self.beyond_f32 += inner.clone().filter(|s| !representable(s)).count() as f64;
        distances.extend(inner);
    }

    fn mean(&self) -> f64 {
        let z = self.value.iter().zip(&self.prediction.channels).map(|(sums, channel)| {
            let variance = channel.moments.expect("moments").variance();
            sums[0].abs() / (self.draws * variance).sqrt()
        });
        z.fold(0.0, f64::max)
    }

    fn variance(&self) -> f64 {
        let z = self.value.iter().zip(&self.prediction.channels).map(|(sums, channel)| {
            let moments = channel.moments.expect("moments");
            let spread = (moments.kurtosis().expect("a kurtosis") - 1.0).sqrt();
            let difference = sums[1] / self.draws / moments.variance() - 1.0;
            difference.abs() * self.draws.sqrt() / spread
        });
        z.fold(0.0, f64::max)
    }

    fn lookups(&self) -> f64 {
        let law = self.prediction.lookups.as_ref().expect("a law of the lookups");
        (self.lookups - self.draws * law.mean).abs() / (self.draws * law.variance).sqrt()
    }

    /// Fisher's root of χ².
    fn distances(&self) -> f64 {
        let Some(Law::Distances { bins, escape, .. }) = &self.prediction.law else { return 0.0 };
        let share = (1.0 - escape) / (bins.len() + 1) as f64;
        let mut expected = vec![share * self.draws; bins.len() + 1];
        expected.push(escape * self.draws);
        let terms = self.bins.iter().zip(&expected).map(|(n, e)| (n - e).powi(2) / e);
        (2.0 * terms.sum::<f64>()).sqrt() - (2.0 * expected.len() as f64 - 3.0).sqrt()
    }

    fn covariance(&self) -> f64 {
        let sums = self.products.iter().zip(&self.prediction.covariances);
        let z = sums.map(|(sum, covariance)| {
            let difference = sum - self.draws * covariance.value;
            difference.abs() / (self.draws * covariance.variance).sqrt()
        });
        z.fold(0.0, f64::max)
    }

    /// How loudly a check speaks: standard errors, or what is counted in their place.
    fn loudness(&self, check: &str) -> f64 {
        match check {
            "mean" => self.mean(),
            "variance" => self.variance(),
            "lookups" => self.lookups(),
            "distances" | "depth" => self.distances(),
            "covariance" => self.covariance(),
            "invariant" => self.defect / 1e-12,
            "resolution" => self.ties + if self.beyond_f32 == 0.0 { 1e6 } else { 0.0 },
            _ => panic!("no check is called {check}"),
        }
    }
}

/// The first draws of an experiment, bit by bit.
fn first_draws(experiment: &dyn Experiment, channels: usize, address: Address) -> Vec<u64> {
    let mut buffer = DrawBuffer::new(channels);
    experiment.fill(&mut address.stream(), DrawBuffer::LENGTH, &mut buffer);
    let values = buffer.values.iter().flatten().chain(&buffer.defects).map(|x| x.to_bits());
    values.chain(buffer.lookups.iter().map(|&n| u64::from(n))).collect()
}

/// What is wrong with one mutant; prints a line of the table.
fn faults(about: &About, plan: &Plan) -> Vec<String> {
    let name = about.name;
    let Some((case, planned)) = mutation::find(&about.target, plan) else {
        return vec![format!("{name}: no such experiment")];
    };
    let mut faults = Vec::new();
    if planned.names.estimator != about.target.estimator {
        faults.push(format!("{name}: `{}` is called otherwise", planned.names.estimator));
    }
    let Planned { outcome: Ok(ready), address, .. } = planned else {
        return vec![format!("{name}: refused")];
    };
    let walk = |walk| {
        mutation::experiment(about, walk, case, planned, plan.options.seed)
            .expect("a mutant of this problem")
            .unwrap_or_else(|refusal| panic!("{name}: {refusal}"))
    };
    let (faulty, twin) = (walk(Walk::Faulty), walk(Walk::Twin));
    let channels = ready.prediction.channels.len();
    let first = |experiment: &dyn Experiment| first_draws(experiment, channels, *address);
    if first(&*twin) != first(&*ready.experiment) {
        faults.push(format!("{name}: the twin's draws are not the estimator's"));
    }
    if first(&*faulty) == first(&*twin) {
        faults.push(format!("{name}: the bug changes nothing"));
    }
    let sums = |experiment: &dyn Experiment| Sums::of(&ready.prediction, experiment, *address);
    let (faulty, twin) = (sums(&*faulty), sums(&*twin));
    let (loud, quiet) = (faulty.loudness(about.check), twin.loudness(about.check));
    let needed = faulty.draws * (CAUGHT / loud).powi(2);
    let others: Vec<String> = ["mean", "variance", "lookups", "distances", "covariance"]
        .into_iter()
        .map(|check| (check, faulty.loudness(check)))
        .filter(|&(check, z)| check != about.check && z > 5.0)
        .map(|(check, z)| format!("{check} {z:.0}"))
        .collect();
    println!(
        "{name:38} {:28} {:32} {:10} {loud:9.1} {quiet:5.2} {needed:8.0} | {} | {:.0e}",
        about.target.case,
        about.target.estimator,
        about.check,
        others.join(", "),
        faulty.defect,
    );
    // A NaN is loud.
    if loud < CAUGHT {
        faults.push(format!("{name}: {} says {loud:.1} only", about.check));
    }
    if quiet.is_nan() || quiet > QUIET {
        faults.push(format!("{name}: the twin fails its {} at {quiet:.1}", about.check));
    }
    faults
}

#[test]
fn every_mutant_is_caught_and_its_twin_is_not() {
    let cases = cases();
    let plan = Plan::new(&cases, &options(1, BLOCKS * BLOCK));
    let all = mutants::all();
    let wrong: Vec<String> = all.par_iter().flat_map(|about| faults(about, &plan)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// z-scores of the blocks' means.
fn blocks(planned: &Planned, stream: impl Fn(Address) -> Stream + Sync) -> Vec<f64> {
    let ready = planned.outcome.as_ref().expect("an experiment");
    let channel = &ready.prediction.channels[0];
    let deviation = channel.moments.expect("moments").variance().sqrt();
    let draw = |block: u64| {
        let mut rng = stream(Address { block, ..planned.address });
        let mut buffer = DrawBuffer::new(1);
        let mut sum = 0.0;
        for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
            ready.experiment.fill(&mut rng, DrawBuffer::LENGTH, &mut buffer);
            sum += buffer.values[0].iter().map(|x| x - channel.mean.value).sum::<f64>();
        }
        sum / (deviation * (BLOCK as f64).sqrt())
    };
    (0..256).into_par_iter().map(draw).collect()
}

/// Blocks with the very same mean, and the correlation of blocks 1 to 8 apart.
fn loudness(z: &[f64]) -> [f64; 2] {
    let mut sorted = z.to_vec();
    sorted.sort_by(f64::total_cmp);
    // The draws are continuous: two means never agree by chance.
    let same = sorted.windows(2).filter(|pair| pair[0] == pair[1]).count() as f64;
    let power = z.iter().map(|x| x * x).sum::<f64>();
    let lagged = |lag: usize| {
        let sum: f64 = z.iter().zip(&z[lag..]).map(|(a, b)| a * b).sum();
        (sum / power).abs() * (z.len() as f64).sqrt()
    };
    [same, (1..=8).map(lagged).fold(0.0, f64::max)]
}

#[test]
fn every_wrong_stream_is_caught() {
    let cases = cases();
    let plan = Plan::new(&cases, &options(1, BLOCK));
    let (_, planned) = mutation::find(&mutants::target::LINEAR, &plan).expect("an experiment");
    let [same, lagged] = loudness(&blocks(planned, Address::stream));
    assert!(same == 0.0 && lagged < QUIET, "right streams: {same}, {lagged}");
    for StreamMutant { name, stream, .. } in mutants::streams::MUTANTS {
        let [same, lagged] = loudness(&blocks(planned, stream));
        println!("{name:20} {same} equal blocks, correlation {lagged:.1}");
        assert!(same > CAUGHT || lagged > CAUGHT, "{name}: {same}, {lagged}");
    }
}
