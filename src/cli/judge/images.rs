//! `trueflight judge --images`: the gate over stacks of images.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::VerdictForm;
use crate::cli::{Console, USAGE, numbers, output};
use crate::judge::images::against::{Terms, compare};
use crate::judge::images::{Claim, ImageOptions, Judgement, Level, Stack, files, judge};
use crate::report::judge::images as report;
use crate::report::judge::junit::JUnitCase;
use media::formats::Format;
use numeric::digits::counted;

/// Options on images.
#[derive(Debug, Args)]
#[command(next_help_heading = "Images")]
pub struct Arguments {
    /// Judge images: the passes of a renderer, pixel by pixel
    #[arg(long, conflicts_with_all = ["case", "batch", "variance_tolerance", "column"])]
    #[arg(conflicts_with_all = ["lookups", "input", "stop_early", "draws"])]
    pub images: bool,
    /// Expected mean of each pixel: an image
    #[arg(long, value_name = "FILE", requires = "images", conflicts_with = "truth")]
    truth_image: Option<PathBuf>,
    /// The truth image is the mean of N independent passes, and has their error; needs a variance of one pass
    #[arg(long, value_name = "N", requires = "truth_image", conflicts_with = "case")]
    #[arg(value_parser = numbers::whole::<u32>(1..=u32::MAX), allow_negative_numbers = true)]
    truth_passes: Option<u32>,
    /// The variance of each pixel of one pass: an image
    #[arg(long, value_name = "FILE", requires = "images", conflicts_with = "variance")]
    variance_image: Option<PathBuf>,
    /// The variance is no exact one but the sample variance of N passes other than those judged: its error counts, and
    /// zeros, negative values and NaN in it are allowed
    #[arg(long, value_name = "N", requires = "images", conflicts_with = "case")]
    #[arg(value_parser = numbers::whole::<u32>(2..=u32::MAX), allow_negative_numbers = true)]
    variance_passes: Option<u32>,
    /// Estimate the variance from other passes of the same renderer: a stack (.npy), a folder with a pass in each file,
    /// or the option once for each file
    #[arg(long, value_name = "FILE", requires = "images")]
    #[arg(conflicts_with_all = ["case", "variance", "variance_image", "variance_passes"])]
    variance_stack: Vec<PathBuf>,
    /// Judge by a second stack instead of a truth: passes of a reference, noisy as they are; a stack (.npy), a folder,
    /// or the option once for each file
    #[arg(long, value_name = "FILE", requires = "images")]
    #[arg(conflicts_with_all = ["case", "truth", "truth_image", "truth_passes", "variance", "variance_image"])]
    #[arg(conflicts_with_all = ["variance_passes", "variance_stack", "kurtosis", "range"])]
    against: Vec<PathBuf>,
    /// Both stacks of --against have the same distribution in each pixel, not only the same mean: the exact test alone
    /// decides, and the variances must agree, too
    #[arg(long, requires = "against", conflicts_with = "case")]
    same_distribution: bool,
    /// Judge tiles of N × N pixels; 1 for single pixels [default: the smallest power of 2 with 2048 values of all
    /// passes; where the variance comes from passes 8192, and as many as their tails need]
    #[arg(long, value_name = "N", requires = "images")]
    #[arg(value_parser = numbers::whole::<u32>(1..=u32::MAX), allow_negative_numbers = true)]
    tile: Option<u32>,
    /// Judge averages of blocks of N × N pixels instead of pixels: with a filter that blends pixels, blocks wider than the
    /// filter are independent. All images are averaged; a variance must come from passes
    #[arg(long, value_name = "N", requires = "images", conflicts_with_all = ["case", "variance", "variance_image"])]
    #[arg(value_parser = numbers::whole::<u32>(1..=1 << 16), allow_negative_numbers = true)]
    average: Option<u32>,
    /// Write judgement.json, tiles.csv, z-map.png and p-values.png into a folder
    #[arg(long, value_name = "DIR", requires = "images")]
    out: Option<PathBuf>,
}

/// Error of images without anything to compare them with.
const MISSING: &str = "what the pixels should be is not known; give --truth T for all, an image by --truth-image FILE, or \
                       passes of a reference by --against FILE";

/// Reads, judges, writes, prints.
pub fn main(arguments: &super::Arguments, console: &Console) -> anyhow::Result<u8> {
    let images = &arguments.images;
    arguments.check_junit("images")?;
    images.out.iter().try_for_each(|out| output::can_write(out))?;
    if arguments.files.iter().any(|file| super::is_pipe(file)) {
        bail!("images are not read of a pipe; give files");
    }
    if arguments.truth.is_none() && images.truth_image.is_none() && images.against.is_empty() {
        bail!(MISSING);
    }
    // If a required option conflicts with another given option, clap does not enforce the requirement.
    if images.same_distribution && images.against.is_empty() {
        bail!("--same-distribution compares two stacks; give the second by --against");
    }
    if images.truth_passes.is_some() && images.truth_image.is_none() {
        bail!("--truth-passes says where a truth image is from; give it by --truth-image");
    }
    if images.variance_passes.is_some()
        && arguments.variance.is_none()
        && images.variance_image.is_none()
    {
        bail!(
            "--variance-passes says where a variance is from; give it by --variance-image or --variance"
        );
    }
    if let (Some(tolerance), true) = (arguments.tolerance, arguments.truth != Some(0.0)) {
        numbers::check_share("--tolerance", tolerance)?;
    }
    let options = ImageOptions {
        tile: images.tile.map(|tile| tile as usize),
        tolerance: arguments.tolerance,
        alpha: arguments.alpha,
    };
    let mut name = name(&arguments.files);
    if !images.against.is_empty() {
        name = format!("{name} against {}", self::name(&images.against));
    }
    let judgement = match judged(arguments, &options) {
        Ok(judgement) => judgement,
        Err(error) => {
            arguments.write_junit(&[], &[(name, format!("{error:#}"))])?;
            output::complain(&error);
            return Ok(USAGE);
        }
    };
    show(&judgement, &name, arguments, console)?;
    let mut errors = output::Errors::default();
    if let Some(out) = &images.out {
        let files = errors.write(report::artifacts(&judgement, &name), out);
        if let Some(files) =
            files.filter(|_| arguments.format == VerdictForm::Table && !console.quiet)
        {
            let page = out.join("z-map.png");
            let map = if files > 1 { format!("map: {}\n", page.display()) } else { String::new() };
            let files = counted(files as u64, "file");
            errors.keep(output::print(&format!("{files} in {}\n{map}", out.display())));
        }
    }
    errors.keep(arguments.write_junit(&[JUnitCase::of_images(&name, &judgement)], &[]));
    Ok(errors.close(arguments.code(judgement.verdict)))
}

/// Reads and judges.
fn judged(arguments: &super::Arguments, options: &ImageOptions) -> anyhow::Result<Judgement> {
    let images = &arguments.images;
    let judged_files = passes(&arguments.files)?;
    let (against, variance_stack) = (passes(&images.against)?, passes(&images.variance_stack)?);
    let beside = [&images.truth_image, &images.variance_image].into_iter().flatten();
    let all = judged_files.iter().chain(&against).chain(&variance_stack).chain(beside);
    let frame = files::Frame::of(&all.collect::<Vec<_>>())?;
    let block = images.average.and_then(|block| NonZeroUsize::new(block as usize));
    let read = |paths: &[PathBuf]| -> anyhow::Result<Stack> {
        let stack = files::stack_in(paths, frame)?;
        Ok(match block {
            Some(block) => stack.averaged(block),
            None => stack,
        })
    };
    if !against.is_empty() {
        let stack = read(&judged_files)?;
        let reference = read(&against)?;
        let terms =
            Terms { is_same_distribution: images.same_distribution, rounding: arguments.rounding };
        return Ok(compare(&stack, &reference, terms, options)?);
    }
    let level = |value: Option<f64>, image: &Option<PathBuf>| match (value, image) {
        (Some(value), _) => Ok(Some(Level::All(value))),
        (None, Some(path)) => files::picture_in(path, frame).map(|picture| {
            Some(Level::Each(match block {
                Some(block) => picture.averaged(block),
                None => picture,
            }))
        }),
        (None, None) => Ok(None),
    };
    let variance_stack = match &*variance_stack {
        [] => None,
        paths => Some(read(paths)?),
    };
    let truth = level(arguments.truth, &images.truth_image)?.context(MISSING)?;
    let claim = Claim {
        truth,
        truth_passes: images.truth_passes.map(|passes| passes as usize),
        variance: level(arguments.variance, &images.variance_image)?,
        variance_passes: images.variance_passes.map(|passes| passes as usize),
        variance_stack,
        kurtosis: arguments.kurtosis,
        range: arguments.range,
        rounding: arguments.rounding,
    };
    Ok(judge(&read(&judged_files)?, &claim, options)?)
}

/// Returns the files of a stack; those of a folder in the order of their names.
fn passes(paths: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    if let Some(missing) = paths.iter().find(|path| !path.exists()) {
        bail!("{}: there is no such file or folder; give another", missing.display());
    }
    let folder = match paths {
        [folder] if folder.is_dir() => folder,
        _ => {
            if let Some(folder) = paths.iter().find(|path| path.is_dir()) {
                bail!(
                    "{}: a folder beside other files; give one folder with all passes, or the files themselves",
                    folder.display()
                );
            }
            return Ok(paths.to_vec());
        }
    };
    let entries =
        std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>).with_context(
            || format!("{}: cannot be listed; give a folder that can be read", folder.display()),
        )?;
    let is_image = |path: &PathBuf| Format::of(path).is_some_and(files::is_image);
    let mut finding: Vec<PathBuf> =
        entries.into_iter().map(|entry| entry.path()).filter(is_image).collect();
    finding.sort();
    if finding.is_empty() {
        bail!(
            "{}: a folder without images ({}); give one with a pass in each file",
            folder.display(),
            Format::list(files::is_image)
        );
    }
    Ok(finding)
}

/// Returns the name of the first of several files, with their number.
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
        VerdictForm::Table if console.quiet => Ok(()),
        VerdictForm::Table => {
            output::print(&report::console::block(judgement, name, output::pen(console).width))
        }
        VerdictForm::Json => output::print(&report::json(judgement)?),
    }
}
