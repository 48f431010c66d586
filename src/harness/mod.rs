//! Case → plan → run → verdict → record.
pub mod record;
