#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The verdict on stored runs: check, import, and limits of check.
. "$(dirname "$0")/checks.sh"

tall=$scenes/stability/stack_height.yaml
run 0 simulate "$tall" --set height=5 --frames 700 -o stands.npz --verdict stands.json
words=$(grep verdict: out)
run 0 check stands.npz --scene "$tall" --set height=5
says "$words"
says "    deepest overlap: 0.0"
says "    drift after the first 10 s: "
says "    energy gained: 0 J above what start and bomb brought"
run 0 check stands.npz --verdict holds --max-overlap 0.1 --max-drift 0.01 --max-gain 0.1
says "$words"
complains "assumed: a gravity of 10 m/s2"
run 0 check stands.npz --verdict sound
run 1 check stands.npz --max-overlap 0.001 --verdict falls
says "failed: verdict settles, not falls"
says "failed: overlap 0.0"
run 0 check stands.npz --scene "$tall" --set height=5 --json
/usr/bin/python3 - <<'PYTHON' || fail "the figures of check"
import json
made, read = json.load(open("stands.json")), json.load(open("out"))
assert read["format"] == "twinbox check run 1" and read["passed"] and read["failures"] == []
assert read["verdict"] == made, (read["verdict"], made)
PYTHON
run 1 check stands.npz --json --max-drift 0
says '"passed": false'
says '"drift '

# With a bomb, masses decide: those of the file; without them, nothing is said of energy. Of a short run nothing is said
# of drift.
run 0 simulate "$scenes/stack.yaml" --frames 100 -o struck.npz
words=$(grep verdict: out)
run 0 check struck.npz --scene "$scenes/stack.yaml"
says "$words"
run 0 check struck.npz
says "$words"
/usr/bin/python3 -c "
import numpy
run = dict(numpy.load('struck.npz'))
del run['mass']
numpy.savez('massless.npz', **run)"
run 0 check massless.npz
says "energy gained: unknown without masses"
run 0 check massless.npz --scene "$scenes/stack.yaml"
says "$words"

# An engine that keeps boxes 15 mm apart: the same run explodes without its skin, one that really explodes does with it.
/usr/bin/python3 - <<'PYTHON'
def write(name, rise, after):
    with open(name, "w") as f:
        f.write("# dt: 1/60\n# size: 0,100,20,static\n")
        for i in range(1, 11):
            f.write(f"# size: {i},1,1,dynamic\n")
        f.write("frame,body,x,y,angle\n0,0,0,-10,0\n")
        for frame in range(120):
            for i in range(1, 11):
                f.write(f"{frame},{i},0,{i - 0.5 + i * rise * min(max(frame - after, 0), 20) / 20:.6f},0\n")
write("skin.csv", 0.015, 0)
write("bursts.csv", 0.045, 30)
PYTHON
run 0 import skin.csv -o skin.npz
says "    verdict: explodes at "
run 0 import skin.csv -o skin.npz --skin 0.0075
says "    verdict: settles; "
run 0 check skin.npz --skin 0.0075 --verdict settles
run 1 check skin.npz --verdict settles
run 0 import bursts.csv -o bursts.npz --skin 0.0075
says "    verdict: explodes at "
run 1 check bursts.npz --skin 0.0075 --verdict holds
run 1 check bursts.npz --skin 0.0075 --verdict sound
run 1 check bursts.npz --skin 0.0075 --max-gain 1
says "failed: energy gained "

# What import found is in the file, and pictures say it.
/usr/bin/python3 -c 'import numpy; v = str(numpy.load("bursts.npz")["verdict"]); assert v.startswith("explodes at"), v' ||
    fail "the verdict is not in the run"

# A run that ends in NaN ends before it.
{ sed '/^60,3,/,$d' skin.csv; echo "60,3,nan,1,0"; echo "61,3,inf,-nan,0"; } >nan.csv
run 0 import nan.csv -o nan.npz
says "nan by nan: 60 frames of 11 bodies"
says "    verdict: non-finite at 1 s"
complains "assumed: the run ends before frame 60, in which body 3 is NaN or infinite"
run 0 check nan.npz --verdict non-finite
run 1 check nan.npz --verdict holds

# Bodies that come in another order than twinbox's have no verdict, but can be imported.
grep -v '^0,4,' skin.csv >late.csv
run 0 import late.csv -o late.npz
says "no verdict: "
run 2 check late.npz
complains "no verdict"

# compare and figures find contacts again where a run has none.
run 0 simulate "$scenes/stack.yaml" --frames 100 --method momentum -o sweeps.npz
run 0 simulate "$scenes/stack.yaml" --frames 100 --method momentum --no-contacts -o bare.npz
run 0 compare sweeps.npz bare.npz
says "a run has no contacts: those of both are recomputed from the poses"
run 0 simulate "$scenes/stack.yaml" --frames 100 --no-contacts --method nncg -o other.npz
run 1 compare sweeps.npz other.npz
says "cause: unknown, as a run has no impulses: the solver, its warm start or another kind of step"
says "all states of frame 2 are equal; body 1 has 2 contacts in step 3"
run 0 figure annotated bare.npz --at 0.5 -o bare.svg
says "bare.svg"
grep -q "contacts found again" bare.svg || fail "the figure does not say that contacts are found again"
grep -q "impulses are unknown" bare.svg || fail "the figure shows impulses"

# A tolerance in metres and radians, and a report.
run 0 simulate "$scenes/stack.yaml" --frames 100 --method admm -o admm.npz
run 1 compare sweeps.npz admm.npz --tolerance 100,0.001 --report report
says "centres more than 100 m or turned more than 0.001 rad apart: frame "
says "not compared: the verdict, \""
says "report -> report/report.html"
equal "files" "$(ls report | tr '\n' ' ')" "junit.xml report.html results.json run.html "
/usr/bin/python3 - <<'PYTHON' || fail "the files of a report"
import json, re, numpy, xml.etree.ElementTree as tree
suite = tree.parse("report/junit.xml").getroot()
assert suite.get("tests") == "1" and suite.get("failures") == "1"
case, failure = suite[0], suite[0][0]
assert (case.get("classname"), case.get("name"), case.get("file")) == ("trajectories", "admm.npz", "sweeps.npz")
assert float(case.get("time")) > 0 and "cause of the first difference: solver" in failure.get("message")
assert failure.text == "expected: sweeps.npz\nactual: admm.npz\n"
assert "\ncause: the solver\n" in suite.find("system-out").text
results = json.load(open("report/results.json"))
assert not results["passed"] and results["tolerance_angle"] == 0.001 and results["frames_equal"] == 3
assert [other["what"] for other in results["not_compared"]] == ["verdict"]
one, other = numpy.load("sweeps.npz"), numpy.load("admm.npz")
same = numpy.all([numpy.all((one[key] == other[key]) | numpy.isnan(one[key]), axis=tuple(range(1, one[key].ndim)))
                  for key in ("position", "angle", "velocity", "angular_velocity")], axis=0)
near = numpy.all(~(abs(one["angle"] - other["angle"]) > 0.001), axis=1) # and all are within 100 m
assert (results["frames_equal"], results["frames_within"]) == (sum(same), sum(near & ~same)) and sum(near & ~same) > 0
link = re.search(r"run\.html#t=([\d.]+)&amp;body=(\d+)", open("report/report.html").read())
beyond = results["beyond"]
assert beyond["frame"] > results["first"]["frame"]
assert abs(float(link[1]) * 60 - beyond["frame"]) < 0.1 and int(link[2]) == beyond["body"], (link[0], beyond)
PYTHON
run 0 compare sweeps.npz admm.npz --tolerance 100,100 --report passed
says "equal within the tolerance of 100 m and 100 rad: 101 frames of 12 bodies; 3 of them in every bit"
grep -q 'failures="0"' passed/junit.xml || fail "a comparison within tolerance fails in JUnit"
finish
