//! The command `trueflight-mpi`: that of `trueflight`, whose runs are drawn by all ranks that `mpirun` has begun.

use std::process::ExitCode;

use trueflight::Catalogue;

fn main() -> ExitCode {
    trueflight::cli::main_among(&Catalogue::builtin(), trueflight_mpi::join)
}
