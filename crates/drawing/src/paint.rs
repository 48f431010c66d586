//! Paints a sheet as pixels, with the raster backend of plotters.

use plotters::backend::{BitMapBackend, DrawingBackend};
use plotters::style::{Color, RGBAColor, RGBColor, ShapeStyle};

use crate::font::Typeface;
use crate::sheet::{Align, Image, Label, Shape, Sheet, Spot, strokes};

/// Units of the fine raster per unit of the sheet. Blocks of 2 × 2 are averaged, which smooths edges: a PNG has 1.5 pixels a unit.
const UNITS: f64 = 3.0;
/// Largest distance of a coordinate from the sheet's corner, in units.
const MAX_COORDINATE: f64 = 1e6;

/// Returns the sheet as the bytes of a PNG file.
///
/// # Errors
///
/// Why it could not be painted.
pub fn png(sheet: &Sheet) -> Result<Vec<u8>, String> {
    let (rgb, size) = pixels_of(sheet)?;
    encode(&rgb, size, None).map_err(in_words)
}

/// Returns red, green and blue of the sheet's pixels row by row, with width and height.
///
/// # Errors
///
/// Why it could not be painted.
pub fn pixels_of(sheet: &Sheet) -> Result<(Vec<u8>, (u32, u32)), String> {
    let face = Typeface::load().map_err(in_words)?;
    let [width, height] = [sheet.width, sheet.height].map(even);
    let mut fine = vec![255; width as usize * height as usize * 3];
    let mut backend = BitMapBackend::with_buffer(&mut fine, (width, height));
    for shape in &sheet.shapes {
        paint(&mut backend, &face, shape)?;
    }
    backend.present().map_err(in_words)?;
    drop(backend);
    Ok((halved(&fine, width as usize), (width / 2, height / 2)))
}

fn paint(backend: &mut BitMapBackend, face: &Typeface, shape: &Shape) -> Result<(), String> {
    match shape {
        Shape::Path { points, width, colour, dash } => {
            let stroke_width = natural(width * UNITS).max(1);
            let style = ShapeStyle { color: *colour, filled: false, stroke_width };
            let mut strokes = strokes(points, dash).into_iter();
            strokes
                .try_for_each(|stroke| backend.draw_path(distinct(&stroke), &style))
                .map_err(in_words)
        }
        Shape::Area { points, colour } => {
            // Of the type that paths have within plotters, too.
            let points = points.iter().map(|&point| whole(point));
            backend.fill_polygon(points, &colour.to_backend_color()).map_err(in_words)
        }
        Shape::Disc { at, radius, colour } => {
            let (radius, colour) = (natural(radius * UNITS), colour.to_backend_color());
            backend.draw_circle(whole(*at), radius, &colour, true).map_err(in_words)
        }
        Shape::Text(label) => write(backend, face, label),
        Shape::Image(image) => show(backend, image),
    }
}

/// Paints every pixel as a rectangle; where they overlap the later one covers the earlier.
fn show(backend: &mut BitMapBackend, image: &Image) -> Result<(), String> {
    for ([low, .., high, _], RGBAColor(red, green, blue, _)) in image.cells() {
        let colour = RGBColor(red, green, blue).to_backend_color();
        backend.draw_rect(whole(low), whole(high), &colour, true).map_err(in_words)?;
    }
    Ok(())
}

/// Returns a path without repeated points, which would give a thick line no direction.
fn distinct(points: &[Spot]) -> Vec<(i32, i32)> {
    let mut path: Vec<_> = points.iter().map(|&point| whole(point)).collect();
    path.dedup();
    if let [(x, y)] = path[..] {
        path.push((x + 1, y));
    }
    path
}

/// Writes letters by the typeface itself: plotters' own text ignores side bearings, which spoils spacing and puts the
/// hat of σ̂ beside it.
fn write(backend: &mut BitMapBackend, face: &Typeface, label: &Label) -> Result<(), String> {
    let em = label.size * UNITS;
    let share = match label.align {
        Align::Start => 0.0,
        Align::Middle => 0.5,
        Align::End => 1.0,
    };
    let back = face.width(&label.text, em) * share / UNITS;
    let [x, y] = label.at;
    let from = if label.upward { [x, y + back] } else { [x - back, y] };
    let (x0, y0) = whole(from);
    let colour = label.colour;
    let mut answer = Ok(());
    face.rasterise(&label.text, em, |along, down, coverage| {
        let at = if label.upward { (x0 + down, y0 - along) } else { (x0 + along, y0 + down) };
        let ink = colour.mix(coverage.clamp(0.0, 1.0)).to_backend_color();
        if let Err(error) = backend.draw_pixel(at, ink) {
            answer = Err(in_words(error));
        }
    });
    answer
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
/// The data does not fit the size.
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

/// Returns a length in units, even so that it can be halved.
fn even(length: f64) -> u32 {
    natural(length / 2.0).max(1) * 2 * natural(UNITS)
}

fn whole(at: Spot) -> (i32, i32) {
    // Stops far outside of any sheet: figures clip to their panels long before, and the backend's differences of
    // coordinates still fit its integers.
    #[expect(clippy::cast_possible_truncation)]
    let round = |x: f64| (x * UNITS).round().clamp(-MAX_COORDINATE, MAX_COORDINATE) as i32;
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
    /// Colour.
    const DARK: RGBAColor = RGBAColor(34, 34, 34, 1.0);

    #[test]
    fn points_beyond_all_integers_are_painted() {
        let mut sheet = Sheet::new(40.0, 30.0);
        let far = [f64::MAX, f64::MIN, f64::INFINITY, f64::NAN, 1e300, -1e300];
        sheet.path(far.iter().zip(far.iter().rev()).map(|(&x, &y)| [x, y]).collect(), 2.0, DARK);
        sheet.area(vec![[-1e300, 0.0], [1e300, 0.0], [0.0, 1e300]], DARK);
        sheet.text([1e300, -1e300], "far", 12.0, DARK, Align::Start);
        assert!(png(&sheet).is_ok());
    }
}
