//! What a handle holds.

use std::ffi::CString;
use std::mem;
use std::rc::Rc;

#[cfg(feature = "theory")]
use trueflight::check::CheckError;
use trueflight::check::{MOST, Outcome, Pushed};
use trueflight::judge::trial::BUFFER;
use trueflight::rng::{Address, name_hash};

use crate::check::Common;
use crate::random::Rng;
use crate::status::{Error, Status, c_text};

/// How far a check is.
enum Stage {
    /// It is being set up.
    SetUp(Box<trueflight::Check<()>>),
    /// It waits for draws.
    Open(Box<Pushed>),
    /// It is judged.
    Judged(Box<Outcome>),
    /// An error ended it.
    Ended,
}

/// What was said, the draws so far, the verdict, or an error.
pub(crate) struct State {
    common: Rc<Common>,
    stage: Stage,
    /// The truths that were said; a single one serves all values of a draw.
    truths: Vec<f64>,
    /// How many draws are made, where that is said.
    pub(crate) draws: Option<u64>,
    pub(crate) seed: u64,
    /// The number of the next block that a callback makes.
    block: u64,
    fault: Option<Error>,
    /// What C reads: the verdict's lines, and its reason.
    text: CString,
    reason: CString,
    /// Texts that an error replaced: C may still read them.
    old: Vec<CString>,
}

impl State {
    pub(crate) fn new(common: Rc<Common>) -> Self {
        Self {
            stage: Stage::SetUp(Box::new(trueflight::claim(common.name.as_str()))),
            common,
            truths: Vec::new(),
            draws: None,
            seed: 1,
            block: 0,
            fault: None,
            text: CString::default(),
            reason: CString::default(),
            old: Vec::new(),
        }
    }

    fn error(&self, status: Status, what: &str) -> Error {
        Error::new(status, format!("check `{}`: {what}", self.common.name))
    }

    /// An error of the border, with the check's name; all others have it.
    pub(crate) fn placed(&self, error: Error) -> Error {
        match error.status {
            Status::NullPointer | Status::Text | Status::Internal
                if !error.message.starts_with("check `") =>
            {
                self.error(error.status, &error.message)
            }
            _ => error,
        }
    }

    /// The first error.
    pub(crate) fn fault(&self) -> Option<&Error> {
        self.fault.as_ref()
    }

    /// Keeps an error: no verdict may come of what went wrong.
    pub(crate) fn spoil(&mut self, error: &Error) {
        self.stage = Stage::Ended;
        let (text, reason) = (c_text(&error.message), c_text(&error.message));
        self.old
            .extend([mem::replace(&mut self.text, text), mem::replace(&mut self.reason, reason)]);
        self.fault = Some(error.clone());
    }

    /// Says something of the draws, if it makes sense by itself.
    pub(crate) fn say(
        &mut self,
        sense: Result<(), String>,
        what: impl FnOnce(trueflight::Check<()>) -> trueflight::Check<()>,
    ) -> Result<(), Error> {
        sense.map_err(|what| self.error(Status::Claim, &what))?;
        match mem::replace(&mut self.stage, Stage::Ended) {
            Stage::SetUp(check) => {
                self.stage = Stage::SetUp(Box::new(what(*check)));
                Ok(())
            }
            _ => Err(self.error(Status::Order, "say what is known before the first draw")),
        }
    }

    /// Says what the mean is: of each value, or one for all.
    pub(crate) fn say_truths(
        &mut self,
        sense: Result<(), String>,
        truths: Vec<f64>,
    ) -> Result<(), Error> {
        self.say(sense, |said| said.truth(truths.clone()))?;
        self.truths = truths;
        Ok(())
    }

    /// Takes what is known from theory, which is looked at once; what else is missing may be said later.
    #[cfg(feature = "theory")]
    pub(crate) fn of(&mut self, case: &str, estimator: &str, swept: f64) -> Result<(), Error> {
        let swept = (!swept.is_nan()).then_some(swept);
        self.say(Ok(()), |said| said.of(case, estimator, swept))?;
        match &self.stage {
            Stage::SetUp(check) => match check.as_ref().clone().open() {
                Err(error @ CheckError::Case { .. }) => Err(error.into()),
                _ => Ok(()),
            },
            _ => Ok(()),
        }
    }

    /// There is no theory.
    #[cfg(not(feature = "theory"))]
    pub(crate) fn of(&mut self, case: &str, estimator: &str, _: f64) -> Result<(), Error> {
        let what = format!(
            "nothing is known of `{estimator}` of {case}: this library was built without theory; build it with the \
             feature `theory`, or give numbers"
        );
        Err(self.error(Status::Case, &what))
    }

    /// What takes draws; the first time, what was said is looked at.
    pub(crate) fn open(&mut self) -> Result<&mut Pushed, Error> {
        if let Some(error) = &self.fault {
            return Err(error.clone());
        }
        self.stage = match mem::replace(&mut self.stage, Stage::Ended) {
            Stage::SetUp(check) => Stage::Open(Box::new(check.open()?)),
            other => other,
        };
        match &mut self.stage {
            Stage::Open(pushed) => Ok(pushed),
            _ => Err(Error::new(
                Status::Order,
                format!("check `{}`: the verdict was given; make a new check", self.common.name),
            )),
        }
    }

    /// The same for draws of so many values.
    fn open_for(&mut self, values: usize) -> Result<(), Error> {
        let draws = if values == 1 { "1 value".into() } else { format!("{values} values") };
        let wrong = |what: String| format!("{what}, but a draw has {draws}");
        match (&self.stage, &self.truths[..]) {
            (Stage::SetUp(_), &[truth]) if values > 1 => {
                self.say(Ok(()), |said| said.truth(vec![truth; values]))?;
            }
            (Stage::SetUp(_), truths) if truths.len() > 1 && truths.len() != values => {
                let what = wrong(format!("{} truths", truths.len()));
                let what = format!("{what}; give one for each value, or one for all");
                return Err(self.error(Status::Claim, &what));
            }
            _ => {}
        }
        if matches!(self.stage, Stage::SetUp(_)) {
            self.say(Ok(()), |said| said.values(values))?;
        }
        let found = self.open()?.values();
        if found == values {
            return Ok(());
        }
        Err(self.error(Status::Claim, &wrong(format!("{found} values of the draws before"))))
    }

    /// Whether more draws may change what is said.
    pub(crate) fn is_open(&mut self) -> Result<bool, Error> {
        match &self.stage {
            Stage::Judged(_) => Ok(false),
            // How many values a draw has is not known yet.
            Stage::SetUp(check) => Ok(check.as_ref().clone().open()?.is_open()),
            _ => Ok(self.open()?.is_open()),
        }
    }

    /// Makes draws of so many values, block by block, until all is decided or there are enough. What fills a block
    /// answers how many draws it made; fewer than there is room for end it.
    pub(crate) fn run(
        &mut self,
        values: usize,
        mut fill: impl FnMut(&mut [f64], usize, &mut Rng) -> usize,
    ) -> Result<(), Error> {
        let (seed, experiment) = (self.seed, name_hash(&self.common.name));
        let (wanted, most) = (self.draws, self.draws.unwrap_or(MOST));
        let mut block = self.block_of(values, room(most))?;
        self.open_for(values)?;
        loop {
            let number = self.block;
            self.block += 1;
            let pushed = self.open()?;
            let left = most.saturating_sub(pushed.draws());
            if left == 0 || (wanted.is_none() && !pushed.is_open()) {
                return Ok(());
            }
            let room = room(left);
            let address = Address { seed, experiment, block: number, lane: 0 };
            let made = fill(&mut block[..room * values], room, &mut Rng::of(&address.stream()));
            self.common.misuse()?;
            if made > room {
                let what = format!("the callback tells {made} draws, but was asked for {room}");
                return Err(self.error(Status::Callback, &what));
            }
            self.open()?.absorb(&block[..made * values])?;
            if made < room {
                return Ok(());
            }
        }
    }

    /// Memory for draws of so many values, which no later write may leave.
    fn block_of(&self, values: usize, draws: usize) -> Result<Vec<f64>, Error> {
        if values == 0 {
            let what = "a draw has 0 values; it must have 1 at least";
            return Err(self.error(Status::Draws, what));
        }
        let mut block = Vec::new();
        let numbers = values.checked_mul(draws).filter(|&n| block.try_reserve_exact(n).is_ok());
        let Some(numbers) = numbers else {
            let what = format!("there is no memory for {draws} draws of {values} values");
            return Err(self.error(Status::Draws, &what));
        };
        block.resize(numbers, 0.0);
        Ok(block)
    }

    /// The verdict, with its texts; the first time, all draws are judged.
    pub(crate) fn judged(&mut self) -> Result<&Outcome, Error> {
        if let Some(error) = &self.fault {
            return Err(error.clone());
        }
        if !matches!(self.stage, Stage::Judged(_)) {
            self.judge().inspect_err(|error| self.spoil(error))?;
        }
        match &self.stage {
            Stage::Judged(outcome) => Ok(outcome),
            _ => Err(self.error(Status::Internal, "no verdict")),
        }
    }

    fn judge(&mut self) -> Result<(), Error> {
        self.open()?;
        let Stage::Open(pushed) = mem::replace(&mut self.stage, Stage::Ended) else {
            return Err(self.error(Status::Internal, "not open"));
        };
        let outcome = pushed.verdict()?;
        (self.text, self.reason) = (c_text(&outcome.to_string()), c_text(&outcome.reason()));
        self.stage = Stage::Judged(Box::new(outcome));
        Ok(())
    }

    /// The verdict's lines, or the error.
    pub(crate) fn text(&self) -> &CString {
        &self.text
    }

    /// Why it does not pass.
    pub(crate) fn reason(&self) -> &CString {
        &self.reason
    }
}

/// How many draws the next block has, if so many are left.
fn room(left: u64) -> usize {
    usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER))
}
