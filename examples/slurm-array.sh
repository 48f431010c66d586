#!/bin/bash
#SBATCH --job-name=trueflight
#SBATCH --array=1-16
#SBATCH --cpus-per-task=8
#SBATCH --requeue
# Each task draws one share of the run; queued again, it goes on with what it has.
# When all are done: trueflight merge shares/part-* --out results
set -eu
part=shares/part-$SLURM_ARRAY_TASK_ID
if [ -e "$part/blocks.bin" ]; then
    trueflight run --resume "$part" --threads "$SLURM_CPUS_PER_TASK"
else
    trueflight run cases --draws 4e7 --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
        --out "$part" --threads "$SLURM_CPUS_PER_TASK"
fi
