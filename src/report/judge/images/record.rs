//! `judgement.json`: the judgement of a stack of images, for machines.

use crate::judge::images::Judgement;
use crate::judge::images::judgement::{Comparison, Estimate, Refuted, Tile, Variance};
use crate::report::ReportError;
use crate::report::fields::{Cell, table, tree};

/// Returns the judgement as a JSON object.
pub fn json(judgement: &Judgement) -> Result<String, ReportError> {
    tree(&judgement)
}

fn refuted<T>(of: &Judgement, field: fn(&Refuted) -> T) -> Option<T> {
    of.refuted_by.as_ref().map(field)
}

fn variance<T>(of: &Judgement, field: fn(&Variance) -> T) -> Option<T> {
    of.variance.as_ref().map(field)
}

fn estimate<T>(of: &Judgement, field: fn(&Estimate) -> T) -> Option<T> {
    of.estimate.as_ref().map(field)
}

fn comparison<T>(of: &Judgement, field: fn(&Comparison) -> T) -> Option<T> {
    of.comparison.as_ref().map(field)
}

fn tiles(tiles: &[Tile]) -> Cell {
    Cell::rows(&tiles.iter().collect::<Vec<_>>())
}

table! {
    impl<'a> for &'a Judgement {
        "verdict": "Result: pass, fail or inconclusive" = |of| of.verdict.word();
        "reason": "Reason of the verdict; empty for a plain pass" = |of| &of.reason;
        "guarantees": "Promises of the verdict, and their assumptions" = |of| &of.guarantees;
        "alpha": "Probability that correct passes fail" = |of| of.alpha;
        "beta": "Probability that a tile, or the whole, passes although it is off by its tolerance" = |of| of.beta;
        "listed_rate": "Bound on the expected share of false entries on the list of suspects" = |of| of.listed_rate;
        "passes": "Number of passes" = |of| of.passes;
        "size.rows": "Height of a pass in pixels" = |of| of.size.rows;
        "size.columns": "Width of a pass in pixels" = |of| of.size.columns;
        "size.channels": "Number of values of a pixel" = |of| of.size.channels;
        "tile": "Rows and columns of the smallest tiles" = |of| of.tile;
        "refuted_by.pass": "Pass of the first value that refutes the claim by itself; this and all places count from 0" = |of| refuted(of, |value| value.pass);
        "refuted_by.row": "Its row" = |of| refuted(of, |value| value.row);
        "refuted_by.column": "Its column" = |of| refuted(of, |value| value.column);
        "refuted_by.channel": "Its channel" = |of| refuted(of, |value| value.channel);
        "refuted_by.value": "The value" = |of| refuted(of, |value| value.value);
        "refuting": "Number of such values" = |of| of.refuting;
        "order.reason": "Dependence of the passes on each other; empty if none was found" = |of| &of.order.reason;
        "order.evidence": "ln 1/p against independent passes" = |of| of.order.evidence;
        "order.limit": "Limit of that evidence" = |of| of.order.limit;
        "order.correlation": "Strongest correlation of passes" = |of| of.order.correlation;
        "order.lag": "Number of passes between them" = |of| of.order.lag;
        "order.is_tested": "Whether the passes suffice for the test" = |of| Some(of.order.is_tested);
        "neighbours.reason": "Dependence of the pixels of a pass on each other; empty if none was found" = |of| &of.neighbours.reason;
        "neighbours.evidence": "ln E against independent pixels" = |of| of.neighbours.evidence;
        "neighbours.limit": "Limit of that evidence" = |of| of.neighbours.limit;
        "neighbours.correlation": "Correlation of adjacent pixels" = |of| of.neighbours.correlation;
        "neighbours.is_tested": "Whether there are pixels to test" = |of| Some(of.neighbours.is_tested);
        "repeated": "Passes that share values" = |of| &of.repeated;
        "variance.about_truth": "Mean of (x − truth)²/V over all pixels" = |of| variance(of, |found| found.about_truth);
        "variance.about_mean": "Mean of s²/V" = |of| variance(of, |found| found.about_mean);
        "variance.margin": "Largest mean of s²/V with which a picture passes" = |of| variance(of, |found| found.margin);
        "variance.ln_e": "Evidence against a variance of at most V" = |of| variance(of, |found| found.ln_e);
        "variance.limit": "Limit of that evidence" = |of| variance(of, |found| found.limit);
        "variance.is_refuted": "Whether the variance is refuted" = |of| variance(of, |found| found.is_refuted);
        "estimate.passes": "Number of passes that the variance was estimated from" = |of| estimate(of, |found| found.passes);
        "estimate.kurtosis": "Kurtosis of the smallest tiles that the evidence relies on" = |of| estimate(of, |found| found.kurtosis);
        "estimate.is_given": "Whether the kurtosis was given" = |of| estimate(of, |found| found.is_given);
        "estimate.negative": "Number of negative variances, which count as 0" = |of| estimate(of, |found| found.negative);
        "estimate.unknown": "Number of variances that are no numbers: their values are not judged" = |of| estimate(of, |found| found.unknown);
        "estimate.first_row": "Row of the first of either" = |of| of.estimate.and_then(|found| Some(found.first?[0]));
        "estimate.first_column": "Its column" = |of| of.estimate.and_then(|found| Some(found.first?[1]));
        "estimate.first_channel": "Its channel" = |of| of.estimate.and_then(|found| Some(found.first?[2]));
        "truth_passes": "Number of passes that the truth is the mean of; null for an exact truth" = |of| of.truth_passes;
        "comparison.passes": "Number of passes of the reference" = |of| comparison(of, |found| found.passes);
        "comparison.method": "Test of equal distributions: permutation, signs or none" = |of| comparison(of, |found| found.method.word());
        "comparison.permutations": "Number of random permutations" = |of| comparison(of, |found| found.permutations);
        "comparison.p": "Smallest p-value of all tiles and the whole together, for equal distributions" = |of| comparison(of, |found| found.p);
        "comparison.is_same_distribution": "Whether equal distributions are claimed" = |of| comparison(of, |found| found.is_same_distribution);
        "comparison.spread": "Variance over that of the reference" = |of| of.comparison.as_ref().and_then(|found| found.spread);
        "comparison.spread_p": "p-value of that ratio for equal distributions" = |of| comparison(of, |found| found.spread_p);
        "comparison.kurtosis": "Largest kurtosis of the smallest tiles, as measured" = |of| of.comparison.as_ref().and_then(|found| found.kurtosis);
        "whole": "Whole picture, an entry per channel, with the columns of `tiles.csv`" = |of| tiles(&of.whole);
        "counts.tiles": "Number of all tiles, in each channel" = |of| of.counts.tiles;
        "counts.pass": "Number that pass" = |of| of.counts.pass;
        "counts.fail": "Number that fail, by Holm" = |of| of.counts.fail;
        "counts.listed": "Number on the list of suspects, by e-BH" = |of| of.counts.listed;
        "worst": "Tiles with the most evidence against them, with the columns of `tiles.csv`" = |of| tiles(&of.worst);
    }
}
