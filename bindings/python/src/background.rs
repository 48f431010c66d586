//! Work on a thread of its own, while Python looks for Ctrl-C and tells how far it is.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::trouble::Trouble;

/// How often Python looks for Ctrl-C.
const TICK: Duration = Duration::from_millis(50);

/// How far the work is, and whether anybody still wants it.
#[derive(Debug, Default)]
pub struct Progress {
    is_stopped: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

/// What ends work that nobody wants any more.
struct Stopped;

impl Progress {
    /// Tells how many draws there are to make.
    pub fn expect(&self, draws: u64) {
        self.total.store(draws, Ordering::Relaxed);
    }

    /// Tells of more draws. If nobody wants them it unwinds, which is no panic: no hook hears of it.
    pub fn add(&self, draws: u64) {
        if self.is_stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
        self.done.fetch_add(draws, Ordering::Relaxed);
    }
}

/// Does work on so many threads, 0 for one per processor, without the GIL. `tell` is called with the draws made and
/// those expected. After Ctrl-C, or an exception of `tell`, it returns at once, and the work ends when it next tells
/// of draws.
///
/// # Errors
///
/// That of the work or of `tell`, or `KeyboardInterrupt`.
pub fn work<T: Send + 'static>(
    py: Python<'_>,
    threads: usize,
    tell: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T, Trouble> + Send + 'static,
) -> PyResult<T> {
    let progress = Arc::new(Progress::default());
    let theirs = Arc::clone(&progress);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    let (sender, mut answers) = sync_channel(1);
    // A pool of its own: the threads end with it, so that a fork of the process later on finds none.
    thread::spawn(move || {
        let answer = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&theirs))));
        // Nobody may be waiting any more.
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

/// What a panic said.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    format!("a fault of trueflight itself: {}", text.unwrap_or_else(|| "no message".to_owned()))
}
