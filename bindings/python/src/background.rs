//! Work on a separate thread, while Python handles Ctrl-C and reports progress.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::error::Failure;

/// Interval at which Python checks for Ctrl-C.
const TICK: Duration = Duration::from_millis(50);

/// Progress of the work, and whether it is cancelled.
#[derive(Debug, Default)]
pub struct Progress {
    is_stopped: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

/// Payload that unwinds cancelled work.
struct Stopped;

impl Progress {
    /// Sets the number of draws to make.
    pub fn expect(&self, draws: u64) {
        self.total.store(draws, Ordering::Relaxed);
    }

    /// Adds draws. Cancelled work unwinds here without a panic: no hook is called.
    pub fn add(&self, draws: u64) {
        if self.is_stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
        self.done.fetch_add(draws, Ordering::Relaxed);
    }
}

/// Does work on `threads` threads, 0 for one per processor, without the GIL. `tell` is called with the draws made and
/// those expected. After Ctrl-C, or an exception of `tell`, it returns at once, and the work ends when it next adds
/// draws.
///
/// # Errors
///
/// The work's error, an exception of `tell`, or `KeyboardInterrupt`.
pub fn work<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    tell: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let progress = Arc::new(Progress::default());
    let theirs = Arc::clone(&progress);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let (sender, mut answers) = sync_channel(1);
    // The threads end with their pool, so that a later fork of the process has none.
    thread::spawn(move || {
        let answer = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&theirs))));
        // The receiver may be gone.
        let _ = sender.send(answer);
    });
    loop {
        let (back, answer) = py.detach(move || {
            let answer = answers.recv_timeout(TICK);
            (answers, answer)
        });
        answers = back;
        match answer {
            Ok(Ok(answer)) => {
                report(&progress, tell)?;
                return answer.map_err(PyErr::from);
            }
            Ok(Err(panic)) => return Err(PyRuntimeError::new_err(message(&*panic))),
            Err(RecvTimeoutError::Timeout) => {
                let heard = py.check_signals().and_then(|()| report(&progress, tell));
                if let Err(error) = heard {
                    progress.is_stopped.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the drawing ended without an answer"));
            }
        }
    }
}

/// Calls `tell` with the draws made and those expected.
fn report(progress: &Progress, tell: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    let [done, total] = [&progress.done, &progress.total].map(|n| n.load(Ordering::Relaxed));
    match tell {
        Some(tell) if total > 0 => tell.call1((done, total)).map(drop),
        _ => Ok(()),
    }
}

/// Returns the message of a panic.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    format!("a fault of trueflight itself: {}", text.unwrap_or_else(|| "no message".to_owned()))
}
