//! Alignment of the pixels of several files.
//!
//! An `OpenEXR` file stores the pixels of its data window, and states its place in the picture, the display window.
//! Files with the same data window are compared as they are stored. Where data windows differ, as after cropping to
//! what is not black, pixels are laid into the display window, which must then be the same: outside its data window a
//! file is 0, and pixels beyond the display window are left out.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::{ImageError, ending};
use media::files::Pixels;
use media::files::exr::{self, Window};

/// Headers are shorter than this, but for rare ones.
const HEAD: u64 = 1 << 16;

/// The most pixels of a frame: a small file may announce any display window.
const MOST: usize = 1 << 27;

/// The picture into which pixels are laid; none where files are compared as they are stored.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Frame(Option<Window>);

impl Frame {
    /// The frame of files that are compared with each other.
    ///
    /// # Errors
    ///
    /// Data windows differ, and so do display windows. Faults of a file are found when its pixels are read.
    pub fn of(paths: &[impl AsRef<Path>]) -> Result<Self, ImageError> {
        let windows = paths.iter().filter_map(|path| {
            let path = path.as_ref();
            Some((path, windows(path)?))
        });
        let windows: Vec<_> = windows.collect();
        let Some(((first, [data, display]), others)) = windows.split_first() else {
            return Ok(Self(None));
        };
        if others.iter().all(|(_, [other, _])| other == data) {
            return Ok(Self(None));
        }
        match others.iter().find(|(_, [_, other])| other != display) {
            None if display
                .size()
                .iter()
                .try_fold(1, |n: usize, &m| n.checked_mul(m))
                .is_some_and(|n| n <= MOST) =>
            {
                Ok(Self(Some(*display)))
            }
            None => Err(ImageError::Faulty {
                file: first.display().to_string(),
                what: "an image beside the others",
                cause: format!("its display window {display} has more than {MOST} pixels"),
                cure: "write all with one data window",
            }),
            Some((path, [data, other])) => Err(ImageError::Faulty {
                file: path.display().to_string(),
                what: "an image beside the others",
                cause: format!(
                    "its data window {data} lies in the display window {other}, and that of {} is {display}",
                    first.display()
                ),
                cure: "write all with one display window: pixels are not compared by their position in the file",
            }),
        }
    }

    /// The pixels of a data window in the frame.
    pub(super) fn laid(self, pixels: Pixels, data: Window) -> Pixels {
        let Self(Some(frame)) = self else { return pixels };
        let ([columns, rows], [width, height]) = (frame.size(), pixels.size);
        let channels = pixels.channels;
        // How far the data window begins to the right of the frame, and below it.
        let [right, below] =
            [0, 1].map(|axis| i64::from(data.low[axis]) - i64::from(frame.low[axis]));
        let mut values = vec![0.0; columns * rows * channels];
        for (row, line) in
            (0_i64..).zip(pixels.values.chunks_exact((width * channels).max(1)).take(height))
        {
            let Some(row) = usize::try_from(row + below).ok().filter(|&row| row < rows) else {
                continue;
            };
            for (column, pixel) in (0_i64..).zip(line.chunks_exact(channels)) {
                if let Some(column) = usize::try_from(column + right).ok().filter(|&c| c < columns)
                {
                    let first = (row * columns + column) * channels;
                    values[first..first + channels].copy_from_slice(pixel);
                }
            }
        }
        Pixels { size: [columns, rows], values, ..pixels }
    }
}

/// The data window and the display window of a picture; none of a file that has none, or that cannot be read.
fn windows(path: &Path) -> Option<[Window; 2]> {
    if ending(path).as_deref() != Some("exr") {
        return None;
    }
    let (mut file, mut bytes) = (File::open(path).ok()?, Vec::new());
    file.by_ref().take(HEAD).read_to_end(&mut bytes).ok()?;
    if exr::parts(&bytes).is_err() {
        file.read_to_end(&mut bytes).ok()?;
    }
    let parts = exr::parts(&bytes).ok()?;
    let first = parts.first()?;
    Some([first.data, first.display])
}
