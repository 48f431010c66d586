//! Python module `trueflight._trueflight`, the compiled part of `trueflight`. The Python part, `trueflight/*.py`, converts
//! arguments, calls callables for draws, and shows results.
//!
//! ```text
//! judge       draws from Python, array by array, and the verdict
//! cases       case files as a name, a text or a dict
//! rows        predictions and runs, as rows in JSON
//! background  work on a separate thread, while Python handles Ctrl-C
//! error       errors as exceptions
//! ```

mod advice;
mod background;
mod cases;
mod error;
mod judge;
mod rows;

/// Compiled part of `trueflight`.
#[pyo3::pymodule]
mod _trueflight {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::advice::advise;
    #[pymodule_export]
    use crate::cases::built_in;
    #[pymodule_export]
    use crate::judge::judge;
    #[pymodule_export]
    use crate::rows::{predict, run};

    /// Number of draws that are judged at a time.
    #[pymodule_export]
    const BLOCK: usize = trueflight::judge::BUFFER;

    /// Largest number of draws that are made by default.
    #[pymodule_export]
    const MAX_DRAWS: u64 = trueflight::check::MAX_DRAWS;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
