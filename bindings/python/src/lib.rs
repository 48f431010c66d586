//! The module `trueflight._trueflight`: what Python cannot do by itself. The rest is in `trueflight/*.py`, which
//! reads arguments, asks callables for draws, and shows what is found.
//!
//! ```text
//! judging     draws that are pushed, array by array, and the verdict
//! cases       case files as a name, a text or a dict
//! rows        predictions and runs, as rows in JSON
//! background  work on a thread of its own, while Python looks for Ctrl-C
//! trouble     why there is no answer, as an exception
//! ```

mod background;
mod cases;
mod judging;
mod rows;
mod trouble;

/// What Python cannot do by itself.
#[pyo3::pymodule]
mod _trueflight {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::cases::built_in;
    #[pymodule_export]
    use crate::judging::Judging;
    #[pymodule_export]
    use crate::rows::{predict, run};

    /// How many draws are judged at a time.
    #[pymodule_export]
    const BLOCK: usize = trueflight::judge::BUFFER;

    /// How many draws are made at most where nobody says.
    #[pymodule_export]
    const MOST: u64 = trueflight::check::MOST;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
