//! PNG with a palette: a third of the size without one, for sheets of few colours.

use std::collections::BTreeMap;

use crate::{Sheet, paint};

/// Maximum number of colours of a palette.
const MAX_COLOURS: usize = 256;

/// Returns a sheet as the bytes of a PNG file.
///
/// # Errors
///
/// Why it could not be painted.
pub fn png(sheet: &Sheet) -> Result<Vec<u8>, String> {
    let (rgb, size) = paint::pixels_of(sheet)?;
    encode(&rgb, size).map_err(|error| error.to_string())
}

/// Returns the bytes of a PNG file. Greys are rounded to every second one; if there are still more than 256 colours,
/// the file has no palette.
fn encode(rgb: &[u8], size: (u32, u32)) -> Result<Vec<u8>, png::EncodingError> {
    let coarse: Vec<[u8; 3]> =
        rgb.as_chunks::<3>().0.iter().map(|&colour| rounded(colour)).collect();
    let mut palette: BTreeMap<[u8; 3], usize> = BTreeMap::new();
    for &colour in &coarse {
        palette.entry(colour).or_insert(0);
        if palette.len() > MAX_COLOURS {
            return paint::encode(rgb, size, None);
        }
    }
    for (number, entry) in palette.values_mut().enumerate() {
        *entry = number;
    }
    let indices: Vec<u8> =
        coarse.iter().map(|colour| u8::try_from(palette[colour]).unwrap_or(u8::MAX)).collect();
    let colours: Vec<u8> = palette.keys().flatten().copied().collect();
    paint::encode(&indices, size, Some(colours))
}

fn rounded([red, green, blue]: [u8; 3]) -> [u8; 3] {
    let is_grey = red == green && green == blue;
    if is_grey { [red | 1; 3] } else { [red, green, blue] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colours(bytes: &[u8]) -> (png::ColorType, Vec<u8>) {
        let mut decoder = png::Decoder::new(bytes);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().expect("a PNG");
        let kind = reader.info().color_type;
        let mut pixels = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut pixels).expect("pixels");
        (kind, pixels)
    }

    #[test]
    fn few_colours_make_a_palette_and_stay_what_they_are() {
        let rgb = [255, 255, 255, 10, 20, 30, 1, 1, 1, 10, 20, 30];
        let (kind, pixels) = colours(&encode(&rgb, (2, 2)).expect("encodes"));
        assert_eq!((kind, &pixels[..]), (png::ColorType::Indexed, &rgb[..]));
    }

    #[test]
    fn many_colours_have_no_palette() {
        let rgb: Vec<u8> = (0..2).flat_map(|j| (0..150).flat_map(move |i| [i, j, 7])).collect();
        let (kind, pixels) = colours(&encode(&rgb, (300, 1)).expect("encodes"));
        assert_eq!((kind, pixels), (png::ColorType::Rgb, rgb));
    }
}
