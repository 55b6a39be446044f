#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The verdict of a run: one line, and a file with all figures.
. "$(dirname "$0")/checks.sh"
stability=$scenes/stability

# One of each kind (when each is given: tests/studies/test_verdict*.c). What the line begins with | arguments
while IFS='|' read -r words arguments; do
    run 0 simulate $arguments
    says "    verdict: $words"
done <<END
settles at |$stability/stack_height.yaml --set height=5
falls at |$stability/stack_height.yaml --set height=16
falls at 0.8|$stability/friction_ramp.yaml --set slope=0.5 --verdict falls.json
stands; |$scenes/stack.yaml --frames 45
tunnels at |$stability/bomb_speed.yaml --set speed=100
collapses: 2|$stability/double_domino.yaml
explodes at |$scenes/stack.yaml --method pair-net --frames 100
|$scenes/stack.yaml --bomb-x 2.5 --verdict bomb.json
END
says " of 10 boxes fell, first at "
# Without the bomb the same boxes are meant to stand.
run 0 simulate "$scenes/stack.yaml" --no-bomb --iterations 3
equal "lines about fallen bodies" "$(grep -c "boxes fell" out)" 0

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
