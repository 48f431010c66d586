//! What a handle holds.

use std::ffi::CString;
use std::mem;

use trueflight::check::{MOST, Outcome, Pushed};
use trueflight::judge::trial::BUFFER;
use trueflight::rng::{Address, name_hash};

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

/// A check: a name, what is known of a draw, and the verdict on draws.
pub struct Check {
    name: String,
    stage: Stage,
    /// How many draws are made, where that is said.
    pub(crate) draws: Option<u64>,
    pub(crate) seed: u64,
    /// The number of the next block that a callback makes.
    block: u64,
    fault: Option<Error>,
    /// What C reads: the verdict's lines, and its reason.
    text: CString,
    reason: CString,
}

impl Check {
    pub(crate) fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            stage: Stage::SetUp(Box::new(trueflight::claim(name))),
            draws: None,
            seed: 1,
            block: 0,
            fault: None,
            text: CString::default(),
            reason: CString::default(),
        }
    }

    fn error(&self, status: Status, what: &str) -> Error {
        Error::new(status, format!("check `{}`: {what}", self.name))
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
        self.text = c_text(&error.message);
        self.reason = self.text.clone();
        self.fault = Some(error.clone());
    }

    /// Says something of the draws.
    pub(crate) fn say(
        &mut self,
        what: impl FnOnce(trueflight::Check<()>) -> trueflight::Check<()>,
    ) -> Result<(), Error> {
        match mem::replace(&mut self.stage, Stage::Ended) {
            Stage::SetUp(check) => {
                self.stage = Stage::SetUp(Box::new(what(*check)));
                Ok(())
            }
            _ => Err(self.error(Status::Order, "say what is known before the first draw")),
        }
    }

    /// Takes what is known from theory, which is looked at once.
    #[cfg(feature = "theory")]
    pub(crate) fn of(&mut self, case: &str, estimator: &str, swept: f64) -> Result<(), Error> {
        let swept = (!swept.is_nan()).then_some(swept);
        self.say(|said| said.of(case, estimator, swept))
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
                format!("check `{}`: the verdict was given; make a new check", self.name),
            )),
        }
    }

    /// Asks for draws of one value.
    pub(crate) fn of_one_value(&mut self) -> Result<(), Error> {
        match self.open()?.values() {
            1 => Ok(()),
            values => {
                let what = format!("a draw has {values} values; make them by tf_check_run_batches");
                Err(self.error(Status::Draws, &what))
            }
        }
    }

    /// Whether more draws may change what is said.
    pub(crate) fn is_open(&mut self) -> Result<bool, Error> {
        match self.stage {
            Stage::Judged(_) => Ok(false),
            _ => Ok(self.open()?.is_open()),
        }
    }

    /// Makes draws, block by block, until all is decided or there are enough. What fills a block answers how many
    /// draws it made; fewer than there is room for end it.
    pub(crate) fn run(
        &mut self,
        mut fill: impl FnMut(&mut [f64], usize, &mut Rng) -> usize,
    ) -> Result<(), Error> {
        let (seed, experiment) = (self.seed, name_hash(&self.name));
        let (wanted, most) = (self.draws, self.draws.unwrap_or(MOST));
        let values = self.open()?.values();
        let mut block = vec![0.0; BUFFER * values];
        loop {
            let number = self.block;
            self.block += 1;
            let pushed = self.open()?;
            let left = most.saturating_sub(pushed.draws());
            if left == 0 || (wanted.is_none() && !pushed.is_open()) {
                return Ok(());
            }
            let room = usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER));
            let address = Address { seed, experiment, block: number, lane: 0 };
            let made = fill(&mut block[..room * values], room, &mut Rng::of(&address.stream()));
            if made > room {
                let what = format!("the callback tells {made} draws, but was asked for {room}");
                return Err(self.error(Status::Callback, &what));
            }
            pushed.absorb(&block[..made * values])?;
            if made < room {
                return Ok(());
            }
        }
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
