//! A dozen textbook estimators: one draw after the other, the standard library's `ln` and `cos`, one PCG generator.
//!
//! On homogeneous media the density is hidden from the compiler, which would otherwise delete the lookups.

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use rand::Rng;
use rand_pcg::Pcg64;

use crate::fields::{PERMUTATION, VOXELS, eq21, improved_noise, voxels};

fn uniform(rng: &mut Pcg64) -> f64 {
    (rng.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

pub fn eq21_ratio(rng: &mut Pcg64) -> f64 {
    let (majorant, length) = (black_box(1.0), black_box(20.0));
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        weight *= 1.0 - eq21(0.0, 0.0, t) / majorant;
    }
}

pub fn eq21_woodcock(rng: &mut Pcg64) -> f64 {
    let (majorant, length) = (black_box(1.0), black_box(20.0));
    let mut t = 0.0;
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return 1.0;
        }
        if uniform(rng) < eq21(0.0, 0.0, t) / majorant {
            return 0.0;
        }
    }
}

pub fn eq21_next_flight(rng: &mut Pcg64) -> f64 {
    let (majorant, length): (f64, f64) = (black_box(1.0), black_box(20.0));
    let (mut t, mut weight, mut score) = (0.0, 1.0, (-majorant * length).exp());
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return score;
        }
        weight *= 1.0 - eq21(0.0, 0.0, t) / majorant;
        score += weight * (-majorant * (length - t)).exp();
    }
}

pub fn eq21_residual_ratio(rng: &mut Pcg64) -> f64 {
    let (majorant, control, length): (f64, f64, f64) =
        (black_box(1.0), black_box(0.3), black_box(20.0));
    let (mut t, mut weight) = (0.0, (-control * length).exp());
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        weight *= 1.0 - (eq21(0.0, 0.0, t) - control) / majorant;
    }
}

pub fn homogeneous(rng: &mut Pcg64) -> f64 {
    let (majorant, length) = (black_box(1.0), black_box(8.0));
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        weight *= 1.0 - black_box(0.5) / majorant;
    }
}

pub fn grid_ratio(rng: &mut Pcg64) -> f64 {
    let values = &VOXELS[..];
    let (majorant, size) = (black_box(1.2), (1.0f64 + 0.9 * 0.9 + 0.95 * 0.95).sqrt());
    let (length, d) = (10.0 * size, [1.0 / size, 0.9 / size, 0.95 / size]);
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        let p = [t * d[0], 0.5 + t * d[1], 0.3 + t * d[2]];
        weight *= 1.0 - 1.2 * voxels(values, p) / majorant;
    }
}

pub fn noise_ratio(rng: &mut Pcg64) -> f64 {
    let table = &PERMUTATION[..];
    let (majorant, length) = (black_box(1.0), black_box(10.0));
    let size = (0.6f64 * 0.6 + 0.5 * 0.5 + 0.37 * 0.37).sqrt();
    let d = [0.6 / size, 0.5 / size, 0.37 / size];
    let bound = 1.036_353_811_211_802_7 * (2.0 - 0.5f64.powi(11));
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        let p = [0.3 + t * d[0], 0.7 + t * d[1], -0.45 + t * d[2]];
        let (mut sum, mut amplitude, mut scale) = (0.0, 1.0, 1.0);
        for _ in 0..12 {
            sum += amplitude * improved_noise(table, p[0] * scale, p[1] * scale, p[2] * scale);
            (amplitude, scale) = (0.5 * amplitude, 2.0 * scale);
        }
        weight *= 1.0 - (0.5 + 0.5 * sum / bound) / majorant;
    }
}

/// Reflected particles of a rod through Eq. 21 by analog delta tracking; scattering is forward or backward.
pub fn rod_analog(rng: &mut Pcg64) -> f64 {
    let (majorant, length, albedo) = (black_box(1.0), black_box(20.0), 0.7);
    let (mut t, mut direction) = (0.0, 1.0);
    loop {
        t -= direction * (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return 0.0;
        }
        if t < 0.0 {
            return 1.0;
        }
        if uniform(rng) >= eq21(0.0, 0.0, t) / majorant {
            continue;
        }
        if uniform(rng) >= albedo {
            return 0.0;
        }
        if uniform(rng) >= 0.5 {
            direction = -direction;
        }
    }
}

/// Light of the emitter at the end of a homogeneous rod: a shadow ray from each scattering, by ratio tracking.
pub fn lit_rod_next_event(rng: &mut Pcg64) -> f64 {
    let (majorant, extinction, length) = (black_box(1.6), black_box(1.0), black_box(2.0));
    let (albedo, forward) = (0.9, 0.75);
    let (mut t, mut direction, mut is_scattered, mut score) = (0.0, 1.0, false, 0.0);
    loop {
        t -= direction * (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return if is_scattered { score } else { 1.0 };
        }
        if t < 0.0 {
            return score;
        }
        if uniform(rng) >= extinction / majorant {
            continue;
        }
        if uniform(rng) >= albedo {
            return score;
        }
        is_scattered = true;
        let (mut s, mut shadow) = (t, if direction > 0.0 { forward } else { 1.0 - forward });
        loop {
            s -= (1.0 - uniform(rng)).ln() / majorant;
            if s >= length {
                break;
            }
            shadow *= 1.0 - extinction / majorant;
        }
        score += shadow;
        if uniform(rng) >= forward {
            direction = -direction;
        }
    }
}

/// Reflected particles of a homogeneous slab with isotropic scattering by analog delta tracking.
pub fn slab_analog(rng: &mut Pcg64) -> f64 {
    let (majorant, extinction, thickness) = (black_box(1.25), black_box(1.0), black_box(1.5));
    let (mut z, mut cosine, albedo) = (0.0, 0.5, 0.7);
    loop {
        z -= cosine * (1.0 - uniform(rng)).ln() / majorant;
        if z >= thickness {
            return 0.0;
        }
        if z < 0.0 {
            return 1.0;
        }
        if uniform(rng) >= extinction / majorant {
            continue;
        }
        if uniform(rng) >= albedo {
            return 0.0;
        }
        cosine = 2.0 * uniform(rng) - 1.0;
    }
}

/// Radiance along a ray through a ball in a white environment by analog delta tracking.
pub fn ball_analog(rng: &mut Pcg64) -> f64 {
    let (majorant, radius, albedo) = (black_box(2.0), black_box(1.5), 0.9);
    let entry: f64 = -(radius * radius - 0.5f64 * 0.5).sqrt();
    let (mut p, mut d) = ([0.5, 0.0, entry], [0.0, 0.0, 1.0]);
    loop {
        let flown = -(1.0 - uniform(rng)).ln() / majorant;
        for (x, d) in p.iter_mut().zip(d) {
            *x += flown * d;
        }
        let squared = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / (radius * radius);
        if squared >= 1.0 {
            return 1.0;
        }
        if uniform(rng) >= 2.0 * (1.0 - squared) / majorant {
            continue;
        }
        if uniform(rng) >= albedo {
            return 0.0;
        }
        let cosine = 2.0 * uniform(rng) - 1.0;
        let (sine, angle) = ((1.0 - cosine * cosine).sqrt(), TAU * uniform(rng));
        d = [sine * angle.cos(), sine * angle.sin(), cosine];
    }
}

/// Light of a point source, scattered once into a ray: delta tracking to a collision, ratio tracking to the light.
pub fn single_scattering(rng: &mut Pcg64) -> f64 {
    let (majorant, extinction, length) = (black_box(1.0), black_box(0.8), black_box(6.0));
    let (light, albedo) = ([0.5, 2.5], 0.9);
    let mut t: f64 = 0.0;
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return 0.0;
        }
        if uniform(rng) < extinction / majorant {
            break;
        }
    }
    let squared = light[0] * light[0] + (light[1] - t) * (light[1] - t);
    let (distance, mut s, mut weight) = (squared.sqrt(), 0.0, 1.0);
    loop {
        s -= (1.0 - uniform(rng)).ln() / majorant;
        if s >= distance {
            break;
        }
        weight *= 1.0 - extinction / majorant;
    }
    albedo * weight / (4.0 * PI) / (4.0 * PI * squared)
}
