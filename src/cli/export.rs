//! `trueflight export`: a case as a scene of another renderer, with the expected values of its pixels.

use std::fmt::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::help::Names;
use super::{Console, numbers, output};
use crate::case::catalogue::source;
use crate::case::{CaseError, Catalogue};
use crate::export::{self, ExportError, ExportOptions, Target};

/// Arguments of `export`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A case file, or the name of a built-in case
    #[arg(value_name = "CASE", value_parser = Names::Cases, hide_possible_values = true)]
    case: String,
    /// Renderer of the scene
    #[arg(long, value_enum, value_name = "RENDERER")]
    to: Renderer,
    /// Folder for the scene, its field, truth.json and case.toml
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Cells along the longest side of a field that is sampled [default: 32 in space, 256 along a line]
    #[arg(long, value_name = "N", value_parser = numbers::whole::<u16>(2..=512), allow_negative_numbers = true)]
    cells: Option<u16>,
    /// Channels of a case that has several, from 1 and at most three, such as 1,3 [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = numbers::whole::<u16>(1..=8), allow_negative_numbers = true)]
    channels: Option<Vec<u16>>,
    /// Write a homogeneous medium as a heterogeneous one, to test how Mitsuba tracks through it
    #[arg(long)]
    heterogeneous: bool,
}

/// Renderer that a scene is written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Renderer {
    /// Mitsuba 3
    Mitsuba,
    /// pbrt-v4
    Pbrt,
}

/// Writes the scene, and prints the expected values of its pixels.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let name = &arguments.case;
    let source = source(name);
    let target = match arguments.to {
        Renderer::Mitsuba => Target::Mitsuba,
        Renderer::Pbrt => Target::Pbrt,
    };
    let channels = arguments.channels.as_ref();
    let wishes = ExportOptions {
        cells: arguments.cells.map(usize::from),
        channels: channels.map(|list| list.iter().copied().map(usize::from).collect()),
        heterogeneous: arguments.heterogeneous,
    };
    let exported = source.map_err(ExportError::Case).and_then(|source| {
        export::export_with(catalogue, &source, target, &wishes, &arguments.out)
    });
    let exported = match exported {
        Ok(exported) => exported,
        Err(ExportError::Case(error @ CaseError::Faulty { .. })) => {
            return Err(output::mistakes(&[error], console, ["case file", "nothing was written"]));
        }
        Err(error) => return Err(error.into()),
    };
    if console.quiet {
        return Ok(0);
    }
    let mut text = String::new();
    for question in &exported.truth.questions {
        let export::truth::ExpectedSamples { name, scene, mean, error, .. } = question;
        let _ = writeln!(text, "{scene}: {name} {mean} ± {error:.1e}");
    }
    for note in &exported.truth.notes {
        let _ = writeln!(text, "note: {note}");
    }
    for file in &exported.older {
        let _ = writeln!(
            text,
            "note: {} is of an earlier export, and does not belong to this one",
            file.display()
        );
    }
    let _ = writeln!(text, "{} files in {}", exported.files.len(), arguments.out.display());
    output::print(&text)?;
    Ok(0)
}
