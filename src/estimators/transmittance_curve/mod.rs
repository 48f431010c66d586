//! Estimators of the transmittance at many distances from one walk.

pub mod double;
pub mod packet;
pub mod portrait;

use crate::estimators::estimators;
use crate::problems::TransmittanceCurve;

pub use portrait::Portrait;

estimators! {
    TransmittanceCurve:
    double::DoubleCurve,
}
