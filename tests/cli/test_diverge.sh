#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Why two runs differ, and how fast they diverge.
. "$(dirname "$0")/checks.sh"

stack=$scenes/stack.yaml
run 0 simulate "$stack" --frames 120 -o engine.npz
run 0 simulate "$stack" --frames 120 --method engine:k=20 -o more.npz
run 0 simulate "$stack" --frames 60 -o short.npz
run 0 simulate "$stack" --frames 120 --bomb-x 5.000001 -o moved.npz

run 0 compare engine.npz engine.npz
says "equal: 121 frames of 12 bodies, every bit of float32 poses and velocities"
equal "lines" "$(wc -l <out)" 3
run 1 compare engine.npz short.npz
says "different lengths, 121 and 61 frames: only the first 61 are compared"
says "equal as far as both go: 61 frames"
run 1 compare engine.npz short.npz --tolerance 1

# Ten sweeps and twenty: equal until the first box touches the ground.
run 1 compare engine.npz more.npz
says "run 1: stack by engine, 121 frames of 12 bodies (engine.npz)"
says "run 2: stack by engine:k=20, 121 frames of 12 bodies (more.npz)"
says "first difference: frame 5, body 1:"
says "cause: the solver"
says "all states of frame 4 are equal, and so are the 2 contacts of step 5, but the impulses of 2 differ"
says "contact of bodies 0 and 1, feature 03020000"
says "largest distance: frame "
complains "note: with --scene SCENE, the growth is compared"
grep -q "centres" out && fail "a distance is compared without --tolerance"

run 1 compare engine.npz more.npz --tolerance 0.01 --scene "$stack" --csv distance.csv
says "within the tolerance: 18 frames, 5 of them equal in every bit"
says "centres more than 0.01 m apart: frame 18, body 4:"
says "the states before that step differ since frame 5: an earlier step is the cause"
says "shifted run (body 1 shifted by 1e-06 m, the same frames): from"
says "verdict: "
equal "header" "$(head -1 distance.csv)" "frame,time,distance,shifted_distance"
equal "lines" "$(wc -l <distance.csv)" 122
equal "first frame" "$(sed -n 2p distance.csv)" "0,0,0,9.99999997e-07"
run 0 compare engine.npz more.npz --tolerance 1e6 --csv alone.csv
says "equal within the tolerance of 1e+06 m: 121 frames of 12 bodies; 5 of them in every bit of their states"
equal "first frame" "$(sed -n 2p alone.csv)" "0,0,0,"

# Run 2 has a shifted bomb, as the shifted run has: both grow alike.
run 1 compare engine.npz moved.npz --scene "$stack"
says "different scenes: hashes "
says "first difference: frame 0, body 11 (the bomb):"
says "cause: the initial state"
says "shifted run (body 11 shifted by 9.5e-07 m"
says "verdict: chaos: grows as fast as a tiny shift"

# Chaos as the tolerance: two roundings of the bomb's place pass although the runs end metres apart, twice the sweeps do not.
run 0 compare engine.npz moved.npz --tolerance chaos --scene "$stack"
says "as near as roundings keep the runs: 121 frames of 12 bodies"
says "later frames tell nothing"
run 1 compare engine.npz more.npz --tolerance chaos --scene "$stack" --report chaos
says "farther than roundings allow: frame "
grep -q 'run.html#t=' chaos/report.html || fail "no page where roundings do not suffice"
run 0 compare engine.npz engine.npz --tolerance chaos --scene "$stack"
run 2 compare engine.npz more.npz --tolerance chaos
complains "--tolerance: error: chaos is measured with --scene SCENE"
mkdir a b
run 2 compare a b --tolerance chaos
/usr/bin/python3 - <<'PYTHON'
import numpy
run = dict(numpy.load("moved.npz"))
for key in "position", "angle", "velocity", "angular_velocity":
    run[key][100:, 11] = numpy.nan
for key in list(run):
    if key.startswith(("contact_", "verdict")):
        del run[key]
numpy.savez("lost.npz", **run)
PYTHON
run 1 compare engine.npz lost.npz --tolerance chaos --scene "$stack"
says "farther than roundings allow: frame 100, body 11 (the bomb): only in run 1"

finish
