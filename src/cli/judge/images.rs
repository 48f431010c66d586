//! `trueflight judge --images`: the gate over stacks of images.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::Shown;
use crate::cli::{Console, USAGE, numbers, output};
use crate::judge::images::{Claim, Judgement, Level, Wanted, files, judge};
use crate::report::judge::images as report;
use crate::report::judge::junit::Told;

/// What concerns images alone.
#[derive(Debug, Args)]
#[command(next_help_heading = "Images")]
pub struct Arguments {
    /// Judge images: the passes of a renderer, pixel by pixel
    #[arg(long, conflicts_with_all = ["case", "kurtosis", "batch", "variance_tolerance", "column"])]
    #[arg(conflicts_with_all = ["lookups", "input", "stop_early", "draws"])]
    pub images: bool,
    /// What the mean of each pixel should be: an image
    #[arg(long, value_name = "FILE", requires = "images", conflicts_with = "truth")]
    truth_image: Option<PathBuf>,
    /// The variance of each pixel of one pass: an image
    #[arg(long, value_name = "FILE", requires = "images", conflicts_with = "variance")]
    variance_image: Option<PathBuf>,
    /// Judge tiles of N × N pixels; 1 for single pixels [default: the least power of 2 with 2048
    /// values of all passes]
    #[arg(long, value_name = "N", requires = "images")]
    #[arg(value_parser = numbers::whole::<u32>(1..=u32::MAX), allow_negative_numbers = true)]
    tile: Option<u32>,
    /// Write judgement.json, tiles.csv and z-map.png into a folder
    #[arg(long, value_name = "DIR", requires = "images")]
    out: Option<PathBuf>,
}

/// Reads, judges, writes, prints.
pub fn main(arguments: &super::Arguments, console: &Console) -> anyhow::Result<u8> {
    let images = &arguments.images;
    arguments.check_junit("images")?;
    if let Some(out) = &images.out {
        output::writable(out)?;
    }
    let beside = [&images.truth_image, &images.variance_image].into_iter().flatten();
    let all: Vec<&PathBuf> = arguments.files.iter().chain(beside).collect();
    let frame = files::Frame::of(&all)?;
    let level = |value: Option<f64>, image: &Option<PathBuf>| match (value, image) {
        (Some(value), _) => Ok(Some(Level::All(value))),
        (None, Some(path)) => files::picture_in(path, frame).map(Level::Each).map(Some),
        (None, None) => Ok(None),
    };
    let claim = Claim {
        truth: level(arguments.truth, &images.truth_image)?
            .context("give --truth or --truth-image")?,
        variance: level(arguments.variance, &images.variance_image)?,
        range: arguments.range,
        rounding: arguments.rounding,
    };
    let wanted = Wanted {
        tile: images.tile.map(|tile| tile as usize),
        tolerance: arguments.tolerance,
        alpha: arguments.alpha,
    };
    if arguments.files.iter().any(|file| super::is_pipe(file)) {
        bail!("images are not read of a pipe; give files");
    }
    let name = name(&arguments.files);
    let judgement = match files::stack_in(&arguments.files, frame)
        .and_then(|stack| judge(&stack, &claim, &wanted))
    {
        Ok(judgement) => judgement,
        Err(error) => {
            arguments.write_junit(&[], &[(name, error.to_string())])?;
            output::complain(&error.into());
            return Ok(USAGE);
        }
    };
    show(&judgement, &name, arguments, console)?;
    let mut errors = output::Errors::default();
    if let Some(out) = &images.out {
        errors.write(report::artifacts(&judgement, &name), out);
    }
    errors.keep(arguments.write_junit(&[Told::of_images(&name, &judgement)], &[]));
    Ok(errors.close(arguments.code(judgement.verdict)))
}

/// The first of several files with how many there are.
fn name(files: &[PathBuf]) -> String {
    let first = files.first().map_or(Path::new(""), PathBuf::as_path).display();
    match files.len() {
        0 | 1 => first.to_string(),
        more => format!("{first} and {} others", more - 1),
    }
}

fn show(
    judgement: &Judgement,
    name: &str,
    arguments: &super::Arguments,
    console: &Console,
) -> anyhow::Result<()> {
    match arguments.format {
        Shown::Table if console.quiet => Ok(()),
        Shown::Table => {
            output::print(&report::console::block(judgement, name, output::pen(console).width))
        }
        Shown::Json => output::print(&(serde_json::to_string_pretty(judgement)? + "\n")),
    }
}
