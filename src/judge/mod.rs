//! Verdicts on draws that another program made, and the claims about them that a case gives: [`OfCase`].

mod of_case;

pub use ::judge::*;
pub use of_case::{
    ChoiceError, ExperimentChoice, OfCase, estimators as estimators_of, theory as theory_of,
};
