//! Tests of the tester: known bugs that the gate must catch.

pub mod mutants;
