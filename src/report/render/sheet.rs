//! Sheet of a picture: the reference and every estimator's image, below each its error in false colour, and below that
//! its cost.

use super::{colour, given, short};
use crate::render::PictureRecord;
use crate::render::record::{Exposure, ExposureRecord};
use crate::report::plots::style::{DARK, FAINT, GREY};
use drawing::font::{self, Typeface, fit};
use drawing::sheet::{Align, Image, Sheet};

/// Number of units of the sheet per pixel of the file.
const FILE_PIXEL: f64 = 2.0 / 3.0;
/// Distance of images from each other and from the rim.
const GAP: f64 = 20.0;
/// Maximum number of images in a row, the reference among them.
const MAX_IMAGES: usize = 6;
/// Maximum number of lines of the caption.
const MAX_CAPTION_LINES: usize = 4;
/// Size of letters, and distance of lines.
const LETTER: f64 = 10.5;
const LINE: f64 = 15.0;

/// Place of a column of the sheet.
struct SheetColumn {
    left: f64,
    top: f64,
    size: [f64; 2],
}

/// Returns the sheet of a picture.
pub fn compose(record: &PictureRecord, face: &Typeface) -> Sheet {
    let count = record.exposures.len() + 1;
    // The smallest number of rows, of equal length.
    let bands = count.div_ceil(MAX_IMAGES);
    let across = count.div_ceil(bands);
    let [columns, rows] = record.size;
    // Small pictures are shown twice as large.
    let zoom = if columns <= 160 { 2.0 } else { 1.0 } * FILE_PIXEL;
    let size = [columns, rows].map(|n| n as f64 * zoom);
    // Corners on whole pixels of the file.
    let even = |x: f64| (x / 2.0).ceil() * 2.0;
    let step = even(size[0].max(150.0) + GAP);
    let room = step - GAP;
    let below = record.exposures.iter().map(|exposure| words(face, exposure, room).len());
    let lines = below.fold(4, usize::max);
    let band = even(2.0 * size[1] + 14.0 + lines as f64 * LINE + GAP);
    let width = GAP + across as f64 * step;
    let full = width - 2.0 * GAP;
    let facts = wrapped(face, &facts(record), full, 2);
    let caption = wrapped(face, &record.caption, full, MAX_CAPTION_LINES);
    let head = even(49.0 + LINE * (facts.len() + caption.len()) as f64);
    let mut sheet = Sheet::new(width, head + bands as f64 * band);
    let title = fit(face, &record.title, 16.0, full);
    sheet.text([GAP, 22.0], title, 16.0, DARK, Align::Start);
    let lines = facts.into_iter().map(|line| (line, GREY));
    let lines = lines.chain(caption.into_iter().map(|line| (line, DARK)));
    for (i, (line, colour)) in lines.enumerate() {
        sheet.text([GAP, 46.0 + LINE * i as f64], line, LETTER, colour, Align::Start);
    }
    for number in 0..count {
        let (row, column) = (number / across, number % across);
        let (left, top) = (GAP + column as f64 * step, head + row as f64 * band);
        let place = SheetColumn { left, top, size };
        match number.checked_sub(1) {
            None => reference(&mut sheet, face, record, &place, room),
            Some(index) => {
                exposure(&mut sheet, face, record, &record.exposures[index], &place, room);
            }
        }
    }
    sheet
}

fn facts(record: &PictureRecord) -> String {
    let [columns, rows] = record.size;
    format!(
        "{} in {}, {columns} × {rows} pixels; {} lookups for each of {} pixels that the volume covers; \
         {} empty pixels cost no lookup and no random number",
        record.problem, record.medium, record.budget, record.covered, record.empty
    )
}

fn reference(
    sheet: &mut Sheet,
    face: &Typeface,
    record: &PictureRecord,
    place: &SheetColumn,
    room: f64,
) {
    let SheetColumn { left, top, size } = *place;
    show(sheet, picture(record, &record.reference.image, [left, top], size));
    legend(sheet, record, place);
    let mut lines = wrapped(face, &format!("reference: {}", record.reference.how), room, 3);
    let finding = &record.reference;
    lines.push(format!("its RMS error {}", short(finding.error)));
    if finding.lookups > 0.0 {
        lines.push(format!("lookups/pixel {}", short(finding.lookups)));
    }
    write(sheet, place, &lines);
}

/// Draws the meaning of the colours of the errors, where the error of the reference would be.
fn legend(sheet: &mut Sheet, record: &PictureRecord, place: &SheetColumn) {
    let SheetColumn { left, top, size } = *place;
    let top = top + size[1] + 8.0;
    let (high, low) = (top + 26.0, top + size[1] - size[1].min(120.0) / 8.0);
    let strongest = number(record.strongest);
    let [maximum, minimum] = [format!("≥ {strongest}"), format!("≤ −{strongest}")];
    let marks = [(0.0, &*maximum), (0.5, "0"), (1.0, &*minimum)];
    colour::bar(sheet, [left + 20.0, high], low - high, (record.channels, &marks));
    let words = if record.channels > 1 { "by channel" } else { "image − reference" };
    sheet.text([left, top + 8.0], words, LETTER, DARK, Align::Start);
}

/// Returns a round number.
fn number(x: f64) -> String {
    if (1e-3..1e4).contains(&x) { format!("{x}") } else { format!("{x:e}") }
}

fn exposure(
    sheet: &mut Sheet,
    face: &Typeface,
    record: &PictureRecord,
    exposure: &ExposureRecord,
    place: &SheetColumn,
    room: f64,
) {
    let SheetColumn { left, top, size } = *place;
    match &exposure.outcome {
        Ok(finding) => {
            show(sheet, picture(record, &finding.image, [left, top], size));
            let below = [left, top + size[1] + 8.0];
            show(sheet, difference(record, &finding.image, below, size));
        }
        Err(reason) => {
            sheet.frame([left, top], size, FAINT);
            sheet.frame([left, top + size[1] + 8.0], size, FAINT);
            for (i, line) in wrapped(face, &format!("refused: {reason}"), size[0] - 16.0, 7)
                .into_iter()
                .enumerate()
            {
                let y = top + 20.0 + LINE * i as f64;
                sheet.text([left + 8.0, y], line, LETTER, DARK, Align::Start);
            }
        }
    }
    write(sheet, place, &words(face, exposure, room));
}

/// Returns the lines below an image.
fn words(face: &Typeface, exposure: &ExposureRecord, room: f64) -> Vec<String> {
    let mut lines = wrapped(face, &exposure.estimator.to_string(), room, 2);
    lines.extend(wrapped(face, &given(exposure), room, 2));
    lines.extend(exposure.outcome.iter().flat_map(costs));
    lines
}

fn costs(exposure: &Exposure) -> Vec<String> {
    let predicted = exposure.predicted_rmse.map(|rmse| format!(" (theory {})", short(rmse)));
    let merit = exposure.figure_of_merit.map_or("–".into(), short);
    let mut lines = vec![
        format!("RMSE {}{}", short(exposure.rmse), predicted.unwrap_or_default()),
        format!("lookups/pixel {}", short(exposure.lookups)),
        format!("draws/pixel {}", short(exposure.draws)),
        format!("figure of merit {merit}"),
    ];
    if exposure.pilots > 0.0 {
        lines.push(format!("pilot lookups/pixel {}", short(exposure.pilots)));
    }
    lines
}

fn write(sheet: &mut Sheet, place: &SheetColumn, lines: &[String]) {
    let SheetColumn { left, top, size } = *place;
    let first = top + 2.0 * size[1] + 8.0 + 14.0;
    for (i, line) in lines.iter().enumerate() {
        let at = [left, first + LINE * i as f64];
        sheet.text(at, line.as_str(), LETTER, DARK, Align::Start);
    }
}

/// Draws an image in a frame, without which a white one cannot be seen.
fn show(sheet: &mut Sheet, image: Image) {
    let (at, size) = (image.at, image.size);
    sheet.image(image);
    sheet.frame(at, size, FAINT);
}

fn picture(record: &PictureRecord, image: &[f64], at: [f64; 2], size: [f64; 2]) -> Image {
    let shown: Vec<f64> = image.iter().map(|x| x / record.white).collect();
    let pixels = shown.chunks_exact(record.channels).map(colour::radiance).collect();
    Image { at, size, columns: record.size[0], pixels }
}

fn difference(record: &PictureRecord, image: &[f64], at: [f64; 2], size: [f64; 2]) -> Image {
    let pairs = image.iter().zip(&record.reference.image);
    let apart: Vec<f64> = pairs.map(|(x, truth)| (x - truth) / record.strongest).collect();
    let pixels = apart.chunks_exact(record.channels).map(colour::difference).collect();
    Image { at, size, columns: record.size[0], pixels }
}

/// Returns a text in lines of a width; the last one is cut if the text is too long.
fn wrapped(face: &Typeface, text: &str, width: f64, maximum: usize) -> Vec<String> {
    let mut lines = font::wrapped(face, text, LETTER, width);
    if lines.len() > maximum {
        let rest = lines.split_off(maximum - 1).join(" ");
        lines.push(fit(face, &rest, LETTER, width));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_broken_at_spaces_and_cut_at_the_end() {
        let face = Typeface::load().expect("the font is sound");
        let text = "single (non-terminating, a=0.7) with a rather long explanation";
        let lines = wrapped(&face, text, 120.0, 2);
        assert_eq!(lines.len(), 2);
        assert!(lines[1].ends_with('…'), "{lines:?}");
        assert!(lines.iter().all(|line| face.width(line, LETTER) <= 120.0));
        assert_eq!(wrapped(&face, "short", 120.0, 2), ["short"]);
        assert!(wrapped(&face, "", 120.0, 2).is_empty());
    }
}
