//! Whether `mpirun`, or a scheduler in its place, has begun this process among others.

use std::env;
use std::sync::Arc;

use anyhow::{anyhow, bail};

use super::ranks::{Join, Link};

/// How many processes there are, as far as is said: by Open MPI, by MPICH and those like it, or by Slurm where it has begun
/// this process as one of many.
pub fn ranks() -> usize {
    let slurm = env::var_os("PMIX_RANK").map(|_| "SLURM_NTASKS");
    let names = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"].into_iter().chain(slurm);
    names.filter_map(|name| env::var(name).ok()?.parse().ok()).max().unwrap_or(1)
}

/// Whether many can do what is asked.
pub fn allow(is_run: bool, join: Option<Join>) -> anyhow::Result<()> {
    let ranks = ranks();
    if ranks > 1 && !is_run {
        bail!("{ranks} processes were begun, but only `run` is shared by ranks: leave out mpirun");
    }
    if ranks > 1 && join.is_none() {
        bail!(
            "{ranks} processes were begun, but this program knows no MPI: \
             begin trueflight-mpi, which `cargo build --release -p trueflight-mpi` makes (a program of one's own \
             calls `cli::main_among`), or leave out mpirun"
        );
    }
    Ok(())
}

/// Joins the others, of whom MPI must know as many as were begun.
pub fn join(join: Join) -> anyhow::Result<Arc<dyn Link>> {
    let link = join().map_err(|why| anyhow!(why))?;
    if link.size() != ranks() {
        bail!(
            "{} processes were begun, but MPI knows of {}: mpirun is not that of the MPI library of this build",
            ranks(),
            link.size()
        );
    }
    Ok(link)
}
