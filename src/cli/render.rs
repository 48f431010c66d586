//! `trueflight render`: pictures of estimators side by side.

use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::bail;
use clap::Args;

use super::selection::{Seed, Threads};
use super::{Console, output};
use crate::case::{CaseError, Catalogue};
use crate::render::{self, Picture, PictureRecord};
use crate::report::{self, Artifact};
use media::catalogue::OwnPages;
use numeric::digits::counted;

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Picture files, or names of built-in pictures (`trueflight list pictures`); without any, all of these
    #[arg(value_name = "PICTURES")]
    pictures: Vec<String>,
    /// Folder; the sheets, gallery.csv, report.html and a folder of PFM and EXR images for each picture go to gallery/ in it
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    threads: Threads,
}

/// Renders, writes, prints.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let pictures = read(&arguments.pictures, catalogue.own_pages(), console)?;
    let out = arguments.out.join("gallery");
    // A folder that cannot be written to is reported before the rendering, not after it.
    output::can_write(&out)?;
    let rows = pictures.iter().map(|picture| 2 * picture.rows() as u64).sum();
    let bar = output::progress("rendering", "rows", rows, console);
    let mut records = Vec::new();
    for picture in &pictures {
        let begin = Instant::now();
        let render = || Ok(picture.render(arguments.seed.seed, &|| bar.inc(1)));
        let record = arguments.threads.install(render)?;
        if let Some(reason) = record.refusal() {
            bail!("{}: {reason}", picture.name);
        }
        let files = report::render::artifacts(&record)?;
        output::write(&files, &out)?;
        if !console.quiet {
            let text = table(&record, begin.elapsed().as_secs_f64());
            bar.suspend(|| output::print(&text))?;
        }
        // The sheet is the first of a picture's files.
        let sheet = files.into_iter().next().map(|file| file.bytes).unwrap_or_default();
        records.push((record, sheet));
    }
    bar.finish_and_clear();
    let page = Artifact::text("report.html", report::render::html::text(&records));
    let rows = report::render::csv(records.iter().map(|(record, _)| record))?;
    output::write(&[Artifact::text("gallery.csv", rows), page], &out)?;
    if !console.quiet {
        let page = output::report_in(&out);
        let pictures = counted(records.len() as u64, "picture");
        output::print(&format!("{pictures} in {}\n{page}", out.display()))?;
    }
    Ok(0)
}

fn read(names: &[String], own: &OwnPages, console: &Console) -> anyhow::Result<Vec<Picture>> {
    let read: Vec<Result<Picture, CaseError>> = if names.is_empty() {
        render::gallery().iter().map(|source| Picture::read(source, own)).collect()
    } else {
        names.iter().map(|name| Picture::open(name, own)).collect()
    };
    let (mut pictures, mut errors) = (Vec::<Picture>::new(), Vec::new());
    for picture in read {
        match picture {
            Ok(picture) if pictures.iter().any(|other| other.name == picture.name) => {
                bail!("two pictures are called {}; rename one, or render them apart", picture.name);
            }
            Ok(picture) => pictures.push(picture),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() {
        return Ok(pictures);
    }
    Err(output::mistakes(&errors, console, ["picture file", "nothing was rendered"]))
}

fn table(record: &PictureRecord, seconds: f64) -> String {
    let PictureRecord { covered, empty, .. } = record;
    let mut text = format!(
        "{}  {seconds:.1} s\n  {covered} pixels are covered; {empty} are empty and cost nothing\n  \
         reference: {}, RMS error {}\n",
        record.title,
        record.reference.how,
        report::render::short(record.reference.error)
    );
    for exposure in &record.exposures {
        let _ = match &exposure.outcome {
            Ok(result) => writeln!(
                text,
                "  {:<40} RMSE {:<9} theory {:<9} lookups/pixel {:<7} draws/pixel {:<7} fom {}",
                exposure.estimator.to_string(),
                report::render::short(result.rmse),
                result.predicted_rmse.map_or("–".into(), report::render::short),
                report::render::short(result.lookups),
                report::render::short(result.draws),
                result.figure_of_merit.map_or("–".into(), report::render::short),
            ),
            Err(reason) => {
                writeln!(text, "  {:<40} refused: {reason}", exposure.estimator.to_string())
            }
        };
    }
    text.push('\n');
    text
}
