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
# Reads the object, strictly, and what the text says: result, text. `states` checks that the text has a piece.
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


def states(piece):
    assert piece in text, f"{piece!r} is not in the text"
PYTHON

# check FORMAT: with statements from standard input.
check() {
    checks=$((checks + 1))
    { cat check.py && cat; } >program.py
    /usr/bin/python3 program.py "$1" 2>trace || fail "$1: $(tail -3 trace)"
}

both 0 methods
check "twinbox methods 1" <<'PYTHON'
names = [method["name"] for method in result["methods"]]
assert names == [line.split()[0] for line in text.splitlines() if not line.startswith(" ")]
for method in result["methods"]:
    states(method["summary"])
    for setting in method["settings"]:
        states(f"    {setting['key']}: {setting['summary']}\n")
known = {method["name"]: method for method in result["methods"]}
assert known["pair-net"]["needs_network"] and not known["engine"]["needs_network"]
assert known["engine"]["contact_solver"] and not known["playback"]["contact_solver"]
assert known["scene-net"]["without_learned_part"] == "scene-net:net=off"
PYTHON

"$twinbox" solve "$scenes/stack.yaml" --frame 41 -o impact.npz >/dev/null
both 0 solve impact.npz -m engine -m momentum:k=20 -m reference
check "twinbox solve 1" <<'PYTHON'
assert len(result["methods"]) == 3
states("%s, step %d: %d bodies, %d contacts; reference: residual %.2g m/s after %d factorizations\n" % (
    result["scene"], result["step"], result["bodies"], result["contacts"],
    result["reference"]["residual"], result["reference"]["factorizations"]))
for row in result["methods"]:
    keys = ("method", "error", "right", "counted", "residual", "signorini", "cone", "dissipation", "penetration", "energy")
    states("%-40s %12.4g %7d/%-4d %12.4g %12.4g %10.4g %14.4g %14.4g %10.4g\n" % tuple(row[key] for key in keys))
PYTHON

"$twinbox" simulate "$scenes/stack.yaml" -o engine.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" --method momentum -o momentum.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" --bomb-frame 299 -o late.npz >/dev/null
"$twinbox" simulate "$scenes/stack.yaml" --frames 5 --method momentum -o short.npz >/dev/null
both 0 compare engine.npz engine.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["passed"] is True and result["first"] is None and result["largest"] is None
states("equal: %d frames of %d bodies" % (result["frames"], result["expected"]["bodies"]))
assert result["cause"] == "none"
assert all(result[key] is None for key in ("first", "beyond", "contacts", "beyond_contacts", "growth", "shifted", "words"))
PYTHON
"$twinbox" simulate "$scenes/stack.yaml" --frames 5 -o begin.npz >/dev/null
both 1 compare engine.npz begin.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["words"] == "frames: 301 and 6" and result["frames"] == 6 and result["first"] is None
PYTHON
"$twinbox" simulate "$scenes/single.yaml" --frames 5 -o single.npz >/dev/null
both 1 compare engine.npz single.npz
check "twinbox compare runs 1" <<'PYTHON'
states(result["words"] + "\n")
assert result["passed"] is False and result["first"] is None and result["cause"] is None and result["frames"] == 0
PYTHON

both 1 compare engine.npz momentum.npz --scene "$scenes/stack.yaml" --tolerance 0.01
check "twinbox compare runs 1" <<'PYTHON'
def state(where):
    return "frame %d, body %d%s: %.3g m apart, %.3g rad, %.3g m/s, %.3g rad/s" % (
        where["frame"], where["body"], " (the bomb)" if where["bomb"] else "",
        where["distance"], where["angle"], where["speed"], where["spin"])


def growth(of):
    return "from %.2g m in frame %d to %.2g m in frame %d, then above 0.1 m\n  %.3g / s, doubles every %.3g frames; " \
           "scatter: a factor of %.2g\n" % (of["from"], of["first"], of["to"], of["last"], of["rate"],
                                            of["doubling_frames"], of["scatter_factor"])


def contact(of):
    return "bodies %d and %d, feature %08x, at (%.4g, %.4g) m: different impulses\n  normal %.9g and %.9g N s, tangent " \
           "%.9g and %.9g N s\n" % (of["a"], of["b"], of["feature"], *of["point"], *of["normal_impulse"], *of["tangent_impulse"])


for i, run in enumerate((result["expected"], result["actual"])):
    states(f"run {i + 1}: {run['scene']} by {run['method']}, {run['frames']} frames of {run['bodies']} bodies ({run['path']})")
states("first difference: " + state(result["first"]))
states("centres more than 0.01 m apart: " + state(result["beyond"]))
states("cause: the " + result["cause"])
states("largest distance: frame %d, body %d: %.3g m apart\n" % tuple(result["largest"].values()))
states("mean squared difference of positions: %.3g m^2\n" % result["rollout_mse"])
states(contact(result["contacts"]["contact"]))
assert result["beyond_contacts"]["step"] == result["beyond"]["frame"] > result["contacts"]["step"]
if result["beyond_contacts"]["contact"]["only_in_run"] is None:
    states(contact(result["beyond_contacts"]["contact"]))
states("growth of the largest distance: " + growth(result["growth"]))
shifted = result["shifted"]
states("shifted run (body %d shifted by %.2g m, the same frames): " % (shifted["body"], shifted["shift"]) + growth(shifted["growth"]))
assert shifted["verdict"] == "chaos" and shifted["rerun_differs"] is None
states("verdict: chaos")
assert result["passed"] is False and result["words"] is None and abs(result["tolerance"] - 0.01) < 1e-9 and result["frames"] == 301
PYTHON
# Two frames are too few for a rate, which is then NaN.
both 1 compare engine.npz short.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["growth"]["rate"] is None and result["growth"]["doubling_frames"] is None
assert result["actual"]["frames"] == 6 and result["first"]["frame"] == 4
assert result["growth"]["count"] == 2 and result["shifted"] is None
states("too few frames for a rate: 2 of")
PYTHON
both 1 compare engine.npz late.npz
check "twinbox compare runs 1" <<'PYTHON'
assert result["first"]["only_in_run"] == 1 and result["first"]["bomb"] and result["cause"] == "initial state"
assert result["first"]["distance"] is None
assert result["contacts"] is None
states("(the bomb): only in run 1")
PYTHON

# A folder's name has every kind of character; what it holds is that of results.json.
folder_name='a "b" <c> \ é'
"$twinbox" render engine.npz -o "$folder_name" --frames 40:42 --size 320x180 >/dev/null
"$twinbox" render momentum.npz -o actual --frames 40:42 --size 320x180 >/dev/null
both 1 compare "$folder_name" actual --report report
check "twinbox compare 1" <<'PYTHON'
assert result == json.load(open("report/results.json"))
assert result["expected"] == 'a "b" <c> \\ é' and result["passed"] is False
counts = result["counts"]
states(f"{counts['different']} of {counts['frames']} frames differ")
states("verdict: " + result["verdict"])
for cause in result["causes"]:
    states(cause + "\n")
failed = [frame for frame in result["frames"] if frame["failed"]]
assert len(failed) == counts["different"]
states(f"first difference: {failed[0]['name']}: {failed[0]['words']}\n")
PYTHON
both 1 compare "$folder_name" actual --flip 0.001
check "twinbox compare 1" <<'PYTHON'
failed = [frame for frame in result["frames"] if frame["failed"]]
states("FLIP: mean %.3g, 99th percentile %.3g\n" % (failed[0]["flip"], failed[0]["flip_p99"]))
assert result["tolerance"] == "mean FLIP of at most 0.001", result["tolerance"]
PYTHON
both 0 compare actual actual
check "twinbox compare 1" <<'PYTHON'
assert result["passed"] is True and result["counts"]["equal"] == 3 and result["verdict"] == "equal"
assert result["frames"][0]["flip"] is None
for run in result["trajectories"]:
    assert run["words"] == "equal states", run["words"]
PYTHON

both 0 simulate "$scenes/stack.yaml" -o run.npz
/usr/bin/python3 - "twinbox simulate 1" <<'PYTHON' || fail "simulate --json"
exec(open("check.py").read())
states(f"{result['scene']} by {result['method']}: {result['steps']} steps of {result['dt']:.6g} s, {result['bodies']} bodies")
states(f"state {result['state']} -> {result['output']}")
states(f"verdict: {result['verdict']['verdict']}")
assert result["steps"] == 300 and result["fallbacks"]["by_sweeps"] == 0
PYTHON
run 0 simulate "$scenes/stack.yaml" --frames 5 --json
grep -q '"output": null' out || fail "output where no run is written"

# No failure looks like a result.
run 2 simulate "$scenes/stack.yaml" --method pair-net:network=none.npz --json
equal "output after an error" "$(<out)" ""
run 2 solve impact.npz -m engine -m pair-net --json
equal "output after an error" "$(<out)" ""
complains "network"
run 2 compare engine.npz none.npz --json
equal "output after an error" "$(<out)" ""
run 2 compare actual none --json
equal "output after an error" "$(<out)" ""
run 2 compare actual actual --json --watch
complains "--json: error: cannot be combined with --watch"
run 2 compare actual actual --json --annotations github
complains "--json: error: cannot be combined with --annotations"
for command in "methods" "solve impact.npz -m engine" "compare engine.npz engine.npz"; do
    "$twinbox" $command --json >/dev/full 2>err
    equal "status of $command where standard output is full" $? 3
done
finish
