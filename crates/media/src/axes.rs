//! The order of the axes of an array.

/// Names of the first, the second and the third axis, as in `"zyx"`: `array[z, y, x]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Axes([usize; 3]);

impl Default for Axes {
    /// `array[z, y, x]`.
    fn default() -> Self {
        Self([2, 1, 0])
    }
}

impl Axes {
    /// All orders by their names.
    pub const NAMES: [&str; 6] = ["zyx", "xyz", "xzy", "yxz", "yzx", "zxy"];

    /// The order of a name; `None` where the letters are not x, y and z once each.
    pub fn named(name: &str) -> Option<Self> {
        let name = Self::NAMES.into_iter().find(|known| *known == name)?;
        let mut axes = name.bytes().map(|letter| usize::from(letter - b'x'));
        Some(Self([axes.next()?, axes.next()?, axes.next()?]))
    }

    /// Returns the name.
    pub fn name(self) -> &'static str {
        let is_this = |name: &&str| Self::named(name) == Some(self);
        Self::NAMES.into_iter().find(is_this).unwrap_or_default()
    }

    /// Sizes along x, y and z, and the values with x fastest, of an array of a shape. Its last axis varies fastest, or in
    /// Fortran's order its first.
    pub fn sorted(
        self,
        shape: [usize; 3],
        is_fortran: bool,
        values: Vec<f64>,
    ) -> ([usize; 3], Vec<f64>) {
        let [a, b, c] = shape;
        let strides = if is_fortran { [1, a, a * b] } else { [b * c, c, 1] };
        let (mut size, mut stride) = ([0; 3], [0; 3]);
        for (place, &axis) in self.0.iter().enumerate() {
            (size[axis], stride[axis]) = (shape[place], strides[place]);
        }
        let [nx, ny, nz] = size;
        if stride == [1, nx, nx * ny] {
            return (size, values);
        }
        let mut sorted = Vec::with_capacity(values.len());
        for z in 0..nz {
            for y in 0..ny {
                let row = z * stride[2] + y * stride[1];
                sorted.extend((0..nx).map(|x| values[row + x * stride[0]]));
            }
        }
        (size, sorted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sample's value encodes its place: x + 10 y + 100 z, on a lattice of 4 × 3 × 2.
    #[test]
    fn every_order_finds_the_sample_at_its_place() {
        let expected: Vec<f64> =
            (0..24).map(|n| f64::from(n % 4 + 10 * (n / 4 % 3) + 100 * (n / 12))).collect();
        for name in Axes::NAMES {
            let axes = Axes::named(name).expect("an order");
            assert_eq!(axes.name(), name);
            let shape = axes.0.map(|axis| [4, 3, 2][axis]);
            let [a, b, c] = shape;
            for is_fortran in [false, true] {
                let value = |n: usize| -> f64 {
                    let in_c = [n / (b * c), n / c % b, n % c];
                    let at = if is_fortran { [n % a, n / a % b, n / (a * b)] } else { in_c };
                    at.iter()
                        .zip(axes.0)
                        .map(|(&i, axis)| i as f64 * [1.0, 10.0, 100.0][axis])
                        .sum()
                };
                let sorted = axes.sorted(shape, is_fortran, (0..24).map(value).collect());
                assert_eq!(sorted, ([4, 3, 2], expected.clone()), "{name}, Fortran {is_fortran}");
            }
        }
        for name in ["", "zy", "xxz", "XYZ", "zyxw", "abc"] {
            assert_eq!(Axes::named(name), None, "{name}");
        }
    }
}
