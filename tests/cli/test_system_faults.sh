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

# The folder of another process, which is named. `flock` locks it as twinbox does.
mkdir taken
flock --no-fork taken sleep 60 &
holder=$!
wait_for grep "FLOCK .* $holder " /proc/locks
for command in "render $(small)" "chart $scenes/stack.yaml --quick --methods engine" \
    "stability --scenes $scenes --study stack_height --methods engine" "paper --quick --scenes $scenes"; do
    run 3 $command -o taken
    complains "taken: error: another process ($holder) is writing into this folder; wait until it ends, or choose another name"
done
kill $holder
wait $holder 2>/dev/null
equal "files in the other's folder" "$(names taken)" ""

# The network that another process trains.
run 0 dataset "$scenes/single.yaml" -o pairs.npz --bomb-x=-2:2:1
mkdir nets
"$twinbox" train pairs.npz -o nets/net.npz --iterations 1000000 >/dev/null 2>&1 &
holder=$!
wait_for grep "FLOCK .* $holder " /proc/locks
run 3 train pairs.npz -o nets/net.npz --iterations 1
complains "nets/net.npz: error: another process ($holder) is making this file; wait until it ends, or choose another name"
run 0 train pairs.npz -o nets/other.npz --iterations 1
kill -9 $holder
wait $holder 2>/dev/null
run 0 train pairs.npz -o nets/net.npz --iterations 1
equal "files beside networks" "$(names nets)" "net.npz other.npz "

# What a killed process left goes with the next file in the folder.
run 0 render $(small) -o taken
touch taken/.twinbox-0123456789abcdef.tmp
run 0 render $(small) -o taken --resume
equal "files after a kill" "$(names taken)" "$(names whole)"
finish
