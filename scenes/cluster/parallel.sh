#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A study by GNU parallel: 16 shards, as many at a time as there are cores, then the merge. A shard that was cut off is
# started again, twice at most, and continues. More machines: PARALLEL='--sshloginfile hosts --workdir .'
#
#     parallel.sh out/map stability --study height_iterations -o out/map
set -eu
export OMP_NUM_THREADS=1
parallel --quote --retries 3 twinbox "${@:2}" --shard {}/16 ::: {1..16}
twinbox merge "$1"
