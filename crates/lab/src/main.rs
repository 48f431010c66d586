//! The command `trueflight-lab`.

use std::process::ExitCode;

fn main() -> ExitCode {
    trueflight_lab::cli::main()
}
