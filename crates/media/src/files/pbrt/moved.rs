//! The transform by the directives before a medium.

/// A scale and a translation: p → scale·p + shift; or the name of the directive that rotates the axes.
#[derive(Debug, Clone)]
pub(super) struct Moved {
    pub(super) scale: [f64; 3],
    pub(super) shift: [f64; 3],
    pub(super) turned_by: Option<&'static str>,
}

impl Default for Moved {
    fn default() -> Self {
        Self { scale: [1.0; 3], shift: [0.0; 3], turned_by: None }
    }
}

impl Moved {
    pub(super) fn translate(&mut self, by: [f64; 3]) {
        self.shift = [0, 1, 2].map(|j| self.shift[j] + self.scale[j] * by[j]);
    }

    pub(super) fn scale(&mut self, by: [f64; 3]) {
        self.scale = [0, 1, 2].map(|j| self.scale[j] * by[j]);
    }
}

/// The samples, mirrored along some axes.
pub(super) fn mirrored(density: Vec<f64>, [nx, ny, nz]: [u64; 3], about: [bool; 3]) -> Vec<f64> {
    if about == [false; 3] {
        return density;
    }
    let place = |n: u64, size: u64, is_about: bool| if is_about { size - 1 - n } else { n };
    let mut turned = Vec::with_capacity(density.len());
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let (x, y, z) =
                    (place(x, nx, about[0]), place(y, ny, about[1]), place(z, nz, about[2]));
                let at = usize::try_from((z * ny + y) * nx + x).unwrap_or(usize::MAX);
                turned.extend(density.get(at).copied());
            }
        }
    }
    turned
}
