#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Long runs are written in bounded memory, and one that is killed leaves nothing.
. "$(dirname "$0")/checks.sh"

# Most memory of a run, in kB. A sanitizer's memory grows with what was ever allocated, so both runs are measured.
peak() {
    /usr/bin/python3 - "$twinbox" "$@" <<'PYTHON'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
PYTHON
}

# 6,000 steps have 57 MB of arrays, most of them contacts; 180 MB were needed when a run was kept in memory.
short=$(peak simulate "$scenes/pyramid.yaml" --frames 10)
for options in "-o long.npz" "-o long.npz --no-contacts --hash long.hash" "--hash long.hash" ""; do
    long=$(peak simulate "$scenes/pyramid.yaml" --frames 6000 $options)
    checks=$((checks + 1))
    [ $((long - short)) -lt 65536 ] || fail "6,000 steps with '$options' take $((long - short)) kB more than 10"
done
[ "$(wc -l <long.hash)" -eq 6002 ] || fail "hashes of 6,000 steps"

# Killed in the middle: the folder is as it was, also where an older file is to be replaced.
mkdir killed
run 0 simulate "$scenes/stack.yaml" --frames 10 -o killed/old.npz
cp killed/old.npz old.npz
for output in killed/new.npz killed/old.npz; do
    "$twinbox" simulate "$scenes/pyramid.yaml" --frames 500000 -o $output --hash killed/hash.csv >/dev/null 2>&1 &
    sleep 0.7
    checks=$((checks + 1))
    kill -KILL $! || fail "the run was over"
    wait $! 2>/dev/null
done
equal "files of killed runs" "$(ls -A killed)" old.npz
cmp -s killed/old.npz old.npz || fail "the older file has changed"

# Without contacts: a file of a tenth, which all that needs no contacts reads; the rest says what is missing.
run 0 simulate "$scenes/stack.yaml" --frames 60 -o with.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --no-contacts -o without.npz
[ "$(stat -c %s without.npz)" -lt "$(stat -c %s with.npz)" ] || fail "the contacts are still there"
run 0 compare with.npz without.npz
says "equal: 61 frames of 12 bodies"
says "every bit of float32 poses and velocities"
run 0 render without.npz --frames 0:3 --size 320x180 -o frames
run 0 figure strip without.npz -o strip.svg

# The output is checked before the first step.
run 3 simulate "$scenes/pyramid.yaml" --frames 500000 -o nowhere/run.npz
complains "nowhere/run.npz: error: cannot write"

finish
