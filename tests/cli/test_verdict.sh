#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The verdict of a run: one line, and a file with all figures.
. "$(dirname "$0")/checks.sh"
stability=$scenes/stability

# What the line says | arguments
while IFS='|' read -r words arguments; do
    run 0 simulate $arguments
    says "    verdict: $words"
done <<END
settles; at rest |$stability/stack_height.yaml --set height=5
moves; still moving at the end|$scenes/stack.yaml --no-bomb
falls; 13 of 16 fell, first at |$stability/stack_height.yaml --set height=16
falls; 1 of 1 fell, first at 0.8|$stability/friction_ramp.yaml --set slope=0.5 --verdict falls.json
stands; |$scenes/stack.yaml --frames 45
too short; too short to tell|$stability/stack_height.yaml --set height=5 --frames 5
tunnels at |$stability/bomb_speed.yaml --set speed=100
collapses; 22 of 22 fell, first at |$stability/double_domino.yaml
explodes at |$scenes/stack.yaml --method pair-net --frames 100
|$scenes/stack.yaml --bomb-x 2.5 --verdict bomb.json
END
says " of 10 fell, first at "

/usr/bin/python3 - <<'PYTHON' || fail "the files of verdicts"
import json
falls, bomb = (json.load(open(name)) for name in ("falls.json", "bomb.json"))
assert falls["format"] == "twinbox simulate verdict 1" and falls["scene"] == "friction_ramp" and falls["method"] == "engine"
assert falls["verdict"] == "falls" and falls["holds"] is False and falls["sound"] is True
assert falls["body"] == 1 and falls["unit"] == "boxes" and falls["value"] == 1 and falls["quantity"] == "bodies that fell"
assert abs(falls["time"] - falls["frame"] / 60) < 1e-6 and falls["steps"] == 3600
assert falls["fallen"] == [1] and falls["bodies"] == 1 and falls["at_rest"] is False and falls["rest_since"] is None
assert falls["drift"] > 100, falls
assert bomb["bodies"] == 10 and 0 < len(bomb["fallen"]) <= 10 and 11 not in bomb["fallen"]
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
