#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs from elsewhere and for elsewhere: import reads CSV, export writes CSV and JSON.
. "$(dirname "$0")/checks.sh"
python() { /usr/bin/python3 "$@" || fail "python: $*"; }

run 0 simulate "$scenes/stack.yaml" --frames 90 -o ours.npz

# CSV gives every bit back, with names, bomb and static bodies.
run 0 export ours.npz -o ours.csv
says "stack by engine: 91 frames of 12 bodies -> ours.csv"
run 0 import ours.csv -o back.npz
says "stack by engine: 91 frames of 12 bodies, dt 0.0166667 s -> back.npz"
complains "assumed: units are m, s and rad; y points up"
run 0 compare ours.npz back.npz
says "equal: 91 frames of 12 bodies"
run 0 import ours.csv -o again.npz -q
equal "output of -q" "$(cat err)" ""
cmp -s back.npz again.npz || fail "importing twice gives two different files"
python - <<'PYTHON'
import numpy as np
a, b = np.load("ours.npz"), np.load("back.npz")
kept = [name for name in a.files if not name.startswith(("contact_", "mass", "verdict"))]
assert b.files == kept + ["verdict", "verdict_frame", "verdict_body"], b.files
for name in kept:
    assert a[name].tobytes() == b[name].tobytes(), name
PYTHON

# What simulate writes as CSV has no sizes; they come from a second file.
run 0 simulate "$scenes/stack.yaml" --frames 90 -o rows.csv
run 2 import rows.csv -o rows.npz
complains "rows.csv: error: the sizes of the bodies are missing: give --sizes FILE.csv"
{ echo body,width,height; for body in 1 2 3 4 5 6 7 8 9 10 11; do echo "$body,1,1"; done; } >sizes.csv
run 2 import rows.csv --sizes sizes.csv -o rows.npz
complains "rows.csv: error: the time step is missing: give --dt S"
run 0 import rows.csv --sizes sizes.csv --dt 1/60 -o rows.npz
for note in "bodies 1 to 11 of the file become bodies 0 to 10" "the scene is called 'rows'" "no body is static"; do
    complains "twinbox: note: assumed: $note"
done
run 0 render rows.npz --size 320x180 --frames 40 -o rows
sed 's/^3,1,1/3,1,0/' sizes.csv >flat.csv
run 2 import rows.csv --sizes flat.csv --dt 1/60 -o refused.npz
complains "flat.csv:4:5: error: height: '0' is less than 1e-06"
run 2 import rows.csv --sizes ours.csv --dt 1/60 -o refused.npz
complains "ours.csv:"

# Standard input may be a pipe. The run is called after its file, and errors have the line.
"$twinbox" import - --sizes sizes.csv --dt 1/60 -o piped.npz <rows.csv >out 2>err || fail "import -: $(<err)"
says "piped by piped: 91 frames of 11 bodies"
cat ours.csv | "$twinbox" import - -o piped.npz >out || fail "import - of a pipe"
cmp -s piped.npz back.npz || fail "standard input is read differently"
head -c 3000 ours.csv | "$twinbox" import - -o refused.npz >out 2>err && fail "half a line is taken"
grep -q "^standard input:[0-9]*:*[0-9]*: error: " err || fail "no line of standard input: $(<err)"

# Hostile files end at once, and nothing is written.
truncate -s 2G huge.csv
head -c 100000 /dev/urandom >noise.csv
sed 's/^50,3,.*$//' ours.csv >empty_line.csv
sed '/^50,3,/d' ours.csv >missing.csv
sed '/^50,/d' ours.csv >gap.csv
{ cat ours.csv; grep '^50,3,' ours.csv; } >twice.csv
sed 's/^\(50,3\),[^,]*/\1,nan/' ours.csv >nan.csv
sed 's/^50,3,/4000000000,3,/' ours.csv >far.csv
at=$(grep -n '^50,3,' ours.csv | cut -d: -f1)
next=$(grep -n '^51,3,' ours.csv | cut -d: -f1)
frame=$(grep -n '^50,1,' ours.csv | cut -d: -f1)
lines=$(wc -l <ours.csv)
while IFS='|' read -r file reason; do
    run 2 import "$file" -o refused.npz
    complains "$reason"
done <<END
huge.csv|huge.csv: error: larger than
noise.csv|noise.csv
empty_line.csv|empty_line.csv:$at: error: the line is empty
missing.csv|missing.csv:$((next - 1)): error: body 3 is in frame 49 and in frame 51, but not in frame 50
gap.csv|gap.csv:$frame: error: frame 51 comes here, but frame 50 has no rows
twice.csv|twice.csv:$((lines + 1)): error: body 3 is twice in frame 50: also in line $at
nan.csv|nan.csv:$next: error: body 3 is finite in frame 51, but not in frame 50
far.csv|far.csv:$at:1: error: frame: '4000000000' is not a whole number from 0 to 2147483646
nowhere.csv|nowhere.csv: error: cannot open
.|error:
ours.npz|ours.npz: error: has a NUL byte: not a CSV file
END
[ ! -e refused.npz ] || fail "a refused file was imported"
run 2 import ours.csv -o ours.txt
complains "the name of a run must end in .npz"
run 2 export ours.npz -o ours.txt
complains "ours.txt: error: the name must end in .csv or .json"
run 2 export ours.csv -o ours.json
complains "ours.csv: error: "
[ ! -e ours.json ] || fail "a refused file was exported"

# JSON has the same numbers, and contacts.
run 0 export ours.npz -o ours.json
run 0 export rows.npz -o rows.json
python - <<'PYTHON'
import json
import numpy as np
a, b = np.load("ours.npz"), json.load(open("ours.json"))
assert list(b) == ["format", "version", "scene", "method", "scene_hash", "dt", "bomb", "bodies", "frames"], list(b)
assert (b["scene"], b["method"], b["bomb"]) == ("stack", "engine", 11) and int(b["scene_hash"], 16) == a["scene_hash"]
assert np.float32(b["dt"]) == a["dt"]
assert np.array_equal(np.float32([body["size"] for body in b["bodies"]]), a["size"])
assert [body["static"] for body in b["bodies"]] == [bool(f) for f in a["fixed"]]
states = np.concatenate([a["position"], a["angle"][..., None], a["velocity"], a["angular_velocity"][..., None]], 2)
for k, frame in enumerate(b["frames"]):
    assert np.float32(frame["states"]).tobytes() == states[k].tobytes(), k
    first, end = a["contact_start"][k], a["contact_start"][k + 1]
    for i, contact in zip(range(first, end), frame["contacts"], strict=True):
        assert [contact["a"], contact["b"]] == list(a["contact_bodies"][i])
        for name in "point", "normal", "impulse":
            assert np.array_equal(np.float32(contact[name]), a["contact_" + name][i]), (i, name)
rows = json.load(open("rows.json"))
assert "scene_hash" not in rows and "bomb" not in rows and "contacts" not in rows["frames"][1]
PYTHON

# Unknown velocities, an absent body, and names with quotes.
python - <<'PYTHON'
import numpy as np
position, angle = np.zeros((3, 2, 2)), np.zeros((3, 2))
position[:, 0, 1], position[0, 1], angle[0, 1] = (2, 1, 0), np.nan, np.nan
np.savez("odd.npz", position=position, angle=angle, size=[[1, 1], [1, 1]], dt=0.5,
         scene='"""\\"); quit(1)', method="'''\\")
PYTHON
run 0 export odd.npz -o odd.json
run 0 export odd.npz -o odd.csv
run 0 import odd.csv -o odd_back.npz
run 0 compare odd.npz odd_back.npz
python - <<'PYTHON'
import json
odd = json.load(open("odd.json"))
assert odd["scene"] == '"""\\"); quit(1)' and odd["method"] == "'''\\"
assert odd["frames"][0]["states"] == [[0, 2, 0], None] and "contacts" not in odd["frames"][0]
PYTHON

run 0 export ours.npz -o ours.json
run 2 import ours.json -o refused.npz
complains "ours.json: error: is JSON, and only CSV can be imported; 'twinbox export RUN.npz -o RUN.csv' writes it"
finish
