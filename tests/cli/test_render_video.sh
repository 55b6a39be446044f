#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The memory of a video is bounded: what the encoder is told depends on the size of the frames.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 2 -o run.npz

# As many pixels ahead as 40 frames of 1920x1080 have, 25 for VP9; never less than two frames.
run 0 render run.npz -o frames --frames 0:0 --size 1920x1080 --video a.mp4 -v
grep 'started ffmpeg -y' err | grep -q -e lookahead -e threads && fail "1920x1080 is bounded"
run 0 render run.npz -o frames --frames 0:0 --size 2560x1440 --video a.mp4 --video a.webm --video a.gif -v
grep 'started ffmpeg -y' err >started
grep -q -e '-f mp4 -rc-lookahead 22 -threads 4 ' started || fail "2560x1440 as MP4: $(<started)"
grep -q -e '-f webm -lag-in-frames 14 -threads 4 ' started || fail "2560x1440 as WebM: $(<started)"
grep -e '-f gif' started | grep -q -e -threads && fail "a GIF is bounded"
[ -s a.mp4 ] && [ -s a.webm ] && [ -s a.gif ] || fail "a video is missing"
finish
