//! Integrals from the beginning of a span to any place in it.
//!
//! ```text
//! ∫ up to s = prefix sum over the whole panels before s + the rest of one panel, by a rule of the caller
//! ```

use crate::Span;

/// Prefix sums of the integrals of several functions over adjacent panels.
#[derive(Debug, Clone)]
pub struct Cumulative {
    width: usize,
    ends: Vec<f64>,
    /// Integrals up to each end, end by end.
    sums: Vec<f64>,
}

impl Cumulative {
    /// Begins a table of the integrals of `width` functions.
    pub fn new(from: f64, width: usize) -> Self {
        Self { width, ends: vec![from], sums: vec![0.0; width] }
    }

    /// Tabulates integrals over adjacent panels; `add` adds those over a span to a row of zeros.
    #[must_use]
    pub fn over(
        from: f64,
        width: usize,
        panels: impl Iterator<Item = Span>,
        mut add: impl FnMut(Span, &mut [f64]),
    ) -> Self {
        let mut table = Self::new(from, width);
        for span in panels {
            table.push(span.to, |row| add(span, row));
        }
        table
    }

    /// Appends a panel; `add` adds the integrals over it to a row of zeros.
    pub fn push(&mut self, to: f64, add: impl FnOnce(&mut [f64])) {
        let before = self.sums.len() - self.width;
        self.sums.resize(self.sums.len() + self.width, 0.0);
        let (sums, row) = self.sums.split_at_mut(before + self.width);
        add(row);
        row.iter_mut().zip(&sums[before..]).for_each(|(x, sum)| *x += sum);
        self.ends.push(to);
    }

    /// Writes the integrals up to a place into a row of zeros. `add` adds those over a part of a panel, given the index
    /// of the panel.
    pub fn up_to(&self, s: f64, row: &mut [f64], add: impl FnOnce(usize, Span, &mut [f64])) {
        let last = self.ends.len() - 1;
        let panel = self.ends.partition_point(|&end| end <= s).saturating_sub(1).min(last);
        let rest = Span::new(self.ends[panel], s);
        if panel < last && !rest.is_empty() {
            add(panel, rest, row);
        }
        let before = &self.sums[panel * self.width..][..self.width];
        row.iter_mut().zip(before).for_each(|(x, sum)| *x += sum);
    }

    /// Integrals over all panels.
    pub fn whole(&self) -> &[f64] {
        &self.sums[self.sums.len() - self.width..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::GaussLegendre;

    #[test]
    fn integrals_up_to_any_place_are_those_of_polynomials() {
        let rule = GaussLegendre::new(3);
        let add = |span: Span, row: &mut [f64]| {
            for (t, weight) in rule.on(span) {
                row[0] += weight;
                row[1] += weight * t.powi(3);
            }
        };
        let panels = Span::between(&[-1.0, 0.5, 0.7, 2.0]);
        let table = Cumulative::over(-1.0, 2, panels, add);
        assert!((table.whole()[1] - 3.75).abs() < 1e-14);
        for s in [-1.0, -0.3, 0.5, 0.6, 1.9, 2.0] {
            let mut row = [0.0; 2];
            table.up_to(s, &mut row, |_, rest, row| add(rest, row));
            let exact = (s.powi(4) - 1.0) / 4.0;
            assert!((row[0] - s - 1.0).abs() < 1e-14 && (row[1] - exact).abs() < 1e-14, "{s}");
        }
    }
}
