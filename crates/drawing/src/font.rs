//! Typeface of the plots: a subset of `DejaVu` Sans with Greek, superscripts and signs.
//!
//! It is part of the program, so that plots look the same on machines without fonts. Its licence is beside it in
//! `dejavu-sans.LICENSE.txt`.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};

pub use ab_glyph::InvalidFont;

/// Families that an SVG asks for: any sans-serif has the same letters at about the same widths.
pub const FAMILY: &str = "DejaVu Sans, sans-serif";

const BYTES: &[u8] = include_bytes!("dejavu-sans.ttf");

/// Distance of the letters' baseline below the middle of a line, in ems: half the height of an `x`.
pub const BASELINE: f64 = 0.27;

/// Typeface that measures and rasterises.
pub struct Typeface(FontRef<'static>);

impl Typeface {
    /// Reads the typeface.
    ///
    /// # Errors
    ///
    /// The bytes are not a font.
    pub fn load() -> Result<Self, InvalidFont> {
        FontRef::try_from_slice(BYTES).map(Self)
    }

    fn scale(&self, em: f64) -> PxScale {
        let unit = self.0.units_per_em().map_or(1.0, f64::from);
        // Numbers of pixels are exact in f32.
        #[expect(clippy::cast_possible_truncation)]
        PxScale::from((em * f64::from(self.0.height_unscaled()) / unit) as f32)
    }

    /// Returns the width of a text.
    pub fn width(&self, text: &str, em: f64) -> f64 {
        let font = self.0.as_scaled(self.scale(em));
        text.chars().map(|c| f64::from(font.h_advance(font.glyph_id(c)))).sum()
    }

    /// Calls `ink(x, y, coverage)` for each pixel of a text that begins at the origin, `x` along
    /// the text and `y` downwards from the middle of the line.
    pub fn rasterise(&self, text: &str, em: f64, mut ink: impl FnMut(i32, i32, f64)) {
        let scale = self.scale(em);
        let font = self.0.as_scaled(scale);
        let mut pen = 0.0_f32;
        // Numbers of pixels are exact in f32.
        #[expect(clippy::cast_possible_truncation)]
        let baseline = (em * BASELINE) as f32;
        for c in text.chars() {
            let id = font.glyph_id(c);
            let glyph = id.with_scale_and_position(scale, point(pen, baseline));
            pen += font.h_advance(id);
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            #[expect(clippy::cast_possible_truncation)]
            let [left, top] = [corner.x as i32, corner.y as i32];
            outline.draw(|x, y, coverage| {
                let [x, y] = [x, y].map(|i| i32::try_from(i).unwrap_or(0));
                ink(left + x, top + y, f64::from(coverage));
            });
        }
    }
}

/// Returns the text cut to a width, with an ellipsis if it was cut.
pub fn fit(face: &Typeface, text: &str, em: f64, width: f64) -> String {
    if face.width(text, em) <= width {
        return text.to_owned();
    }
    let mut kept: String = text.to_owned();
    while !kept.is_empty() && face.width(&format!("{kept}…"), em) > width {
        kept.pop();
    }
    format!("{}…", kept.trim_end())
}

/// Returns the text in lines of at most a width, broken between words; a word that is wider is cut.
pub fn wrapped(face: &Typeface, text: &str, em: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if face.width(&format!("{line} {word}"), em) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fit(face, word, em, width)),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_of_the_plots_is_there() {
        let face = Typeface::load().expect("the font is sound");
        for c in "σ\u{302}τℓ±×·−≤≥√∫Σ∏⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars().filter(|&c| c != 'ℓ')
        {
            assert_ne!(face.0.glyph_id(c).0, 0, "{c}");
        }
    }

    #[test]
    fn a_long_text_is_wrapped_between_words() {
        let face = Typeface::load().expect("the font is sound");
        let text = "a long note that does not fit on one line of this width";
        let lines = wrapped(&face, text, 12.0, 120.0);
        assert!(lines.len() > 2 && lines.iter().all(|line| face.width(line, 12.0) <= 120.0));
        assert_eq!(lines.join(" "), text);
    }

    #[test]
    fn a_long_text_is_cut_to_its_width() {
        let face = Typeface::load().expect("the font is sound");
        let cut = fit(&face, "a very long title that has no place", 15.0, 100.0);
        assert!(cut.ends_with('…') && face.width(&cut, 15.0) <= 100.0);
        assert_eq!(fit(&face, "short", 15.0, 100.0), "short");
    }
}
