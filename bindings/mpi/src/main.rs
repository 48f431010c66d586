//! The command `trueflight-mpi`: `trueflight` with runs that all ranks of `mpirun` draw.

use std::process::ExitCode;

use trueflight::Catalogue;

fn main() -> ExitCode {
    trueflight::cli::main_among(&Catalogue::builtin(), trueflight_mpi::join)
}
