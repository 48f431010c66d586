//! Repeated sequences of draws of few values, such as 0 and 1, where equal values are no evidence.
//!
//! ```text
//! token     a draw, or, where one value has more than half of all draws, any other draw with the number of that
//!           value's draws before it: tokens of independent draws of one distribution are again such
//! window    W consecutive tokens; those of a certain hash are kept, ever fewer, so that the memory is bounded
//! bet       a window that was seen before comes again: its next L tokens are those of before
//! e         L!/∏m!  if they are, m how often each comes among them;  else 0
//! E         ∏ (1 − f + f e),  f = (successes + ½)/(bets + 1)   over bets that share no token
//! ```
//!
//! For independent draws of one distribution all orders of the next L tokens are equally probable. They come in the
//! order of the bet with probability ∏m!/L! at most, for any distribution. So the mean of each e is 1 at most, E is
//! a test martingale, and E ≥ 1/α comes with probability α at most at any number of looks (J. Ville, *Étude
//! critique de la notion de collectif*, 1939). The choice of windows affects the power alone: W and L follow from
//! the values of the first block, in any order. A distribution that is nearly continuous in the first block is left
//! to [`super::replays`].

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use super::capital::ln_add;
use super::replays::{Replay, SpreadHasher, hash};

/// Maximum number of windows that are kept.
const MAX_WINDOWS: usize = 1 << 15;
/// ln E beyond which a repetition is certain.
const CERTAIN: f64 = 100.0;
/// Maximum number of windows after that.
const FEW_WINDOWS: usize = 1 << 8;
/// Number of last tokens that are stored: more than the largest W + L.
const RING: usize = 256;
/// Maximum of W, and of L.
const LONGEST: usize = 48;
/// Minimum of L.
const SHORTEST_BET: usize = 12;
/// Bits of a token above which equal single values are evidence.
const FINE: f64 = 22.0;
/// Odd base of the polynomial that is the hash of a window, modulo 2⁶⁴.
const BASE: u64 = 0x9e37_79b9_7f4a_7c15;

/// Search for sequences of draws that repeat.
#[derive(Debug, Clone, Default)]
pub struct Sequences {
    scheme: Option<Scheme>,
    is_planned: bool,
    draws: u64,
    /// Number of draws of the most frequent value since the last token.
    gap: u64,
    tokens: u64,
    ring: Ring,
    kept: HashMap<u64, TokenWindow, BuildHasherDefault<SpreadHasher>>,
    /// Number of leading bits of a window's hash that must be 0.
    bits: u32,
    pending: Option<Bet>,
    bets: f64,
    successes: f64,
    ln_e: f64,
    distance: Option<u64>,
    /// The first repeated draw, and the last.
    reach: Option<[u64; 2]>,
}

/// Definition of a token, and the numbers of tokens of a window and a bet.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scheme {
    /// The bits of a value that has more than half of all draws.
    filler: Option<u64>,
    window: usize,
    bet: usize,
    /// `BASE` to the power of the two.
    bases: [u64; 2],
}

/// The last tokens.
#[derive(Debug, Clone)]
struct Ring(Box<[Token; RING]>);

impl Default for Ring {
    fn default() -> Self {
        Self(Box::new([Token::default(); RING]))
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Token {
    hash: u64,
    /// Hash of all tokens so far.
    prefix: u64,
    /// Hash of the window that ends here.
    window: u64,
    draw: u64,
}

/// A window, with the hash of the tokens after its last occurrence.
#[derive(Debug, Clone, Copy)]
struct TokenWindow {
    next: u64,
    draw: u64,
    token: u64,
    count: u64,
}

#[derive(Debug, Clone, Copy)]
struct Bet {
    end: u64,
    next: u64,
    distance: u64,
    /// The distance in tokens.
    tokens: u64,
}

/// Bits of a number, equal for 0 and −0.
fn bits_of(x: f64) -> u64 {
    (x + 0.0).to_bits()
}

impl Scheme {
    /// Chooses the scheme by the values of a first block; `None` where values are so varied that equality of single
    /// values suffices.
    fn new(block: &[f64]) -> Option<Self> {
        let mut values: Vec<u64> = block.iter().map(|&x| bits_of(x)).collect();
        values.sort_unstable();
        let n = values.len() as f64;
        let counts = || values.chunk_by(|a, b| a == b).map(|group| (group.len() as f64, group[0]));
        let (maximum, commonest) = counts().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let filler = (2.0 * maximum > n).then_some(commonest);
        let others = n - filler.map_or(0.0, |_| maximum);
        let same: f64 = counts()
            .filter(|(_, value)| Some(*value) != filler)
            .map(|(count, _)| count * (count - 1.0))
            .sum();
        let same = if others > 1.0 { same / (others * (others - 1.0)) } else { 1.0 };
        // Two gaps before values of probability p are equal with probability p/(2 − p).
        let rare = others.max(1.0) / n;
        let alike = if filler.is_some() { same * rare / (2.0 - rare) } else { same };
        let bits = -alike.log2();
        if bits.is_nan() || bits > FINE {
            return None;
        }
        // Windows of a file of 16 blocks are then equal by accident once in 16 such files.
        let expected = 2.0 * (16.0 * n).log2() + 4.0;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few dozen
        let window = ((expected / bits.max(0.5)).ceil() as usize).clamp(1, LONGEST);
        let bet = window.max(SHORTEST_BET);
        let power = |n: usize| (0..n).fold(1, |power: u64, _| power.wrapping_mul(BASE));
        Some(Self { filler, window, bet, bases: [power(window), power(bet)] })
    }
}

impl Sequences {
    /// Adds draws that follow the last ones; the first call defines the tokens.
    pub fn absorb(&mut self, x: &[f64]) {
        if !self.is_planned && !x.is_empty() {
            self.scheme = Scheme::new(x);
            self.is_planned = true;
        }
        let Some(scheme) = self.scheme else { return };
        let first = self.draws;
        self.draws += x.len() as u64;
        for (draw, &x) in (first..).zip(x) {
            let bits = bits_of(x);
            if Some(bits) == scheme.filler {
                self.gap += 1;
                continue;
            }
            let token = hash(hash(bits ^ self.gap.wrapping_mul(BASE)));
            self.gap = 0;
            self.take(&scheme, token, draw);
        }
    }

    #[allow(clippy::cast_possible_truncation)] // modulo 256
    fn at(&self, token: u64) -> &Token {
        &self.ring.0[token as usize % RING]
    }

    /// Hash of the `count` tokens that end with `last`.
    fn hash_of(&self, last: u64, count: usize, base: u64) -> u64 {
        // Before the first token the ring is 0.
        let before = self.at(last.wrapping_sub(count as u64)).prefix;
        self.at(last).prefix.wrapping_sub(before.wrapping_mul(base))
    }

    fn is_kept(&self, window: u64) -> bool {
        hash(window).leading_zeros() >= self.bits
    }

    #[inline]
    fn take(&mut self, scheme: &Scheme, hash: u64, draw: u64) {
        let (token, [window, bet]) = (self.tokens, [scheme.window as u64, scheme.bet as u64]);
        self.tokens += 1;
        let prefix = self.at(token.wrapping_sub(1)).prefix.wrapping_mul(BASE).wrapping_add(hash);
        #[allow(clippy::cast_possible_truncation)] // modulo 256
        let place = token as usize % RING;
        self.ring.0[place] = Token { hash, prefix, window: 0, draw };
        if self.tokens < window {
            return;
        }
        let seen = self.hash_of(token, scheme.window, scheme.bases[0]);
        self.ring.0[place].window = seen;
        if self.pending.is_some_and(|pending| pending.end == token) {
            self.settle(scheme, token);
        }
        if self.tokens >= window + bet {
            let earlier = *self.at(token - bet);
            if self.is_kept(earlier.window) {
                self.keep(scheme, &earlier, token);
            }
        }
        if self.pending.is_none() && self.is_kept(seen) {
            self.pending = self.kept.get(&seen).map(|known| Bet {
                end: token + bet,
                next: known.next,
                distance: draw - known.draw,
                tokens: token - known.token,
            });
        }
    }

    /// Keeps a window after its next tokens are complete.
    fn keep(&mut self, scheme: &Scheme, window: &Token, last: u64) {
        let next = self.hash_of(last, scheme.bet, scheme.bases[1]);
        let token = last - scheme.bet as u64;
        let kept = self.kept.entry(window.window).or_insert(TokenWindow {
            next,
            draw: window.draw,
            token,
            count: 0,
        });
        *kept = TokenWindow { next, draw: window.draw, token, count: kept.count + 1 };
        // A certain repetition needs few further windows, only for its numbers.
        let maximum = if self.ln_e > CERTAIN { FEW_WINDOWS } else { MAX_WINDOWS };
        while self.kept.len() >= maximum {
            self.bits += 1;
            let minimum = self.bits;
            self.kept.retain(|&window, _| hash(window).leading_zeros() >= minimum);
        }
    }

    /// Settles the bet that ends with the token `last`.
    fn settle(&mut self, scheme: &Scheme, last: u64) {
        let Some(bet) = self.pending.take() else { return };
        let share = (self.successes + 0.5) / (self.bets + 1.0);
        self.bets += 1.0;
        let lost = (1.0 - share).ln();
        if self.hash_of(last, scheme.bet, scheme.bases[1]) != bet.next {
            self.ln_e += lost;
            return;
        }
        self.successes += 1.0;
        self.ln_e += ln_add(lost, share.ln() + self.ln_orders(scheme, last));
        // A period shorter than a bet was seen at a multiple of it.
        let is_long = bet.tokens >= 2 * scheme.bet as u64;
        let period = if is_long { None } else { self.period(scheme, last) };
        let distance = period.unwrap_or(bet.distance);
        self.distance = Some(self.distance.map_or(distance, |known| known.min(distance)));
        let first = self.at(last).draw - bet.distance;
        self.reach = [self.reach.map_or(first, |[first, _]| first), self.at(last).draw].into();
    }

    /// `ln(L!/∏m!)` of the last L tokens.
    fn ln_orders(&self, scheme: &Scheme, last: u64) -> f64 {
        let bet = scheme.bet as u64;
        let mut tokens: Vec<u64> = (0..bet).map(|back| self.at(last - back).hash).collect();
        tokens.sort_unstable();
        let ln_factorial = |n: usize| libm::lgamma(n as f64 + 1.0);
        let same = tokens.chunk_by(|a, b| a == b).map(|group| ln_factorial(group.len()));
        ln_factorial(scheme.bet) - same.sum::<f64>()
    }

    /// The period, in draws, of the last window and bet, where that is shorter than the bet.
    fn period(&self, scheme: &Scheme, last: u64) -> Option<u64> {
        let [window, bet] = [scheme.window as u64, scheme.bet as u64];
        let token = |back: u64| self.at(last - back).hash;
        let is_period =
            |period: &u64| (0..window + bet).all(|back| token(back) == token(back + period));
        let period = (1..bet.min(self.tokens - window - bet)).find(is_period)?;
        Some(self.at(last).draw - self.at(last - period).draw)
    }

    /// The repetition, with its evidence; `None` where no bet was won.
    pub fn found(&self) -> Option<Replay> {
        let distance = self.distance?;
        let mut counts: Vec<u64> =
            self.kept.values().map(|kept| kept.count).filter(|&n| n > 1).collect();
        counts.sort_unstable();
        let times = counts.get(counts.len() / 2).copied().unwrap_or(2);
        // Where the draws repeat without others between them, the last windows are incomplete.
        let whole = self.reach.map_or(0, |[first, last]| (last - first).div_ceil(distance));
        let times = if (times..=times + 1 + times / 8).contains(&whole) { whole } else { times };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
        let count = self.successes as u64;
        Some(Replay { distance, count, times, ln_p: -self.ln_e.max(0.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::rng::{Address, unit};

    fn draws(seed: u64, n: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut rng = Address { seed, experiment: 9, block: 0, lane: 0 }.stream();
        (0..n).map(|_| of(unit(&mut rng))).collect()
    }

    fn read(draws: &[f64]) -> Sequences {
        let mut sequences = Sequences::default();
        let block = (draws.len() / 16).next_power_of_two().clamp(64, 1 << 14);
        draws.chunks(block).for_each(|block| sequences.absorb(block));
        sequences
    }

    type Law = fn(f64) -> f64;
    const LAWS: [(&str, Law); 6] = [
        ("a fair coin", |u| f64::from(u8::from(u < 0.5))),
        ("a coin of 0.9", |u| f64::from(u8::from(u < 0.9))),
        ("a coin of 0.02", |u| f64::from(u8::from(u < 0.02))),
        ("three values", |u| (3.0 * u).floor()),
        ("eight bits", |u| (256.0 * u).floor() / 256.0),
        ("half zeros, half coarse", |u| ((60.0 * u).floor() - 30.0).max(0.0)),
    ];

    #[test]
    fn sequences_of_few_values_that_come_again_are_found_at_their_distance() {
        for (name, distribution) in LAWS {
            for (period, n) in [(10_000, 20_000), (10_000, 170_000), (65_536, 131_072)] {
                let once = draws(1, period, distribution);
                let many: Vec<f64> = once.iter().copied().cycle().take(n).collect();
                // After other draws, and with an incomplete last repetition.
                let late = [draws(2, 5000, distribution), many[..n - 99].to_vec()].concat();
                for list in [many, late] {
                    let result = read(&list).found().unwrap_or_else(|| panic!("{name}, {period}"));
                    assert_eq!(result.distance, period as u64, "{name}: {result:?}");
                    assert!(result.ln_p < -15.0, "{name}: {result:?}");
                    assert!(result.times.abs_diff((n / period) as u64) < 2, "{name}: {result:?}");
                }
            }
        }
    }

    #[test]
    fn short_periods_are_found() {
        for (name, distribution) in LAWS {
            for (period, times) in [(7, 3000), (100, 24), (100, 400), (1000, 17)] {
                let once = draws(4, period, distribution);
                if once.iter().all(|x| *x == once[0]) || name == "a coin of 0.02" && period < 999 {
                    continue;
                }
                let many: Vec<f64> = once.iter().copied().cycle().take(times * period).collect();
                let Some(result) = read(&many).found() else { panic!("{name}: {period}") };
                assert!(result.ln_p < -9.0, "{name}, {period}: {result:?}");
                assert_eq!(period as u64 % result.distance, 0, "{name}, {period}: {result:?}");
            }
        }
    }

    #[test]
    fn independent_draws_are_no_repetition() {
        for seed in 10..30 {
            for (name, distribution) in LAWS {
                let list = draws(seed, 100_000, distribution);
                let result = read(&list).found();
                assert!(result.is_none_or(|result| result.ln_p > -7.0), "{name}: {result:?}");
                let few = read(&list[..2000]).found();
                assert!(few.is_none_or(|result| result.ln_p > -7.0), "{name}: {few:?}");
            }
            for rare in [1e-3, 1e-5, 0.0] {
                let list = draws(seed, 300_000, |u| f64::from(u8::from(u < rare)));
                let result = read(&list).found();
                assert!(result.is_none_or(|result| result.ln_p > -7.0), "{rare}: {result:?}");
            }
        }
    }

    #[test]
    fn a_bet_pays_what_its_order_is_worth() {
        // Twelve tokens of a fair coin, six of each: 12!/(6! 6!) = 924.
        let scheme = Scheme { filler: None, window: 1, bet: 12, bases: [BASE; 2] };
        let mut sequences = Sequences::default();
        for token in 0..12 {
            sequences.take(&scheme, token % 2, token);
        }
        assert!((sequences.ln_orders(&scheme, 11) - 924f64.ln()).abs() < 1e-12);
    }
}
