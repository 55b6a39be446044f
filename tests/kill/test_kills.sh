# SPDX-License-Identifier: GPL-3.0-or-later
# A sample of what tests/kill/run does, of nine commands; tests/run --deep does all.
set -eu
most=2 video=video
# The sanitizers need no video; ffmpeg and slow starts would take most of the time.
! nm -D "$1" | grep -q __asan_init || { video=; }
python3 "$2/tests/kill/kills.py" "$1" "$2" --no-terms --most $most render-jobs approve dataset train-pair-net chart-study chart-pages \
    stability stability-pages $video
