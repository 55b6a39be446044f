#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
. "$(dirname "$0")/checks.sh"

# The CSV has the columns of the reference files, without static bodies and bodies that are not there yet.
run 0 simulate "$scenes/single.yaml" --frames 20 --bomb-frame 5 -o run.csv --hash run.hash
equal "CSV header" "$(head -n 1 run.csv)" "frame,body,x,y,angle,vx,vy,omega"
equal "CSV rows" "$(tail -n +2 run.csv | wc -l)" $((5 + 16 * 2))
equal "first row" "$(sed -n 2p run.csv)" "0,1,0,4,0,0,0,0"
equal "hash header" "$(head -n 1 run.hash)" "frame,hash"
equal "hash rows" "$(tail -n +2 run.hash | wc -l)" 21
# Two rows of Box2D-Lite's own (sine and cosine as doubles): single, bomb from x = 5, frames 0 and 600.
run 0 simulate "$scenes/single.yaml" --frames 600 --bomb-x 5 --hash run.hash
equal "the reference's last state" "$(tail -n 1 run.hash)" 600,10608ace18aac33d

# Numbers: a fraction is divided in float32; a decimal goes to the nearest float32.
for dt in 1/60 0.016666668 0.01666666753590106964; do
    run 0 simulate "$scenes/stack.yaml" --frames 100 --dt $dt --hash "dt.hash"
    mv dt.hash "dt$(echo $dt | tr / _).hash"
done
cmp -s dt1_60.hash dt0.016666668.hash || fail "--dt 0.016666668 is not 1/60"
cmp -s dt1_60.hash dt0.01666666753590106964.hash || fail "--dt 0.01666666753590106964 is not 1/60"
run 0 simulate "$scenes/stack.yaml" --frames 100 --dt 1/61 --hash dt.hash
cmp -s dt1_60.hash dt.hash && fail "--dt has no effect"

# Each switch changes the run.
for option in --no-bomb --no-warm-starting --no-accumulate --no-position-correction "--iterations 4" \
    "--method engine:k=4" "--bomb-x 1.25" "--bomb-frame 30"; do
    run 0 simulate "$scenes/stack.yaml" --frames 100 $option --hash other.hash
    cmp -s dt1_60.hash other.hash && fail "$option has no effect"
done
run 0 simulate "$scenes/stack.yaml" --frames 100 --iterations 4 --hash four.hash
run 0 simulate "$scenes/stack.yaml" --frames 100 --method engine:k=4 --hash other.hash
cmp -s four.hash other.hash || fail "--iterations 4 and engine:k=4 differ"

# An existing trajectory is replaced as a whole; a second run gives the same bytes.
run 0 simulate "$scenes/stack.yaml" --frames 30 -o a.npz
run 0 simulate "$scenes/stack.yaml" --frames 30 -o b.npz
cmp -s a.npz b.npz || fail "two runs, two files"
run 0 compare a.npz b.npz
says "equal: 31 frames of 12 bodies"
/usr/bin/python3 - <<'PYTHON' || fail "numpy.load"
import numpy
run = numpy.load("a.npz", allow_pickle=False)
assert run["position"].shape == (31, 12, 2) and run["position"].dtype == numpy.float32
assert str(run["scene"]) == "stack" and str(run["method"]) == "engine"
assert run["fixed"].tolist() == [1] + 11 * [0] and int(run["bomb"]) == 11
assert abs(run["position"][0, 1, 1] - 0.51) < 1e-6
late = numpy.isnan(run["position"][:, 11, 0])
assert not late.any()
PYTHON
# A run has the verdict that is printed, and has it while it is written in parts, too.
for scene in stack stability/card_house; do
    run 0 simulate "$scenes/$scene.yaml" -o judged.npz
    printed=$(sed -n 's/^    verdict: //p' out)
    /usr/bin/python3 -c "
import numpy, sys
run = numpy.load('judged.npz', allow_pickle=False)
assert str(run['verdict']) == sys.argv[1] != '', (str(run['verdict']), sys.argv[1])
assert 0 < run['verdict_frame'] < len(run['position'])" "$printed" || fail "$scene: the verdict in the run"
done
run 0 simulate "$scenes/single.yaml" --frames 12 --bomb-frame 5 -o late.npz
/usr/bin/python3 -c "
import numpy
run = numpy.load('late.npz', allow_pickle=False)
there = ~numpy.isnan(run['angle'][:, 2])
assert there.tolist() == 5 * [False] + 8 * [True], there" || fail "a body that is not there yet is NaN"

# --set has the effect of the same number in the file; the paths of networks stay relative to the scene.
stability=$scenes/stability
run 0 simulate "$stability/stack_height.yaml" --set height=7 --set iterations=4 --frames 50 --hash set.hash
says "8 bodies"
sed 's/value: 10, from: 2/value: 7, from: 2/; s/iterations: .iterations/iterations: 4*$one/; s/  iterations: .*/  one: {value: 1, from: 1, to: 2}/' \
    "$stability/stack_height.yaml" >seven.yaml
run 0 simulate seven.yaml --frames 50 --hash seven.hash
cmp -s set.hash seven.hash || fail "--set is not the number in the file"
run 0 simulate "$stability/stack_height.yaml" --set height=7 --frames 5 --method pair-net
run 0 simulate "$stability/top_removed.yaml" --frames 610 -o gone.npz
/usr/bin/python3 -c "
import numpy
run = numpy.load('gone.npz', allow_pickle=False)
there = ~numpy.isnan(run['angle'][:, 11])
assert there.tolist() == 600 * [True] + 11 * [False], there" || fail "a body that has gone is NaN"
run 0 compare gone.npz gone.npz
says "equal"

# Refused.
for value in height height= =7 height=x height=nan height=1e999 "height=7 "; do
    run 2 simulate "$stability/stack_height.yaml" --set "$value"
    complains "--set: error: '$value' is not NAME=VALUE"
done
run 2 simulate "$stability/stack_height.yaml" --set height=41
complains "stack_height.yaml: error: height must be from 2 to 40 boxes (set to 41)"
run 2 simulate "$stability/stack_height.yaml" --set height=2.5
complains "height must be a whole number"
run 2 simulate "$stability/stack_height.yaml" --set hight=3
complains "did you mean 'height'?"
run 2 simulate "$scenes/stack.yaml" --set height=3
complains "'height' is not a parameter; known: iterations, dt, friction, bomb_x, bomb_y, bomb_mass, bomb_speed"
run 2 simulate "$stability/stack_height.yaml" $(for i in 1 2 3 4 5 6 7; do echo --set height=3; done)
complains "the parameter 'height' is set twice"
run 2 simulate nowhere.yaml
complains "nowhere.yaml: error:"
run 2 simulate "$scenes/single.yaml" -o run.txt
complains "must end in .npz or .csv"
run 2 simulate "$scenes/single.yaml" --method magic
complains "is not a method; known: engine, "
run 2 simulate "$scenes/single.yaml" --method engine:sweeps=3
complains "'sweeps' is not a setting"
run 2 simulate "$scenes/single.yaml" --method engine:k=none
complains "k: error: must be a whole number"
for value in nan 1e9999 1/0 0 -1/60 60x; do
    run 2 simulate "$scenes/single.yaml" --dt=$value
    complains "--dt: error: '$value'"
done
run 2 simulate "$scenes/single.yaml" --frames 0
complains "--frames: error: '0'"
run 2 simulate "$scenes/single.yaml" --frames 99999999999999999999
run 2 simulate "$scenes/pyramid.yaml" --frames 1000000
complains "too many to record"
run 2 simulate "$scenes/single.yaml" --no-bomb --bomb-x 3
run 2 simulate "$scenes/single.yaml" "$scenes/stack.yaml"
complains "only 1 scene can be given ('"
run 2 simulate "$scenes/stack.yaml" --dt 0 --frames 0 # the first of several errors
complains "--dt: error: '0'"
run 2 simulate --dt 0
complains "a scene file is needed"
run 2 simulate "$scenes/single.yaml" --method pair-net:network=nowhere.npz
complains "nowhere.npz"
run 2 simulate "$scenes/single.yaml" --method pair-net:network="$scenes/single.yaml"
complains "single.yaml"
run 2 simulate "$scenes/single.yaml" --bomb-x 1e30
[ -e run.txt ] && fail "a refused run left a file"

# The disk fails: status 3, and no partial file.
run 3 simulate "$scenes/single.yaml" -o nowhere/run.npz
complains "nowhere/run.npz"
run 3 simulate "$scenes/single.yaml" -o /dev/full/run.npz
finish
