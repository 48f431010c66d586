//! The command `trueflight`.

use std::process::ExitCode;

use trueflight::Catalogue;

fn main() -> ExitCode {
    trueflight::cli::main(&Catalogue::builtin())
}
