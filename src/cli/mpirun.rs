//! Whether `mpirun`, or a scheduler in its place, has begun this process among others.

use std::env;

use anyhow::bail;

/// How many processes there are, as far as is said: by Open MPI, by MPICH and those like it, or by Slurm where it has begun
/// this process as one of many.
pub fn ranks() -> usize {
    let slurm = env::var_os("PMIX_RANK").map(|_| "SLURM_NTASKS");
    let names = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"].into_iter().chain(slurm);
    names.filter_map(|name| env::var(name).ok()?.parse().ok()).max().unwrap_or(1)
}

/// Whether many can do what is asked.
pub fn allow(is_run: bool) -> anyhow::Result<()> {
    let ranks = ranks();
    if ranks > 1 && !is_run {
        bail!("{ranks} processes were begun, but only `run` is shared by ranks: leave out mpirun");
    }
    if ranks > 1 && !cfg!(feature = "mpi") {
        bail!(
            "{ranks} processes were begun, but this program was built without MPI: \
             build it with `cargo build --release --features mpi`, or leave out mpirun"
        );
    }
    Ok(())
}
