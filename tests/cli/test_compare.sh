#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 40 -o a.npz
run 0 simulate "$scenes/stack.yaml" --frames 40 --bomb-x 1 -o b.npz
run 0 simulate "$scenes/stack.yaml" --frames 30 -o short.npz
run 0 simulate "$scenes/single.yaml" --frames 40 -o other.npz
run 0 compare a.npz a.npz
says "equal: 41 frames of 12 bodies"
run 1 compare a.npz b.npz
says "first difference: frame 0, body 11:"
run 1 compare a.npz short.npz
says "41"
says "31"
run 1 compare a.npz other.npz
says "bodies"

/usr/bin/python3 - <<'PYTHON'
# One bit of one body in one frame.
import numpy
run = dict(numpy.load("a.npz", allow_pickle=False))
run["angle"].view(numpy.uint32)[17, 4] ^= 1
numpy.savez("bit.npz", **run)
PYTHON
run 1 compare a.npz bit.npz
says "first difference: frame 17, body 4: 0 m apart"

render() { run 0 render "$1" -o "$2" --size 160x90 --frames 0:4; }
render a.npz one
render a.npz two
render b.npz three
run 0 compare one two
says "equal: 5 frames"
run 1 compare one three
says "first difference: frame 0:"
says "of 5 frames differ"
rm two/frame_000003.png
run 1 compare one two
says "only in one: 1 frames, from 3 on"
run 0 compare one/frame_000002.png two/frame_000002.png
head -c 300 one/frame_000001.png >two/frame_000001.png
run 2 compare one two
complains "two/frame_000001.png"

run 2 compare a.npz one
complains "is no trajectory"
run 2 compare one nowhere
complains "nowhere"
mkdir empty
run 2 compare one empty
complains "empty"
run 2 compare a.npz a.npz a.npz
head -c 1000 a.npz >cut.npz
run 2 compare a.npz cut.npz
complains "cut.npz: error:"
finish
