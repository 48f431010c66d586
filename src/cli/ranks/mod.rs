//! One run drawn by many processes, the ranks that `mpirun` has begun.
//!
//! ```text
//! rank 0   plans, deals pieces to all ranks and to itself, keeps and merges their blocks, looks, judges, writes
//! others   plan the same, and draw the pieces that rank 0 deals
//! ```
//!
//! Blocks are found by their addresses and merged in that order, so that results do not depend on the number of ranks.
//! MPI ends all ranks if one dies; the blocks that rank 0 had received by then are in its log.

mod team;

use std::env;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::{anyhow, bail};
use serde::{Deserialize, Serialize};

use self::team::Team;
use super::{Console, USAGE, journal, output, run};
use crate::case::Catalogue;
use crate::draw::block::Block;
use crate::draw::share::{BlockName, Drawing};
use crate::draw::store::Header;
use crate::plan::Plan;
use crate::record::baseline::fingerprint;
use theory::parallel;

/// Message of a rank to another.
#[derive(Debug, Serialize, Deserialize)]
enum Message {
    /// From rank 0: words that ask for the run.
    Plan(Vec<String>),
    /// To rank 0: the draws that a rank would make, on how many threads; or the reason why it cannot.
    Planned(Result<(Header, usize), String>),
    /// From rank 0: blocks for one thread to draw.
    Draw(Vec<BlockName>),
    /// To rank 0: these blocks, except for those that stay undrawn.
    Drawn(Vec<(BlockName, Option<Block>)>),
    /// From rank 0: blocks that are not begun stay undrawn.
    Stop,
    /// From rank 0: nothing more is to be drawn.
    End,
}

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
    /// Connects rank `rank` of `size` by a thread that carries out the tasks of one queue and fills the other.
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
    fn send(&self, to: usize, message: &Message) {
        // Every message can be encoded; the next receiver finds a carrier that has ended.
        let bytes = postcard::to_stdvec(message).unwrap_or_default();
        let _ = self.outgoing.send(Outgoing::Message(to, bytes));
    }

    /// Waits for the next message, and returns it after the number of its rank.
    fn receive(&self) -> (usize, Message) {
        let received = self.incoming.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let received = received.unwrap_or_else(|_| self.fail("cannot receive from other ranks"));
        self.decoded(received)
    }

    /// Returns the next message if it comes within this time.
    fn receive_within(&self, time: Duration) -> Option<(usize, Message)> {
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
    fn fail(&self, why: &str) -> ! {
        output::complain(&anyhow!("rank {}: {why}", self.rank));
        let _ = self.outgoing.send(Outgoing::Abort(USAGE));
        // The carrier ends the process before that.
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
        // A carrier that has panicked carries nothing more.
        let _ = self.carrier.take().map(JoinHandle::join);
    }
}

/// Returns the number of processes that `mpirun` or a scheduler has started: Open MPI, MPICH and its relatives, or
/// Slurm.
fn size() -> usize {
    let slurm = env::var_os("PMIX_RANK").map(|_| "SLURM_NTASKS");
    let names = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"].into_iter().chain(slurm);
    names.filter_map(|name| env::var(name).ok()?.parse().ok()).max().unwrap_or(1)
}

/// Joins the other ranks, if there are any; only `run` is shared by ranks.
pub(super) fn join(is_run: bool, join: Option<Join>) -> anyhow::Result<Option<Link>> {
    let size = size();
    if size == 1 {
        return Ok(None);
    }
    if !is_run {
        bail!("{size} processes were begun, but only `run` is shared by ranks: leave out mpirun");
    }
    let Some(join) = join else {
        bail!(
            "{size} processes were begun, but this program knows no MPI: \
             begin trueflight-mpi, which `cargo build --release -p trueflight-mpi` makes (a program of one's own \
             calls `cli::main_among`), or leave out mpirun"
        );
    };
    let link = join().map_err(|why| anyhow!(why))?;
    if link.size != size {
        let known = link.size;
        bail!(
            "{size} processes were begun, but MPI knows of {known}: mpirun is not that of the MPI library of this build"
        );
    }
    Ok(Some(link))
}

/// Draws a run as one of several ranks.
pub(super) fn main(
    link: Link,
    arguments: &run::Arguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    // The default of a single process, one thread per processor, would start that many threads on each rank.
    let mut arguments = arguments.clone();
    arguments.requested.selection.threads.get_or_insert(1);
    if link.rank > 0 {
        serve(&link, &arguments, catalogue, console);
        return Ok(0);
    }
    let team = Team::new(link);
    let requested = arguments.resumed()?;
    if requested.is_share() {
        bail!("a share is drawn by one process: leave out mpirun, or --shard");
    }
    if !console.quiet {
        // MPI ends rank 0 together with any other rank, without time for a message then.
        let (ranks, again) = (team.size(), journal::resume(&requested.out()));
        output::note(&format!(
            "{ranks} ranks draw; should one of them die, {again} under mpirun goes on"
        ));
    }
    team.plan(&requested.words()?);
    run::draw(&requested, Box::new(team), catalogue, console)
}

/// Draws the pieces that rank 0 deals. Errors go to rank 0, which reports them to the user.
fn serve(link: &Link, arguments: &run::Arguments, catalogue: &Catalogue, console: &Console) {
    let Message::Plan(words) = link.receive().1 else { return };
    let drawn = run::Arguments::of(&words).and_then(|requested| {
        let selection =
            requested.requested.selection.clone().on_threads_of(&arguments.requested.selection);
        let cases = selection.read(catalogue, console)?;
        selection.with_plan(&cases, &requested.options()?, console, |plan| {
            draw(link, plan, Header::new(plan, &fingerprint()?, &words, None));
            Ok(())
        })
    });
    if let Err(error) = drawn {
        link.send(0, &Message::Planned(Err(format!("{error:#}"))));
        link.receive();
    }
}

/// Receives on one thread while the threads of the pool draw.
fn draw(link: &Link, plan: &Plan, header: Header) {
    let threads = rayon::current_num_threads();
    link.send(0, &Message::Planned(Ok((header, threads))));
    let is_stopped = AtomicBool::new(false);
    let is_over = || is_stopped.load(Ordering::Relaxed);
    let drawing = Drawing::new(plan, &is_over);
    let (dealt, portions) = mpsc::channel();
    let portions = Mutex::new(portions);
    let next = || portions.lock().unwrap_or_else(PoisonError::into_inner).recv();
    thread::scope(|scope| {
        scope.spawn(|| {
            let dealt = dealt;
            loop {
                match link.receive().1 {
                    // The threads take portions until no more are dealt.
                    Message::Draw(names) => drop(dealt.send(names)),
                    Message::Stop => is_stopped.store(true, Ordering::Relaxed),
                    _ => return,
                }
            }
        });
        parallel::range(threads, |_| {
            while let Ok(names) = next() {
                let names: Vec<BlockName> = names;
                let drawn = names.into_iter().map(|name| (name, drawing.draw(name)));
                link.send(0, &Message::Drawn(drawn.collect()));
            }
        });
    });
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::thread;

    use super::{Link, Outgoing, Received};
    use crate::case::Catalogue;
    use crate::cli::{Console, output, run};

    /// Carries the messages of a rank that is a thread.
    fn carry(rank: usize, outgoing: &Receiver<Outgoing>, to: &[Sender<Received>]) {
        while let Ok(Outgoing::Message(other, bytes)) = outgoing.recv() {
            to[other].send((rank, bytes)).expect("a rank that receives");
        }
    }

    fn links(ranks: usize) -> Vec<Link> {
        let (to, from): (Vec<Sender<Received>>, Vec<_>) = (0..ranks).map(|_| channel()).unzip();
        let link = |(rank, incoming)| {
            let ((outgoing, orders), to) = (channel(), to.clone());
            let carrier = thread::spawn(move || carry(rank, &orders, &to));
            Link::new(rank, ranks, outgoing, incoming, carrier)
        };
        from.into_iter().enumerate().map(link).collect()
    }

    /// Returns the checks that a run by this number of ranks writes.
    fn checks(folder: &Path, ranks: usize) -> String {
        let out = folder.join(ranks.to_string()).display().to_string();
        let case = folder.join("ray.toml").display().to_string();
        let words = ["--draws=3e5", "--fixed-draws", "--fresh", "--out", &out, "--", &case];
        let requested = run::Arguments::of(&words.map(str::to_owned)).expect("words");
        let console = Console { color: output::When::Never, quiet: true };
        let catalogue = Catalogue::builtin();
        let main = &|link| super::main(link, &requested, &catalogue, &console);
        thread::scope(|scope| {
            let begin = |link| scope.spawn(move || main(link));
            let all: Vec<_> = links(ranks).into_iter().map(begin).collect();
            for rank in all {
                assert_eq!(rank.join().expect("a rank").expect("a verdict"), 0);
            }
        });
        fs::read_to_string(Path::new(&out).join("checks.csv")).expect("checks")
    }

    #[test]
    fn any_number_of_ranks_writes_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        let case = "title = \"a ray\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 4]
sampling.constant.value = 0.75
estimators = [{ ratio = {} }, { double = {} }]
";
        fs::write(folder.path().join("ray.toml"), case).expect("a case");
        let alone = checks(folder.path(), 1);
        assert!(alone.lines().count() > 4, "{alone}");
        for ranks in [2, 3] {
            assert_eq!(checks(folder.path(), ranks), alone, "{ranks} ranks");
        }
    }
}
