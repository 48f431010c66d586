//! Tests of Trueflight itself, with the command `trueflight-lab`: known bugs that the gate must catch, correct draws that it
//! must not fail, the promises that its verdicts are counted against, and numbers under stress.
//!
//! The lab depends on the harness (the package `trueflight`), and only tests depend on the lab: users do not build it.

pub mod cli;
pub mod h_function;
pub mod mutants;
pub mod report;
pub mod self_test;
pub mod stress;
