//! The settings of a particle: its rule, roulette and splitting.

use media::catalogue::{Domain, Settings};
use theory::ParticleRule;

/// The collisions after which both the scattered particle and the one that goes straight on are followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Splitting {
    /// Never: one particle at most.
    None,
    /// Up to n times on any path from the start: 2ⁿ particles at most.
    Depth(u32),
    /// Up to n times in a walk: n + 1 particles at most.
    Budget(u32),
}

impl Splitting {
    /// Returns whether a collision splits, after `depth` splits on the way from the start and `total` in the walk
    /// as a whole.
    pub fn splits(self, depth: u32, total: u32) -> bool {
        match self {
            Self::None => false,
            Self::Depth(maximum) => depth < maximum,
            Self::Budget(maximum) => total < maximum,
        }
    }
}

/// The settings of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleSettings {
    /// The rule at a collision that does not split.
    pub rule: ParticleRule,
    /// w₀, the weight below which roulette is played.
    pub roulette: Option<f64>,
    /// Choice of the collisions that split.
    pub splitting: Splitting,
}

impl ParticleSettings {
    /// A particle with a rule, and neither roulette nor splitting.
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
        });
        let roulette = roulette.ok()?;
        let rule = ParticleRule::ALL.into_iter().find(|rule| Some(rule.name()) == word)?;
        Some(Self { roulette, ..Self::of(rule) })
    }

    /// Reads `rule`, `roulette`, and `depth` or `budget`.
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

    /// Settings in words.
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
