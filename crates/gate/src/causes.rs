//! Likely causes of a failure, by its pattern.
//!
//! A pattern is which checks failed, and on which side. The causes of a pattern are the frequent kinds of the known
//! bugs (`trueflight self-test`) that leave it. They are likely, not certain.

mod table;

pub use table::{CAUSES, Cause, Line, TABLE, line};

/// The side on which a quantity is off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Side {
    /// It was not found to be off.
    #[default]
    Right,
    /// Too small.
    Low,
    /// Too large.
    High,
    /// Too small in one channel, too large in another, or off without a side.
    Both,
}

impl Side {
    /// Whether the quantity is off.
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
pub enum Place {
    /// Everywhere, here and there, or nothing was swept.
    #[default]
    Anywhere,
    /// At the smallest swept values only.
    LowEnd,
    /// At the largest swept values only.
    HighEnd,
}

impl Place {
    /// Likely cause of a failure there, whatever fails.
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

/// Which checks of an experiment fail, and on which side.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // one for each check that has no side
pub struct Pattern {
    /// The mean.
    pub mean: Side,
    /// The variance.
    pub variance: Side,
    /// The number of lookups: its mean, or its distribution.
    pub lookups: Side,
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
    /// Part of the sweep.
    pub place: Place,
}

impl Pattern {
    /// Adds a check that failed; `off` is the deviation, where the check has one.
    pub fn note(&mut self, check: &str, off: Option<f64>) {
        match check {
            "mean" => self.mean.note(off),
            "variance" => self.variance.note(off),
            "lookups" => self.lookups.note(off),
            "counts" if self.lookups == Side::Right => self.lookups = Side::Both,
            "covariance" | "curve" => self.curve = true,
            "atoms" | "distances" | "depth" => self.distribution = true,
            "invariant" => self.balance = true,
            "numeric" => self.number = true,
            "dispersion" | "streams" | "generator" => self.dependence = true,
            "resolution" => self.resolution = true,
            _ => {}
        }
    }
}

impl Pattern {
    /// The pattern in words: `the mean is high, the variance low`.
    pub fn words(&self) -> String {
        let side = |side: Side| match side {
            Side::Right => "right",
            Side::Low => "low",
            Side::High => "high",
            Side::Both => "off",
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
        ];
        said.extend(others.iter().filter(|other| other.0).map(|other| other.1.to_owned()));
        match self.place {
            Place::Anywhere => {}
            Place::LowEnd => said.push("only at the low end of the sweep".to_owned()),
            Place::HighEnd => said.push("only at the high end of the sweep".to_owned()),
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
