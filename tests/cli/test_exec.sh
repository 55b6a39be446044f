#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Other programs as a method: an adapter of the tests in both forms, and what happens when it fails in any way.
. "$(dirname "$0")/checks.sh"

# With a name of its own, by which its processes are found.
export adapter=$(basename "$folder").py
cp "$sources/tests/cli/adapter.py" "$adapter"
cat >fall.yaml <<'YAML'
gravity: [0, -10]
dt: 1/60
iterations: 10
frames: 100
bodies:
  - {static: true, size: [100, 20], position: [0, -10], friction: 0.2}
  - {size: [1, 1], mass: 1, position: [0, 100], friction: 0.2}
bomb: {frame: 40, x: 30, y: 50, size: [1, 1], mass: 5, friction: 0.2}
YAML
method() { echo "exec:/usr/bin/python3 $adapter $1"; }

# Both forms give the run of free fall, which is stored as that of another program, and the same again.
for form in json binary; do
    run 0 simulate fall.yaml --method "$(method $form),name=Fall" -o "$form.npz"
    says "fall by exec:/usr/bin/python3 $adapter $form,name=Fall: 100 steps of 0.0166667 s, 3 bodies"
    run 0 simulate fall.yaml --method "$(method $form),name=Fall" -o "$form-again.npz"
    run 0 compare "$form.npz" "$form-again.npz"
done
run 0 compare json.npz binary.npz --tolerance 1e-3
run 0 export json.npz -o json.json
/usr/bin/python3 - <<'PYTHON' || fail "the run is not that of free fall"
import json
import os
run = json.load(open("json.json"))
method = f"exec:/usr/bin/python3 {os.environ['adapter']} json,name=Fall"
assert run["program"] == "fall 1" and run["method"] == method, run["program"]
assert "contacts" not in run["frames"][5]
x, y, angle, vx, vy, omega = run["frames"][60]["states"][1]
assert abs(vy + 10) < 1e-4 and abs(y - (100 - 5 * 61 / 60)) < 1e-3, (y, vy)
assert run["frames"][39]["states"][2] is None and run["frames"][40]["states"][2][1] == 50
assert abs(run["frames"][100]["states"][2][4] + 10) < 1e-4
PYTHON
run 0 render json.npz -o frames --size 320x180 --frames 3:3
run 0 page json.npz binary.npz -o page.html

# fails KIND TEXT [SETTINGS]: the run ends with this verdict, in time, and no process is left.
fails() {
    cp json.npz kept.npz
    run 2 simulate fall.yaml --method "$(method "$1"),step_limit=${3:-60}" -o kept.npz
    complains "adapter failed: $2"
    says "verdict: adapter failed at"
    equal "the file of a run that failed" "$(md5sum <kept.npz)" "$(md5sum <json.npz)"
    if pgrep -f "$adapter $1" >left; then fail "$1: process $(head -1 left) is left"; fi
}
fails silent "has not answered in time" 2
fails stubborn "has not answered in time" 2
fails sleep "has not answered in time" 2
fails close "has closed its standard output"
fails fork "has ended (status 0)"
fails die "has ended (status 1): ValueError: the engine has no more memory, in step 5"
fails group "has not answered in time" 2
fails group-later "has not answered in time" 2
fails bytes "has a name or version that is not UTF-8"
fails escapes 'says: no "lib" in C:\x/ü 😀'
fails lone "its first line is not as it should be"
fails garbage "its first line is not as it should be: 'Loading the engine...'"
fails doubled "its first line is not as it should be"
fails again "its answer is not as it should be"
fails nul "has written a NUL byte in a line of text, in step 5"
fails wordy "says: much much much "
fails version "speaks version 2 of the protocol; expected version 1"
fails flood "has written a line of more than 4096 bytes"
fails long "has written a line of more than"
fails former "has answered for scene 0; it is at scene 1, in step 5"
fails frame "has answered with frame 4; frame 5 was asked for"
fails count "has answered with 6 numbers; 2 bodies have 12"
fails nan "body 1: its y is no finite number: 'NaN'"
fails null "body 1: its angle is no finite number: 'null'"
fails huge "body 1: its x is no finite number"
fails comma "has answered with"
fails twice "has " # it depends on when the second answer comes
fails settings "says: {}"
run 2 simulate fall.yaml --method "$(method slow),run_limit=2"
complains "the run has taken longer than its run_limit"
run 0 simulate fall.yaml --method "$(method crlf)"
run 0 simulate fall.yaml --method "$(method complain),step_limit=60"

# A signal ends the program, too.
for signal in INT TERM HUP; do
    strike $signal 130 "pgrep -f '^/usr/bin/python3 $adapter silent'" simulate fall.yaml --method "$(method silent),step_limit=1000"
    for _ in $(seq 100); do pgrep -f "$adapter silent" >left || break; sleep 0.05; done
    if [ -s left ]; then fail "$signal: process $(head -1 left) is left"; kill -9 $(cat left); fi
done

# Programs that cannot be run, and texts that name none.
run 2 simulate fall.yaml --method "exec:./none"
complains "exec:./none: error: adapter failed: cannot be run: No such file or directory, in step 1 of scene fall"
echo text >text
run 2 simulate fall.yaml --method "exec:./text"
complains "cannot be run: Permission denied"
run 2 simulate fall.yaml --method "$(method settings),k=8,mode=a=b,name=Fall"
complains "says: {'k': '8', 'mode': 'a=b'}"

# A stored run names its method; only a program that the command line names is started.
run 2 compare json.npz binary.npz --scene fall.yaml
complains "is not started, as the command line does not name it"
# Only an option for methods does: the name of a file is none.
mkdir names
run 0 simulate fall.yaml --method "exec:python3 $adapter json" -o "names/exec:python3 $adapter json,x.npz"
cp binary.npz names/z.npz && cp fall.yaml names/
(cd names && cp "../$adapter" . && exec "$twinbox" compare *.npz --scene fall.yaml) >out 2>err </dev/null
equal "exit status with a file whose name is that of a program" $? 2
complains "is not started, as the command line does not name it"

# Studies: a failure is a verdict of its method, and two runs that differ are reported. One process serves all runs.
cat >counted <<'SH'
#!/bin/sh
echo started >>starts
exec /usr/bin/python3 $adapter "$1"
SH
chmod +x counted
make_tower
OMP_NUM_THREADS=1 run 0 stability tower.yaml --vary height=1:4 --quick -o study \
    --methods "engine,exec:./counted json,name=Fall,$(method random),$(method die),exec:./none"
says "Fall"
says "is fall 1"
says "not deterministic: two runs at"
grep -q "^tower_height,exec,.*die,height,,,1,adapter failed$" study/stability.csv || fail "die: $(cat study/stability.csv)"
grep -q "die,fall,1,4,4,has ended (status 1): ValueError" study/engines.csv || fail "engines: $(cat study/engines.csv)"
grep -q "none.*No such file" study/refusals.csv || fail "refusals: $(cat study/refusals.csv)"
equal "processes of a study" "$(grep -c started starts)" 1

# Charts: closed loop only, and time in a column of its own.
run 0 chart "$scenes/stack.yaml" --quick --methods "engine:k=10,$(method json),$(method die)" --launches 1 -o chart
complains "note: runs ended early: exec:/usr/bin/python3 $adapter die: error: adapter failed: has ended (status 1)"
/usr/bin/python3 - <<'PYTHON' || fail "chart.csv"
import csv
rows = [row for row in csv.DictReader(open("chart/chart.csv")) if "json" in row["setting"]]
assert all(row["us_solver"] == row["us_step"] == "" for row in rows)
assert all(row["error_mean"] == "" for row in rows if row["protocol"] == "frozen")
closed = [row for row in rows if row["protocol"] == "closed" and row["phase"] == "rest"]
assert closed[0]["us_engine"] == "1.5" and float(closed[0]["error_mean"]) > 0, closed
assert not any("exec" in row["method"] for row in csv.DictReader(open("chart/equal_time.csv")))
PYTHON

# A scene as JSON, for adapters and others.
run 0 export "$scenes/stack.yaml" --flat -o flat.json
says "stack: 11 bodies and a bomb -> flat.json"
run 0 export "$scenes/stability/arch.yaml" --flat --set friction=0.7 -o arch.json
/usr/bin/python3 - <<'PYTHON' || fail "a flat scene"
import json
flat, arch = json.load(open("flat.json")), json.load(open("arch.json"))
assert flat["bodies"][0]["static"] and flat["bodies"][3]["size"] == [1, 1] and flat["bomb"]["mass"] == 50
assert flat["bomb"]["frame"] == 0 and len(flat["bodies"]) == 11 and abs(flat["dt"] - 1 / 60) < 1e-8
assert all(abs(body["friction"] - 0.7) < 1e-6 for body in arch["bodies"])
PYTHON
finish
