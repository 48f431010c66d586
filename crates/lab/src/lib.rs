//! Tests of the tester: known bugs that the gate must catch, correct draws that it must not fail, and the promises that
//! its verdicts are counted against.

pub mod calibration;
pub mod mutants;
pub mod streams;
