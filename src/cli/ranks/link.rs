//! Connection of a rank with the others.

use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::anyhow;

use super::Message;
use crate::cli::{USAGE, output};

/// Message of another rank, after its number.
pub type Received = (usize, Vec<u8>);

/// Task for the thread that carries messages.
#[derive(Debug)]
pub enum Outgoing {
    /// Carry a message to a rank.
    Message(usize, Vec<u8>),
    /// End all ranks with this exit code.
    Abort(u8),
    /// Leave the other ranks: nothing more is sent or received.
    Leave,
}

/// Joins the other ranks, or says why it cannot; `trueflight_mpi::join` in `bindings/mpi` does it by MPI.
pub type Join = fn() -> Result<Link, String>;

/// Two queues between this rank and a thread that carries its messages, which arrive in the order in which they are sent.
/// A link that is dropped while its thread panics ends all ranks: the others wait for its messages.
#[derive(Debug)]
pub struct Link {
    /// Number of this rank, from 0.
    pub rank: usize,
    /// Number of ranks.
    pub size: usize,
    outgoing: Sender<Outgoing>,
    incoming: Mutex<Receiver<Received>>,
    carrier: Option<JoinHandle<()>>,
}

impl Link {
    /// Connects rank `rank` of `size` by a thread that does the tasks of one queue and fills the other.
    pub fn new(
        rank: usize,
        size: usize,
        outgoing: Sender<Outgoing>,
        incoming: Receiver<Received>,
        carrier: JoinHandle<()>,
    ) -> Self {
        Self { rank, size, outgoing, incoming: Mutex::new(incoming), carrier: Some(carrier) }
    }

    /// Sends a message, and does not wait for it.
    pub(super) fn send(&self, to: usize, message: &Message) {
        // Every message can be encoded; a carrier that has ended is found by the next receiver.
        let bytes = postcard::to_stdvec(message).unwrap_or_default();
        let _ = self.outgoing.send(Outgoing::Message(to, bytes));
    }

    /// Waits for the next message, and returns it after the number of its rank.
    pub(super) fn receive(&self) -> (usize, Message) {
        let received = self.incoming.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let received = received.unwrap_or_else(|_| self.fail("cannot receive from other ranks"));
        self.decoded(received)
    }

    /// Returns the next message if it comes within this time.
    pub(super) fn receive_within(&self, time: Duration) -> Option<(usize, Message)> {
        let incoming = self.incoming.lock().unwrap_or_else(PoisonError::into_inner);
        Some(self.decoded(incoming.recv_timeout(time).ok()?))
    }

    fn decoded(&self, (from, bytes): Received) -> (usize, Message) {
        let message = postcard::from_bytes(&bytes).unwrap_or_else(|_| {
            self.fail(&format!(
                "cannot read a message of rank {from}: it is another version of this program"
            ))
        });
        (from, message)
    }

    /// Ends all ranks with an error message, so that none waits for ever.
    pub(super) fn fail(&self, why: &str) -> ! {
        output::complain(&anyhow!("rank {}: {why}", self.rank));
        let _ = self.outgoing.send(Outgoing::Abort(USAGE));
        // The carrier ends the process first.
        thread::sleep(Duration::from_secs(10));
        std::process::exit(USAGE.into())
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        /// Exit code of a process that panics.
        const PANICKED: u8 = 101;
        let last = if thread::panicking() { Outgoing::Abort(PANICKED) } else { Outgoing::Leave };
        let _ = self.outgoing.send(last);
        // A carrier that has panicked has nothing more to carry.
        let _ = self.carrier.take().map(JoinHandle::join);
    }
}
