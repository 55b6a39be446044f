#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A study by Slurm: an array of 16 shards, and a job behind it that merges them. If pieces are missing, that job submits their
# shards again, four times at most. Options of sbatch: its variables, such as SBATCH_TIMELIMIT and SBATCH_PARTITION.
#
#     slurm.sh out/map stability --study height_iterations -o out/map
set -u
export OMP_NUM_THREADS=1
[ -z "${SLURM_ARRAY_TASK_ID-}" ] || exec twinbox "${@:2}"
array=--array=1-16
if [ -n "${ROUND-}" ]; then
    array=$(twinbox merge "$1")
    status=$?
    [ $status -eq 1 ] && [ "$ROUND" -lt 5 ] || exit $status
fi
job=$(sbatch --parsable --ntasks=1 --cpus-per-task=1 "$array" "$0" "$@") || exit
ROUND=$((${ROUND:-0} + 1)) exec sbatch --ntasks=1 --dependency=afterany:"$job" "$0" "$@"
