//! Likely causes of a failure, given its pattern.
//!
//! A pattern says which checks failed, and on which side. The causes of a pattern are the frequent kinds among the
//! known bugs (`trueflight-lab self-test`) with this pattern. They are likely, not certain.

use crate::CheckId;

/// The side on which a quantity deviates.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum DeviationSide {
    /// No deviation was found.
    #[default]
    Right,
    /// Too small.
    Low,
    /// Too large.
    High,
    /// Too small in one channel, too large in another, or deviating without a side.
    Both,
}

impl DeviationSide {
    /// Returns whether the quantity deviates.
    pub fn is_off(self) -> bool {
        self != Self::Right
    }

    /// A sign for tables: `0`, `-`, `+` or `*`.
    pub fn sign(self) -> char {
        match self {
            Self::Right => '0',
            Self::Low => '-',
            Self::High => '+',
            Self::Both => '*',
        }
    }

    fn note(&mut self, off: Option<f64>) {
        let side = match off {
            Some(off) if off > 0.0 => Self::High,
            Some(off) if off < 0.0 => Self::Low,
            _ => Self::Both,
        };
        *self = if *self == Self::Right || *self == side { side } else { Self::Both };
    }
}

/// Part of a sweep in which an estimator fails.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SweepPart {
    /// Anywhere in the sweep, or nothing was swept.
    #[default]
    Anywhere,
    /// At the smallest swept values only.
    LowEnd,
    /// At the largest swept values only.
    HighEnd,
}

impl SweepPart {
    /// Likely cause of a failure in this part, for any check that fails.
    pub fn hint(self) -> Option<&'static str> {
        match self {
            Self::Anywhere => None,
            Self::LowEnd => Some(
                "where σ̂ is small, σ_t exceeds it: 1 − σ_t/σ̂ is negative there, and its sign, its size or a probability \
                 made of it is wrong",
            ),
            Self::HighEnd => Some(
                "where σ̂ is large, walks have many collisions: a cap on them, an early end, or rounding of small steps",
            ),
        }
    }
}

/// Symptom of the failure of a check: its contribution to a [`Pattern`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symptom {
    /// The mean is off.
    Mean,
    /// The variance is off.
    Variance,
    /// The mean number of lookups is off.
    Lookups,
    /// The numbers of lookups have another distribution.
    LookupDistribution,
    /// Values of one walk are wrongly correlated.
    Correlation,
    /// The values have another distribution.
    Distribution,
    /// A walk does not balance.
    Balance,
    /// A draw is not a finite number, or is out of its range.
    Number,
    /// Draws depend on each other, or random numbers repeat.
    Dependence,
    /// Draws or positions lack bits.
    Resolution,
}

/// Checks of an experiment that fail, and the side of each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // one for each check that has no side
pub struct Pattern {
    /// The mean.
    pub mean: DeviationSide,
    /// The variance.
    pub variance: DeviationSide,
    /// The number of lookups: its mean, or its distribution.
    pub lookups: DeviationSide,
    /// A covariance, or the curve along one walk.
    pub curve: bool,
    /// The distribution of free flights or of the values.
    pub distribution: bool,
    /// The balance of each walk.
    pub balance: bool,
    /// A draw that is not a finite number, or out of its range.
    pub number: bool,
    /// Draws that depend on each other, or random numbers that repeat.
    pub dependence: bool,
    /// Draws or positions that lack bits.
    pub resolution: bool,
    /// All draws are 0 or 1, which says nothing about weights; false where that is not known.
    pub binary: bool,
    /// Part of the sweep.
    pub place: SweepPart,
}

impl Pattern {
    /// Adds a check that failed; `off` is the deviation, where the check has one.
    pub fn note(&mut self, check: CheckId, off: Option<f64>) {
        match check.symptom() {
            Symptom::Mean => self.mean.note(off),
            Symptom::Variance => self.variance.note(off),
            Symptom::Lookups => self.lookups.note(off),
            Symptom::LookupDistribution => {
                if self.lookups == DeviationSide::Right {
                    self.lookups = DeviationSide::Both;
                }
            }
            Symptom::Correlation => self.curve = true,
            Symptom::Distribution => self.distribution = true,
            Symptom::Balance => self.balance = true,
            Symptom::Number => self.number = true,
            Symptom::Dependence => self.dependence = true,
            Symptom::Resolution => self.resolution = true,
        }
    }

    /// The pattern in words: `the mean is high, the variance low`.
    pub fn words(&self) -> String {
        let side = |side: DeviationSide| match side {
            DeviationSide::Right => "right",
            DeviationSide::Low => "low",
            DeviationSide::High => "high",
            DeviationSide::Both => "off",
        };
        let sides = [
            ("the mean", self.mean),
            ("the variance", self.variance),
            ("the number of lookups", self.lookups),
        ];
        let mut said: Vec<String> = sides
            .iter()
            .filter(|(_, of)| of.is_off())
            .map(|(what, of)| format!("{what} is {}", side(*of)))
            .collect();
        let others = [
            (self.curve, "draws of one walk are wrongly correlated"),
            (self.distribution, "the distribution differs"),
            (self.balance, "a walk does not balance"),
            (self.number, "a draw is no finite number or out of its range"),
            (self.dependence, "draws depend on each other"),
            (self.resolution, "draws lack bits"),
            (self.binary, "draws are 0 or 1"),
        ];
        said.extend(others.iter().filter(|other| other.0).map(|other| other.1.to_owned()));
        match self.place {
            SweepPart::Anywhere => {}
            SweepPart::LowEnd => said.push("only at the low end of the sweep".to_owned()),
            SweepPart::HighEnd => said.push("only at the high end of the sweep".to_owned()),
        }
        said.join(", ")
    }

    /// The lines that follow a failure: its likely causes, and where the manual says more. Empty without a failure.
    pub fn lines(&self) -> Vec<String> {
        let Some(line) = line(self) else { return Vec::new() };
        let mut lines = vec![format!("usual causes where {}:", self.words())];
        lines.extend(self.place.hint().map(|hint| format!("- {hint}")));
        lines.extend(line.causes.iter().map(|cause| format!("- {}", cause.text)));
        lines.push(format!("more in the manual: {PAGE}, \"My estimator fails\""));
        lines
    }
}

/// The page of the manual about failures.
pub const PAGE: &str = "docs/failures.md";

/// A kind of bug.
#[derive(Debug, PartialEq, Eq)]
pub struct Cause {
    /// Name in the manual.
    pub name: &'static str,
    /// What is wrong with the program.
    pub text: &'static str,
}

/// A line of the table.
pub struct CauseRow {
    /// The pattern in words.
    pub pattern: &'static str,
    /// Returns true for patterns of this line.
    applies: fn(&Pattern) -> bool,
    /// The likely causes, the most frequent first.
    pub causes: &'static [&'static Cause],
}

macro_rules! kinds {
    ($($constant:ident = $name:literal: $text:literal;)*) => {
        $(static $constant: Cause = Cause { name: $name, text: $text };)*

        /// Every kind of bug.
        pub static CAUSES: &[&Cause] = &[$(&$constant),*];
    };
}

kinds! {
    WEIGHT = "weight": "a factor of the weight is missing, applied twice, clamped at 0 or without its sign (1/q, 1 − r, albedo, transmittance)";
    DENSITIES = "densities": "densities or weights of combined techniques are incomplete: a term of the sum, null collisions, a transmittance or a cosine is missing";
    SCORE = "score": "a contribution is missing or counted twice: the first or last flight, light that two techniques find";
    PROBABILITY = "probability": "a probability is not the one that the weight assumes: a majorant that is too low, σ_t of another channel, a rule out of its range";
    FLIGHT = "flight": "distances are wrong: the logarithm, σ̂ of another place, a boundary that is flown over, the begin or the end of the ray";
    LOOKUP = "lookup": "σ_t is looked up at the wrong place, along the reversed ray, or once too often";
    ENDING = "ending": "walks end too early or too late: a cap on collisions, a cut-off, roulette whose survivors keep their weight";
    CONTROL = "control": "the integral of the control is not the integral of what lookups subtract (T_c, residual)";
    DIRECTIONS = "directions": "a direction, a cosine or a phase function is wrong: its sign, its frame, a squared distance";
    CHANNELS = "channels": "a quantity of one channel is used for another: majorant, phase function, hero";
    NUMBERS = "numbers": "random numbers are used twice: for two decisions, or by two blocks, threads or passes of one seed";
    PRECISION = "precision": "single precision, or random numbers of too few bits";
    ANOTHER = "another": "the estimator is unbiased, but another one than claimed: averaged draws, another rule or other weights";
}

/// Patterns of failures and the kinds of bugs that cause them. The first line that applies to a pattern counts. Its
/// causes are the kinds of most known bugs with that pattern; `tests/it/newcomers/causes.rs` compares the table with all of
/// them.
pub static TABLE: &[CauseRow] = &[
    CauseRow {
        pattern: "a draw is no finite number, or out of its range",
        applies: |p| p.number,
        causes: &[&WEIGHT, &PROBABILITY],
    },
    CauseRow {
        pattern: "draws lack bits, the mean is right",
        applies: |p| p.resolution && !p.mean.is_off(),
        causes: &[&PRECISION],
    },
    CauseRow {
        pattern: "draws depend on each other, mean and variance are right",
        applies: |p| p.dependence && !is_sided(p),
        causes: &[&NUMBERS],
    },
    CauseRow {
        pattern: "a walk does not balance, the mean is right",
        applies: |p| p.balance && !p.mean.is_off(),
        causes: &[&WEIGHT, &PROBABILITY, &PRECISION],
    },
    CauseRow {
        pattern: "a walk does not balance, the mean is high, the variance low",
        applies: |p| p.balance && (p.mean, p.variance) == (DeviationSide::High, DeviationSide::Low),
        causes: &[&WEIGHT],
    },
    CauseRow {
        pattern: "a walk does not balance",
        applies: |p| p.balance,
        causes: &[&CONTROL, &WEIGHT, &PROBABILITY, &DENSITIES],
    },
    CauseRow {
        pattern: "lookups are off, mean and variance are right",
        applies: |p| p.lookups.is_off() && !p.mean.is_off() && !p.variance.is_off(),
        causes: &[&LOOKUP, &FLIGHT],
    },
    CauseRow {
        pattern: "lookups are high, the mean is high",
        applies: |p| (p.lookups, p.mean) == (DeviationSide::High, DeviationSide::High),
        causes: &[&PROBABILITY, &NUMBERS, &ENDING, &FLIGHT],
    },
    CauseRow {
        pattern: "lookups are high, the mean is low",
        applies: |p| (p.lookups, p.mean) == (DeviationSide::High, DeviationSide::Low),
        causes: &[&FLIGHT, &NUMBERS, &WEIGHT, &LOOKUP],
    },
    CauseRow {
        pattern: "lookups are low, the mean is high",
        applies: |p| (p.lookups, p.mean) == (DeviationSide::Low, DeviationSide::High),
        causes: &[&FLIGHT, &PROBABILITY, &ENDING, &NUMBERS],
    },
    CauseRow {
        pattern: "lookups are low, the mean is low",
        applies: |p| (p.lookups, p.mean) == (DeviationSide::Low, DeviationSide::Low),
        causes: &[&LOOKUP, &ENDING, &NUMBERS, &WEIGHT],
    },
    CauseRow {
        pattern: "lookups are off in another way, with the mean or the variance",
        applies: |p| p.lookups.is_off(),
        causes: &[&NUMBERS, &DIRECTIONS, &CHANNELS, &FLIGHT],
    },
    CauseRow {
        pattern: "draws are 0 or 1, the share of 1 is off",
        applies: |p| p.binary && (p.mean.is_off() || p.distribution),
        causes: &[&PROBABILITY, &LOOKUP, &FLIGHT, &ENDING],
    },
    CauseRow {
        pattern: "the variance is off, the mean is right",
        applies: |p| p.variance.is_off() && !p.mean.is_off(),
        causes: &[&ANOTHER, &CONTROL, &NUMBERS],
    },
    CauseRow {
        pattern: "the mean is high in one channel and low in another",
        applies: |p| p.mean == DeviationSide::Both,
        causes: &[&CHANNELS, &DENSITIES, &WEIGHT, &DIRECTIONS],
    },
    CauseRow {
        pattern: "the distribution differs",
        applies: |p| p.distribution,
        causes: &[&FLIGHT, &CONTROL, &LOOKUP],
    },
    CauseRow {
        pattern: "the mean is high, the variance high",
        applies: |p| {
            p.mean == DeviationSide::High
                && matches!(p.variance, DeviationSide::High | DeviationSide::Both)
        },
        causes: &[&DENSITIES, &SCORE, &WEIGHT, &CONTROL],
    },
    CauseRow {
        pattern: "the mean is low, the variance low",
        applies: |p| {
            p.mean == DeviationSide::Low
                && matches!(p.variance, DeviationSide::Low | DeviationSide::Both)
        },
        causes: &[&WEIGHT, &DENSITIES, &SCORE, &DIRECTIONS],
    },
    CauseRow {
        pattern: "the mean is low, the variance high",
        applies: |p| (p.mean, p.variance) == (DeviationSide::Low, DeviationSide::High),
        causes: &[&CONTROL, &LOOKUP, &SCORE, &DENSITIES],
    },
    CauseRow {
        pattern: "the mean is high, the variance low",
        applies: |p| (p.mean, p.variance) == (DeviationSide::High, DeviationSide::Low),
        causes: &[&WEIGHT, &PROBABILITY],
    },
    CauseRow {
        pattern: "the mean is high, the variance is right or not tested",
        applies: |p| p.mean == DeviationSide::High,
        causes: &[&DENSITIES, &WEIGHT, &SCORE],
    },
    CauseRow {
        pattern: "the mean is low, the variance is right or not tested",
        applies: |p| p.mean == DeviationSide::Low,
        causes: &[&DENSITIES, &WEIGHT, &DIRECTIONS, &ENDING],
    },
    CauseRow {
        pattern: "values of one walk are wrongly correlated, each by itself is right",
        applies: |p| p.curve,
        causes: &[&NUMBERS, &FLIGHT],
    },
];

/// Returns whether the mean, the variance or the number of lookups deviates to one side.
fn is_sided(pattern: &Pattern) -> bool {
    pattern.mean.is_off()
        || pattern.variance.is_off()
        || matches!(pattern.lookups, DeviationSide::Low | DeviationSide::High)
}

/// The line of a pattern; `None` where nothing failed.
pub fn line(pattern: &Pattern) -> Option<&'static CauseRow> {
    TABLE.iter().find(|line| (line.applies)(pattern))
}
