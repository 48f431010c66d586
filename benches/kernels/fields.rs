//! Fields of a textbook.
//!
//! The grid is looked up in space: eight voxels, seven linear interpolations. The noise is Perlin's own program of 2002
//! with a table of permutations. The library's field chooses its gradients by a hash, so that the two means differ and
//! the work does not.

use std::sync::LazyLock;

use trueflight::media::lattice::hash3;

/// Returns σ_t of Eq. 21 at a point, by the printed formula.
#[allow(clippy::manual_midpoint)] // as it is printed
pub fn eq21(x: f64, y: f64, z: f64) -> f64 {
    (((1.5 * (x + y + z)).cos() + 1.0) / 2.0).powi(5) * ((z / 2.0).sin() + 2.0) / 3.0
}

/// 128³ random voxels, x first.
pub static VOXELS: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let value = |n: u32| f64::from(hash3(n % 128, n / 128 % 128, n / 16_384, 1)) / 4_294_967_296.0;
    (0..1 << 21).map(value).collect()
});

/// Interpolates the eight voxels around a point of the box.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the box
pub fn voxels(values: &[f64], p: [f64; 3]) -> f64 {
    let u = p.map(|x| x * 12.7);
    let i = u.map(|u| (u as usize).min(126));
    let f = [u[0] - i[0] as f64, u[1] - i[1] as f64, u[2] - i[2] as f64];
    let at = |x: usize, y: usize, z: usize| values[((i[2] + z) * 128 + i[1] + y) * 128 + i[0] + x];
    let lerp = |f: f64, a: f64, b: f64| a + f * (b - a);
    let row = |y: usize, z: usize| lerp(f[0], at(0, y, z), at(1, y, z));
    lerp(f[2], lerp(f[1], row(0, 0), row(1, 0)), lerp(f[1], row(0, 1), row(1, 1)))
}

/// A permutation of 0 to 255, twice.
pub static PERMUTATION: LazyLock<Vec<usize>> = LazyLock::new(|| {
    let mut table: Vec<(u32, usize)> = (0..256).map(|n| hash3(n, 0, 0, 1)).zip(0..).collect();
    table.sort_unstable();
    let table: Vec<usize> = table.into_iter().map(|(_, n)| n).collect();
    table.repeat(2)
});

fn grad(hash: usize, x: f64, y: f64, z: f64) -> f64 {
    let h = hash & 15;
    let u = if h < 8 { x } else { y };
    let v = if h < 4 {
        y
    } else if h == 12 || h == 14 {
        x
    } else {
        z
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// Returns improved noise, by its author's program.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the low eight bits
pub fn improved_noise(p: &[usize], x: f64, y: f64, z: f64) -> f64 {
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let lerp = |t: f64, a: f64, b: f64| a + t * (b - a);
    let cell = |x: f64| (x.floor() as i64 & 255) as usize;
    let (i, j, k) = (cell(x), cell(y), cell(z));
    let (x, y, z) = (x - x.floor(), y - y.floor(), z - z.floor());
    let (u, v, w) = (fade(x), fade(y), fade(z));
    let (a, b) = (p[i] + j, p[i + 1] + j);
    let (aa, ab, ba, bb) = (p[a] + k, p[a + 1] + k, p[b] + k, p[b + 1] + k);
    let near = lerp(
        v,
        lerp(u, grad(p[aa], x, y, z), grad(p[ba], x - 1.0, y, z)),
        lerp(u, grad(p[ab], x, y - 1.0, z), grad(p[bb], x - 1.0, y - 1.0, z)),
    );
    let z = z - 1.0;
    let far = lerp(
        v,
        lerp(u, grad(p[aa + 1], x, y, z), grad(p[ba + 1], x - 1.0, y, z)),
        lerp(u, grad(p[ab + 1], x, y - 1.0, z), grad(p[bb + 1], x - 1.0, y - 1.0, z)),
    );
    lerp(w, near, far)
}
