//! Logs of the store beside the results: begun, resumed, ended; and the signals that end a drawing.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use anyhow::{Context, bail};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use super::output;
use crate::draw::share::Workers;
use crate::draw::store::{Header, Key, Log, Store, entry, lock};
use media::files;

/// Exit code of a process that a signal ends: 128 + SIGINT.
const INTERRUPTED: i32 = 130;

/// Returns the path of the blocks of a share or of an interrupted run in a folder.
pub fn blocks(folder: &Path) -> PathBuf {
    folder.join("blocks.bin")
}

/// Returns the path of the experiments that the runs of a folder have finished.
pub fn finished(folder: &Path) -> PathBuf {
    folder.join("draws.bin")
}

/// Returns the command that resumes the run of a folder.
pub fn resume(folder: &Path) -> String {
    format!("`{} run --resume {}`", output::program(), folder.display())
}

/// Opens a log, and reads its header.
pub fn open(folder: &Path) -> anyhow::Result<(Log, Header)> {
    let log = Log::open(&blocks(folder))?;
    let header = log.get(Key::Header)?.context("it has no header")?;
    Ok((log, header))
}

/// Reads the header of an interrupted run.
pub fn header(folder: &Path) -> anyhow::Result<Header> {
    let path = blocks(folder);
    if !path.exists() {
        bail!(
            "there is no {}: nothing was interrupted there, or it has been finished since",
            path.display()
        );
    }
    Ok(open(folder)?.1)
}

/// Begins a log, or resumes one of the same draws. An existing log of other draws is an error, unless the run is fresh.
pub fn store(
    folder: &Path,
    header: Header,
    is_resumed: bool,
    is_fresh: bool,
    workers: Box<dyn Workers>,
) -> anyhow::Result<Store> {
    let (path, lock) = (blocks(folder), lock(folder)?);
    if is_resumed {
        // This must come before frames of another program are cut off.
        if let Some(why) = open(folder)?.1.mismatch(&header) {
            bail!("cannot go on with {}: {why}; begin anew with --fresh", path.display());
        }
    } else {
        if path.exists() && !is_fresh {
            let (log, _) = open(folder)
                .context("something is in the way; --fresh puts another in its place")?;
            let (path, cure) = (path.display(), resume(folder));
            if log.has(Key::End) {
                bail!("{path} holds a finished share; --fresh draws it anew");
            }
            bail!(
                "{path} holds the blocks of a run that was interrupted; go on with {cure}, or begin anew with --fresh"
            );
        }
        Log::write(&path, [entry(Key::Header, &header)])?;
    }
    let log = Log::resume(&path, lock)?;
    if let Some(at) = log.damaged_at {
        let path = path.display();
        output::warn(&format!(
            "{path} is torn or damaged at byte {at}: what followed is drawn again"
        ));
    }
    Ok(Store::journal(header, log, workers, stop()?))
}

/// Returns a flag that the first Ctrl-C, or the first SIGTERM, sets; the second ends the process at once.
fn stop() -> anyhow::Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // This order matters: the first call must find the flag unset.
        flag::register_conditional_shutdown(signal, INTERRUPTED, Arc::clone(&stop))
            .and_then(|_| flag::register(signal, Arc::clone(&stop)))
            .context("cannot listen to signals")?;
    }
    Ok(stop)
}

/// Removes the blocks of a run once its results are on the disk.
pub fn end(folder: &Path) -> anyhow::Result<()> {
    for path in [folder.join("record.json"), finished(folder)] {
        files::synchronise(&path);
    }
    let path = blocks(folder);
    fs::remove_file(&path).with_context(|| format!("cannot remove {}", path.display()))
}
