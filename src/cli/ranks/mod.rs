//! One run drawn by many processes, its ranks, that `mpirun` has begun. How they talk is a [`Link`]: the library knows of none.
//!
//! ```text
//! rank 0   plans, deals pieces to all ranks and to itself, keeps and merges what they give, looks, judges, writes
//! others   plan the same, and draw what they are dealt
//! ```
//!
//! Blocks are found by their addresses and merged in the order of these, so that results do not depend on the
//! number of ranks. Looks are decided on rank 0 only: what it deals next tells the others. MPI itself ends all ranks
//! where one dies; what rank 0 was given by then is in its file of blocks.

mod link;
mod team;

use std::sync::Arc;

use anyhow::bail;
use serde::{Deserialize, Serialize};

pub use self::link::{Heard, Join, Link};
use self::team::Team;
use super::{Console, journal, output, run};
use crate::case::Catalogue;
use crate::draw::block::Block;
use crate::draw::share::Piece;
use crate::draw::store::Header;
use crate::draw::workers::Drawing;
use crate::plan::Plan;
use crate::record::baseline::fingerprint;
use theory::parallel;

/// What rank 0 says to another.
#[derive(Debug, Serialize, Deserialize)]
enum Order {
    /// The words that ask for the run.
    Plan(Vec<String>),
    /// Pieces, each with its number among all that are dealt; so many of them are answered together.
    Draw { pieces: Vec<(usize, Piece)>, each: usize },
    /// Nothing more is to be drawn.
    End,
}

/// What another answers.
#[derive(Debug, Serialize, Deserialize)]
enum Answer {
    /// What it would draw, on so many threads; or why it cannot.
    Planned(Result<(Header, usize), String>),
    /// What it drew of pieces, each by its number.
    Drawn(Vec<(usize, Vec<Option<Block>>)>),
}

/// Draws what is asked for as a rank among others.
pub(super) fn main(
    link: &Arc<dyn Link>,
    arguments: &run::Arguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    // As many as processors, like that of other codes under MPI, would be as many for each rank.
    let mut arguments = arguments.clone();
    arguments.selection.threads.get_or_insert(1);
    if link.rank() > 0 {
        return Ok(serve(link.as_ref(), &arguments, catalogue, console));
    }
    lead(Team::new(Arc::clone(link)), &arguments, catalogue, console)
}

/// Has all ranks draw what is asked for, and judges it.
fn lead(
    team: Team,
    arguments: &run::Arguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    let asked = arguments.resumed()?;
    if asked.shard.is_some() {
        bail!("a share is drawn by one process: leave out mpirun, or --shard");
    }
    if !console.quiet {
        // MPI ends rank 0 with any other, and leaves it no time to say so then.
        let (ranks, again) = (team.size(), journal::resume(&asked.out));
        output::note(&format!(
            "{ranks} ranks draw; should one of them die, {again} under mpirun goes on"
        ));
    }
    team.plan(&asked.words());
    run::draw(&asked, Box::new(team), catalogue, console)
}

/// Draws what rank 0 deals, to its end. What goes wrong is told to rank 0, which tells the user.
fn serve(
    link: &dyn Link,
    arguments: &run::Arguments,
    catalogue: &Catalogue,
    console: &Console,
) -> u8 {
    let Order::Plan(words) = order(link) else { return 0 };
    let drawn = run::Arguments::of(&words).and_then(|asked| {
        let selection = asked.selection.clone().on_threads_of(&arguments.selection);
        let cases = selection.read(catalogue, console)?;
        selection.with_plan(&cases, &asked.options()?, console, |plan| {
            let header = Header::new(plan, &fingerprint()?, &words, None);
            draw(link, plan, header);
            Ok(())
        })
    });
    if let Err(error) = drawn {
        answer(link, &Answer::Planned(Err(format!("{error:#}"))));
        order(link);
    }
    0
}

fn draw(link: &dyn Link, plan: &Plan, header: Header) {
    answer(link, &Answer::Planned(Ok((header, rayon::current_num_threads()))));
    let threads = rayon::current_num_threads();
    let is_over = || link.is_stopped();
    let drawing = Drawing::new(plan, &is_over);
    while let Order::Draw { pieces, each } = order(link) {
        let together: Vec<&[(usize, Piece)]> = pieces.chunks(each.max(1)).collect();
        parallel::map(&together, |pieces| {
            let drawn = pieces.iter().map(|(number, piece)| (*number, drawing.draw(piece)));
            let answer = encoded(&Answer::Drawn(drawn.collect()));
            // Two portions, with one answer of each thread, are all that rank 0 deals before it has heard.
            if !link.post(0, &answer, 2 * threads + 2) {
                link.send(0, &answer);
            }
        });
    }
}

/// The next order of rank 0.
fn order(link: &dyn Link) -> Order {
    link.read(&link.wait())
}

fn answer(link: &dyn Link, answer: &Answer) {
    link.send(0, &encoded(answer));
}

/// Never empty: every message can be encoded.
fn encoded(message: &impl Serialize) -> Vec<u8> {
    postcard::to_stdvec(message).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::fs;
    use std::path::Path;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::sync::{Arc, Mutex};
    use std::thread;

    use super::{Heard, Link};
    use crate::case::Catalogue;
    use crate::cli::{Console, output, run};

    /// A rank that is a thread.
    #[derive(Debug)]
    struct Thread {
        rank: usize,
        to: Vec<Sender<Heard>>,
        heard: Mutex<Receiver<Heard>>,
        is_stopped: Arc<AtomicBool>,
        /// Whether one has ended all.
        is_over: Arc<AtomicBool>,
        /// What is longer is not posted.
        longest: usize,
    }

    impl Link for Thread {
        fn rank(&self) -> usize {
            self.rank
        }

        fn size(&self) -> usize {
            self.to.len()
        }

        fn send(&self, to: usize, bytes: &[u8]) {
            self.to[to].send((self.rank, bytes.to_vec())).expect("a rank that hears");
        }

        fn post(&self, to: usize, bytes: &[u8], _: usize) -> bool {
            let is_short = bytes.len() <= self.longest;
            if is_short {
                self.send(to, bytes);
            }
            is_short
        }

        fn send_and_hear(&self, to: usize, bytes: &[u8], heard: &mut VecDeque<Heard>) {
            heard.extend(self.hear());
            self.send(to, bytes);
        }

        fn hear(&self) -> Option<Heard> {
            assert!(!self.is_over.load(Ordering::Relaxed), "another rank has ended all");
            self.heard.lock().expect("a channel").try_recv().ok()
        }

        fn abort(&self, _: u8) -> ! {
            self.is_over.store(true, Ordering::Relaxed);
            panic!("rank {} ends all", self.rank)
        }

        fn stop_others(&self) {
            self.is_stopped.store(true, Ordering::Relaxed);
        }

        fn is_stopped(&self) -> bool {
            self.is_stopped.load(Ordering::Relaxed)
        }
    }

    impl Drop for Thread {
        fn drop(&mut self) {
            if thread::panicking() {
                self.is_over.store(true, Ordering::Relaxed);
            }
        }
    }

    fn links(ranks: usize, longest: usize) -> Vec<Arc<dyn Link>> {
        let (to, from): (Vec<_>, Vec<_>) = (0..ranks).map(|_| channel()).unzip();
        let [is_stopped, is_over] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
        let link = |(rank, heard)| -> Arc<dyn Link> {
            let (to, heard) = (to.clone(), Mutex::new(heard));
            let (is_stopped, is_over) = (Arc::clone(&is_stopped), Arc::clone(&is_over));
            Arc::new(Thread { rank, to, heard, is_stopped, is_over, longest })
        };
        from.into_iter().enumerate().map(link).collect()
    }

    /// What a run by so many ranks writes of its checks.
    fn checks(folder: &Path, ranks: usize, longest: usize) -> String {
        let out = folder.join(format!("{ranks}-{longest}")).display().to_string();
        let case = folder.join("ray.toml").display().to_string();
        let words = ["--draws=3e5", "--fixed-draws", "--fresh", "--out", &out, "--", &case];
        let asked = run::Arguments::of(&words.map(str::to_owned)).expect("words");
        let console = Console { color: output::When::Never, quiet: true };
        let catalogue = Catalogue::builtin();
        let main = &|link: &Arc<dyn Link>| super::main(link, &asked, &catalogue, &console);
        let links = links(ranks, longest);
        thread::scope(|scope| {
            let begin = |link| scope.spawn(move || main(&link));
            let all: Vec<_> = links.into_iter().map(begin).collect();
            for rank in all {
                assert_eq!(rank.join().expect("a rank").expect("a verdict"), 0);
            }
        });
        fs::read_to_string(Path::new(&out).join("checks.csv")).expect("checks")
    }

    #[test]
    fn any_number_of_ranks_comes_to_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        let case = "title = \"a ray\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 4]
sampling.constant.value = 0.75
estimators = [{ ratio = {} }, { double = {} }]
";
        fs::write(folder.path().join("ray.toml"), case).expect("a case");
        let alone = checks(folder.path(), 1, 0);
        assert!(alone.lines().count() > 4, "{alone}");
        for (ranks, longest) in [(2, usize::MAX), (3, usize::MAX), (3, 0)] {
            assert_eq!(checks(folder.path(), ranks, longest), alone, "{ranks} ranks");
        }
    }
}
