//! Multiple importance sampling with delta tracking through a medium that is constant in each cell.

use super::{RARE, Spectrum};

/// Maximum number of atoms of the distribution of MIS with delta tracking.
const MAX_ATOMS: usize = 300_000;
/// Maximum difference of extinctions, relative to the majorant, that count as one constant.
const CONSTANT: f64 = 1e-13;

/// The largest rate times the length of a cell, and the rates relative to the largest.
pub type CellRates = (f64, Vec<f64>);

impl Spectrum {
    /// Distribution of MIS with delta tracking through a medium that is constant in each cell: scores of survivors,
    /// and their probabilities. `None` where the medium is not constant, or has too many different cells.
    ///
    /// ```text
    /// X_λ = p_λ/Σ_h w_h p_h,   P = Π_j l_j^{m_j}/m_j! Σ_h w_h p_h,   p_λ = e^{−μ̄_λ ℓ} Π_j n_{λj}^{m_j}
    /// ```
    ///
    /// Cells with proportional n are merged.
    pub(super) fn cells(&self) -> Option<Vec<(f64, Vec<f64>)>> {
        let mut cells = Vec::<CellRates>::new();
        let scale = self.majorants.iter().fold(0.0f64, |maximum, &x| maximum.max(x));
        for (panel, here) in self.mesh.numbered() {
            let of_channel = |nulls: &Vec<f64>| {
                let n = nulls[here.clone()].to_vec();
                n.iter().all(|x| (x - n[0]).abs() <= CONSTANT * scale).then_some(n[0])
            };
            let n: Vec<f64> = self.nulls.iter().map(of_channel).collect::<Option<_>>()?;
            join(&mut cells, CONSTANT * scale, panel.span.length(), &n);
        }
        let length = self.length();
        let begin: Vec<f64> = self.majorants.iter().map(|x| (-x * length).exp()).collect();
        balanced(&cells, begin, &self.hero)
    }
}

/// Merges an interval with the cells that have proportional rates. An interval with rates of at most `nothing` is
/// left out.
pub fn join(cells: &mut Vec<CellRates>, nothing: f64, length: f64, rates: &[f64]) {
    let largest = rates.iter().fold(0.0f64, |maximum, &n| maximum.max(n));
    if largest <= nothing {
        return;
    }
    let direction: Vec<f64> = rates.iter().map(|n| (n / largest).max(0.0)).collect();
    let length = length * largest;
    let like = |cell: &&mut CellRates| {
        cell.1.iter().zip(&direction).all(|(a, b)| (a - b).abs() <= CONSTANT)
    };
    match cells.iter_mut().find(like) {
        Some(cell) => cell.0 += length,
        None => cells.push((length, direction)),
    }
}

/// The probability of every combination of numbers of events in all cells, and the densities of all heroes relative
/// to their mean.
///
/// Numbers of events are left out where they add less than `RARE` to the probability and to `E[X⁴]/T⁴` of every
/// channel. A draw is at most `1/w`. With `T = e^{−μ̄ℓ + Σ l d}`, a number of events together with all numbers of
/// later events adds
///
/// ```text
/// P X⁴/T⁴ ≤ l^m/m! p e^{Σ l d}/T (wT)^{−3}
/// ```
pub fn balanced(
    cells: &[CellRates],
    begin: Vec<f64>,
    heroes: &[f64],
) -> Option<Vec<(f64, Vec<f64>)>> {
    let mean =
        |densities: &[f64]| -> f64 { heroes.iter().zip(densities).map(|(w, p)| w * p).sum() };
    // e^{Σ l d} of all cells from one on.
    let ahead = |first: usize| -> Vec<f64> {
        let events = |channel| cells[first..].iter().map(|(l, d)| l * d[channel]).sum::<f64>();
        (0..heroes.len()).map(|channel| events(channel).exp()).collect()
    };
    let truths: Vec<f64> = begin.iter().zip(ahead(0)).map(|(p, events)| p * events).collect();
    let mut paths = vec![(1.0, begin)];
    for (cell, (length, direction)) in cells.iter().enumerate() {
        let later = ahead(cell + 1);
        let counts = |measure: f64, density: &[f64]| {
            let whole: f64 = (0..heroes.len()).map(|i| heroes[i] * density[i] * later[i]).sum();
            let adds = |i: usize| {
                let rest = measure * density[i] * later[i] / truths[i];
                rest / (heroes[i] * truths[i]).powi(3)
            };
            let mut channels = (0..heroes.len()).filter(|&i| heroes[i] > 0.0);
            measure * whole > RARE || channels.any(|i| adds(i) > RARE)
        };
        // Events that are equally probable in all channels need no numbers.
        if direction.iter().all(|&d| d == 1.0) {
            for (measure, _) in &mut paths {
                *measure *= length.exp();
            }
            continue;
        }
        let mut longer = Vec::new();
        for (measure, density) in paths {
            let (mut measure, mut density, mut m) = (measure, density, 0.0);
            while counts(measure, &density) || m < *length {
                longer.push((measure, density.clone()));
                m += 1.0;
                measure *= length / m;
                density.iter_mut().zip(direction).for_each(|(p, d)| *p *= d);
                if longer.len() > MAX_ATOMS {
                    return None;
                }
            }
        }
        paths = longer;
    }
    let atom = |(measure, density): (f64, Vec<f64>)| {
        let mean = mean(&density);
        (measure * mean, density.iter().map(|p| p / mean).collect())
    };
    Some(paths.into_iter().filter(|(_, density)| mean(density) > 0.0).map(atom).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use crate::ray::spectral::Tracker;
    use media::Medium;
    use media::constant::Constant;
    use numeric::Span;
    use std::sync::Arc;

    /// `E[X^k]/T^k` for k = 2, 3, 4 by the series in 60 digits: where T = e^{−8}, paths of probability 1e-20 make a
    /// thousandth of the fourth moment.
    const EXACT: [[f64; 3]; 2] = [
        [1.683_036_899_952_253, 2.832_613_426_177_761_5, 4.767_393_649_192_376],
        [4.327_929_293_438_775, 672.336_904_305_154_2, 1_253_428.662_951_745_4],
    ];

    #[test]
    fn rare_paths_that_make_a_moment_are_counted() {
        let span = Span::new(0.0, 1.0);
        let depths: [f64; 2] = [0.01, 8.0];
        let meshes = depths.map(|extinction| {
            Mesh::new(Medium::new(Arc::new(Constant { extinction }), span, span))
        });
        let majorants = vec![0.01 * 3.0, 8.0 * 1.02];
        let tracker = Tracker::Mis { delta: true };
        let meshes: Vec<&Mesh> = meshes.iter().collect();
        let spectrum = Spectrum::new(&meshes, majorants, vec![0.6, 0.4], tracker);
        for (channel, exact) in EXACT.iter().enumerate() {
            for (power, exact) in [2, 3, 4].into_iter().zip(exact) {
                let mut k = vec![0.0; 2];
                k[channel] = f64::from(power);
                let unit = (-depths[channel] * f64::from(power)).exp();
                let result = spectrum.moment(&k).expect("cells") / unit;
                assert!((result / exact - 1.0).abs() < 1e-12, "{channel}, {power}: {result}");
            }
        }
    }
}
