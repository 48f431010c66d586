//! What this rank hears and says. MPI lets any thread talk, one at a time.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::{Context, anyhow, bail};
use mpi::Threading;
use mpi::environment::Universe;
use mpi::request::scope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, MatchedReceiveVec, Source};
use serde::de::DeserializeOwned;

use crate::cli::{USAGE, output};

/// How long who waits for others sleeps, at first and at most: MPI itself would keep a processor busy, which is
/// needed to draw.
const NAPS: [Duration; 2] = [Duration::from_micros(50), Duration::from_millis(1)];

/// How many bytes may be on their way from a rank, so that it need not wait for others.
const ON_THEIR_WAY: usize = 64 << 20;

/// What is sent: a message, or the word that the drawing shall end.
const MESSAGE: i32 = 0;
const STOP: i32 = 1;

/// This rank's place among the others.
#[derive(Debug)]
pub struct Link {
    /// Its number, from 0.
    pub rank: usize,
    /// How many there are.
    pub size: usize,
    /// Who has it may talk.
    turn: Mutex<()>,
    is_stopped: AtomicBool,
}

/// A message, and the rank that sent it.
pub type Heard = (usize, Vec<u8>);

/// Joins the others, who must not be left before [`Universe`] is.
///
/// # Errors
///
/// Where MPI cannot be begun, or lets one thread only talk.
pub fn join() -> anyhow::Result<(Universe, Link)> {
    let joined = mpi::initialize_with_threading(Threading::Serialized);
    let (mut universe, threading) = joined.context("cannot begin MPI")?;
    if threading < Threading::Serialized {
        bail!("this MPI library lets one thread only talk: use one that was built with threads");
    }
    let world = universe.world();
    let (rank, size) = (number(world.rank()), number(world.size()));
    universe.set_buffer_size(ON_THEIR_WAY);
    let (turn, is_stopped) = (Mutex::new(()), AtomicBool::new(false));
    Ok((universe, Link { rank, size, turn, is_stopped }))
}

impl Link {
    /// Sends a message, and waits until the other takes it.
    pub fn send(&self, to: usize, bytes: &[u8]) {
        let (_turn, world) = self.talk();
        world.process_at_rank(named(to)).send_with_tag(bytes, MESSAGE);
    }

    /// Sends one of at most so many messages that are on their way, and does not wait; not if it is too long for that.
    pub fn post(&self, to: usize, bytes: &[u8], most: usize) -> bool {
        // MPI needs some room of its own for each.
        let is_short = bytes.len() + 1024 <= ON_THEIR_WAY / most;
        if is_short {
            let (_turn, world) = self.talk();
            world.process_at_rank(named(to)).buffered_send_with_tag(bytes, MESSAGE);
        }
        is_short
    }

    /// As [`Self::send`]; what others send meanwhile is heard, for they may wait for that.
    pub fn send_and_hear(&self, to: usize, bytes: &[u8], heard: &mut VecDeque<Heard>) {
        let (turn, world) = self.talk();
        scope(|scope| {
            let process = world.process_at_rank(named(to));
            let mut sending = process.immediate_send_with_tag(scope, bytes, MESSAGE);
            while let Err(open) = sending.test() {
                heard.extend(next(&world));
                sending = open;
            }
        });
        drop(turn);
    }

    /// The next message, if there is one.
    pub fn hear(&self) -> Option<Heard> {
        let (_turn, world) = self.talk();
        next(&world)
    }

    /// Waits for the next message: it comes, or MPI ends this process.
    pub fn wait(&self) -> Heard {
        let mut naps = Naps::default();
        loop {
            if let Some(heard) = self.hear() {
                return heard;
            }
            naps.next();
        }
    }

    /// Ends all ranks, and says why, so that none waits for ever.
    pub fn abort(&self, why: &str) -> ! {
        output::complain(&anyhow!("rank {}: {why}", self.rank));
        SimpleCommunicator::world().abort(i32::from(USAGE))
    }

    /// What a message says. One that cannot be read ends all ranks: it comes from another program.
    pub fn read<T: DeserializeOwned>(&self, (from, bytes): &Heard) -> T {
        postcard::from_bytes(bytes).unwrap_or_else(|_| {
            self.abort(&format!(
                "cannot read what rank {from} says: it is another version of this program"
            ))
        })
    }

    /// Tells all others that the drawing shall end.
    pub fn stop_others(&self) {
        let (_turn, world) = self.talk();
        for rank in (0..self.size).filter(|&rank| rank != self.rank) {
            world.process_at_rank(named(rank)).send_with_tag(&[0_u8; 0][..], STOP);
        }
    }

    /// Whether another has said that the drawing shall end.
    pub fn is_stopped(&self) -> bool {
        if self.is_stopped.load(Ordering::Relaxed) {
            return true;
        }
        // Who finds others talking learns it the next time.
        let Ok(_turn) = self.turn.try_lock() else { return false };
        let told = SimpleCommunicator::world().any_process().immediate_probe_with_tag(STOP);
        self.is_stopped.store(told.is_some(), Ordering::Relaxed);
        told.is_some()
    }

    fn talk(&self) -> (MutexGuard<'_, ()>, SimpleCommunicator) {
        (self.turn.lock().unwrap_or_else(PoisonError::into_inner), SimpleCommunicator::world())
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        if thread::panicking() {
            // Nobody shall wait for a rank that cannot go on.
            SimpleCommunicator::world().abort(101);
        }
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

fn next(world: &SimpleCommunicator) -> Option<Heard> {
    let found = world.any_process().immediate_matched_probe_with_tag(MESSAGE)?;
    let (bytes, status) = found.matched_receive_vec::<u8>();
    Some((number(status.source_rank()), bytes))
}

fn number(rank: i32) -> usize {
    usize::try_from(rank).unwrap_or_default()
}

fn named(rank: usize) -> i32 {
    i32::try_from(rank).unwrap_or_default()
}
