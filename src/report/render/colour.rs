//! Numbers as colours.

/// `RdBu` of C. Brewer, *`ColorBrewer`* (2003), from blue over white to red: it can be told apart without
/// red or green.
const DIVERGING: [[f64; 3]; 9] = [
    [33.0, 102.0, 172.0],
    [67.0, 147.0, 195.0],
    [146.0, 197.0, 222.0],
    [209.0, 229.0, 240.0],
    [255.0, 255.0, 255.0],
    [253.0, 219.0, 199.0],
    [244.0, 165.0, 130.0],
    [214.0, 96.0, 77.0],
    [178.0, 24.0, 43.0],
];

/// Steps to either side of white: files stay small.
const STEPS: f64 = 24.0;

/// A radiance in grey, for screens with the sRGB curve: 1 is white, and nothing is darker than black.
pub fn grey(radiance: f64) -> [u8; 3] {
    let x = radiance.clamp(0.0, 1.0);
    let shown = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    [byte(255.0 * shown); 3]
}

/// A difference from −1, blue, to 1, red.
pub fn signed(difference: f64) -> [u8; 3] {
    let x = (difference.clamp(-1.0, 1.0) * STEPS).round() / STEPS;
    let place = (x + 1.0) * 0.5 * (DIVERGING.len() - 1) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 0 to 8
    let below = (place.floor() as usize).min(DIVERGING.len() - 2);
    let share = place - below as f64;
    let (low, high) = (DIVERGING[below], DIVERGING[below + 1]);
    std::array::from_fn(|i| byte(low[i] + (high[i] - low[i]) * share))
}

fn byte(x: f64) -> u8 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    let byte = x.round() as u8;
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_white_and_the_middle() {
        assert_eq!([grey(-1.0)[0], grey(0.0)[0], grey(1.0)[0], grey(9.0)[0]], [0, 0, 255, 255]);
        // ((128/255 + 0.055)/1.055)^2.4
        assert_eq!(grey(0.215_861), [128; 3]);
    }

    #[test]
    fn no_difference_is_white_and_the_ends_are_blue_and_red() {
        assert_eq!(signed(0.0), [255; 3]);
        assert_eq!([signed(-7.0), signed(1.0)], [[33, 102, 172], [178, 24, 43]]);
        // A quarter to red.
        assert_eq!(signed(0.25), [253, 219, 199]);
    }
}
