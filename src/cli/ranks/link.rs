//! What this rank hears and says.

use std::collections::VecDeque;
use std::fmt::Debug;
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use anyhow::anyhow;
use serde::de::DeserializeOwned;

use crate::cli::{USAGE, output};

/// How long who waits for others sleeps, at first and at most: without that a processor would be busy, which is
/// needed to draw.
const NAPS: [Duration; 2] = [Duration::from_micros(50), Duration::from_millis(1)];

/// A message, and the rank that sent it.
pub type Heard = (usize, Vec<u8>);

/// Joins the other ranks, or says why it cannot; MPI's is `trueflight_mpi::join`, in `bindings/mpi`.
pub type Join = fn() -> Result<Arc<dyn Link>, String>;

/// This rank's place among the others. What one rank says to another arrives in the order in which it is said.
///
/// Many threads talk at once. The last owner lets go in the thread that joined, when all is said: ranks may wait for each
/// other there. A link that is dropped while its thread panics must end all ranks, for the others wait for what this one
/// owes them.
pub trait Link: Debug + Send + Sync {
    /// Its number, from 0.
    fn rank(&self) -> usize;

    /// How many there are.
    fn size(&self) -> usize;

    /// Sends a message; may wait until the other takes it.
    fn send(&self, to: usize, bytes: &[u8]);

    /// Sends one of at most so many messages that are on their way, and does not wait; not if it is too long for that,
    /// which the answer `false` tells.
    fn post(&self, to: usize, bytes: &[u8], most: usize) -> bool;

    /// As [`Self::send`]; what others send meanwhile is heard, for they may wait for that.
    fn send_and_hear(&self, to: usize, bytes: &[u8], heard: &mut VecDeque<Heard>);

    /// The next message, if there is one.
    fn hear(&self) -> Option<Heard>;

    /// Ends all ranks, with this exit code.
    fn abort(&self, code: u8) -> !;

    /// Tells all others that the drawing shall end.
    fn stop_others(&self);

    /// Whether another has said that the drawing shall end.
    fn is_stopped(&self) -> bool;
}

impl dyn Link + '_ {
    /// Waits for the next message: it comes, or all ranks are ended.
    pub(super) fn wait(&self) -> Heard {
        let mut naps = Naps::default();
        loop {
            if let Some(heard) = self.hear() {
                return heard;
            }
            naps.next();
        }
    }

    /// Ends all ranks, and says why, so that none waits for ever.
    pub(super) fn fail(&self, why: &str) -> ! {
        output::complain(&anyhow!("rank {}: {why}", self.rank()));
        self.abort(USAGE)
    }

    /// What a message says. One that cannot be read ends all ranks: it comes from another program.
    pub(super) fn read<T: DeserializeOwned>(&self, (from, bytes): &Heard) -> T {
        postcard::from_bytes(bytes).unwrap_or_else(|_| {
            self.fail(&format!(
                "cannot read what rank {from} says: it is another version of this program"
            ))
        })
    }
}

/// Naps that become longer.
#[derive(Debug, Default)]
pub struct Naps(Duration);

impl Naps {
    /// Lets others have the processor for a while.
    pub fn next(&mut self) {
        self.0 = (2 * self.0).clamp(NAPS[0], NAPS[1]);
        thread::sleep(self.0);
    }
}
