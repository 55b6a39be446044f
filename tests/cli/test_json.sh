#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# --json: one object on standard output and nothing else, with the figures of the text and the same exit status.
. "$(dirname "$0")/checks.sh"

# both STATUS ARGUMENT...: text goes to text, the object to json.
both() {
    run "$@"
    mv out text
    run "$@" --json
    mv out json
    # Work of more than a second shows its progress, on a busy machine here too.
    equal "errors of $* --json" "$(grep -v '^[a-z ]*: [0-9]*%$' err)" ""
    [ "$(tail -c 2 json | od -An -tx1)" = " 7d 0a" ] || fail "$* --json does not end with } and a newline"
}

cat >check.py <<'PYTHON'
# Reads the object, strictly, and what the text says: result, text.
import json
import sys


def refuse(name):
    raise ValueError(name)


def unique(pairs):
    assert len(dict(pairs)) == len(pairs), pairs
    return dict(pairs)


result = json.loads(open("json", encoding="utf-8").read(), parse_constant=refuse, object_pairs_hook=unique)
text = open("text", encoding="utf-8").read()
assert next(iter(result)) == "format"
assert result["format"] == sys.argv[1], result["format"]


def states(*pieces):
    """The text has them; of a number, with as many digits as texts have."""
    for piece in pieces:
        forms = [piece] if isinstance(piece, str) else ["%.*g" % (digits, piece) for digits in (2, 3, 4, 6, 9)]
        assert any(form in text for form in forms), f"{piece!r} is not in the text"
PYTHON

# check FORMAT: with statements from standard input.
check() {
    checks=$((checks + 1))
    { cat check.py && cat; } >program.py
    /usr/bin/python3 program.py "$1" 2>trace || fail "$1: $(tail -3 trace)"
}

both 0 methods
check "twinbox methods 1" <<'PYTHON'
assert [method["name"] for method in result["methods"]] == [line.split()[0] for line in text.splitlines() if not line.startswith(" ")]
for method in result["methods"]:
    states(method["summary"], *(f"    {setting['key']}: {setting['summary']}\n" for setting in method["settings"]))
known = {method["name"]: method for method in result["methods"]}
assert known["pair-net"]["needs_network"] and not known["engine"]["needs_network"]
assert known["engine"]["contact_solver"] and not known["playback"]["contact_solver"]
assert known["scene-net"]["without_learned_part"] == "scene-net:net=off"
PYTHON

"$twinbox" solve "$scenes/stack.yaml" --frame 41 -o impact.npz >/dev/null
both 0 solve impact.npz -m engine -m momentum:k=20 -m reference
check "twinbox solve 1" <<'PYTHON'
assert len(result["methods"]) == 3
states(*(result[key] for key in ("scene", "step", "bodies", "contacts")), *result["reference"].values())
for row in result["methods"]:
    line, = [line.split() for line in text.splitlines() if line.split()[:1] == [row["method"]]]
    assert line[2] == f"{row['right']}/{row['counted']}", line
    for key, word in zip(("error", "residual", "signorini", "cone", "dissipation", "penetration", "energy"), line[1:2] + line[3:]):
        assert word == "%.4g" % row[key], (key, row, line)
PYTHON

"$twinbox" simulate "$scenes/stack.yaml" --method nncg -o nncg.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" -o engine.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" --method momentum -o momentum.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" --bomb-frame 299 -o late.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" --frames 4 --method momentum -o short.npz >/dev/null
both 0 compare nncg.npz nncg.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["passed"] is True and result["cause"] == "none"
assert all(result[key] is None for key in ("first", "largest", "beyond", "contacts", "beyond_contacts", "growth", "shifted", "words"))
states("equal: %d frames of %d bodies" % (result["frames"], result["expected"]["bodies"]))
PYTHON
both 1 compare nncg.npz momentum.npz --scene "$scenes/stack.yaml" --tolerance 0.01
check "twinbox compare runs 1" <<'PYTHON'
for run in result["expected"], result["actual"]:
    states(f"{run['scene']} by {run['method']}, {run['frames']} frames of {run['bodies']} bodies ({run['path']})")
for where in result["first"], result["beyond"]:
    states(f"frame {where['frame']}, body {where['body']}", *(where[key] for key in ("distance", "angle", "speed", "spin")))
states("cause: the " + result["cause"], *result["largest"].values(), result["rollout_mse"])
contact = result["contacts"]["contact"]
states("%08x" % contact["feature"], *contact["point"], *contact["normal_impulse"], *contact["tangent_impulse"])
assert result["beyond_contacts"]["step"] == result["beyond"]["frame"] > result["contacts"]["step"]
shifted = result["shifted"]
for of in result["growth"], shifted["growth"]:
    states(*(of[key] for key in ("from", "first", "to", "last", "rate", "doubling_frames", "scatter_factor")))
states(f"(body {shifted['body']} shifted by ", shifted["shift"], "verdict: " + shifted["verdict"])
assert shifted["verdict"] == "chaos" and shifted["rerun_differs"] is None
assert result["passed"] is False and result["words"] is None and abs(result["tolerance"] - 0.01) < 1e-9 and result["frames"] == 301
PYTHON
# Two frames are too few for a rate, which is then NaN.
both 1 compare nncg.npz short.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["growth"]["rate"] is None and result["growth"]["doubling_frames"] is None and result["growth"]["count"] == 2
assert result["actual"]["frames"] == 5 and result["first"]["frame"] == 3 and result["shifted"] is None
PYTHON
both 1 compare engine.npz late.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["first"]["only_in_run"] == 1 and result["first"]["bomb"] and result["cause"] == "initial state"
assert result["first"]["distance"] is None and result["contacts"] is None
PYTHON

# A folder's name has every kind of character; what it holds is that of results.json.
folder_name='a "b" <c> \ é'
"$twinbox" render engine.npz -o "$folder_name" --frames 40:42 --size 320x180 >/dev/null
"$twinbox" render momentum.npz -o actual --frames 40:42 --size 320x180 >/dev/null
both 1 compare "$folder_name" actual --report report --tolerance 1
check "twinbox compare 1" <<'PYTHON'
assert result == json.load(open("report/results.json"))
assert result["expected"] == 'a "b" <c> \\ é' and result["passed"] is False
counts = result["counts"]
failed = [frame for frame in result["frames"] if frame["failed"]]
assert len(failed) == counts["different"]
states(f"{counts['different']} of {counts['frames']} frames differ", "verdict: " + result["verdict"], *result["causes"],
       f"first difference: {failed[0]['name']}: {failed[0]['words']}\n")
assert result["tolerance"] == "differences above 1 in at most 0% of the pixels", result["tolerance"]
PYTHON
both 0 simulate "$scenes/stack.yaml" -o run.npz
check "twinbox simulate 1" <<'PYTHON'
states(f"{result['scene']} by {result['method']}: {result['steps']} steps of {result['dt']:.6g} s, {result['bodies']} bodies",
       f"state {result['state']} -> {result['output']}", f"verdict: {result['verdict']['verdict']}")
assert result["steps"] == 300 and result["fallbacks"]["by_sweeps"] == 0
PYTHON
run 0 simulate "$scenes/stack.yaml" --frames 5 --json
grep -q '"output": null' out || fail "output where no run is written"

# No failure looks like a result. (What is refused: refused/*.txt.)
for command in "methods" "solve impact.npz -m engine" "compare engine.npz engine.npz"; do
    "$twinbox" $command --json >/dev/full 2>err
    equal "status of $command where standard output is full" $? 3
done
finish
