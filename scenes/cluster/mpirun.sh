#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A study by OpenMPI: a shard for each of 4 ranks, then the merge. When a rank is cut off, mpirun ends the others, too; all
# continue in the next round, of five at most.
#
#     mpirun.sh out/map stability --study height_iterations -o out/map
set -u
for round in {1..5}; do
    mpirun -n 4 -x OMP_NUM_THREADS=1 twinbox "${@:2}"
    twinbox merge "$1"
    status=$?
    [ $status -eq 1 ] || break
done
exit $status
