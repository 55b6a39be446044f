#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The verdict of a run: one line, and a file with all figures.
. "$(dirname "$0")/checks.sh"
stability=$scenes/stability

# With ten iterations the engine holds a stack of 5, and none of 16 (golden/stability.csv).
run 0 simulate "$stability/stack_height.yaml" --set height=5
says "    verdict: settles at "
run 0 simulate "$stability/stack_height.yaml" --set height=16
says "    verdict: falls at "
# A slope of 0.5 exceeds the friction, 0.2: the box slides by g (sin - 0.2 cos) t^2 / 2 = 1.34 m/s^2 t^2 along it and is half
# its side lower after 0.5 m / sin: sqrt(1.118 / 1.34) s.
run 0 simulate "$stability/friction_ramp.yaml" --set slope=0.5 --verdict falls.json
says "    verdict: falls at 0.8"
says " s (body 1, 0.51"
says " m lower)"
# Nothing has fallen shortly after the strike.
run 0 simulate "$scenes/stack.yaml" --frames 45
says "    verdict: stands; "
says "; still moves at the end"
# The centre crosses the slab of 0.25 m within a step.
run 0 simulate "$stability/bomb_speed.yaml" --set speed=100
says "    verdict: tunnels at "
says "body 1, at 100 m/s through a static box)"
# Dominoes are meant to fall: they start with a speed. What has fallen is counted.
run 0 simulate "$stability/double_domino.yaml"
says "    verdict: collapses: 2"
says " of 20 boxes fell, first at "
# A bomb may topple what it strikes.
run 0 simulate "$scenes/stack.yaml" --bomb-x 2.5 --verdict bomb.json
says "    verdict: "
says " of 10 boxes fell, first at "
# Without the bomb the same boxes are meant to stand.
run 0 simulate "$scenes/stack.yaml" --no-bomb --iterations 3
complaint=$(grep -c "boxes fell" out)
equal "lines about fallen bodies" "$complaint" 0
run 0 simulate "$scenes/stack.yaml" --method pair-net --frames 100
says "    verdict: explodes at "

/usr/bin/python3 - <<'PYTHON' || fail "the files of verdicts"
import json
falls, bomb = (json.load(open(name)) for name in ("falls.json", "bomb.json"))
assert falls["format"] == "twinbox simulate verdict 1" and falls["scene"] == "friction_ramp" and falls["method"] == "engine"
assert falls["verdict"] == "falls" and falls["holds"] is False and falls["quantity"] == "descent"
assert falls["body"] == 1 and falls["unit"] == "m" and 0.5 < falls["value"] < 0.55, falls
assert abs(falls["time"] - falls["frame"] / 60) < 1e-6 and falls["steps"] == 3600
assert falls["falls_judged"] == "to the end" and falls["fallen"] == [1] and falls["bodies"] == 1
assert falls["drift"] > 100, falls
assert bomb["falls_judged"] == "until the bomb touches" and bomb["bodies"] == 10
assert 0 < len(bomb["fallen"]) <= 10 and 11 not in bomb["fallen"]
assert bomb["holds"] is False and bomb["sound"] is True and bomb["drift"] is None
assert bomb["verdict"] in ("falls", "collapses") and bomb["value"] == len(bomb["fallen"]) and bomb["unit"] == "boxes"
PYTHON

# The verdict does not change the run, and the same run gives the same file.
run 0 simulate "$scenes/stack.yaml" --bomb-x 2.5 --verdict again.json
cmp -s bomb.json again.json || fail "two runs, two verdicts"
run 0 simulate "$scenes/stack.yaml" --bomb-x 2.5 --verdict /dev/stdout
says '"format": "twinbox simulate verdict 1"'
run 3 simulate "$scenes/stack.yaml" --verdict nowhere/verdict.json
complains "nowhere/verdict.json"
finish
