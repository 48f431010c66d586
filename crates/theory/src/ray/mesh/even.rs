//! Meshes with equal panels that ignore the breaks of the medium.

use super::{Mesh, NODES};
use media::Medium;
use numeric::{Known, Span};

/// Nodes per panel of a coarse mesh.
const COARSE_NODES: usize = 5;
/// Least number of panels of a coarse mesh.
const MIN_PANELS: usize = 64;
/// Factor by which a coarse mesh has fewer nodes at least.
const FEWER: usize = 4;
/// Relative difference that a coarse mesh makes at most: of `∫σ_t` and `∫σ_t²`, and of the largest σ_t.
const AGREEMENT: [f64; 3] = [1e-4, 1e-4, 2e-3];

impl Mesh {
    /// Cuts the support into equal panels of 16 nodes: a quick look at a field of thousands of pieces. The error of
    /// integrals on it is not known: it is infinite.
    pub fn even(medium: Medium, panels: usize) -> Self {
        let mut mesh = Self::evenly(medium, panels, NODES);
        mesh.error = f64::INFINITY;
        mesh.depth = Known::estimated(mesh.integrate(&|_, sigma| sigma), f64::INFINITY);
        mesh
    }

    fn evenly(medium: Medium, panels: usize, nodes: usize) -> Self {
        let support = medium.support();
        let at = |i: usize| support.from + support.length() * (i as f64 / panels as f64);
        let panels = (0..panels).map(|i| Span::new(at(i), at(i + 1))).collect();
        let mut mesh = Self { panels, ..Self::without_panels(medium, nodes, false) };
        mesh.t = mesh.panels.iter().flat_map(|&panel| mesh.nodes(panel)).collect();
        mesh.extinction = mesh.medium.extinctions(&mesh.t);
        mesh
    }

    /// Returns the coarsest mesh of equal panels that is good enough to search a σ̂: its integrals are about those of this
    /// mesh. `None` where it saves little. It states the errors of this mesh, which are not its own.
    #[must_use]
    pub fn coarse(&self) -> Option<Self> {
        let seen = |mesh: &Self| {
            let largest = mesh.largest(&|_, sigma| sigma).map_or(0.0, |(_, largest)| largest);
            [mesh.integrate(&|_, sigma| sigma), mesh.integrate(&|_, sigma| sigma * sigma), largest]
        };
        let exact = seen(self);
        let counts = std::iter::successors(Some(MIN_PANELS), |panels| Some(2 * panels));
        let counts = counts.take_while(|panels| FEWER * COARSE_NODES * panels <= self.t.len());
        let mut meshes = counts.map(|panels| Self {
            is_coarse: true,
            error: self.error,
            depth: self.depth,
            ..Self::evenly(self.medium.clone(), panels, COARSE_NODES)
        });
        meshes.find(|mesh| {
            let mut pairs = seen(mesh).into_iter().zip(exact).zip(AGREEMENT);
            pairs.all(|((result, exact), maximum)| (result - exact).abs() <= maximum * exact)
        })
    }
}
