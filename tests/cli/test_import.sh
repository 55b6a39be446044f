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
{ echo body,width,height; for body in 1 2 3 4 5 6 7 8 9 10 11; do echo "$body,1,1"; done; } >sizes.csv
run 0 import rows.csv --sizes sizes.csv --dt 1/60 -o rows.npz
for note in "bodies 1 to 11 of the file become bodies 0 to 10" "the scene is called 'rows'" "no body is static"; do
    complains "twinbox: note: assumed: $note"
done
run 0 render rows.npz --size 320x180 --frames 40 -o rows

# Standard input may be a pipe. The run is called after its file, and errors have the line.
"$twinbox" import - --sizes sizes.csv --dt 1/60 -o piped.npz <rows.csv >out 2>err || fail "import -: $(<err)"
says "piped by piped: 91 frames of 11 bodies"
cat ours.csv | "$twinbox" import - -o piped.npz >out || fail "import - of a pipe"
cmp -s piped.npz back.npz || fail "standard input is read differently"
head -c 3000 ours.csv | "$twinbox" import - -o refused.npz >out 2>err && fail "half a line is taken"
grep -q "^standard input:[0-9]*:*[0-9]*: error: " err || fail "no line of standard input: $(<err)"

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
finish
