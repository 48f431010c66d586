//! Ranks under `mpirun` for the command of `trueflight`: messages by MPI, which lets any thread talk, one at a time.
//!
//! A program with media and estimators of its own is drawn by ranks with
//! `fn main() -> ExitCode { trueflight::cli::main_among(&catalogue, trueflight_mpi::join) }`.

use std::collections::VecDeque;
use std::fmt::{self, Debug, Formatter};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use mpi::Threading;
use mpi::environment::Universe;
use mpi::request::scope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, MatchedReceiveVec, Source};
use trueflight::cli::ranks::{Heard, Link};

/// How many bytes may be on their way from a rank, so that it need not wait for others.
const ON_THEIR_WAY: usize = 64 << 20;

/// What is sent: a message, or the word that the drawing shall end.
const MESSAGE: i32 = 0;
const STOP: i32 = 1;

/// Joins the other ranks; all of them wait for each other where their links end.
///
/// # Errors
///
/// Where MPI cannot be begun, or lets one thread only talk.
pub fn join() -> Result<Arc<dyn Link>, String> {
    let joined = mpi::initialize_with_threading(Threading::Serialized);
    let (mut universe, threading) = joined.ok_or("cannot begin MPI")?;
    if threading < Threading::Serialized {
        return Err(
            "this MPI library lets one thread only talk: use one that was built with threads"
                .to_owned(),
        );
    }
    let world = universe.world();
    let (rank, size) = (number(world.rank()), number(world.size()));
    universe.set_buffer_size(ON_THEIR_WAY);
    let (turn, is_stopped) = (Mutex::new(()), AtomicBool::new(false));
    Ok(Arc::new(Joined { rank, size, turn, is_stopped, _universe: universe }))
}

/// This rank's place among the others.
struct Joined {
    rank: usize,
    size: usize,
    /// Who has it may talk.
    turn: Mutex<()>,
    is_stopped: AtomicBool,
    /// MPI, which ends with it.
    _universe: Universe,
}

impl Joined {
    fn talk(&self) -> (MutexGuard<'_, ()>, SimpleCommunicator) {
        (self.turn.lock().unwrap_or_else(PoisonError::into_inner), SimpleCommunicator::world())
    }
}

impl Link for Joined {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn send(&self, to: usize, bytes: &[u8]) {
        let (_turn, world) = self.talk();
        world.process_at_rank(named(to)).send_with_tag(bytes, MESSAGE);
    }

    fn post(&self, to: usize, bytes: &[u8], most: usize) -> bool {
        // MPI needs some room of its own for each.
        let is_short = bytes.len() + 1024 <= ON_THEIR_WAY / most;
        if is_short {
            let (_turn, world) = self.talk();
            world.process_at_rank(named(to)).buffered_send_with_tag(bytes, MESSAGE);
        }
        is_short
    }

    fn send_and_hear(&self, to: usize, bytes: &[u8], heard: &mut VecDeque<Heard>) {
        let (turn, world) = self.talk();
        scope(|scope| {
            let process = world.process_at_rank(named(to));
            let mut sending = process.immediate_send_with_tag(scope, bytes, MESSAGE);
            while let Err(open) = sending.test() {
                heard.extend(next(&world, MESSAGE));
                sending = open;
            }
        });
        drop(turn);
    }

    fn hear(&self) -> Option<Heard> {
        let (_turn, world) = self.talk();
        next(&world, MESSAGE)
    }

    fn abort(&self, code: u8) -> ! {
        SimpleCommunicator::world().abort(i32::from(code))
    }

    fn stop_others(&self) {
        let (_turn, world) = self.talk();
        for rank in (0..self.size).filter(|&rank| rank != self.rank) {
            world.process_at_rank(named(rank)).send_with_tag(&[0_u8; 0][..], STOP);
        }
    }

    fn is_stopped(&self) -> bool {
        if self.is_stopped.load(Ordering::Relaxed) {
            return true;
        }
        // Who finds others talking learns it the next time.
        let Ok(_turn) = self.turn.try_lock() else { return false };
        if next(&SimpleCommunicator::world(), STOP).is_some() {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
        self.is_stopped.load(Ordering::Relaxed)
    }
}

impl Drop for Joined {
    fn drop(&mut self) {
        if thread::panicking() {
            // Nobody shall wait for a rank that cannot go on.
            self.abort(101);
        }
        // MPI may end only when all that was sent has been received.
        while next(&SimpleCommunicator::world(), STOP).is_some() {}
    }
}

impl Debug for Joined {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "rank {} of {}", self.rank, self.size)
    }
}

/// What has come of a kind, if anything.
fn next(world: &SimpleCommunicator, kind: i32) -> Option<Heard> {
    let found = world.any_process().immediate_matched_probe_with_tag(kind)?;
    let (bytes, status) = found.matched_receive_vec::<u8>();
    Some((number(status.source_rank()), bytes))
}

fn number(rank: i32) -> usize {
    usize::try_from(rank).unwrap_or_default()
}

fn named(rank: usize) -> i32 {
    i32::try_from(rank).unwrap_or_default()
}
