//! Distribution of the hero channel. The walk of the hero scores all channels of a chromatic medium.

use super::Refusal;
use media::catalogue::{Domain, Settings, Value};
use numeric::digits::rounded;
use theory::problems::transmittance::luminance;

/// Largest error of the sum of probabilities.
const SUM: f64 = 1e-9;

/// Distribution of the hero channel.
#[derive(Debug, Clone, PartialEq)]
pub enum Heroes {
    /// Every channel with the same probability.
    Uniform,
    /// The weights of the luminance as probabilities.
    Luminance,
    /// One given probability for each channel.
    Given(Vec<f64>),
}

impl Heroes {
    /// Reads `hero`: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1.
    pub fn read(settings: &Settings) -> Option<Self> {
        let entry = settings.entry("hero");
        if !entry.is_some_and(|entry| matches!(entry.node.value, Value::Array(_))) {
            let word = settings.word_or("hero", &["uniform", "luminance"], "uniform")?;
            return Some(if word == "uniform" { Self::Uniform } else { Self::Luminance });
        }
        let given = settings.numbers("hero", Domain::Positive, 1)?;
        let sum: f64 = given.iter().sum();
        if (sum - 1.0).abs() > SUM {
            let message = format!("the probabilities sum to {}", rounded(sum));
            settings.fault("hero", message, "give each channel its share of 1");
            return None;
        }
        Some(Self::Given(given))
    }

    /// Label of the setting, as in `hero .2 .8`; empty where every channel has the same probability.
    pub fn label(&self) -> String {
        match self {
            Self::Uniform => String::new(),
            Self::Luminance => "hero by luminance".into(),
            Self::Given(given) => {
                let given: Vec<String> = given.iter().map(f64::to_string).collect();
                format!("hero {}", given.join(" "))
            }
        }
    }

    /// Probability of one of `count` channels; 0 of those that a list is too short for.
    #[inline(always)]
    pub fn probability(&self, count: usize, channel: usize) -> f64 {
        match self {
            Self::Luminance => luminance(count, channel),
            Self::Given(given) => given.get(channel).copied().unwrap_or_default(),
            Self::Uniform => 1.0 / count as f64,
        }
    }

    /// Probabilities of `count` channels.
    pub fn of(&self, count: usize) -> Vec<f64> {
        (0..count).map(|channel| self.probability(count, channel)).collect()
    }

    /// Requires one probability for each of `count` channels.
    ///
    /// # Errors
    ///
    /// The list has another number of probabilities.
    pub fn require(&self, count: usize) -> Result<(), Refusal> {
        match self {
            Self::Given(given) if given.len() != count => {
                let needs = "one hero probability for each channel";
                let actual = format!("there are {} for {count} channels", given.len());
                Err(Refusal::mismatch(needs, actual))
            }
            _ => Ok(()),
        }
    }
}
