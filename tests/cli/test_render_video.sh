#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The memory of a video is bounded: what the encoder is told depends on the size of the frames.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 2 -o run.npz

# encoder ARGUMENT...: the ffmpeg that a video of one frame starts.
encoder() {
    run 0 render run.npz -o frames --frames 0:0 "$@" -v
    grep 'started ffmpeg -y' err
}

# As many pixels ahead as 40 frames of 1920x1080 have, 25 for VP9; never less than two frames.
encoder --size 1920x1080 --video a.mp4 | grep -q -e lookahead -e threads && fail "1920x1080 is bounded"
encoder --size 3840x2160 --video a.mp4 | grep -q -e '-rc-lookahead 10 -threads 4 ' || fail "3840x2160 as MP4"
encoder --size 3840x2160 --video a.webm | grep -q -e '-lag-in-frames 6 -threads 4 ' || fail "3840x2160 as WebM"
encoder --size 3840x2160 --video a.gif | grep -q -e -threads && fail "a GIF is bounded"
[ -s a.mp4 ] && [ -s a.webm ] && [ -s a.gif ] || fail "a video is missing"

finish
