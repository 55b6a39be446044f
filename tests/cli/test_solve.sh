#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One contact problem, written and solved.
. "$(dirname "$0")/checks.sh"

run 0 solve "$scenes/stack.yaml" --frame 41 -o impact.npz
says "stack, step 41: 12 bodies, 19 contacts -> impact.npz"
run 0 solve "$scenes/stack.yaml" --frame 41 -o again.npz
cmp -s impact.npz again.npz || fail "the same problem has other bytes"
run 0 solve "$scenes/stack.yaml" --frame 41 --bomb-x 2 -o other.npz
cmp -s impact.npz other.npz && fail "the bomb comes from elsewhere, the problem is the same"
run 0 solve "$scenes/stack.yaml" --frame 41 --run-by engine:k=3 -o soft.npz
cmp -s impact.npz soft.npz && fail "another method ran the scene, the problem is the same"
run 0 solve "$scenes/stack.yaml" --frame 1 -o first.npz
says "step 1: 12 bodies"

# The state after the step is the problem's, solved by the same method and moved on by dt.
run 0 simulate "$scenes/stack.yaml" --frames 41 -o run.npz
/usr/bin/python3 - <<'PYTHON' || fail "the problem is not that of the run's step 41"
import numpy
problem, run = numpy.load("impact.npz"), numpy.load("run.npz")
assert numpy.array_equal(problem["position"], run["position"][40])
assert numpy.array_equal(problem["angle"], run["angle"][40])
assert numpy.array_equal(problem["contact_bodies"], run["contact_bodies"][run["contact_start"][41]:])
assert problem["frame"] == 41 and problem["bomb"] == 11 and str(problem["scene"]) == "stack"
fallen = run["velocity"][40] + numpy.float32(1 / 60) * numpy.array([0, -10], numpy.float32)
assert numpy.abs(problem["velocity"][1:] - fallen[1:]).max() < 1e-5
PYTHON

# value METHOD COLUMN: a figure of the last table.
value() { awk -v method="$1" -v column="$2" '$1 == method { print $column }' out; }
# less WHAT A B
less() {
    checks=$((checks + 1))
    awk -v a="$2" -v b="$3" 'BEGIN { exit !(a < b) }' || fail "$1: $2 is not less than $3"
}
run 0 solve impact.npz -m engine:k=1 -m engine:k=10 --method engine:k=100 -m engine:k=1000 -m reference
says "stack, step 41: 12 bodies, 19 contacts; reference: residual"
equal "lines" "$(wc -l <out)" 7
for column in 2 4; do
    less "column $column" "$(value engine:k=10 $column)" "$(value engine:k=1 $column)"
    less "column $column" "$(value engine:k=100 $column)" "$(value engine:k=10 $column)"
    less "column $column" "$(value engine:k=1000 $column)" "$(value engine:k=100 $column)"
    less "column $column" "$(value reference $column)" 1e-4
done
equal "bodies right by the reference" "$(value reference 3)" 11/11
run 0 solve impact.npz -m "pair-net:network=$scenes/networks/pair-net.npz"

# Impulses from elsewhere: those of a run's step are the solution of its method; none leave the bodies falling.
run 0 simulate "$scenes/stack.yaml" --frames 41 -o run.npz
/usr/bin/python3 - <<'PYTHON'
import numpy
run = numpy.load("run.npz")
impulses = run["contact_impulse"][run["contact_start"][41]:run["contact_start"][42] if len(run["contact_start"]) > 42 else None]
with open("mine.csv", "w") as file:
    file.write("tangent,contact,normal\n")
    file.writelines(f"{float(t)!r},{i},{float(n)!r}\n" for i, (n, t) in reversed(list(enumerate(impulses))))
open("none.csv", "w").write("contact,normal,tangent\n")
PYTHON
run 0 solve impact.npz -m engine --impulses mine.csv
less "impulses of the engine" "$(value mine.csv 2)" "$(awk -v e="$(value engine 2)" 'BEGIN { print 1.0001 * e }')"
less "impulses of the engine" "$(awk -v e="$(value engine 2)" 'BEGIN { print 0.9999 * e }')" "$(value mine.csv 2)"
equal "residual" "$(value mine.csv 4 | cut -c1-4)" "$(value engine 4 | cut -c1-4)"
run 0 solve impact.npz --impulses none.csv
less "the engine" "$(value engine 2)" "$(value none.csv 2)"

# A step of a scene is solved as its file is, written or not.
methods="-m engine:k=3 -m momentum -m reference"
for json in "" --json; do
    run 0 solve soft.npz $methods $json
    cp out by_file
    run 0 solve "$scenes/stack.yaml" --frame 41 --run-by engine:k=3 $methods $json
    cmp -s by_file out || fail "a step and its file have other scores: $(diff by_file out)"
done
run 0 solve "$scenes/stack.yaml" --frame 41 -o both.npz -m engine
cmp -s both.npz impact.npz || fail "with a method, another problem is written"
says "stack, step 41: 12 bodies, 19 contacts -> both.npz"
says "reference: residual"
run 0 solve "$scenes/stack.yaml" --frame 41 -o both.npz -m engine --json
/usr/bin/python3 -m json.tool <out >/dev/null || fail "-o --json is not JSON"

# A step without a solution: nothing is scored against its answer.
wedge=$(dirname "$scenes")/tests/methods/scenes/wedge.yaml
run 0 solve "$wedge" --frame 50 -m engine
says "The reference did not converge (tolerance: 1e-09 m/s); nothing is scored against it."
grep -Eq '^engine +- +-/1 ' out || fail "scored against a step that did not converge"
run 0 solve "$wedge" --frame 50 -m engine --json
says '"converged": false'
grep -q '"error"' out && fail "an error against a step that did not converge"
run 0 simulate "$wedge" -m reference -o wedge.npz
grep -Eq '^    steps that did not converge: [1-9]' out || fail "unconverged steps are not counted"
awk '/largest residual: / { above = $3 > $6 } END { exit !above }' out || fail "the largest residual: $(cat out)"
says "this run is no yardstick"
# The words of the verdict go with the run.
grep -Eq "^    verdict: settles;.*; [0-9]* steps did not converge$" out || fail "the verdict: $(cat out)"
finish
