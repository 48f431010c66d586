//! Ranks under `mpirun` for the command `trueflight`: one thread carries their messages by MPI.
//!
//! A program with media and estimators of its own shares its draws among ranks with
//! `fn main() -> ExitCode { trueflight::cli::main_among(&catalogue, trueflight_mpi::join) }`.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use mpi::Threading;
use mpi::request::scope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, MatchedReceiveVec, Source};
use trueflight::cli::ranks::{Link, Outgoing, Received};

/// Shortest and longest sleep of the carrier while no message comes: without it the carrier would take a processor from the
/// threads that draw.
const MIN_SLEEP: Duration = Duration::from_micros(50);
const MAX_SLEEP: Duration = Duration::from_millis(1);

/// Joins the other ranks; all of them wait for each other at the end of their links.
///
/// # Errors
///
/// MPI cannot be initialised.
pub fn join() -> Result<Link, String> {
    let ((outgoing, tasks), (received, incoming)) = (channel(), channel());
    let (told, joined) = channel();
    // One thread initialises, uses and ends MPI.
    let carrier = thread::spawn(move || {
        if let Some((universe, _)) = mpi::initialize_with_threading(Threading::Funneled) {
            let world = universe.world();
            // The thread that joins waits for it.
            let _ = told.send((number(world.rank()), number(world.size())));
            carry(&world, &tasks, &received);
        }
    });
    let (rank, size) = joined.recv().map_err(|_| "cannot begin MPI")?;
    Ok(Link::new(rank, size, outgoing, incoming, carrier))
}

/// Carries messages until the rank leaves.
fn carry(world: &SimpleCommunicator, tasks: &Receiver<Outgoing>, received: &Sender<Received>) {
    let mut sleep = MIN_SLEEP;
    loop {
        sleep = if receive(world, received) { MIN_SLEEP } else { MAX_SLEEP.min(2 * sleep) };
        match tasks.recv_timeout(sleep) {
            Ok(Outgoing::Message(to, bytes)) => scope(|scope| {
                let process = world.process_at_rank(to.try_into().unwrap_or_default());
                let mut sending = process.immediate_send(scope, &bytes[..]);
                // The other rank may itself wait until its message is taken.
                while let Err(open) = sending.test() {
                    if !receive(world, received) {
                        thread::sleep(MIN_SLEEP);
                    }
                    sending = open;
                }
            }),
            Ok(Outgoing::Abort(code)) => world.abort(code.into()),
            Ok(Outgoing::Leave) | Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
}

/// Receives all messages that have come, and returns whether there were any.
fn receive(world: &SimpleCommunicator, received: &Sender<Received>) -> bool {
    let next = || world.any_process().immediate_matched_probe();
    let mut is_any = false;
    while let Some(message) = next() {
        let (bytes, status) = message.matched_receive_vec::<u8>();
        // A rank without a receiver is about to leave.
        let _ = received.send((number(status.source_rank()), bytes));
        is_any = true;
    }
    is_any
}

fn number(rank: i32) -> usize {
    usize::try_from(rank).unwrap_or_default()
}
