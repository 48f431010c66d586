//! Estimators of the transmittance at many distances from one walk.

pub mod double;
pub mod ray_view;

use crate::estimators;
use theory::problems::TransmittanceCurve;

pub use ray_view::RayView;

estimators! {
    TransmittanceCurve on ControlledLine:
    double::DoubleCurve,
}
