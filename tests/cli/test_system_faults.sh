#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What the system does to commands: a limit of file sizes, a killed process, another process in the folder.
. "$(dirname "$0")/checks.sh"

names() { find "$1" -mindepth 1 -printf '%P\n' | LC_ALL=C sort | tr '\n' ' '; }
small() { echo "$scenes/stack.yaml" --size 320x180 --frames 0:5; }

wait_for() {
    local try
    for try in $(seq 1000); do
        "$@" >/dev/null 2>&1 && return
        sleep 0.02
    done
    fail "waited in vain for: $*"
}

# A file beyond the limit is an error with a message, not a signal, and nothing of it stays.
run 0 render $(small) -o whole
ulimit -S -f 8 # blocks of 1 KiB
run 3 simulate "$scenes/stack.yaml" -o run.npz
complains "run.npz: error: cannot write: File too large"
run 3 render $(small) -o limited
complains "limited/stack-engine.npz: error: cannot write: File too large"
ulimit -S -f unlimited
equal "files of a simulation beyond the limit" "$(ls run.npz 2>/dev/null)" ""
equal "files of a render beyond the limit" "$(names limited)" ""

# The folder of another process. `flock` locks it as twinbox does.
mkdir taken
flock --no-fork taken sleep 60 &
holder=$!
wait_for grep "FLOCK .* $holder " /proc/locks
for command in "render $(small)" "chart $scenes/stack.yaml --quick --methods engine" \
    "stability --scenes $scenes --study stack_height --methods engine" "paper --quick --scenes $scenes"; do
    run 3 $command -o taken
    complains "taken: error: another process is writing into this folder; wait until it ends, or choose another name"
done
kill $holder
wait $holder 2>/dev/null
equal "files in the other's folder" "$(names taken)" ""

finish
