//! Cases as scenes of other renderers: their files, their truth, and refusals.

mod colours;
mod field;
mod pbrt;
mod refusals;
mod scenes;

use std::path::PathBuf;

use crate::common::case_file;
use tempfile::TempDir;
use trueflight::case::CaseText;
use trueflight::export::{self, ExportError, Exported, Target};

/// Returns a case of the repository.
fn source(name: &str) -> CaseText {
    CaseText::read(&case_file(name)).expect("a case")
}

/// Exported case and its folder.
struct Scene {
    folder: TempDir,
    exported: Exported,
}

impl Scene {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect("a text")
    }
}

/// Exports a case of the repository.
fn scene(name: &str, target: Target, cells: Option<usize>) -> Result<Scene, ExportError> {
    let folder = tempfile::tempdir().expect("a folder");
    let exported = export::export(
        &trueflight::Catalogue::builtin(),
        &source(name),
        target,
        cells,
        folder.path(),
    )?;
    Ok(Scene { folder, exported })
}

/// Cases, one of every kind that is exported.
const CASES: &[&str] = &[
    "transmittance/eq21-overview",
    "transmittance/grid-trilinear-centres",
    "furnace/eq21",
    "furnace/grid",
    "furnace/known-bugs",
    "slab/known-bugs",
    "single-scattering/grid",
    "single-scattering/known-bugs",
    "ball/black-light",
];
