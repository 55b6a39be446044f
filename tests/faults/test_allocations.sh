# SPDX-License-Identifier: GPL-3.0-or-later
# Allocations by our own code fail in turn, in the short commands: one in four, and under a sanitizer, which is ten times
# slower and also finds what is not freed then, one in forty. tests/run --deep lets every one fail.
set -eu
twinbox=$1
sources=$2
sample=4
! nm -D "$twinbox" | grep -q __asan_init || sample=40

cases=""
for name in new simulate-net export-csv import compare-json approve page solve; do
    cases+=" --case $name"
done
python3 "$sources/tests/faults/faults.py" "$twinbox" "$sources" --jobs 2 --sample $sample --call malloc --mode fail $cases
