//! Handle of a check, which one call at a time uses.

use std::cell::{Cell, RefCell, RefMut};
use std::rc::Rc;

use crate::session::Session;
use crate::status::{Error, Status};

/// A check: a name, the claims about a draw, and the verdict on draws.
pub struct Check {
    session: RefCell<Session>,
    common: Rc<Common>,
}

/// Part of a check that a second call reads while the first one uses the session.
pub(crate) struct Common {
    pub(crate) name: String,
    /// Whether a callback changed or freed its own check.
    is_misused: Cell<bool>,
}

impl Common {
    /// Returns the error of a callback that uses its own check.
    fn drawing(&self) -> Error {
        let what =
            "the check is drawing; a callback must not use it, call when tf_check_run has returned";
        self.error(Status::Order, what)
    }

    /// Makes an error of the check.
    pub(crate) fn error(&self, status: Status, what: &str) -> Error {
        Error::new(status, format!("check `{}`: {what}", self.name))
    }

    /// Returns the error of a callback that changed or freed its own check.
    pub(crate) fn misuse(&self) -> Result<(), Error> {
        if self.is_misused.get() { Err(self.drawing()) } else { Ok(()) }
    }
}

impl Check {
    pub(crate) fn new(name: &str) -> Self {
        let common = Rc::new(Common { name: name.to_owned(), is_misused: Cell::new(false) });
        Self { session: RefCell::new(Session::new(Rc::clone(&common))), common }
    }

    /// Borrows the session for a query; fails in a callback that draws for this check.
    pub(crate) fn query(&self) -> Result<RefMut<'_, Session>, Error> {
        self.session.try_borrow_mut().map_err(|_| self.common.drawing())
    }

    /// Borrows the session for a change; failure also ends the check once the callback has returned.
    pub(crate) fn change(&self) -> Result<RefMut<'_, Session>, Error> {
        self.query().inspect_err(|_| self.common.is_misused.set(true))
    }
}
