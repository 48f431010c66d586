//! Bar of a long command on a terminal: how much is done, and how long the rest will take.

use std::io::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use terminal_size::{Width, terminal_size_of};

/// Time between two drawings.
const TICK: Duration = Duration::from_millis(100);
/// Age in seconds at which a speed has a tenth of its weight.
const MEMORY: f64 = 15.0;
/// Columns that are assumed where the terminal does not report its width.
const COLUMNS: usize = 80;
/// Returns to the begin of the line and clears it.
const CLEAR: &str = "\r\x1b[2K";

/// Bar on stderr, which a thread draws if it is shown at all. It disappears when it is dropped.
#[derive(Debug)]
pub struct Bar {
    state: Arc<ProgressState>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct ProgressState {
    /// Verb and plural noun of the bar, such as `drawing` and `draws`.
    words: [String; 2],
    begin: Instant,
    /// Seconds after which the work ends at the latest.
    limit: Option<f64>,
    done: AtomicU64,
    all: AtomicU64,
    /// Held while something is written to the terminal.
    screen: Mutex<Screen>,
    closing: Condvar,
}

/// Whether the bar is closed, and its speed so far.
#[derive(Debug, Default)]
struct Screen {
    is_closed: bool,
    pace: Pace,
}

impl Bar {
    /// Returns a bar of work on things of this number, which ends after `limit` seconds at the latest, if there is a limit.
    pub fn new([doing, things]: [&str; 2], all: u64, limit: Option<f64>, is_shown: bool) -> Self {
        let state = Arc::new(ProgressState {
            words: [doing, things].map(str::to_owned),
            begin: Instant::now(),
            limit,
            done: AtomicU64::new(0),
            all: AtomicU64::new(all),
            screen: Mutex::default(),
            closing: Condvar::new(),
        });
        let theirs = Arc::clone(&state);
        let thread = is_shown.then(|| std::thread::spawn(move || theirs.draw()));
        Self { state, thread }
    }

    /// Counts things as done.
    pub fn inc(&self, things: u64) {
        self.state.done.fetch_add(things, Ordering::Relaxed);
    }

    /// Sets the number of things that are done.
    pub fn set_position(&self, done: u64) {
        self.state.done.store(done, Ordering::Relaxed);
    }

    /// Sets the number of all things.
    pub fn set_length(&self, all: u64) {
        self.state.all.store(all, Ordering::Relaxed);
    }

    /// Reduces the number of all things: these need not be done.
    pub fn dec_length(&self, things: u64) {
        self.state.all.fetch_sub(things, Ordering::Relaxed);
    }

    /// Writes something else, with no bar on the screen.
    pub fn suspend<T>(&self, write: impl FnOnce() -> T) -> T {
        let _screen = self.state.screen.lock().unwrap_or_else(PoisonError::into_inner);
        if self.thread.is_some() {
            show(CLEAR);
        }
        write()
    }

    /// Takes the bar off the screen.
    pub fn finish_and_clear(self) {
        drop(self);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        let Some(thread) = self.thread.take() else { return };
        self.state.screen.lock().unwrap_or_else(PoisonError::into_inner).is_closed = true;
        self.state.closing.notify_all();
        // A bar has no place to report a panic to.
        let _ = thread.join();
    }
}

impl ProgressState {
    /// Draws the bar until it is closed, and clears it then.
    fn draw(&self) {
        let mut screen = self.screen.lock().unwrap_or_else(PoisonError::into_inner);
        while !screen.is_closed {
            let [done, all] = [&self.done, &self.all].map(|n| n.load(Ordering::Relaxed));
            let seconds = self.begin.elapsed().as_secs_f64();
            screen.pace.record(done, seconds);
            let left = screen.pace.left(all.saturating_sub(done));
            let limit = self.limit.map(|limit| (limit - seconds).max(0.0));
            let left = left.into_iter().chain(limit).reduce(f64::min);
            let columns = terminal_size_of(std::io::stderr());
            let columns = columns.map_or(COLUMNS, |(Width(columns), _)| usize::from(columns));
            show(&format!("{CLEAR}{}", line(&self.words, [done, all], left, columns)));
            let waited = self.closing.wait_timeout(screen, TICK);
            screen = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        show(CLEAR);
    }
}

/// Writes to stderr at once; a bar has no place to report an error to.
fn show(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Returns the line of a bar. It never fills the last column, so that no terminal wraps it.
fn line(
    [doing, things]: &[String; 2],
    [done, all]: [u64; 2],
    left: Option<f64>,
    columns: usize,
) -> String {
    let left = left.map_or(String::new(), |left| format!(", {} left", rounded(left)));
    let text = format!("{} of {} {things}{left}", grouped(done), grouped(all));
    let taken = [doing, text.as_str()].map(|part| part.chars().count() + 1).iter().sum();
    let room = columns.saturating_sub(1).saturating_sub(taken);
    let share = if all == 0 { 1.0 } else { (done as f64 / all as f64).min(1.0) };
    // At most as many as a terminal has columns.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let full = (share * room as f64) as usize;
    let bar = "█".repeat(full) + &"░".repeat(room - full);
    format!("{doing} {bar} {text}").chars().take(columns.saturating_sub(1)).collect()
}

/// Returns a number with a comma after every third digit from the right.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Returns a time in the largest unit of which it has two.
fn rounded(seconds: f64) -> String {
    const UNITS: [(f64, &str); 3] = [(86_400.0, "d"), (3600.0, "h"), (60.0, "m")];
    let large = UNITS.into_iter().find(|(unit, _)| (seconds / unit).round() >= 2.0);
    let (unit, sign) = large.unwrap_or((1.0, "s"));
    format!("{:.0}{sign}", (seconds / unit).round())
}

/// Speed so far, of which the recent part counts more.
#[derive(Debug, Default)]
struct Pace {
    done: u64,
    seconds: f64,
    /// Weighted mean of the speeds, where those before the begin are zero.
    speed: f64,
}

impl Pace {
    fn record(&mut self, done: u64, seconds: f64) {
        let passed = seconds - self.seconds;
        if passed > 0.0 {
            let weight = forgotten(passed);
            let speed = done.saturating_sub(self.done) as f64 / passed;
            self.speed = self.speed * weight + speed * (1.0 - weight);
            (self.done, self.seconds) = (done, seconds);
        }
    }

    /// Returns the seconds that things will take; `None` before the first one is done.
    fn left(&self, things: u64) -> Option<f64> {
        let speed = self.speed / (1.0 - forgotten(self.seconds));
        (speed > 0.0).then(|| things as f64 / speed)
    }
}

/// Returns the weight of what is older than this.
fn forgotten(seconds: f64) -> f64 {
    0.1_f64.powf(seconds / MEMORY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_fits_its_terminal() {
        let words = ["drawing", "draws"].map(str::to_owned);
        let half = line(&words, [500, 1000], Some(5.0), 50);
        assert_eq!(half, "drawing ██████░░░░░░░ 500 of 1,000 draws, 5s left");
        let begun = line(&words, [0, 0], None, 30);
        assert_eq!(begun, "drawing ████████ 0 of 0 draws");
        for columns in 0..60 {
            let shown = line(&words, [7, 5], Some(1e9), columns);
            assert!(shown.chars().count() < columns.max(1), "{columns}: {shown}");
        }
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        let times = [0.4, 59.0, 89.0, 90.0, 5400.0, 129_600.0, 1e6];
        assert_eq!(times.map(rounded), ["0s", "59s", "89s", "2m", "2h", "2d", "12d"]);
    }

    #[test]
    fn a_steady_pace_is_known_and_a_new_one_is_learned() {
        let mut pace = Pace::default();
        assert_eq!(pace.left(10), None);
        for second in 1..=10 {
            pace.record(20 * second, second as f64);
        }
        assert!((pace.left(100).expect("a pace") - 5.0).abs() < 1e-9);
        for second in 11..=70 {
            pace.record(200 + 10 * (second - 10), second as f64);
        }
        assert!((pace.left(100).expect("a pace") - 10.0).abs() < 0.01);
    }
}
