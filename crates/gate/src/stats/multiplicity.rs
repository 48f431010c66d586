//! Many hypotheses at once: by p-values, by e-values, and e-values joined.
//!
//! ```text
//! Holm         reject p₍₁₎ … p₍ₖ₎ while p₍ᵢ₎ ≤ α/(K + 1 − i)
//! e-Bonferroni reject where e ≥ K/α        (`gate::ln_fail`)
//! e-BH         list the k largest, k = max{i : e₍ᵢ₎ ≥ K/(iα)}
//! mean         (1/K) Σ e, itself an e-value of the intersection
//! ```
//!
//! Sources: S. Holm, *A simple sequentially rejective multiple test procedure*, Scandinavian Journal
//! of Statistics 6 (1979), 65–70; R. Wang, A. Ramdas, *False discovery rate control with e-values*,
//! JRSS B 84 (2022), 822–852; V. Vovk, R. Wang, *E-values: calibration, combination and
//! applications*, Annals of Statistics 49 (2021), 1736–1754. All hold under any dependence.
//!
//! E-values are given by their logarithms, −∞ and ∞ included. NaN is no evidence: a NaN among the p-values counts
//! as 1, among the e-values as 0, and either still counts in `K`.

use super::capital::ln_mean_exp;
use super::gate::ln_fail;

/// Returns for each hypothesis whether Holm's procedure rejects it at family-wise level `alpha`, out of `hypotheses` in
/// all. A hypothesis without a p-value is never rejected.
pub fn holm(p: &[Option<f64>], hypotheses: usize, alpha: f64) -> Vec<bool> {
    let known = p.iter().flatten().count();
    let hypotheses = hypotheses.max(known);
    let size = |p: &Option<f64>| p.map_or(f64::INFINITY, |p| if p.is_nan() { 1.0 } else { p });
    let sizes: Vec<f64> = p.iter().map(size).collect();
    let mut rejected = vec![false; p.len()];
    for (rank, index) in order(&sizes).into_iter().take(known).enumerate() {
        if sizes[index] > alpha / (hypotheses - rank) as f64 {
            break;
        }
        rejected[index] = true;
    }
    rejected
}

/// The indices on the e-BH list at false discovery rate `alpha`, largest e-value first, ties by
/// index.
pub fn e_benjamini_hochberg(ln_e: &[f64], alpha: f64) -> Vec<usize> {
    let mut order = order(&ln_e.iter().map(|&ln_e| -evidence(ln_e)).collect::<Vec<_>>());
    let all = ln_fail(alpha, ln_e.len());
    let listed = |k: usize| evidence(ln_e[order[k - 1]]) >= all - (k as f64).ln();
    let longest = (1..=order.len()).rev().find(|&k| listed(k)).unwrap_or(0);
    order.truncate(longest);
    order
}

/// `ln((1/K) Σ e)`; 0, no evidence, without e-values.
pub fn mean_e_value(ln_e: &[f64]) -> f64 {
    let ln_e: Vec<f64> = ln_e.iter().copied().map(evidence).collect();
    if ln_e.is_empty() { 0.0 } else { ln_mean_exp(&ln_e) }
}

fn evidence(ln_e: f64) -> f64 {
    if ln_e.is_nan() { f64::NEG_INFINITY } else { ln_e }
}

/// Indices of values, the smallest first, ties by index.
fn order(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: f64 = f64::NEG_INFINITY;

    #[test]
    fn holm_steps_down_and_stops() {
        // Thresholds .0125, .0167, .025, .05: the third fails, so the fourth is never compared.
        let holm = |p: &[f64], hypotheses, alpha| {
            holm(&p.iter().copied().map(Some).collect::<Vec<_>>(), hypotheses, alpha)
        };
        assert_eq!(holm(&[0.03, 0.005, 0.04, 0.013], 4, 0.05), [false, true, false, true]);
        // The same p-values among eight: .00625, .00714.
        assert_eq!(holm(&[0.03, 0.005, 0.007, 0.013], 8, 0.05), [false, true, true, false]);
        // One at exactly its threshold is rejected.
        assert_eq!(holm(&[0.05, 0.025], 2, 0.05), [true, true]);
        assert_eq!(holm(&[], 0, 0.05), [false; 0]);
        assert_eq!(holm(&[f64::NAN, 0.02], 2, 0.05), [false, true]);
        assert_eq!(super::holm(&[None, Some(0.04), None], 1, 0.05), [false, true, false]);
    }

    #[test]
    fn e_bh_lists_the_longest_run() {
        // K/α = 40 for the largest, 20, 13.3, 10: the second alone would suffice with the first.
        let ln_e = [1.0, 21.0, 25.0, 0.1].map(f64::ln);
        assert_eq!(e_benjamini_hochberg(&ln_e, 0.1), [2, 1]);
        assert_eq!(e_benjamini_hochberg(&[1.0, 19.0, 25.0, 0.1].map(f64::ln), 0.1), [0; 0]);
        assert_eq!(e_benjamini_hochberg(&[f64::NAN, NONE, f64::INFINITY], 0.1), [2]);
        assert_eq!(e_benjamini_hochberg(&[], 0.1), [0; 0]);
    }

    #[test]
    fn thresholds_and_means() {
        assert!((ln_fail(1e-3, 57) - 57_000.0f64.ln()).abs() < 1e-12);
        let mean = mean_e_value(&[2000.0, 2000.0 + 3.0f64.ln()]);
        assert!((mean - 2000.0 - 2.0f64.ln()).abs() < 1e-12);
        assert!((mean_e_value(&[NONE, f64::NAN, 6.0f64.ln()]) - 2.0f64.ln()).abs() < 1e-15);
        assert_eq!(mean_e_value(&[NONE, NONE]), NONE);
        assert_eq!(mean_e_value(&[1.0, f64::INFINITY]), f64::INFINITY);
        assert_eq!(mean_e_value(&[]), 0.0);
    }
}
