//! Formats of files and the endings of their names: one table for volumes, images, draws and `trueflight inspect`.
//!
//! A new format is a line here, a file with its reader, and an arm where it is read: [`crate::grid_file::reader`] for grids,
//! `judge::images::files` for images, `judge::files` for draws.

use std::path::Path;

macro_rules! formats {
    ($($(#[$about:meta])* $Format:ident: $($ending:literal)*,)*) => {
        /// A format of files.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Format {
            $($(#[$about])* $Format,)*
        }

        impl Format {
            /// All formats.
            pub const ALL: &'static [Self] = &[$(Self::$Format),*];

            /// Endings of the names of its files, in lower case and with the point. The first is the usual one.
            pub fn endings(self) -> &'static [&'static str] {
                match self {
                    $(Self::$Format => &[$($ending),*],)*
                }
            }
        }
    };
}

formats! {
    /// A grid of Mitsuba.
    Vol: ".vol",
    /// An array of `NumPy`.
    Npy: ".npy",
    /// Grids of `OpenVDB`.
    Vdb: ".vdb",
    /// Grids of `NanoVDB`.
    Nvdb: ".nvdb",
    /// A scene file of pbrt.
    Pbrt: ".pbrt",
    /// An image of `OpenEXR`.
    Exr: ".exr",
    /// A portable float map.
    Pfm: ".pfm",
    /// A table of text, columns separated by commas.
    Table: ".csv" ".txt",
    /// Little-endian float64.
    Doubles: ".f64" ".bin" ".raw",
    /// Little-endian float32.
    Singles: ".f32",
}

impl Format {
    /// Returns the format of a file's ending, in upper or lower case.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        let has = |known: &&str| known[1..].eq_ignore_ascii_case(ending);
        Self::ALL.iter().copied().find(|format| format.endings().iter().any(has))
    }

    /// Returns the usual ending, as in `.vdb`.
    pub fn ending(self) -> &'static str {
        self.endings()[0]
    }

    /// Lists the endings of some formats, as in `.vdb, .nvdb and .pbrt`.
    pub fn list(is_wanted: impl Fn(Self) -> bool) -> String {
        let expected = Self::ALL.iter().copied().filter(|format| is_wanted(*format));
        let endings: Vec<&str> = expected.flat_map(Self::endings).copied().collect();
        match endings.split_last() {
            Some((last, [])) => (*last).to_owned(),
            Some((last, others)) => format!("{} and {last}", others.join(", ")),
            None => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_stand_for_formats() {
        let of = |path: &str| Format::of(Path::new(path));
        assert_eq!(of("a/draws.CSV"), Some(Format::Table));
        assert_eq!(of("draws.txt"), Some(Format::Table));
        assert_eq!(of("draws.v2.npy"), Some(Format::Npy));
        for path in ["x.f64", "x.bin", "x.raw"] {
            assert_eq!(of(path), Some(Format::Doubles));
        }
        assert_eq!(of("draws"), None);
        assert_eq!(of("draws.npz"), None);
    }

    #[test]
    fn lists_name_every_ending() {
        assert_eq!(Format::list(|format| format == Format::Vol), ".vol");
        assert_eq!(Format::list(|format| format == Format::Table), ".csv and .txt");
        assert_eq!(Format::list(|_| false), "");
        let all = Format::list(|_| true);
        assert_eq!(all.matches('.').count(), 13, "{all}");
    }
}
