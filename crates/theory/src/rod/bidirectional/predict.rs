//! Prediction for a draw: of each technique, and of their sum.

use super::grid::NodeGrid;
use super::lookups::{Walks, of_technique};
use super::{Combination, Connection, DrawRules, NOTHING, RodScene, powers};
use crate::prediction::raw::{Powers, Raw, RawMoments, added};
use crate::prediction::{Covariance, UNRESOLVED};
use crate::{Channel, CountDistribution, Moments, Prediction, Tails};
use numeric::Known;

/// Relative rounding error of sums over grids.
const ROUNDING: f64 = 2e-14;

/// Nodes, and the step of the integral over ln z, of two resolutions.
fn resolutions(depth: f64) -> [[f64; 2]; 2] {
    let nodes = (20.0 + 3.0 * depth).ceil();
    [[nodes, 0.3], [nodes + 8.0, 0.25]]
}

/// Prediction for a draw. The number of lookups is known where `σ_t/σ̂` has one value, `ratio`. Without `with_distributions`, as
/// for lines in plots, only values are valid, and no error is computed.
pub fn predict(
    scene: &RodScene,
    rules: &DrawRules,
    ratio: Option<f64>,
    with_distributions: bool,
) -> Prediction {
    let [coarse, fine] = resolutions(scene.depth.value);
    let result = powers(scene, rules, fine);
    let rough = if with_distributions { powers(scene, rules, coarse) } else { result.clone() };
    let names = names(scene, rules);
    let is_certain = |&(order, s, _): &(usize, usize, _)| {
        order == 0 && s == 1 && rules.connection == Connection::Exact
    };
    let certain: Vec<bool> = names.iter().map(is_certain).collect();
    let each = result.iter().zip(&rough).zip(names).zip(&certain);
    let mut channels: Vec<Channel> = each
        .map(|(((result, rough), (order, _, name)), &is_certain)| {
            let channel = channel(scene.depth, order, [result, rough], is_certain);
            Channel { name, ..channel }
        })
        .collect();
    let mut covariances = Vec::new();
    if channels.len() > 1 {
        let variances: Vec<f64> = channels.iter().map(variance).collect();
        // Independent paths: neighbouring channels are uncorrelated.
        let neighbours = if rules.is_shared { 0 } else { channels.len() };
        covariances.extend((1..neighbours).map(|i| Covariance {
            pair: [i - 1, i],
            value: 0.0,
            variance: variances[i - 1] * variances[i],
        }));
        let whole = [&result, &rough].map(|all| all.iter().copied().fold(NOTHING, added));
        let order = *scene.orders.end();
        let is_certain = certain.iter().all(|&is_certain| is_certain);
        let sum = channel(scene.depth, order, [&whole[0], &whole[1]], is_certain);
        let last = channels.len() - 1;
        // (X − C)(Σ − T) = Y(Y + Z) with independent Y and Z of mean 0.
        if let Some(moments) = channels[last].moments.filter(|_| !rules.is_shared) {
            let square = variances[last] * variances[last];
            let fourth = moments.relative[2] * moments.scale.powi(4);
            let others = variance(&sum) - variances[last];
            let variance = fourth - square + variances[last] * others;
            let value = variances[last];
            covariances.push(Covariance { pair: [last, last + 1], value, variance });
        }
        let moments = sum.moments.filter(|_| !rules.is_shared);
        let variance_bound = rules.is_shared.then(|| most_of_sum([&result, &rough]));
        channels.push(Channel { name: "sum".into(), moments, variance_bound, ..sum });
    }
    if !rules.has_shares && channels.len() > 1 {
        channels.drain(..channels.len() - 1);
        channels[0].name.clear();
        covariances.clear();
    }
    // Channels of shared subpaths and of the connections between them are correlated.
    let is_known = !rules.is_shared || rules.connection == Connection::Exact;
    let lookups = ratio.filter(|_| is_known).map(|ratio| lookups(scene, rules, ratio));
    Prediction { channels, lookups, covariances, ..Prediction::default() }
}

/// Order, light vertices and name of each technique that is drawn.
fn names(scene: &RodScene, rules: &DrawRules) -> Vec<(usize, usize, String)> {
    let orders = scene.orders.clone();
    let is_single = orders.start() == orders.end();
    let is_combined = !matches!(rules.combination, Combination::Technique(_));
    let name = |order: usize, s: usize| match (is_single, is_combined) {
        (true, true) => format!("s = {s}"),
        (false, true) => format!("r = {order}, s = {s}"),
        (false, false) => format!("r = {order}"),
        (true, false) => String::new(),
    };
    let of = |order| {
        let techniques = rules.combination.techniques(order);
        techniques.map(move |s| (order, s, name(order, s)))
    };
    orders.flat_map(of).collect()
}

/// Bound on the variance of a sum of draws with unknown correlations: its standard deviation is at most the sum of
/// theirs.
fn most_of_sum(resolutions: [&Vec<Powers>; 2]) -> f64 {
    let deviation = |powers: &Powers| (powers[2] - powers[1] * powers[1]).max(0.0).sqrt();
    let [fine, rough] = resolutions.map(|powers| powers.iter().map(deviation).sum::<f64>());
    (fine + (fine - rough).abs()).powi(2)
}

fn variance(channel: &Channel) -> f64 {
    channel.moments.map_or(f64::NAN, |moments| moments.variance())
}

/// Prediction for one channel, from its raw moments at two resolutions.
fn channel(depth: Known, order: usize, [fine, rough]: [&Powers; 2], is_certain: bool) -> Channel {
    let mean = fine[1];
    // d ln C/dτ is between −(r + 3) and r/τ.
    let by_depth =
        depth.error * (order as f64 + 3.0) * (1.0 + 1.0 / depth.value.max(f64::MIN_POSITIVE));
    let by_depth = if depth.error > 0.0 { by_depth } else { 0.0 };
    let error = (mean - rough[1]).abs() + mean * (ROUNDING + by_depth);
    let truth = Known::estimated(mean, error);
    if is_certain || fine[2] / mean.powi(2) == 1.0 {
        return Channel::unbiased(truth, Moments::certain(mean), Tails::LIGHT);
    }
    let relative_error = ROUNDING + 4.0 * by_depth;
    let raw = |&[_, a, b, c, d, .., eighth]: &Powers| {
        RawMoments([a, b, c, d, eighth].map(|x| Known::estimated(x, relative_error * x.abs())))
    };
    // Each resolution in units of its own mean: an error of all powers alike moves no relative moment.
    let central =
        |powers: &Powers| raw(powers).central(Known::estimated(powers[1], 0.0), UNRESOLVED);
    let moments = central(fine).compared(&central(rough)).in_units_of(truth);
    Channel::unbiased(truth, moments, raw(fine).tails(UNRESOLVED))
}

/// Distribution of the lookups of all techniques together.
fn lookups(scene: &RodScene, rules: &DrawRules, ratio: f64) -> CountDistribution {
    let of = |[nodes, _]: [f64; 2]| -> Raw {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a small whole number
        let grid = NodeGrid::new(scene.depth.value, nodes as usize);
        let walks = Walks::new(scene, rules.connection, ratio, &grid);
        let paths = scene
            .orders
            .clone()
            .flat_map(|order| rules.combination.techniques(order).map(move |s| (order, s)));
        if rules.is_shared {
            let order = *scene.orders.end();
            let walk = of_technique(&walks, order, 0);
            return added(walk, walk);
        }
        paths.fold([1.0, 0.0, 0.0, 0.0, 0.0], |sum, (order, s)| {
            added(sum, of_technique(&walks, order, s))
        })
    };
    let [coarse, fine] = resolutions(scene.depth.value).map(of);
    let error = if fine[1] > 0.0 { ((fine[1] - coarse[1]) / fine[1]).abs() } else { 0.0 };
    CountDistribution::of_raw(0.0, fine, error)
}
