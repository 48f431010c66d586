//! Tests of the tester: known bugs that the gate must catch, correct draws that it must not fail, the promises that
//! its verdicts are counted against, and numbers under stress.

pub mod calibration;
pub mod h_function;
pub mod mutants;
pub mod streams;
pub mod stress;
