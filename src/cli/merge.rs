//! `trueflight merge`: a run that many machines drew, judged.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::output::Format;
use super::verdict::Inconclusive;
use super::{Console, journal, run};
use crate::case::Catalogue;
use crate::draw::blocks::Blocks;
use crate::draw::share::{Header, Share, pieces};
use crate::draw::store::Store;
use crate::plan::Plan;
use crate::record::baseline::fingerprint;

/// Arguments of `merge`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The folders of all parts that `run --shard` has drawn
    #[arg(required = true, value_name = "PARTS")]
    parts: Vec<PathBuf>,
    /// Folder for what `run` writes
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
    /// What an inconclusive experiment counts as [default: exit code 3]
    #[arg(long, value_enum, value_name = "AS")]
    inconclusive: Option<Inconclusive>,
    /// Print every row, not only those that do not pass
    #[arg(long, short)]
    verbose: bool,
    /// Form of the rows on stdout; csv and json have all of them
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Reads the parts, and does with them what `run` does with its draws.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let mut files = Vec::new();
    for folder in &arguments.parts {
        let file = Blocks::open(&journal::path(folder)).with_context(|| {
            format!(
                "{} is no part; give the folders that `run --shard K/N --out` wrote",
                folder.display()
            )
        });
        files.push(file?);
    }
    let Some(header) = files.first().map(|file| file.header.clone()) else {
        bail!("there are no parts");
    };
    let faults = faults(&arguments.parts, &files, &header);
    if !faults.is_empty() {
        bail!("the parts are not one run:\n  {}", faults.join("\n  "));
    }
    let mut asked = run::Arguments::of(&header.words)?;
    asked.out.clone_from(&arguments.out);
    (asked.inconclusive, asked.format) = (arguments.inconclusive, arguments.format);
    asked.verbose = arguments.verbose;
    // What an earlier run has drawn is not asked.
    asked.fresh = true;
    run::judge(&asked, catalogue, console, |plan| {
        let own = Header::new(plan, &fingerprint()?, &header.words, None);
        if let Some(why) = header.mismatch(&own) {
            bail!("{} cannot be judged here: {why}", arguments.parts[0].display());
        }
        for (folder, file) in arguments.parts.iter().zip(&files) {
            if let Some(share) = file.header.share.filter(|&share| !has_all(plan, file, share)) {
                bail!("{} has other blocks than those of share {share}", folder.display());
            }
        }
        Ok(Store::parts(files))
    })
}

/// Everything that keeps parts from being one run.
fn faults(folders: &[PathBuf], files: &[Blocks], first: &Header) -> Vec<String> {
    let of = first.share.map_or(0, |share| share.of);
    let mut faults = Vec::new();
    let mut seen = BTreeMap::<u32, &Path>::new();
    for (folder, file) in folders.iter().zip(files) {
        let name = folder.display();
        let Some(share) = file.header.share else {
            faults.push(format!("{name} is an interrupted run, not a part of one"));
            continue;
        };
        if let Some(at) = file.damaged_at {
            let cure = journal::resume(folder);
            faults.push(format!(
                "{name} is torn or damaged at byte {at}; {cure} draws again what followed"
            ));
        } else if !file.is_finished {
            let (blocks, cure) = (file.len(), journal::resume(folder));
            faults.push(format!("{name} is not finished, it has {blocks} blocks; {cure} goes on"));
        }
        if let Some(why) = file.header.mismatch(first) {
            faults.push(format!("{name} is of another run than {}: {why}", folders[0].display()));
        }
        if share.of != of {
            faults.push(format!("{name} is part {share}, {} one of {of}", folders[0].display()));
        } else if let Some(other) = seen.insert(share.part, folder) {
            faults.push(format!("{name} and {} are both part {share}", other.display()));
        }
    }
    let given: BTreeSet<u32> = seen.keys().copied().collect();
    let missing = (1..=of).filter(|part| !given.contains(part));
    let missing: Vec<String> = missing.map(|part| format!("{part}/{of}")).collect();
    if !missing.is_empty() {
        faults.push(format!("missing: {}", missing.join(", ")));
    }
    faults
}

/// Whether a file has all blocks of its share, and no others.
fn has_all(plan: &Plan, file: &Blocks, share: Share) -> bool {
    let (mut blocks, mut missing) = (0_u64, 0);
    for piece in pieces(plan, share) {
        for &experiment in &piece.experiments {
            blocks += 1;
            missing += usize::from(!file.has((experiment, piece.block)));
        }
    }
    (blocks, missing) == (file.len(), 0)
}
