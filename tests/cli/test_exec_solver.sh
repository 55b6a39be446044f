#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Programs that solve contact problems: what they are asked, the scores of their impulses, and what happens when they fail.
. "$(dirname "$0")/checks.sh"

# With a name of its own, by which its processes are found.
solver=$(basename "$folder").py
cp "$sources/tests/cli/solver.py" "$solver"
cp "$scenes/engines/sweeps.py" "$scenes/engines/toy.py" .
cat >rest.yaml <<'YAML'
gravity: [0, -10]
dt: 1/60
iterations: 10
frames: 20
bodies:
  - {static: true, size: [100, 20], position: [0, -10], friction: 0.2}
  - {size: [1, 1], mass: 1, position: [0, 0.5], friction: 0.2}
YAML
method() { echo "exec-solver:/usr/bin/python3 $solver $1"; }
sweeps="exec-solver:/usr/bin/python3 sweeps.py"

# The sweeps of scenes/engines make those of the engine, but for rounding; more of them come nearer to the reference.
run 0 solve "$scenes/stack.yaml" --frame 41 -o impact.npz
run 0 solve impact.npz --json -m engine:k=10 -m engine:k=100 -m "$sweeps" -m "$sweeps,k=100" -m "$sweeps,k=1000"
/usr/bin/python3 - <<'PYTHON' || fail "the scores of sweeps"
import json
ten, hundred, *ours = json.load(open("out"))["methods"]
for engine, other in (ten, ours[0]), (hundred, ours[1]):
    for key in "error", "residual", "signorini", "dissipation", "energy":
        assert abs(engine[key] - other[key]) < 1e-3 * abs(engine[key]), (key, engine[key], other[key])
    assert engine["right"] == other["right"] and other["cone"] < 1e-6
assert ours[0]["error"] > 1.5 * ours[1]["error"] > 100 * ours[2]["error"] > 0, [score["error"] for score in ours]
PYTHON

# The program is asked what the file of the problem has, and what it answers is stored as the impulses of the step.
rm -f asked
run 0 solve impact.npz -m "$(method keep)"
/usr/bin/python3 - <<'PYTHON' || fail "the request"
import json
import numpy
asked, p = json.loads(open("asked").readline()), numpy.load("impact.npz")
columns = lambda names: numpy.concatenate([p[name].reshape(len(p[names[0]]), -1) for name in names], 1)
bodies = columns(["inv_mass", "inv_inertia", "size", "position", "angle", "velocity", "angular_velocity"])
contacts = columns(["contact_bodies", "contact_normal", "contact_arm_a", "contact_arm_b", "contact_separation",
                    "contact_friction", "contact_bias", "contact_warm"])
assert asked.keys() == {"problem", "dt", "bodies", "contacts"} and numpy.float32(asked["dt"]) == p["dt"]
assert (numpy.array(asked["bodies"], "float32") == bodies.astype("float32")).all()
assert (numpy.array(asked["contacts"], "float32") == contacts.astype("float32")).all()
PYTHON

# Closed loop: the same run again, with contacts, impulses and the program's name; where nothing touches, nothing is asked.
run 0 simulate "$scenes/stack.yaml" --frames 60 --method "$sweeps,name=Mine" -o mine.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --method "$sweeps,name=Mine" -o again.npz
run 0 compare mine.npz again.npz
run 0 simulate rest.yaml --method "$sweeps" -o resting.npz
run 0 simulate rest.yaml -o rested.npz
run 0 compare rested.npz resting.npz --tolerance 0.001
run 0 simulate "$scenes/stack.yaml" --frames 60 -o engine.npz
run 0 export mine.npz -o mine.json
/usr/bin/python3 - <<'PYTHON' || fail "the stored run"
import json
run = json.load(open("mine.json"))
assert run["program"] == "sweeps 1"
assert sum(contact["impulse"][0] for contact in run["frames"][60]["contacts"]) > 0
PYTHON
# Pages say what kind of method it is, and what the program calls itself.
run 0 page mine.npz -o mine.html
PYTHONPATH=$sources/tests/browser /usr/bin/python3 -B -c 'import player_page
assert player_page.data("mine.html")["runs"][0]["note"] == "external solver: sweeps 1"' || fail "the page does not name the program"
sed 's/0.5\]/100]/' rest.yaml >fall.yaml
rm -f asked
run 0 simulate fall.yaml --method "$(method keep)"
[ ! -e asked ] || fail "a problem without contacts was asked"
if pgrep -f "$solver" >left; then fail "process $(head -1 left) is left"; fi

# fails KIND TEXT [SETTINGS]: the run ends with this verdict, and no process is left.
fails() {
    run 2 simulate rest.yaml --method "$(method "$1"),step_limit=${3:-60}"
    complains "exec-solver:/usr/bin/python3 $solver $1: error: adapter failed: $2"
    complains ", in step "
    says "verdict: adapter failed at"
    if pgrep -f "$solver $1" >left; then fail "$1: process $(head -1 left) is left"; fi
}
fails few "has answered with 3 numbers; 2 contacts have 4"
fails none "its answer is not as it should be: '{\"problem\": 3, \"ns\": 1500}'"
fails nan "contact 1: its tangent impulse is no finite number: 'NaN'"
fails huge "contact 1: its normal impulse is no finite number"
fails fast "contact 1: its impulse (3e+38, 0) N s makes a velocity infinite"
fails text "contact 0: its normal impulse is no finite number: '\"much\"'"
fails former "has answered problem 2; problem 3 was asked"
fails chatty "its answer is not as it should be: 'no JSON'"
fails silent "has not answered in time" 2
fails die "has ended (status 1): ValueError: the network has no such input"
fails close "has closed its standard output"
fails twice "has "
fails error "says: the network is for another scene"
fails ns-nan "its answer is not as it should be"
fails states "answers states, which 'exec:PROGRAM' takes"
fails poses "answers 'poses'; known: states, impulses"
fails binary "wants the form 'binary'; impulses have: json"
run 2 simulate rest.yaml --method "exec:/usr/bin/python3 $solver good"
complains "answers impulses, which 'exec-solver:PROGRAM' takes"
run 2 simulate rest.yaml --method "$(method settings),k=8,name=Warm,run_limit=3"
complains "says: {'k': '8', 'run_limit': '3'}"
run 2 solve impact.npz -m "exec-solver:./none"
complains "exec-solver:./none: error: adapter failed: cannot be run: No such file or directory"
run 2 compare mine.npz engine.npz --scene "$scenes/stack.yaml"
complains "is not started, as the command line does not name it"

# Charts: frozen and in closed loop, by the program's own clock; the rest is drawn without a program that fails, and without a
# time that is none.
run 0 chart "$scenes/stack.yaml" --quick --launches 1 -o chart --methods \
    "engine:k=10,$sweeps,k=10,name=Mine,$(method good),$(method ns-none),$(method ns-negative),$(method die)"
says " of 11 frozen steps"
complains "note: runs ended early: exec-solver:/usr/bin/python3 $solver die: error: adapter failed: has ended (status 1)"
/usr/bin/python3 - <<'PYTHON' || fail "chart.csv"
import csv
rows = list(csv.DictReader(open("chart/chart.csv")))
find = lambda word: {(row["protocol"], row["phase"]): row for row in rows if word in row["method"] + ":" + row["setting"]}
engine, mine = find("engine:"), find("sweeps.py")
assert len(mine) == 6
for key, row in mine.items():
    assert row["us_solver"] == row["us_step"] == "" and float(row["us_engine"]) > 0, row
    if key[0] == "frozen":
        error, ours = float(engine[key]["error_mean"]), float(row["error_mean"])
        assert abs(error - ours) < 1e-3 * error + 1e-6, (key, error, ours)
for key, row in find("good").items():  # in the first frames nothing touches, so nothing is asked
    assert row["us_engine"] == "1.5" or (key == ("closed", "rest") and 1 < float(row["us_engine"]) < 1.5), row
for word in "ns-none", "ns-negative":
    assert all(row["us_engine"] == "" and float(row["error_mean"]) > 0 for row in find(word).values())
assert find("die")["closed", "impact"]["error_mean"] == "" != find("good")["closed", "impact"]["error_mean"]
PYTHON
grep -q "Mine, .*: an external program, by its own clock" chart/chart-stack.txt || fail "caption: $(cat chart/chart-stack.txt)"

# Two runs that differ are named.
make_tower
run 0 stability tower.yaml --vary height=1:3 --quick -o study --methods "$sweeps,k=10,name=Mine,$(method random),name=Dice"
says "Mine is sweeps 1"
says "not deterministic: two runs at"
finish
