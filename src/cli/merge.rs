//! `trueflight merge` and `trueflight report`: verdicts on a run that many machines drew, and the page of a stored one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::output::{self, Errors};
use super::reports::Reports;
use super::run::{self, RUN, ResumeArguments};
use super::{Console, journal};
use crate::case::Catalogue;
use crate::draw::share;
use crate::draw::store::{Header, Key, Log, Store};
use crate::plan::Plan;
use crate::record::baseline::fingerprint;
use crate::report::run::{html, record_json};

/// Arguments of `merge`.
#[derive(Debug, Args)]
pub struct Merge {
    /// The folders of all parts that `run --shard` has drawn
    #[arg(required = true, value_name = "PARTS")]
    parts: Vec<PathBuf>,
    #[command(flatten)]
    reports: Reports,
}

/// Reads the parts, and treats them as `run` treats its draws.
pub fn merge(arguments: &Merge, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let mut parts = Vec::new();
    for folder in &arguments.parts {
        let no_part = || {
            format!(
                "{} is no part; give the folders that `run --shard K/N --out` wrote",
                folder.display()
            )
        };
        let (log, header) = journal::open(folder).with_context(no_part)?;
        parts.push(RunPart { folder, log, header });
    }
    let faults = faults(&parts);
    if !faults.is_empty() {
        bail!("the parts are not one run:\n  {}", faults.join("\n  "));
    }
    let header = parts[0].header.clone();
    let mut requested = run::Arguments::of(&header.words)?.requested;
    requested.reports = arguments.reports.clone();
    // Draws of an earlier run are not a part.
    run::judge(&requested, RUN, &ResumeArguments::FRESH, catalogue, console, |plan| {
        let own = Header::new(plan, &fingerprint()?, &header.words, None);
        if let Some(why) = header.mismatch(&own) {
            bail!("{} cannot be judged here: {why}", arguments.parts[0].display());
        }
        if let Some(part) = parts.iter().find(|part| !part.has_all(plan, &own.keys())) {
            bail!("{} has other blocks than those of its share", part.folder.display());
        }
        Ok(Store::shares(own, parts.into_iter().map(|part| part.log).collect()))
    })
}

/// Part of a run: its folder and content.
struct RunPart<'a> {
    folder: &'a Path,
    log: Log,
    header: Header,
}

impl RunPart<'_> {
    /// Returns whether it has all blocks of its share, and no others.
    fn has_all(&self, plan: &Plan, keys: &[u64]) -> bool {
        let names = self.header.share.into_iter().flat_map(|share| share::blocks(plan, share));
        let mut keys = names.map(|(one, block)| Key::Block(keys[one as usize], block));
        let mut blocks = 0;
        let has_key = |key| {
            blocks += 1;
            self.log.has(key)
        };
        keys.all(has_key) && blocks == self.log.blocks(None)
    }
}

/// Returns all reasons why parts cannot be one run.
fn faults(parts: &[RunPart]) -> Vec<String> {
    let Some(first) = parts.first() else { return vec!["there are no parts".to_owned()] };
    let of = first.header.share.map_or(0, |share| share.of);
    let mut faults = Vec::new();
    let mut seen = BTreeMap::<u32, &Path>::new();
    for RunPart { folder, log, header } in parts {
        let (name, cure) = (folder.display(), journal::resume(folder));
        let Some(share) = header.share else {
            faults.push(format!("{name} is an interrupted run, not a part of one"));
            continue;
        };
        if let Some(at) = log.damaged_at {
            faults.push(format!(
                "{name} is torn or damaged at byte {at}; {cure} draws again what followed"
            ));
        } else if !log.has(Key::End) {
            let blocks = log.blocks(None);
            faults.push(format!("{name} is not finished, it has {blocks} blocks; {cure} goes on"));
        }
        if let Some(why) = header.mismatch(&first.header) {
            let first = first.folder.display();
            faults.push(format!("{name} is of another run than {first}: {why}"));
        }
        if share.of != of {
            let first = first.folder.display();
            faults.push(format!("{name} is part {share}, {first} one of {of}"));
        } else if let Some(other) = seen.insert(share.part, folder) {
            faults.push(format!("{name} and {} are both part {share}", other.display()));
        }
    }
    let missing = (1..=of).filter(|part| !seen.contains_key(part));
    let missing: Vec<String> = missing.map(|part| format!("{part}/{of}")).collect();
    if !missing.is_empty() {
        faults.push(format!("missing: {}", missing.join(", ")));
    }
    faults
}

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct Report {
    /// Folder with the record.json of a run; the page is written beside it
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Reads a record, and writes its page.
pub fn report(arguments: &Report, console: &Console) -> anyhow::Result<u8> {
    let folder = &arguments.folder;
    let path = folder.join("record.json");
    let text = std::fs::read(&path).with_context(|| {
        format!(
            "cannot read {}; give the folder that `trueflight run --out DIR` wrote",
            path.display()
        )
    })?;
    let record = record_json::read(&text).with_context(|| {
        format!("{}: make it anew with `trueflight run --out DIR`", path.display())
    })?;
    if journal::blocks(folder).exists() {
        let cure = journal::resume(folder);
        output::warn(&format!(
            "the run in {} is not finished: the page is of what was judged; {cure} goes on",
            folder.display()
        ));
    }
    let mut errors = Errors::default();
    let written = errors.write(html::render(&record), folder);
    if written.is_some_and(|files| files > 0) && !console.quiet {
        errors.keep(output::print(&format!("{}\n", folder.join("report.html").display())));
    }
    Ok(errors.close(0))
}
