//! All ranks, as rank 0 sees them.

use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread;

use super::link::{Link, Naps};
use super::{Answer, Order, encoded};
use crate::draw::share::Piece;
use crate::draw::store::Header;
use crate::draw::workers::{Drawing, Take, Workers};
use theory::parallel;

/// In how many portions a thread gets its pieces: the last ones are what others may have to wait for.
const PORTIONS: usize = 16;

/// Rank 0 with the others.
#[derive(Debug)]
pub struct Team {
    link: Arc<dyn Link>,
    /// How many threads each rank has.
    threads: OnceLock<Vec<usize>>,
    /// How many ranks have still to say what they would draw.
    planning: AtomicUsize,
    /// Whether the others are told that the drawing is over.
    is_told: AtomicBool,
}

impl Team {
    /// Rank 0 with the others.
    pub fn new(link: Arc<dyn Link>) -> Self {
        let (threads, planning) = (OnceLock::new(), AtomicUsize::new(0));
        Self { link, threads, planning, is_told: AtomicBool::new(false) }
    }

    /// How many ranks there are.
    pub fn size(&self) -> usize {
        self.link.size()
    }

    /// Tells the others the words that ask for the run.
    pub fn plan(&self, words: &[String]) {
        let order = encoded(&Order::Plan(words.to_owned()));
        (1..self.link.size()).for_each(|rank| self.link.send(rank, &order));
        self.planning.store(self.link.size() - 1, Ordering::Relaxed);
    }

    /// What a rank would draw, while there is one that has still to say so.
    fn planned(&self) -> Option<(usize, Answer)> {
        let more = |left: usize| left.checked_sub(1);
        self.planning.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more).ok()?;
        let heard = self.link.wait();
        Some((heard.0, self.link.read(&heard)))
    }
}

impl Workers for Team {
    fn threads(&self) -> usize {
        self.threads.get().map_or_else(rayon::current_num_threads, |threads| threads.iter().sum())
    }

    fn agree(&self, header: &Header) -> Result<(), String> {
        let mut threads = vec![0; self.link.size()];
        threads[0] = rayon::current_num_threads();
        let mut faults = BTreeMap::new();
        while let Some((rank, answer)) = self.planned() {
            match answer {
                Answer::Planned(Ok((other, of_rank))) => {
                    threads[rank] = of_rank;
                    let told = |why| (rank, format!("would not draw the same: {why}"));
                    faults.extend(other.mismatch(header).map(told));
                }
                Answer::Planned(Err(why)) => {
                    faults.insert(rank, why);
                }
                Answer::Drawn(_) => {
                    self.link.fail(&format!("rank {rank} drew what nobody asked for"))
                }
            }
        }
        let _ = self.threads.set(threads);
        let faults: Vec<String> =
            faults.iter().map(|(rank, why)| format!("rank {rank}: {why}")).collect();
        if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
    }

    /// One thread deals to the others, and takes what they give, while those of the pool draw.
    fn draw(&self, pieces: &[Piece], drawing: &Drawing, take: &Take) {
        let next = AtomicUsize::new(0);
        thread::scope(|scope| {
            scope.spawn(|| self.deal(pieces, &next, drawing, take));
            parallel::range(rayon::current_num_threads(), |_| {
                while let Some(number) = portion(pieces, &next, 1).next() {
                    take(number, drawing.draw(&pieces[number]));
                }
            });
        });
    }
}

/// The numbers of the next pieces that nobody has yet.
fn portion(pieces: &[Piece], next: &AtomicUsize, most: usize) -> Range<usize> {
    let begin = next.fetch_add(most, Ordering::Relaxed).min(pieces.len());
    begin..(begin + most).min(pieces.len())
}

impl Team {
    /// Deals portions to the other ranks, two of them at most to each, until all pieces are drawn.
    fn deal(&self, pieces: &[Piece], next: &AtomicUsize, drawing: &Drawing, take: &Take) {
        let Some(threads) = self.threads.get() else { return };
        let most_each = pieces.len() / (PORTIONS * self.threads());
        let mut open = vec![0; threads.len()];
        let (mut heard, mut naps) = (VecDeque::new(), Naps::default());
        loop {
            for rank in 1..threads.len() {
                loop {
                    // Towards the end less and less, so that none has much left when the others are done.
                    let left = pieces.len().saturating_sub(next.load(Ordering::Relaxed));
                    let each = most_each.min(left / (2 * self.threads())).max(1);
                    let most = each * threads[rank];
                    if open[rank] > most {
                        break;
                    }
                    let numbers = portion(pieces, next, most);
                    if numbers.is_empty() {
                        break;
                    }
                    open[rank] += numbers.len();
                    let dealt = numbers.map(|number| (number, pieces[number].clone())).collect();
                    let order = encoded(&Order::Draw { pieces: dealt, each });
                    if !self.link.post(rank, &order, 4 * threads.len()) {
                        self.link.send_and_hear(rank, &order, &mut heard);
                    }
                }
            }
            if open.iter().all(|&pieces| pieces == 0) {
                return;
            }
            if (drawing.is_over)() && !self.is_told.swap(true, Ordering::Relaxed) {
                self.link.stop_others();
            }
            match heard.pop_front().or_else(|| self.link.hear()) {
                Some(message) => {
                    naps = Naps::default();
                    if let Answer::Drawn(drawn) = self.link.read(&message) {
                        open[message.0] -= drawn.len();
                        for (number, blocks) in drawn {
                            take(number, blocks);
                        }
                    }
                }
                None => naps.next(),
            }
        }
    }
}

impl Drop for Team {
    fn drop(&mut self) {
        if thread::panicking() {
            // The link ends all ranks.
            return;
        }
        while self.planned().is_some() {}
        let order = encoded(&Order::End);
        (1..self.link.size()).for_each(|rank| self.link.send(rank, &order));
    }
}
