//! Paints a sheet with a backend of plotters, as SVG and as PNG.

use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontFamily, FontStyle, FontTransform, RGBAColor, RGBColor, ShapeStyle,
    TextStyle,
};

use crate::report::plots::font::{FAMILY, Typeface};
use crate::report::plots::sheet::{Align, Image, Label, Shape, Sheet, Spot, strokes};

/// Units of a pixel in an SVG: backends take whole numbers.
pub const SVG_UNITS: u32 = 10;
/// Units of a pixel in a PNG: it is drawn at three times the size and each 2 × 2 block averaged, which smooths edges.
const PNG_UNITS: u32 = 3;

/// Largest distance of a coordinate from the sheet's corner, in units.
const FARTHEST: f64 = 1e6;

/// Returns the sheet as an SVG document.
///
/// # Errors
///
/// The backend fails, with its reason in words.
pub fn svg(sheet: &Sheet) -> Result<String, String> {
    let (mut text, units) = (String::new(), f64::from(SVG_UNITS));
    let size = pixels(sheet, SVG_UNITS);
    let mut backend = SVGBackend::with_string(&mut text, size);
    paint(sheet, &mut backend, units, false, |backend, label| {
        let style = text_style(label, units);
        backend.draw_text(&label.text, &style, whole(label.at, units)).map_err(in_words)
    })?;
    drop(backend);
    let text = with_dashes(&text, sheet)?;
    let text = with_defaults(&text);
    let drawn = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    let shown = format!("width=\"{}\" height=\"{}\"", size.0 / SVG_UNITS, size.1 / SVG_UNITS);
    Ok(text.replacen(&drawn, &shown, 1))
}

/// Removes attributes that plotters writes into every element: full opacity, which is the default, and the typeface,
/// which the first element sets for all.
fn with_defaults(text: &str) -> String {
    let face = format!(" font-family=\"{FAMILY}\"");
    let text = text.replace(" opacity=\"1\"", "").replace(&face, "");
    text.replacen("<svg", &format!("<svg{face}"), 1)
}

/// Adds dashes to an SVG document, which plotters does not write: each path is a `polyline`, in the order of the sheet.
fn with_dashes(text: &str, sheet: &Sheet) -> Result<String, String> {
    let paths = sheet.shapes.iter().filter_map(|shape| match shape {
        // Invisible shapes are not written.
        Shape::Path { colour, dash, .. } if colour.3 > 0.0 => Some(dash),
        _ => None,
    });
    let mut pieces = text.split("<polyline ");
    let mut dashed = pieces.next().unwrap_or_default().to_owned();
    let (mut paths, mut pieces) = (paths.fuse(), pieces.fuse());
    loop {
        match (paths.next(), pieces.next()) {
            (Some(dash), Some(piece)) => {
                dashed.push_str("<polyline ");
                if !dash.is_empty() {
                    let lengths = dash.iter().map(|length| natural(length * f64::from(SVG_UNITS)));
                    let lengths: Vec<String> = lengths.map(|length| length.to_string()).collect();
                    dashed = format!("{dashed}stroke-dasharray=\"{}\" ", lengths.join(","));
                }
                dashed.push_str(piece);
            }
            (None, None) => return Ok(dashed),
            _ => return Err("the SVG has another number of lines than the figure".to_owned()),
        }
    }
}

/// Returns the sheet as the bytes of a PNG file.
///
/// # Errors
///
/// The backend or the encoder fails, with its reason in words.
pub fn png(sheet: &Sheet) -> Result<Vec<u8>, String> {
    let (rgb, size) = pixels_of(sheet)?;
    encode(&rgb, size, None).map_err(in_words)
}

/// Returns red, green and blue of the sheet's pixels row by row, with width and height.
///
/// # Errors
///
/// The backend fails, with its reason in words.
pub fn pixels_of(sheet: &Sheet) -> Result<(Vec<u8>, (u32, u32)), String> {
    let face = Typeface::load().map_err(in_words)?;
    let (units, (width, height)) = (f64::from(PNG_UNITS), pixels(sheet, PNG_UNITS));
    let mut fine = vec![255; width as usize * height as usize * 3];
    let mut backend = BitMapBackend::with_buffer(&mut fine, (width, height));
    paint(sheet, &mut backend, units, true, |backend, label| {
        let mut answer = Ok(());
        write(&face, label, units, |at, colour| {
            if let Err(error) = backend.draw_pixel(at, colour.to_backend_color()) {
                answer = Err(in_words(error));
            }
        });
        answer
    })?;
    drop(backend);
    Ok((halved(&fine, width as usize), (width / 2, height / 2)))
}

/// Paints all shapes; with `cut` each dash of a line separately.
fn paint<B: DrawingBackend>(
    sheet: &Sheet,
    backend: &mut B,
    units: f64,
    cut: bool,
    mut text: impl FnMut(&mut B, &Label) -> Result<(), String>,
) -> Result<(), String> {
    let white = ShapeStyle::from(&plotters::style::WHITE).filled();
    let far = whole([sheet.width, sheet.height], units);
    backend.draw_rect((0, 0), far, &white, true).map_err(in_words)?;
    for shape in &sheet.shapes {
        match shape {
            Shape::Path { points, width, colour, dash } => {
                let stroke_width = natural(width * units).max(1);
                let style = ShapeStyle { color: *colour, filled: false, stroke_width };
                let dash = if cut { &dash[..] } else { &[] };
                for stroke in strokes(points, dash) {
                    backend.draw_path(distinct(&stroke, units), &style).map_err(in_words)?;
                }
            }
            Shape::Area { points, colour } => {
                let corners = points.iter().map(|&point| whole(point, units));
                backend.fill_polygon(corners, colour).map_err(in_words)?;
            }
            Shape::Disc { at, radius, colour } => {
                let radius = natural(radius * units);
                backend.draw_circle(whole(*at, units), radius, colour, true).map_err(in_words)?;
            }
            Shape::Text(label) => text(backend, label)?,
            Shape::Image(image) => show(backend, image, units)?,
        }
    }
    backend.present().map_err(in_words)
}

/// Paints every pixel as a rectangle; where they overlap the later one covers the earlier.
fn show<B: DrawingBackend>(backend: &mut B, image: &Image, units: f64) -> Result<(), String> {
    let rows = image.pixels.len() / image.columns.max(1);
    let corner = |column: usize, row: usize| {
        let share = [column as f64 / image.columns as f64, row as f64 / rows as f64];
        whole([0, 1].map(|i| image.at[i] + image.size[i] * share[i]), units)
    };
    for (i, &[red, green, blue]) in image.pixels.iter().enumerate() {
        let (column, row) = (i % image.columns, i / image.columns);
        let (low, high) = (corner(column, row), corner(column + 1, row + 1));
        let style = ShapeStyle::from(&RGBColor(red, green, blue)).filled();
        backend.draw_rect(low, high, &style, true).map_err(in_words)?;
    }
    Ok(())
}

/// Returns a path without repeated points, which would give a thick line no direction.
fn distinct(points: &[Spot], units: f64) -> Vec<(i32, i32)> {
    let mut path: Vec<_> = points.iter().map(|&point| whole(point, units)).collect();
    path.dedup();
    if let [(x, y)] = path[..] {
        path.push((x + 1, y));
    }
    path
}

fn text_style(label: &Label, units: f64) -> TextStyle<'_> {
    let h_pos = match label.align {
        Align::Start => HPos::Left,
        Align::Middle => HPos::Center,
        Align::End => HPos::Right,
    };
    // The backend writes size / 1.24 into the file, taking sizes for line heights.
    let size = label.size * units * 1.24;
    let font = FontDesc::new(FontFamily::Name(FAMILY), size, FontStyle::Normal);
    let turned = if label.upward { FontTransform::Rotate270 } else { FontTransform::None };
    TextStyle::from(font.transform(turned)).color(&label.colour).pos(Pos::new(h_pos, VPos::Center))
}

/// Writes letters by the typeface itself: plotters' own text ignores side bearings, which spoils spacing and puts the
/// hat of σ̂ beside it.
fn write(face: &Typeface, label: &Label, units: f64, mut ink: impl FnMut((i32, i32), RGBAColor)) {
    let em = label.size * units;
    let share = match label.align {
        Align::Start => 0.0,
        Align::Middle => 0.5,
        Align::End => 1.0,
    };
    let back = face.width(&label.text, em) * share / units;
    let [x, y] = label.at;
    let from = if label.upward { [x, y + back] } else { [x - back, y] };
    let (x0, y0) = whole(from, units);
    let colour = label.colour;
    face.rasterise(&label.text, em, |along, down, coverage| {
        let at = if label.upward { (x0 + down, y0 - along) } else { (x0 + along, y0 + down) };
        ink(at, colour.mix(coverage.clamp(0.0, 1.0)));
    });
}

fn halved(fine: &[u8], width: usize) -> Vec<u8> {
    let row = width * 3;
    let mut coarse = Vec::with_capacity(fine.len() / 4);
    for pair in fine.chunks_exact(2 * row) {
        let (upper, lower) = pair.split_at(row);
        for (up, low) in upper.chunks_exact(6).zip(lower.chunks_exact(6)) {
            for channel in 0..3 {
                let four = [up[channel], up[channel + 3], low[channel], low[channel + 3]];
                let sum: u16 = four.map(u16::from).iter().sum();
                coarse.push(u8::try_from((sum + 2) / 4).unwrap_or(u8::MAX));
            }
        }
    }
    coarse
}

/// Returns the bytes of a PNG file: red, green and blue of each pixel, or its index in a palette.
///
/// # Errors
///
/// The encoder fails.
pub fn encode(
    data: &[u8],
    (width, height): (u32, u32),
    palette: Option<Vec<u8>>,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_compression(png::Compression::Best);
    if let Some(palette) = palette {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
    } else {
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_adaptive_filter(png::AdaptiveFilterType::Adaptive);
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

/// Returns the size in units, even so that it can be halved.
fn pixels(sheet: &Sheet, units: u32) -> (u32, u32) {
    let even = |length: f64| natural(length / 2.0).max(1) * 2 * units;
    (even(sheet.width), even(sheet.height))
}

fn whole(at: Spot, units: f64) -> (i32, i32) {
    // Stops far outside of any sheet: figures clip to their panels long before, and the backend's differences of
    // coordinates still fit its integers.
    #[expect(clippy::cast_possible_truncation)]
    let round = |x: f64| (x * units).round().clamp(-FARTHEST, FARTHEST) as i32;
    (round(at[0]), round(at[1]))
}

fn natural(x: f64) -> u32 {
    // Saturates at zero and at the maximum, which no figure reaches.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let n = x.round() as u32;
    n
}

fn in_words(error: impl std::fmt::Display) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plots::style::DARK;

    #[test]
    fn what_lies_beyond_all_integers_is_painted() {
        let mut sheet = Sheet::new(40.0, 30.0);
        let far = [f64::MAX, f64::MIN, f64::INFINITY, f64::NAN, 1e300, -1e300];
        sheet.path(far.iter().zip(far.iter().rev()).map(|(&x, &y)| [x, y]).collect(), 2.0, DARK);
        sheet.area(vec![[-1e300, 0.0], [1e300, 0.0], [0.0, 1e300]], DARK);
        sheet.text([1e300, -1e300], "far", 12.0, DARK, Align::Start);
        assert!(svg(&sheet).is_ok() && png(&sheet).is_ok());
    }

    #[test]
    fn each_dashed_line_is_one_element() {
        let mut sheet = Sheet::new(40.0, 30.0);
        let line = |y: f64| vec![[0.0, y], [20.0, y], [40.0, y]];
        sheet.path(line(5.0), 2.0, DARK);
        sheet.dashed(line(10.0), &[9.0, 4.5], 2.0, DARK);
        sheet.dashed(line(15.0), &[2.5, 3.0], 2.0, DARK.mix(0.0));
        sheet.area(line(20.0), DARK);
        sheet.dashed(line(25.0), &[0.0, 9.0, 9.0, 0.0], 2.0, DARK);
        let svg = svg(&sheet).expect("painted");
        assert_eq!(svg.matches("<polyline ").count(), 3);
        assert_eq!(svg.matches("stroke-dasharray").count(), 2);
        let [solid, dashed, striped] = ["0,50 ", "0,100 ", "0,250 "].map(|begins| {
            let lines = || svg.lines().filter(|line| line.starts_with("<polyline"));
            lines().find(|line| line.contains(&format!("points=\"{begins}"))).expect("a line")
        });
        assert!(!solid.contains("dash"), "{solid}");
        assert!(dashed.contains("stroke-dasharray=\"90,45\""), "{dashed}");
        assert!(striped.contains("stroke-dasharray=\"0,90,90,0\""), "{striped}");
    }
}
