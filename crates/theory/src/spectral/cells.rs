//! Multiple importance sampling with delta tracking through a medium that is constant in each cell.

use super::{RARE, Spectrum};

/// The most atoms of the law of MIS with delta tracking.
const MOST_ATOMS: usize = 300_000;
/// Extinctions that differ by less are one constant, relative to the majorant.
const CONSTANT: f64 = 1e-13;

/// The largest rate times the length of a cell, and the rates relative to the largest.
pub type Cell = (f64, Vec<f64>);

impl Spectrum {
    /// The law of MIS with delta tracking through a medium that is constant in each cell: what survivors
    /// score, with which probability. `None` where the medium is not, or has too many different cells.
    ///
    /// ```text
    /// X_λ = p_λ/Σ_h w_h p_h,   P = Π_j l_j^{m_j}/m_j! Σ_h w_h p_h,   p_λ = e^{−μ̄_λ ℓ} Π_j n_{λj}^{m_j}
    /// ```
    ///
    /// Cells whose n are in proportion are one.
    pub(super) fn cells(&self) -> Option<Vec<(f64, Vec<f64>)>> {
        let (mut cells, mut node) = (Vec::<Cell>::new(), 0);
        let scale = self.majorants.iter().fold(0.0f64, |most, &x| most.max(x));
        for panel in self.mesh.panels() {
            let here = node..node + panel.t.len();
            node = here.end;
            let of_channel = |nulls: &Vec<f64>| {
                let n = nulls[here.clone()].to_vec();
                n.iter().all(|x| (x - n[0]).abs() <= CONSTANT * scale).then_some(n[0])
            };
            let n: Vec<f64> = self.nulls.iter().map(of_channel).collect::<Option<_>>()?;
            join(&mut cells, CONSTANT * scale, panel.span.length(), &n);
        }
        let length = self.length();
        let begin: Vec<f64> = self.majorants.iter().map(|x| (-x * length).exp()).collect();
        balanced(&cells, begin, &|density| self.mean(density))
    }
}

/// Joins a stretch with the cells in whose proportion its rates are; one whose rates are no more than `nothing` is
/// left out.
pub fn join(cells: &mut Vec<Cell>, nothing: f64, length: f64, rates: &[f64]) {
    let largest = rates.iter().fold(0.0f64, |most, &n| most.max(n));
    if largest <= nothing {
        return;
    }
    let direction: Vec<f64> = rates.iter().map(|n| (n / largest).max(0.0)).collect();
    let length = length * largest;
    let like =
        |cell: &&mut Cell| cell.1.iter().zip(&direction).all(|(a, b)| (a - b).abs() <= CONSTANT);
    match cells.iter_mut().find(like) {
        Some(cell) => cell.0 += length,
        None => cells.push((length, direction)),
    }
}

/// The probability of every number of events in all cells, and the densities of all heroes relative to their mean.
pub fn balanced(
    cells: &[Cell],
    begin: Vec<f64>,
    mean: &dyn Fn(&[f64]) -> f64,
) -> Option<Vec<(f64, Vec<f64>)>> {
    let mut paths = vec![(1.0, begin)];
    for (length, direction) in cells {
        // What nobody can tell the channels apart by needs no numbers.
        if direction.iter().all(|&d| d == 1.0) {
            for (measure, _) in &mut paths {
                *measure *= length.exp();
            }
            continue;
        }
        let mut longer = Vec::new();
        for (measure, density) in paths {
            let (mut measure, mut density, mut m) = (measure, density, 0.0);
            while measure * mean(&density) > RARE || m < *length {
                longer.push((measure, density.clone()));
                m += 1.0;
                measure *= length / m;
                density.iter_mut().zip(direction).for_each(|(p, d)| *p *= d);
                if longer.len() > MOST_ATOMS {
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
