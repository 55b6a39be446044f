# SPDX-License-Identifier: GPL-3.0-or-later
# System calls fail, move half of their bytes or are interrupted: every fourth place that calls, in commands that take a few
# hundredths of a second; tests/run --deep has every one. Then a sample of the allocations by libraries.
set -eu
twinbox=$1
sources=$2
sample=1
! nm -D "$twinbox" | grep -q __asan_init || sample=10

# some SAMPLE CALLS CASE...
some() {
    local sample=$1 call=$2 cases="" name
    shift 2
    for name in "$@"; do cases+=" --case $name"; done
    python3 "$sources/tests/faults/faults.py" "$twinbox" "$sources" --jobs 2 --sample "$sample" --call "$call" $cases
}
some $((sample * 4)) system simulate import compare-report approve
some $((sample * 50)) libmalloc export-json import compare-report approve dataset train-from simulate-csv solve-step
