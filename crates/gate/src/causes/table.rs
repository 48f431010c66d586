//! Patterns of failures and the kinds of bugs that leave them.
//!
//! The first line that applies to a pattern counts. Its causes are the kinds that most of the known bugs of that
//! pattern are of; `tests/it/causes.rs` holds the table against all of them.

use super::{Pattern, Side};

/// A kind of bug.
#[derive(Debug, PartialEq, Eq)]
pub struct Cause {
    /// Its name in the manual.
    pub name: &'static str,
    /// What is wrong with the program.
    pub text: &'static str,
}

/// A line of the table.
pub struct Line {
    /// The pattern in words.
    pub pattern: &'static str,
    /// Whether a pattern is of this line.
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

/// The table.
pub static TABLE: &[Line] = &[
    Line {
        pattern: "a draw is no finite number, or out of its range",
        applies: |p| p.number,
        causes: &[&WEIGHT, &PROBABILITY],
    },
    Line {
        pattern: "draws lack bits, the mean is right",
        applies: |p| p.resolution && !p.mean.is_off(),
        causes: &[&PRECISION],
    },
    Line {
        pattern: "draws depend on each other, mean and variance are right",
        applies: |p| p.dependence && !is_sided(p),
        causes: &[&NUMBERS],
    },
    Line {
        pattern: "a walk does not balance, the mean is right",
        applies: |p| p.balance && !p.mean.is_off(),
        causes: &[&WEIGHT, &PROBABILITY, &PRECISION],
    },
    Line {
        pattern: "a walk does not balance, the mean is high, the variance low",
        applies: |p| p.balance && (p.mean, p.variance) == (Side::High, Side::Low),
        causes: &[&WEIGHT],
    },
    Line {
        pattern: "a walk does not balance",
        applies: |p| p.balance,
        causes: &[&CONTROL, &WEIGHT, &PROBABILITY, &DENSITIES],
    },
    Line {
        pattern: "lookups are off, mean and variance are right",
        applies: |p| p.lookups.is_off() && !p.mean.is_off() && !p.variance.is_off(),
        causes: &[&LOOKUP, &FLIGHT],
    },
    Line {
        pattern: "lookups are high, the mean is high",
        applies: |p| (p.lookups, p.mean) == (Side::High, Side::High),
        causes: &[&PROBABILITY, &NUMBERS, &ENDING, &FLIGHT],
    },
    Line {
        pattern: "lookups are high, the mean is low",
        applies: |p| (p.lookups, p.mean) == (Side::High, Side::Low),
        causes: &[&FLIGHT, &NUMBERS, &WEIGHT],
    },
    Line {
        pattern: "lookups are low, the mean is high",
        applies: |p| (p.lookups, p.mean) == (Side::Low, Side::High),
        causes: &[&FLIGHT, &PROBABILITY, &ENDING, &NUMBERS],
    },
    Line {
        pattern: "lookups are low, the mean is low",
        applies: |p| (p.lookups, p.mean) == (Side::Low, Side::Low),
        causes: &[&LOOKUP, &ENDING, &NUMBERS, &WEIGHT],
    },
    Line {
        pattern: "lookups are off in another way, with the mean or the variance",
        applies: |p| p.lookups.is_off(),
        causes: &[&NUMBERS, &DIRECTIONS, &CHANNELS, &FLIGHT],
    },
    Line {
        pattern: "the variance is off, the mean is right",
        applies: |p| p.variance.is_off() && !p.mean.is_off(),
        causes: &[&ANOTHER, &CONTROL, &NUMBERS],
    },
    Line {
        pattern: "the mean is high in one channel and low in another",
        applies: |p| p.mean == Side::Both,
        causes: &[&CHANNELS, &DENSITIES, &WEIGHT, &DIRECTIONS],
    },
    Line {
        pattern: "the distribution differs",
        applies: |p| p.distribution,
        causes: &[&FLIGHT, &CONTROL, &LOOKUP],
    },
    Line {
        pattern: "the mean is high, the variance high",
        applies: |p| p.mean == Side::High && matches!(p.variance, Side::High | Side::Both),
        causes: &[&DENSITIES, &SCORE, &WEIGHT, &CONTROL],
    },
    Line {
        pattern: "the mean is low, the variance low",
        applies: |p| p.mean == Side::Low && matches!(p.variance, Side::Low | Side::Both),
        causes: &[&WEIGHT, &DENSITIES, &SCORE, &DIRECTIONS],
    },
    Line {
        pattern: "the mean is low, the variance high",
        applies: |p| (p.mean, p.variance) == (Side::Low, Side::High),
        causes: &[&CONTROL, &LOOKUP, &SCORE, &DENSITIES],
    },
    Line {
        pattern: "the mean is high, the variance low",
        applies: |p| (p.mean, p.variance) == (Side::High, Side::Low),
        causes: &[&WEIGHT, &PROBABILITY],
    },
    Line {
        pattern: "the mean is high, the variance is right or not tested",
        applies: |p| p.mean == Side::High,
        causes: &[&DENSITIES, &WEIGHT, &SCORE],
    },
    Line {
        pattern: "the mean is low, the variance is right or not tested",
        applies: |p| p.mean == Side::Low,
        causes: &[&DENSITIES, &WEIGHT, &DIRECTIONS, &ENDING],
    },
    Line {
        pattern: "values of one walk are wrongly correlated, each by itself is right",
        applies: |p| p.curve,
        causes: &[&NUMBERS, &FLIGHT],
    },
];

/// Whether the mean, the variance or the number of lookups is off to one side.
fn is_sided(pattern: &Pattern) -> bool {
    pattern.mean.is_off()
        || pattern.variance.is_off()
        || matches!(pattern.lookups, Side::Low | Side::High)
}

/// The line of a pattern; `None` where nothing failed.
pub fn line(pattern: &Pattern) -> Option<&'static Line> {
    TABLE.iter().find(|line| (line.applies)(pattern))
}
