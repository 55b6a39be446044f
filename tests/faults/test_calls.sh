# SPDX-License-Identifier: GPL-3.0-or-later
# A sample of what tests/faults/run does, in commands that take a few hundredths of a second; under a sanitizer, which is ten times
# slower and also finds what is not freed then, a tenth of it. tests/run --deep lets every call fail.
set -eu
twinbox=$1 sources=$2 sample=1
! nm -D "$twinbox" | grep -q __asan_init || sample=10

# some SAMPLE CALLS CASE...
some() {
    local of=$(($1 * sample)) call=$2
    shift 2
    python3 "$sources/tests/faults/faults.py" "$twinbox" "$sources" --jobs 2 --sample $of --call "$call" $(printf -- '--case %s ' "$@")
}
some 8 malloc new simulate-net export-csv import compare-json approve page solve
some 4 system simulate import compare-report approve
some 1 system compare-equal
some 50 libmalloc export-json import compare-report approve dataset train-from simulate-csv solve-step
