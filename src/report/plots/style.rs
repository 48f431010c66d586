//! Colours, dashes and markers: distinct for colour-blind readers and in black and white.

use plotters::style::RGBAColor;

use drawing::sheet::{Sheet, Spot};

/// Returns an opaque colour.
pub const fn ink(red: u8, green: u8, blue: u8) -> RGBAColor {
    RGBAColor(red, green, blue, 1.0)
}

/// Colour of text and frames.
pub const DARK: RGBAColor = ink(0x22, 0x22, 0x22);
/// Colour of secondary text.
pub const GREY: RGBAColor = ink(0x66, 0x66, 0x66);
/// Colour of lines of the grid.
pub const FAINT: RGBAColor = ink(0xE6, 0xE6, 0xE6);
/// Colour of the paper.
pub const PAPER: RGBAColor = ink(0xFF, 0xFF, 0xFF);

/// Palette of M. Okabe and K. Ito, "Color Universal Design" (2008), without its yellow, which is too pale for lines on
/// paper.
pub const COLOURS: [RGBAColor; 7] = [
    ink(0x00, 0x72, 0xB2),
    ink(0xD5, 0x5E, 0x00),
    ink(0x00, 0x9E, 0x73),
    ink(0xCC, 0x79, 0xA7),
    ink(0x00, 0x00, 0x00),
    ink(0xE6, 0x9F, 0x00),
    ink(0x56, 0xB4, 0xE9),
];

const DASHES: [&[f64]; 5] = [&[], &[9.0, 4.0], &[2.5, 3.0], &[10.0, 3.5, 2.5, 3.5], &[16.0, 4.0]];

/// Style of one series.
#[derive(Debug, Clone, Copy)]
pub struct Style {
    /// Colour.
    pub colour: RGBAColor,
    /// Dashes: lengths of stroke and gap.
    pub dash: &'static [f64],
    /// Marker.
    pub marker: Marker,
}

impl Style {
    /// Returns the style of the series with this number. The periods 7, 5 and 12 have no common factor, so that 420
    /// series are distinct.
    pub fn of(index: usize) -> Self {
        let marker = Marker::ALL[index % Marker::ALL.len()];
        Self { colour: COLOURS[index % COLOURS.len()], dash: DASHES[index % DASHES.len()], marker }
    }
}

/// Shape of a measured point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// ●
    Disc,
    /// ■
    Square,
    /// ▲
    Up,
    /// ◆
    Diamond,
    /// ▼
    Down,
    /// ⬠
    Pentagon,
    /// ×
    Cross,
    /// ◀
    Left,
    /// +
    Plus,
    /// ▶
    Right,
    /// ⬡
    Hexagon,
    /// ★
    Star,
}

impl Marker {
    /// Every marker, in the order of use.
    pub const ALL: [Self; 12] = [
        Self::Disc,
        Self::Square,
        Self::Up,
        Self::Diamond,
        Self::Down,
        Self::Pentagon,
        Self::Cross,
        Self::Left,
        Self::Plus,
        Self::Right,
        Self::Hexagon,
        Self::Star,
    ];

    /// Draws the marker, with a thin rim of paper that separates it from lines and other markers.
    pub fn draw(self, sheet: &mut Sheet, at: Spot, radius: f64, colour: RGBAColor) {
        self.fill(sheet, at, radius + 1.2, PAPER);
        self.fill(sheet, at, radius, colour);
    }

    /// Draws the marker without a rim.
    pub fn fill(self, sheet: &mut Sheet, at: Spot, radius: f64, colour: RGBAColor) {
        match self {
            Self::Disc => sheet.disc(at, radius, colour),
            _ => sheet.area(self.corners(at, radius), colour),
        }
    }

    fn corners(self, at: Spot, radius: f64) -> Vec<Spot> {
        let polygon = |corners: u32, turn: f64, size: f64| ring(at, corners, turn, size, size);
        match self {
            Self::Disc => polygon(24, 0.0, radius),
            Self::Square => polygon(4, 0.125, radius * 1.25),
            Self::Up => polygon(3, 0.0, radius * 1.3),
            Self::Diamond => polygon(4, 0.0, radius * 1.3),
            Self::Down => polygon(3, 0.5, radius * 1.3),
            Self::Pentagon => polygon(5, 0.0, radius * 1.15),
            Self::Left => polygon(3, 0.75, radius * 1.3),
            Self::Right => polygon(3, 0.25, radius * 1.3),
            Self::Hexagon => polygon(6, 0.25, radius * 1.15),
            Self::Star => ring(at, 10, 0.0, radius * 1.5, radius * 0.65),
            Self::Cross => arms(at, radius * 1.25, 0.125),
            Self::Plus => arms(at, radius * 1.25, 0.0),
        }
    }
}

/// Returns corners at alternating distances, the first `turn` of a full turn clockwise from the top.
fn ring(at: Spot, corners: u32, turn: f64, even: f64, odd: f64) -> Vec<Spot> {
    let corner = |i: u32| {
        let angle = std::f64::consts::TAU * (turn + f64::from(i) / f64::from(corners));
        let size = if i.is_multiple_of(2) { even } else { odd };
        [at[0] + size * angle.sin(), at[1] - size * angle.cos()]
    };
    (0..corners).map(corner).collect()
}

/// Returns the outline of a cross with four thick arms.
fn arms(at: Spot, radius: f64, turn: f64) -> Vec<Spot> {
    let (half, notch) = (radius * 0.28, radius * 0.28 * std::f64::consts::SQRT_2);
    let tilt = (half / radius).atan() / std::f64::consts::TAU;
    let mut outline = Vec::new();
    for quarter in [0.0, 0.25, 0.5, 0.75] {
        for (offset, size) in [(-tilt, radius), (tilt, radius), (0.125, notch)] {
            let angle = std::f64::consts::TAU * (turn + quarter + offset);
            outline.push([at[0] + size * angle.sin(), at[1] - size * angle.cos()]);
        }
    }
    outline
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dozen_series_differ_in_more_than_colour() {
        for i in 0..12 {
            for j in 0..i {
                assert_ne!(Style::of(i).marker, Style::of(j).marker);
                let (a, b) = (Style::of(i), Style::of(j));
                assert!(a.dash != b.dash || a.colour != b.colour);
            }
        }
    }
}
