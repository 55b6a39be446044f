# SPDX-License-Identifier: GPL-3.0-or-later
# A sample of what `tests/faults/run --kills` does; tests/run --deep does all.
set -eu
cases="render-jobs approve dataset train-pair-net chart stability after-shard"
# The sanitizers need no video; ffmpeg and slow starts would take most of the time.
nm -D "$1" | grep -q __asan_init || cases="$cases render-video"
python3 "$2/tests/faults/faults.py" "$1" "$2" --kills --jobs 2 --most 2 $(printf -- '--case %s ' $cases)
