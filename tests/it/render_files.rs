//! Pictures as files: written files are read again, with the right orientation, by the readers of `judge --images`.

use exr::prelude::{ReadChannels, ReadLayers, read};
use trueflight::judge::images::files::picture;
use trueflight::judge::images::{Picture, Size};
use trueflight::render::record::PictureRecord;
use trueflight::report::render as report;

use crate::coloured_pictures::coloured;
use crate::render::{ball, found, rendered};

/// Returns a ball to the right and above the middle: from the top left, columns beyond 7 and rows up to 8.
fn record(size: usize) -> PictureRecord {
    rendered(&ball(size, 40.0).replace("centre = [0, 0, 0]", "centre = [1, 1, 0]"), 1)
}

fn written(record: &PictureRecord) -> tempfile::TempDir {
    let place = tempfile::TempDir::new().expect("a folder");
    let files = report::artifacts(record).expect("files");
    assert_eq!(files.len(), 1 + 2 * 3, "a sheet, and two files of the reference and of two images");
    assert!(trueflight::report::write(&files, place.path()).is_empty());
    place
}

fn singles(values: &[f64]) -> Vec<f64> {
    #[expect(clippy::cast_possible_truncation)] // as the formats do
    values.iter().map(|&x| f64::from(x as f32)).collect()
}

#[test]
fn both_formats_hold_the_image_with_its_right_at_the_right_and_its_top_at_the_top() {
    let record = record(16);
    let place = written(&record);
    let image = &found(&record, 1).image;
    for ending in ["pfm", "exr"] {
        let path = place.path().join(format!("test/2-ratio.{ending}"));
        let read: Picture = picture(&path).expect("a picture");
        assert_eq!(read.size(), Size { rows: 16, columns: 16, channels: 1 }, "{ending}");
        assert_eq!(read.values(), singles(image), "{ending}");
        let is_dark = |column: usize, row: usize| read.values()[16 * row + column] < 1.0;
        assert!(is_dark(11, 4), "{ending}: the ball is there");
        let outside = (0..16).flat_map(|i| (0..16).map(move |j| (i, j)));
        let mut outside = outside.filter(|&(i, j)| i < 7 || j > 8);
        assert!(!outside.any(|(i, j)| is_dark(i, j)), "{ending}: and nowhere else");
    }
}

#[test]
fn an_exr_has_the_standard_error_of_each_value_beside_it() {
    let record = record(48);
    let place = written(&record);
    let path = place.path().join("test/2-ratio.exr");
    let layers =
        read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = layers.all_attributes().from_file(path).expect("a picture");
    let channels = image.layer_data.channel_data.list;
    let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
    assert_eq!(names, ["Y", "standard_error.Y"]);
    let values =
        |at: usize| channels[at].sample_data.values_as_f32().map(f64::from).collect::<Vec<_>>();
    let exposure = found(&record, 1);
    assert_eq!(values(0), singles(&exposure.image));
    assert_eq!(values(1), singles(&exposure.errors));
    // Measured errors are as large as predicted ones, and pixels that are not covered are exact.
    let covered = record.covered as f64;
    let square = exposure.errors.iter().map(|x| x * x).sum::<f64>() / covered;
    let predicted = exposure.predicted_rmse.expect("theory").powi(2);
    assert!((square / predicted - 1.0).abs() < 0.2, "{square} for {predicted}");
    assert_eq!(exposure.errors.iter().filter(|&&x| x == 0.0).count(), record.empty);
}

#[test]
fn colours_are_three_channels_and_three_errors() {
    let record = rendered(&coloured(), 1);
    let files = report::artifacts(&record).expect("files");
    let file = files.iter().find(|file| file.path.ends_with("reference.exr")).expect("a file");
    let pixels = trueflight::files::exr::read(file.bytes.clone()).expect("a picture");
    assert_eq!((pixels.size, pixels.channels), ([32, 32], 3));
    assert_eq!(pixels.values, singles(&record.reference.image));
    let [red, green, blue] = pixels.values[3 * (16 * 32 + 16)..][..3] else { panic!("a pixel") };
    assert!(red > green && green > blue, "{red}, {green}, {blue}: red is thinnest");
    assert_eq!(pixels.values[..3], [1.0; 3], "the sky");
}
