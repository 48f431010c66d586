//! The file of blocks beside the results: begun, gone on with, and the signals that end its drawing.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use anyhow::{Context, bail};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::drawing::CACHE;
use super::output;
use crate::draw::blocks::{Blocks, Lock};
use crate::draw::share::Header;
use crate::draw::store::Store;
use crate::draw::workers::Workers;
use media::files;

/// What a process that a signal ends answers to its shell: 128 + SIGINT.
const INTERRUPTED: i32 = 130;

/// Where a run writes its record.
const RECORD: &str = "record.json";

/// Where a folder has its file of blocks.
pub fn path(folder: &Path) -> PathBuf {
    folder.join("blocks.bin")
}

/// The command that goes on with it.
pub fn resume(folder: &Path) -> String {
    format!("`{} run --resume {}`", output::program(), folder.display())
}

/// What the first Ctrl-C, or the first wish to terminate, sets; the second ends the process at once.
pub fn stop() -> anyhow::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // In this order: the first finds the flag not set yet.
        flag::register_conditional_shutdown(signal, INTERRUPTED, Arc::clone(&stop))
            .and_then(|_| flag::register(signal, Arc::clone(&stop)))
            .context("cannot listen to signals")?;
    }
    Ok(stop)
}

/// Begins a file where none is in the way, unless all is to be begun anew.
pub fn begin(
    folder: &Path,
    header: &Header,
    is_fresh: bool,
    workers: Box<dyn Workers>,
) -> anyhow::Result<Store> {
    let (path, lock) = (path(folder), Lock::take(folder)?);
    if path.exists() && !is_fresh {
        match Blocks::open(&path) {
            Ok(found) if found.is_finished => {
                bail!("{} holds a finished share; --fresh draws it anew", path.display())
            }
            Ok(_) => bail!(
                "{} holds the blocks of a run that was interrupted; go on with {}, or begin anew with --fresh",
                path.display(),
                resume(folder)
            ),
            Err(fault) => {
                return Err(fault)
                    .context("something is in the way; --fresh puts another in its place");
            }
        }
    }
    Ok(Store::journal(Blocks::create(&path, header, lock)?, workers, stop()?))
}

/// Goes on with the file of an interrupted run, if it is one of the same draws.
pub fn go_on(folder: &Path, header: &Header, workers: Box<dyn Workers>) -> anyhow::Result<Store> {
    let (path, lock) = (path(folder), Lock::take(folder)?);
    // Before anything that another program wrote is cut off.
    if let Some(why) = Blocks::open(&path)?.header.mismatch(header) {
        bail!("cannot go on with {}: {why}; begin anew with --fresh", path.display());
    }
    let file = Blocks::go_on(&path, lock)?;
    if let Some(at) = file.damaged_at {
        let path = path.display();
        output::warn(&format!(
            "{path} is torn or damaged at byte {at}: what followed is drawn again"
        ));
    }
    Ok(Store::journal(file, workers, stop()?))
}

/// Removes the file of a run whose results are written, when these are on the disk.
pub fn end(folder: &Path) -> anyhow::Result<()> {
    let path = path(folder);
    for name in [RECORD, CACHE] {
        files::synchronise(&folder.join(name));
    }
    fs::remove_file(&path).with_context(|| format!("cannot remove {}", path.display()))
}

/// What is known of the file of an interrupted run.
pub fn header(folder: &Path) -> anyhow::Result<Header> {
    let path = path(folder);
    if !path.exists() {
        bail!(
            "there is no {}: nothing was interrupted there, or it has been finished since",
            path.display()
        );
    }
    Ok(Blocks::open(&path)?.header)
}
