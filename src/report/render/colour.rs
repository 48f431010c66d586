//! Numbers as colours.

use crate::report::plots::style::{DARK, GREY, ink};
use drawing::sheet::{Align, Sheet, Spot};

/// `RdBu` of C. Brewer, *`ColorBrewer`* (2003), from blue over white to red: distinct without red or green, too.
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

/// Number of steps to either side of white: fewer steps make files small.
const STEPS: f64 = 24.0;

/// Returns a pixel's radiance in grey, or in red, green and blue, for screens with the sRGB curve: 1 is white, negative
/// radiances are black.
pub fn radiance(channels: &[f64]) -> [u8; 3] {
    let shown = |radiance: f64| {
        let x = radiance.clamp(0.0, 1.0);
        let shown = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        byte(255.0 * shown)
    };
    each(channels, shown)
}

/// Returns a pixel's difference. In one channel: from −1, blue, over 0, white, to 1, red. In three channels each of
/// them separately, from −1, dark, over 0, half, to 1, full: a difference that is equal in all channels is grey.
pub fn difference(channels: &[f64]) -> [u8; 3] {
    if let &[one] = channels {
        return signed(one);
    }
    each(channels, |x| byte(127.5 * (1.0 + x.clamp(-1.0, 1.0))))
}

/// Applies a rule to three channels, or three times to the first.
fn each(channels: &[f64], shown: impl Fn(f64) -> u8) -> [u8; 3] {
    match *channels {
        [red, green, blue] => [red, green, blue].map(shown),
        _ => [shown(channels.first().copied().unwrap_or_default()); 3],
    }
}

/// Draws a bar of the colours of differences, from 1 at its upper end to −1, with words at shares of its height.
pub fn bar(
    sheet: &mut Sheet,
    [left, high]: Spot,
    height: f64,
    (channels, marks): (usize, &[(f64, &str)]),
) {
    const SIZE: f64 = 18.0;
    let right = left + SIZE;
    let steps = 49_u32;
    for step in 0..steps {
        let at = |i: u32| high + height * (1.0 - f64::from(i) / f64::from(steps));
        let shown = 2.0 * f64::from(step) / f64::from(steps - 1) - 1.0;
        let [r, g, b] = difference(&[shown; 3][..channels]);
        let (y, end) = (at(step), at(step + 1));
        sheet.area(vec![[left, y], [right, y], [right, end], [left, end]], ink(r, g, b));
    }
    sheet.frame([left, high], [SIZE, height], GREY);
    for &(share, text) in marks {
        let y = high + share * height;
        sheet.path(vec![[right, y], [right + 5.0, y]], 1.0, GREY);
        sheet.text([right + 9.0, y], text, 10.5, DARK, Align::Start);
    }
}

fn signed(difference: f64) -> [u8; 3] {
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
        assert_eq!([-1.0, 0.0, 1.0, 9.0].map(|x| radiance(&[x])[0]), [0, 0, 255, 255]);
        // ((128/255 + 0.055)/1.055)^2.4
        assert_eq!(radiance(&[0.215_861]), [128; 3]);
        assert_eq!(radiance(&[0.215_861, 0.0, 1.0]), [128, 0, 255]);
    }

    #[test]
    fn no_difference_is_white_and_the_ends_are_blue_and_red() {
        assert_eq!(signed(0.0), [255; 3]);
        assert_eq!([signed(-7.0), signed(1.0)], [[33, 102, 172], [178, 24, 43]]);
        // A quarter of the way to red.
        assert_eq!(difference(&[0.25]), [253, 219, 199]);
    }

    #[test]
    fn in_colours_each_channel_has_its_own_difference_and_none_is_grey() {
        assert_eq!(difference(&[0.0; 3]), [128; 3]);
        assert_eq!(difference(&[-3.0, 0.0, 1.0]), [0, 128, 255]);
    }
}
