//! The honest particle: a rule, and where asked for roulette and splitting.

use super::walk::Steps;
use media::catalogue::{Domain, Settings};
use numeric::rng::Stream;
use theory::{Odds, ParticleRule};

/// How far both of what a collision leaves are followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Splitting {
    /// Never: one particle at most.
    None,
    /// Up to so many times on any way from the start: 2ⁿ particles at most.
    Depth(u32),
    /// Up to so many times in a walk: n + 1 particles at most.
    Budget(u32),
}

/// How a particle walks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// What happens at a collision that does not split.
    pub rule: ParticleRule,
    /// w₀, the weight below which roulette is played.
    pub roulette: Option<f64>,
    /// Which collisions split.
    pub splitting: Splitting,
}

impl Particle {
    /// By a rule alone.
    pub fn of(rule: ParticleRule) -> Self {
        Self { rule, roulette: None, splitting: Splitting::None }
    }

    /// Reads `rule` and `roulette`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let names = ParticleRule::ALL.map(ParticleRule::name);
        let word = settings.word("rule", &names);
        let roulette = settings.optional("roulette", |key| {
            let below = settings.number(key, Domain::Positive)?;
            if below > 1.0 {
                settings.fault(key, "`roulette` is above 1", "a particle begins with weight 1");
                return None;
            }
            Some(below)
        })?;
        let rule = ParticleRule::ALL.into_iter().find(|rule| Some(rule.name()) == word)?;
        Some(Self { roulette, ..Self::of(rule) })
    }

    /// Reads `depth` or `budget` too.
    pub fn read_splitting(settings: &Settings) -> Option<Self> {
        let particle = Self::read(settings);
        let splitting = match (settings.has("depth"), settings.has("budget")) {
            (true, false) => settings.count("depth", 1..=10).map(whole).map(Splitting::Depth),
            (false, true) => settings.count("budget", 1..=1000).map(whole).map(Splitting::Budget),
            _ => {
                let help = "give `depth = n` (2ⁿ particles at most) or `budget = n`, not both";
                settings.fault_at(settings.span.clone(), "", "splitting needs a bound", help);
                None
            }
        };
        Some(Self { splitting: splitting?, ..particle? })
    }

    /// Its settings in words.
    pub fn label(&self) -> String {
        let splitting = match self.splitting {
            Splitting::None => String::new(),
            Splitting::Depth(n) => format!(", depth {n}"),
            Splitting::Budget(n) => format!(", budget {n}"),
        };
        let roulette = self.roulette.map(|below| format!(", roulette {below}"));
        format!("{}{splitting}{}", self.rule.name(), roulette.unwrap_or_default())
    }
}

#[allow(clippy::cast_possible_truncation)] // at most a thousand
fn whole(count: u64) -> u32 {
    count as u32
}

impl Steps for Particle {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.rule.odds(ratio, albedo)
    }

    #[inline(always)]
    fn splits(&self, depth: u32, total: u32) -> bool {
        match self.splitting {
            Splitting::None => false,
            Splitting::Depth(most) => depth < most,
            Splitting::Budget(most) => total < most,
        }
    }

    #[inline(always)]
    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        let Some(below) = self.roulette else { return Some(weight) };
        if weight.abs() >= below {
            return Some(weight);
        }
        (rng.uniform() * below < weight.abs()).then(|| below.copysign(weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::rng::Address;

    #[test]
    fn what_roulette_takes_it_gives_back() {
        let particle =
            Particle { roulette: Some(0.4), ..Particle::of(ParticleRule::NonTerminating) };
        let mut rng = Address { seed: 1, experiment: 2, block: 3, lane: 4 }.stream();
        assert_eq!(particle.keep(&mut rng, 0.4), Some(0.4));
        assert_eq!(particle.keep(&mut rng, 0.0), None);
        for weight in [0.1, -0.3] {
            let draws = 100_000;
            let kept = (0..draws).filter_map(|_| particle.keep(&mut rng, weight));
            let mean = kept.sum::<f64>() / f64::from(draws);
            // A standard deviation of 0.0006 at most.
            assert!((mean - weight).abs() < 0.004, "{mean} for {weight}");
        }
    }

    #[test]
    fn splitting_has_a_bound() {
        let rule = Particle::of(ParticleRule::Analog);
        let depth = Particle { splitting: Splitting::Depth(2), ..rule };
        assert!(!rule.splits(0, 0) && depth.splits(1, 99) && !depth.splits(2, 2));
        let budget = Particle { splitting: Splitting::Budget(3), ..rule };
        assert!(budget.splits(9, 2) && !budget.splits(0, 3));
        assert_eq!(budget.label(), "analog, budget 3");
    }
}
