//! Scatterings in a rod with an emitter at its end, see [`crate::light::vertex`].

use crate::light::Techniques;
use crate::light::contour::Contour;
use crate::light::vertex::{Vertex, Weights};
use crate::rod::line::Line;
use crate::rod::walk::RodPoint;

/// Scatterings at each node of a line that was made for a σ̂, up to a power: of light that goes forward, and of light that
/// goes backward.
pub fn connections(line: &Line, techniques: Techniques, highest: usize) -> Vec<[Vertex; 2]> {
    let weights = Weights::new(techniques, highest, false);
    let moments = along(&weights.contour, line);
    let vertices = line.nodes().iter().zip(&moments).map(|(node, moments)| {
        [node.forward, 1.0 - node.forward].map(|towards| weights.vertex(towards, moments, 0.0))
    });
    vertices.collect()
}

/// Moments of x from each node to the emitter.
pub fn along(contour: &Contour, line: &Line) -> Vec<Vec<f64>> {
    let row = |node: &RodPoint| contour.rates(node.means[0], node.sampling);
    let rates: Vec<Vec<f64>> = line.nodes().iter().map(row).collect();
    line.to_end(&rates).iter().map(|depths| contour.moments(0, depths, 1.0)).collect()
}
