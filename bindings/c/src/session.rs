//! State behind a `tf_check*`: a claim that is being set, a check that takes draws, or a verdict.

use std::ffi::CString;
use std::mem;
use std::rc::Rc;

use gate::check::{CheckError, Outcome, Pushed};

use crate::handle::Common;
use crate::random::Rng;
use crate::status::{Error, Status, c_text};

/// Stage of a check.
enum Stage {
    /// The claim is being set.
    Claim(Box<gate::Check<()>>),
    /// The check takes draws.
    Open(Box<Pushed>),
    /// The draws are judged.
    Judged(Box<Outcome>),
    /// An error ended the check.
    Ended,
}

/// Claim, draws so far, verdict, or error.
pub(crate) struct Session {
    common: Rc<Common>,
    stage: Stage,
    error: Option<Error>,
    /// Texts that C reads: the verdict's lines, and its reason.
    text: CString,
    reason: CString,
    /// Texts that an error replaced: C may still read them.
    old: Vec<CString>,
}

impl Session {
    pub(crate) fn new(common: Rc<Common>) -> Self {
        Self {
            stage: Stage::Claim(Box::new(gate::claim(common.name.as_str()))),
            common,
            error: None,
            text: CString::default(),
            reason: CString::default(),
            old: Vec::new(),
        }
    }

    pub(crate) fn error_of(&self, status: Status, what: &str) -> Error {
        self.common.error(status, what)
    }

    /// Adds the check's name to an error of [`crate::ffi`]; all others have it.
    pub(crate) fn named(&self, error: Error) -> Error {
        match error.status {
            Status::NullPointer | Status::Text | Status::Internal
                if !error.message.starts_with("check `") =>
            {
                self.error_of(error.status, &error.message)
            }
            _ => error,
        }
    }

    /// Returns the first error.
    pub(crate) fn error(&self) -> Option<&Error> {
        self.error.as_ref()
    }

    /// Ends the check with an error: there is no verdict.
    pub(crate) fn fail(&mut self, error: &Error) {
        self.stage = Stage::Ended;
        let (text, reason) = (c_text(&error.message), c_text(&error.message));
        self.old
            .extend([mem::replace(&mut self.text, text), mem::replace(&mut self.reason, reason)]);
        self.error = Some(error.clone());
    }

    /// Sets one property of the claim. The check validates the claim before its first draw.
    pub(crate) fn set(
        &mut self,
        set: impl FnOnce(gate::Check<()>) -> Result<gate::Check<()>, CheckError>,
    ) -> Result<(), Error> {
        match mem::replace(&mut self.stage, Stage::Ended) {
            Stage::Claim(check) => {
                self.stage = Stage::Claim(Box::new(set(*check)?));
                Ok(())
            }
            _ => Err(self.error_of(Status::Order, "set the claim before the first draw")),
        }
    }

    /// Returns the check that takes draws; the first call validates the claim.
    pub(crate) fn open(&mut self) -> Result<&mut Pushed, Error> {
        self.stage = match mem::replace(&mut self.stage, Stage::Ended) {
            Stage::Claim(check) => Stage::Open(Box::new(check.open()?)),
            other => other,
        };
        let Stage::Open(pushed) = &mut self.stage else {
            return Err(self
                .common
                .error(Status::Order, "the verdict was given; make a new check"));
        };
        Ok(pushed)
    }

    /// Returns the check that takes draws of `values` values.
    fn open_for(&mut self, values: usize) -> Result<&mut Pushed, Error> {
        if matches!(self.stage, Stage::Claim(_)) {
            self.set(|check| Ok(check.values(values)))?;
        }
        let before = self.open()?.values();
        if before == values {
            return self.open();
        }
        let what =
            format!("the number of values was {before} in the draws before, but is {values} now");
        Err(self.error_of(Status::Claim, &what))
    }

    /// Returns whether more draws may change the verdict.
    pub(crate) fn is_open(&self) -> Result<bool, Error> {
        self.error.clone().map_or(Ok(()), Err)?;
        Ok(match &self.stage {
            // The first draws validate the claim, and say how many values a draw has.
            Stage::Claim(_) => true,
            Stage::Open(pushed) => pushed.is_open(),
            Stage::Judged(_) | Stage::Ended => false,
        })
    }

    /// Makes draws of `values` values, block by block, until the verdict is decided or there are enough. `fill` writes a
    /// block and returns its number of draws; fewer than it is asked for are the last.
    pub(crate) fn run(
        &mut self,
        values: usize,
        mut fill: impl FnMut(&mut [f64], usize, &mut Rng) -> usize,
    ) -> Result<(), Error> {
        let common = Rc::clone(&self.common);
        let mut block = Vec::new();
        self.open_for(values)?.drive(|pushed, request| {
            let room = request.draws;
            block.resize(room * values, 0.0);
            let made = fill(&mut block, room, &mut Rng::from(&request.stream()));
            common.misuse()?;
            if made > room {
                let what = format!("the callback returned {made} draws, but was asked for {room}");
                return Err(common.error(Status::Callback, &what));
            }
            pushed.absorb(&block[..made * values])?;
            Ok(made == room)
        })
    }

    /// Returns the verdict; the first call judges all draws.
    pub(crate) fn judged(&mut self) -> Result<&Outcome, Error> {
        if let Some(error) = &self.error {
            return Err(error.clone());
        }
        if !matches!(self.stage, Stage::Judged(_)) {
            self.judge().inspect_err(|error| self.fail(error))?;
        }
        match &self.stage {
            Stage::Judged(outcome) => Ok(outcome),
            _ => Err(self.error_of(Status::Internal, "no verdict")),
        }
    }

    fn judge(&mut self) -> Result<(), Error> {
        self.open()?;
        let Stage::Open(pushed) = mem::replace(&mut self.stage, Stage::Ended) else {
            return Err(self.error_of(Status::Internal, "not open"));
        };
        let outcome = pushed.verdict()?;
        (self.text, self.reason) = (c_text(&outcome.to_string()), c_text(&outcome.reason()));
        self.stage = Stage::Judged(Box::new(outcome));
        Ok(())
    }

    /// Returns the lines of the verdict, or the error.
    pub(crate) fn text(&self) -> &CString {
        &self.text
    }

    /// Returns the reason of a verdict other than pass, or the error.
    pub(crate) fn reason(&self) -> &CString {
        &self.reason
    }
}
