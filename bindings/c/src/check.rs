//! The handle: a check's state, which one call at a time may use.

use std::cell::{Cell, RefCell, RefMut};
use std::rc::Rc;

use crate::state::State;
use crate::status::{Error, Status};

/// A check: a name, what is known of a draw, and the verdict on draws.
pub struct Check {
    state: RefCell<State>,
    common: Rc<Common>,
}

/// What a call may look at while another one has the state.
pub(crate) struct Common {
    pub(crate) name: String,
    /// Whether a callback changed its own check, or freed it.
    is_misused: Cell<bool>,
}

impl Common {
    /// What is wrong where a callback uses its own check.
    fn drawing(&self) -> Error {
        let what =
            "the check is drawing; a callback must not use it, call when tf_check_run has returned";
        Error::new(Status::Order, format!("check `{}`: {what}", self.name))
    }

    /// The error that a callback left behind.
    pub(crate) fn misuse(&self) -> Result<(), Error> {
        if self.is_misused.get() { Err(self.drawing()) } else { Ok(()) }
    }
}

impl Check {
    pub(crate) fn new(name: &str) -> Self {
        let common = Rc::new(Common { name: name.to_owned(), is_misused: Cell::new(false) });
        Self { state: RefCell::new(State::new(Rc::clone(&common))), common }
    }

    /// The state, for a look at it: a callback that draws for this check gets an error.
    pub(crate) fn look(&self) -> Result<RefMut<'_, State>, Error> {
        self.state.try_borrow_mut().map_err(|_| self.common.drawing())
    }

    /// The state, for a change: the error of a callback also ends its check, once the callback has returned.
    pub(crate) fn take(&self) -> Result<RefMut<'_, State>, Error> {
        self.look().inspect_err(|_| self.common.is_misused.set(true))
    }
}
