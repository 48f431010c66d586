//! Adaptive quadrature: panels are halved until two halves agree with the whole.

use std::collections::VecDeque;

use crate::{Span, order};

/// Limits of halving.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Maximum number of halvings of one panel.
    pub halvings: u32,
    /// Maximum number of panels that are kept.
    pub panels: usize,
}

/// A panel with its integrals by one rule, over the whole and over both halves.
#[derive(Debug, Clone, Copy)]
pub struct Halved<const N: usize> {
    /// The panel.
    pub span: Span,
    /// Integrals over the panel.
    pub whole: [f64; N],
    /// Integrals over its halves.
    pub halves: [[f64; N]; 2],
}

impl<const N: usize> Halved<N> {
    /// Sum of both halves.
    pub fn value(&self) -> [f64; N] {
        std::array::from_fn(|i| self.halves[0][i] + self.halves[1][i])
    }

    /// Difference of both halves to the whole.
    pub fn change(&self) -> [f64; N] {
        let value = self.value();
        std::array::from_fn(|i| value[i] - self.whole[i])
    }
}

/// Halves panels until a stopping rule accepts all, the widest first, so that all are equally narrow where a limit ends
/// it. Returns the accepted panels in ascending order.
///
/// `rule` integrates over a panel. `is_fine` is given a panel and the sums of the absolute values of all integrals over
/// the first panels.
///
/// Compiled once for each number of integrals: integrands are dear beside a call through a reference.
pub fn halve<const N: usize>(
    first: &mut dyn Iterator<Item = Span>,
    limits: Limits,
    rule: &dyn Fn(Span) -> [f64; N],
    is_fine: &dyn Fn(&Halved<N>, &[f64; N]) -> bool,
) -> Vec<Halved<N>> {
    let mut open: VecDeque<_> = first.map(|span| (span, rule(span), 0)).collect();
    let scale = std::array::from_fn(|i| open.iter().map(|(_, whole, _)| whole[i].abs()).sum());
    let mut kept = Vec::with_capacity(open.len());
    while let Some((span, whole, halvings)) = open.pop_front() {
        let parts = span.halves();
        let here = Halved { span, whole, halves: parts.map(rule) };
        let has_room = halvings < limits.halvings
            && kept.len() + open.len() + 2 <= limits.panels
            && span.contains_inside(span.middle());
        if !has_room || is_fine(&here, &scale) {
            kept.push(here);
            continue;
        }
        for (part, whole) in parts.into_iter().zip(here.halves) {
            open.push_back((part, whole, halvings + 1));
        }
    }
    let begins: Vec<f64> = kept.iter().map(|part| part.span.from).collect();
    order::ascending_places(&begins).into_iter().map(|place| kept[place]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quadrature::GaussLegendre;

    #[test]
    fn panels_are_short_where_the_integrand_is_steep() {
        let rule = GaussLegendre::new(8);
        let limits = Limits { halvings: 60, panels: 1000 };
        let result = halve(
            &mut Span::between(&[0.0, 0.5, 1.0]),
            limits,
            &|span| [rule.integrate(span.from, span.to, f64::sqrt)],
            &|here, [scale]| here.change()[0].abs() <= 1e-15 * scale,
        );
        let value: f64 = result.iter().map(|here| here.value()[0]).sum();
        assert!((value - 2.0 / 3.0).abs() < 1e-14, "{value}");
        assert!(result.windows(2).all(|pair| pair[0].span.to == pair[1].span.from));
        assert!(result[0].span.length() < 1e-6 && result[result.len() - 1].span.length() > 0.1);
    }

    #[test]
    fn a_rule_that_is_never_satisfied_ends_at_the_limit() {
        for limits in [Limits { halvings: 3, panels: 100 }, Limits { halvings: 60, panels: 8 }] {
            let result = halve(&mut Span::between(&[0.0, 1.0]), limits, &|_| [1.0], &|_, _| false);
            assert_eq!(result.len(), 8);
            assert!(result.iter().all(|here| here.span.length() == 0.125));
        }
    }
}
