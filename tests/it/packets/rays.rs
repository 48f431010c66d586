//! Packets along rays, in rods and in slabs, on every level with fused multiply-add.

use super::fields::{Matrix, cases};
use super::{compare, fusing_levels};

#[test]
fn packets_are_the_scalar_draws_at_every_level_that_fuses() {
    packets_are_the_scalar_draws(Matrix::Cross);
}

#[test]
#[ignore = "long: every estimator in every field, 40 s of two cores"]
fn packets_are_the_scalar_draws_in_every_field() {
    packets_are_the_scalar_draws(Matrix::Full);
}

fn packets_are_the_scalar_draws(matrix: Matrix) {
    let compared = compare(&cases(matrix));
    let least = if matrix == Matrix::Full { 200 } else { 100 };
    assert!(fusing_levels().is_empty() || compared > least, "only {compared} compared");
}
