//! Cases as scenes of other renderers, with the expected values of their pixels.
//!
//! ```text
//! case file → scene (what is rendered) → case.toml (the same field, for theory) → truth.json
//!                                      → scene files of the renderer
//! ```
//!
//! A renderer reads a field as samples in single precision. The truth in `truth.json` is that of these samples, read as
//! the renderer reads them, and not of the field that they were taken from. All numbers of a scene are rounded to
//! single precision before theory uses them.
//!
//! Files are made in a temporary folder and moved when all are complete.

mod fields;
mod mitsuba;
mod pbrt;
mod reading;
mod scene;
pub mod truth;

use std::fs;
use std::path::{Path, PathBuf};

use scene::ExportedScene;
use truth::Truth;

use crate::case::{CaseError, CaseText, Catalogue};
use media::files;

/// Renderer that scenes are written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// Mitsuba 3.
    Mitsuba,
    /// pbrt-v4.
    Pbrt,
}

impl Target {
    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mitsuba => "mitsuba",
            Self::Pbrt => "pbrt",
        }
    }

    /// Returns the border of its grids beyond their outermost samples, in words of `trueflight explain grid`.
    pub fn border(self) -> &'static str {
        match self {
            Self::Mitsuba => "clamp",
            Self::Pbrt => "zero",
        }
    }
}

/// Reason why a case was not exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The case file has mistakes.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The case has no mistakes, and the renderer cannot show it.
    #[error("{case} cannot be exported to {target}: {why}; {cure}")]
    Unsuitable {
        /// The case.
        case: String,
        /// The renderer.
        target: &'static str,
        /// Obstacle.
        why: String,
        /// Kind of case without it.
        cure: String,
    },
    /// Theory has no answer for the exported field.
    #[error("{case} cannot be exported: theory has no answer for the sampled field: {why}")]
    Unknown {
        /// The case.
        case: String,
        /// The reason.
        why: String,
    },
    /// `truth.json` could not be encoded.
    #[error("cannot encode truth.json: {0}")]
    Json(#[from] serde_json::Error),
    /// A file could not be written.
    #[error("cannot write {}; free some space or give another folder with --out", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}

/// Result of an export.
#[derive(Debug)]
pub struct Exported {
    /// The files, in the folder asked for.
    pub files: Vec<PathBuf>,
    /// Scenes and fields of an earlier export that are still there, and do not belong to this one.
    pub older: Vec<PathBuf>,
    /// Content of `truth.json`.
    pub truth: Truth,
}

/// Options of an export.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ExportOptions {
    /// Number of cells along the longest side of a field that is sampled. `None` stands for 32 in space and 256 along a
    /// line. A grid keeps its own.
    pub cells: Option<usize>,
    /// Exported channels, from 1, of a case with several: 1 to 3 of them, in this order; `None` for all.
    pub channels: Option<Vec<usize>>,
    /// True if a homogeneous medium is written as a heterogeneous one, to test how a renderer tracks through it.
    pub heterogeneous: bool,
}

/// Writes a case of a catalogue as a scene with a number of cells, and defaults for everything else.
///
/// # Errors
///
/// See [`export_with`].
pub fn export(
    catalogue: &Catalogue,
    source: &CaseText,
    target: Target,
    cells: Option<usize>,
    out: &Path,
) -> Result<Exported, ExportError> {
    export_with(
        catalogue,
        source,
        target,
        &ExportOptions { cells, ..ExportOptions::default() },
        out,
    )
}

/// Writes a case of a catalogue as a scene into a folder, which is created if it does not exist.
///
/// # Errors
///
/// The case has mistakes, the target cannot show it, theory does not know its answer, or a file cannot be written. No
/// file is left behind then.
pub fn export_with(
    catalogue: &Catalogue,
    source: &CaseText,
    target: Target,
    wishes: &ExportOptions,
    out: &Path,
) -> Result<Exported, ExportError> {
    let scene = reading::read(catalogue, source, target, wishes)?;
    let was_there = out.exists();
    let written = write(&scene, out);
    if written.is_err() && !was_there {
        // Removes the folder that was made for the files; an error here changes nothing.
        let _ = fs::remove_dir(out);
    }
    written
}

/// Writes a scene into a folder, completely or not at all.
fn write(scene: &ExportedScene, out: &Path) -> Result<Exported, ExportError> {
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| ExportError::Write { path, source }
    };
    fs::create_dir_all(out).map_err(io(out))?;
    let stage = tempfile::Builder::new().prefix(".trueflight-").tempdir_in(out).map_err(io(out))?;
    let mut names = Vec::new();
    let mut put = |name: String, bytes: &[u8]| {
        let written = fs::write(stage.path().join(&name), bytes).map_err(io(&out.join(&name)));
        names.push(name);
        written
    };
    let grids = scene.grids();
    if !grids.is_empty() {
        put(fields::FILE.into(), &fields::vol(&grids))?;
    }
    if grids.len() > 1 {
        for (channel, grid) in grids.iter().enumerate() {
            put(fields::file_of(channel), &fields::vol(&[grid]))?;
        }
    }
    put(truth::CASE.into(), truth::case(scene).as_bytes())?;
    let mut truth = truth::of(scene, &truth::ask(scene, stage.path())?);
    if scene.target == Target::Mitsuba {
        truth.notes.extend(truth::remark(scene, stage.path()));
    }
    for (view, channel) in scene.asked() {
        let name = scene.file(view, channel);
        if !truth.questions.iter().any(|question| question.scene == name) {
            continue;
        }
        let text = match (scene.target, channel) {
            // One scene has all channels.
            (Target::Mitsuba, Some(2..)) => continue,
            (Target::Mitsuba, _) => mitsuba::text(scene, view),
            (Target::Pbrt, Some(channel)) => {
                pbrt::text(&scene.of_channel(channel - 1), view, &name)
            }
            (Target::Pbrt, None) => pbrt::text(scene, view, &name),
        };
        put(name, text.as_bytes())?;
    }
    put(truth::FILE.into(), truth.json()?.as_bytes())?;
    let older = older(out, &names);
    move_all(stage.path(), out, &names)?;
    Ok(Exported { files: names.iter().map(|name| out.join(name)).collect(), older, truth })
}

/// Returns the files of an earlier export that this one does not replace.
fn older(out: &Path, names: &[String]) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(out) else { return Vec::new() };
    let is_old = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_scene = path.extension().is_some_and(|end| end == "xml" || end == "pbrt");
        let is_field = name.starts_with("density") && name.ends_with(".vol");
        (is_scene || is_field) && !names.iter().any(|own| *own == name)
    };
    let mut older: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    older.retain(is_old);
    older.sort();
    older
}

/// Moves complete files to their places; `truth.json`, which a client reads first, comes last.
fn move_all(stage: &Path, out: &Path, names: &[String]) -> Result<(), ExportError> {
    let io = |name: &String| {
        let path = out.join(name);
        move |source| ExportError::Write { path, source }
    };
    for name in names {
        files::writable(&out.join(name)).map_err(io(name))?;
    }
    for name in names {
        let bytes = fs::read(stage.join(name)).map_err(io(name))?;
        files::replace(&out.join(name), &bytes).map_err(io(name))?;
    }
    Ok(())
}

/// Returns the nearest number of single precision, with which renderers compute.
#[allow(clippy::cast_possible_truncation)] // that is what it is for
pub fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

impl ExportedScene {
    /// Returns the name of a scene file; that of one channel if there are several and pictures have none.
    fn file(&self, view: &scene::ExportedView, channel: Option<usize>) -> String {
        match (self.target, channel) {
            (Target::Mitsuba, _) => format!("{}.xml", view.name),
            (Target::Pbrt, None) => format!("{}.pbrt", view.name),
            (Target::Pbrt, Some(channel)) => format!("{}-{channel}.pbrt", view.name),
        }
    }

    /// Returns the questions: each picture, and each of its channels, from 1, if there are several.
    fn asked(&self) -> Vec<(&scene::ExportedView, Option<usize>)> {
        let channels: Vec<Option<usize>> = if self.is_coloured() {
            (1..=self.channels.len()).map(Some).collect()
        } else {
            vec![None]
        };
        let of_view = |view| channels.iter().map(move |channel| (view, *channel));
        self.views.iter().flat_map(of_view).collect()
    }
}
