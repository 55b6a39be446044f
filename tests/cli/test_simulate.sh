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
# A run has the verdict that is printed.
run 0 simulate "$scenes/stack.yaml" -o judged.npz
printed=$(sed -n 's/^    verdict: //p' out)
/usr/bin/python3 -c "
import numpy, sys
run = numpy.load('judged.npz', allow_pickle=False)
assert str(run['verdict']) == sys.argv[1] != '', (str(run['verdict']), sys.argv[1])
assert 0 <= run['verdict_frame'] < len(run['position'])" "$printed" || fail "the verdict in the run"
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

# A file of the same kind is replaced, and an empty one; devices and links to files are written through.
: >empty.npz
run 0 simulate "$scenes/single.yaml" --frames 2 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 2 -o empty.npz --hash /dev/null
run 0 simulate "$scenes/single.yaml" --frames 2 --hash /dev/stdout
says "frame,hash"
finish
