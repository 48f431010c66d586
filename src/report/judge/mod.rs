//! What `judge` found, on the console and as `JUnit`.

pub mod console;
pub mod images;
pub mod junit;
