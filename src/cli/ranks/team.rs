//! All ranks, from the side of rank 0.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use super::{Link, Message};
use crate::draw::share::{BlockName, Drawing, Take, Workers};
use crate::draw::store::Header;
use theory::parallel;

/// Smallest number of portions of a batch per thread: rank 0 may have to wait for the last ones.
const PORTIONS: usize = 16;

/// Longest time until rank 0 sees that the drawing is over.
const PATIENCE: Duration = Duration::from_millis(10);

/// Rank 0 with the other ranks.
#[derive(Debug)]
pub struct Team {
    link: Link,
    /// Threads of each rank.
    threads: OnceLock<Vec<usize>>,
    /// Number of ranks that have not yet described their draws.
    planning: AtomicUsize,
}

impl Team {
    /// Leads the other ranks of a link.
    pub fn new(link: Link) -> Self {
        Self { link, threads: OnceLock::new(), planning: AtomicUsize::new(0) }
    }

    /// Returns the number of ranks.
    pub fn size(&self) -> usize {
        self.link.size
    }

    /// Sends all others the words that ask for the run.
    pub fn plan(&self, words: &[String]) {
        self.send_all(|| Message::Plan(words.to_owned()));
        self.planning.store(self.link.size - 1, Ordering::Relaxed);
    }

    fn send_all(&self, message: impl Fn() -> Message) {
        (1..self.link.size).for_each(|rank| self.link.send(rank, &message()));
    }

    /// Receives the description of a rank's draws, if one is still missing.
    fn planned(&self) -> Option<(usize, Message)> {
        let more = |left: usize| left.checked_sub(1);
        self.planning.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more).ok()?;
        Some(self.link.receive())
    }

    /// Deals portions to the other ranks, two for each thread at a time, until all blocks are drawn.
    fn deal(&self, names: &[BlockName], next: &AtomicUsize, drawing: &Drawing, take: &Take) {
        let Some(threads) = self.threads.get() else { return };
        let maximum = (names.len() / (PORTIONS * self.threads())).max(1);
        let (mut open, mut is_told) = (vec![0; threads.len()], false);
        loop {
            for rank in 1..threads.len() {
                while open[rank] < 2 * threads[rank] {
                    // Portions shrink towards the end, so that no rank has much left when the others are done.
                    let left = names.len().saturating_sub(next.load(Ordering::Relaxed));
                    let dealt =
                        portion(names, next, (left / (2 * self.threads())).clamp(1, maximum));
                    if dealt.is_empty() {
                        break;
                    }
                    open[rank] += 1;
                    self.link.send(rank, &Message::Draw(dealt.to_vec()));
                }
            }
            if open.iter().all(|&portions| portions == 0) {
                return;
            }
            if (drawing.is_over)() && !is_told {
                self.send_all(|| Message::Stop);
                is_told = true;
            }
            if let Some((rank, Message::Drawn(drawn))) = self.link.receive_within(PATIENCE) {
                open[rank] -= 1;
                for (name, block) in drawn {
                    take(name, block);
                }
            }
        }
    }
}

impl Workers for Team {
    fn threads(&self) -> usize {
        self.threads.get().map_or_else(rayon::current_num_threads, |threads| threads.iter().sum())
    }

    fn agree(&self, header: &Header) -> Result<(), String> {
        let mut threads = vec![rayon::current_num_threads(); self.link.size];
        let mut faults = BTreeMap::new();
        while let Some((rank, message)) = self.planned() {
            match message {
                Message::Planned(Ok((other, of_rank))) => {
                    threads[rank] = of_rank;
                    let refusal =
                        |why| (rank, format!("rank {rank}: would not draw the same: {why}"));
                    faults.extend(other.mismatch(header).map(refusal));
                }
                Message::Planned(Err(why)) => {
                    faults.insert(rank, format!("rank {rank}: {why}"));
                }
                _ => self.link.fail(&format!("rank {rank} drew what nobody asked for")),
            }
        }
        let _ = self.threads.set(threads);
        let faults: Vec<String> = faults.into_values().collect();
        if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
    }

    /// Deals to the other ranks and takes their blocks on one thread, while the threads of the pool draw.
    fn draw(&self, names: &[BlockName], drawing: &Drawing, take: &Take) {
        let next = AtomicUsize::new(0);
        thread::scope(|scope| {
            scope.spawn(|| self.deal(names, &next, drawing, take));
            parallel::range(rayon::current_num_threads(), |_| {
                while let &[name] = portion(names, &next, 1) {
                    take(name, drawing.draw(name));
                }
            });
        });
    }
}

/// Returns the next blocks that are not dealt yet.
fn portion<'n>(names: &'n [BlockName], next: &AtomicUsize, maximum: usize) -> &'n [BlockName] {
    let begin = next.fetch_add(maximum, Ordering::Relaxed).min(names.len());
    &names[begin..(begin + maximum).min(names.len())]
}

impl Drop for Team {
    fn drop(&mut self) {
        // After a panic the link ends all ranks.
        if !thread::panicking() {
            while self.planned().is_some() {}
            self.send_all(|| Message::End);
        }
    }
}
