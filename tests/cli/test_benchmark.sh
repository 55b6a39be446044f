#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The benchmark: it is made, its references score as they should, and a fault that is planted in an entry is found.
. "$(dirname "$0")/checks.sh"
export TWINBOX=$twinbox PYTHONDONTWRITEBYTECODE=1
make=$sources/scenes/benchmark/make score=$sources/scenes/benchmark/score

"$make" bench >made || fail "make: $(tail -1 made)"
equal "cases" "$(tail -n +2 bench/cases.csv | wc -l)" 37
# A reference with steps that did not converge is no yardstick.
printf '#!/bin/sh\n"%s" "$@" | sed "s/.not_converged.: 0/\\"not_converged\\": 3/"\n' "$twinbox" >unconverged
chmod +x unconverged
TWINBOX=$PWD/unconverged "$make" none 2>refused && fail "a benchmark of unconverged references"
grep -q "stack-1: 3 steps of the reference did not converge" refused || fail "make: $(cat refused)"
equal "files whose sums differ" "$(cd bench && sha256sum -c SHA256SUMS 2>/dev/null | grep -vc OK)" 0
/usr/bin/python3 - <<'PYTHON' || fail "cases.csv"
import csv
for row in csv.DictReader(open("bench/cases.csv")):
    if row["kind"] == "struck":
        assert 0 < int(row["touch"]) < int(row["chaos"]) <= int(row["steps"]) + 1, row
        assert float(row["residual"]) < 1e-9, row
PYTHON

# An entry of three cases: the reference's own run as it is stored, the engine's as CSV, a stack at rest, and impulses.
mkdir entry
cp bench/references/stack-2.npz entry
# enter CASE METHOD
enter() {
    local row
    IFS=, read -ra row <<<"$(grep "^$1," bench/cases.csv)"
    run 0 simulate "$sources/${row[2]}" --set "${row[3]}" --method "$2" -o run.npz
    run 0 export run.npz -o "entry/$1.csv"
}
enter gate-1 engine
enter stack_10 interior
printf 'contact,normal,tangent\n' >entry/towers-1.impulses.csv
/usr/bin/python3 - <<'PYTHON' || fail "the impulses of the reference's step"
import csv
import numpy
touch = {row["case"]: int(row["touch"]) for row in csv.DictReader(open("bench/cases.csv")) if row["touch"]}
run = numpy.load("bench/references/stack-2.npz")
first, end = run["contact_start"][touch["stack-2"]:touch["stack-2"] + 2]
with open("entry/stack-2.impulses.csv", "w") as file:
    file.write("contact,normal,tangent\n")
    file.writelines(f"{i},{n:.9g},{t:.9g}\n" for i, (n, t) in enumerate(run["contact_impulse"][first:end]))
PYTHON
# The HDF5 of the step, where h5py can write it: M v = f + H r gives the reference's velocities after the step.
/usr/bin/python3 - <<'PYTHON' || fail "HDF5"
import csv
import numpy
try:
    import h5py
except ImportError:
    raise SystemExit
touch = next(int(row["touch"]) for row in csv.DictReader(open("bench/cases.csv")) if row["case"] == "stack-2")
run = numpy.load("bench/references/stack-2.npz")
first, end = run["contact_start"][touch:touch + 2]
with h5py.File("bench/problems/stack-2.hdf5") as file:
    group = file["fclib_global"]
    mass, force = group["M/x"][()], group["vectors/f"][()]
    jacobian = numpy.zeros((group["H/m"][0], group["H/n"][0]))
    jacobian[group["H/i"][()], group["H/p"][()]] += group["H/x"][()]
velocity = ((force + jacobian @ run["contact_impulse"][first:end].ravel()) / mass).reshape(-1, 3)
found = numpy.column_stack((run["velocity"][touch], run["angular_velocity"][touch]))[1:]
assert numpy.abs(velocity - found).max() < 1e-3, numpy.abs(velocity - found).max()
PYTHON
"$score" bench entry --cases cases.csv >table 2>progress || fail "score: $(tail -1 progress)"
/usr/bin/python3 - <<'PYTHON' || fail "scores of an entry: $(cat table cases.csv)"
import csv
import re
rows = {row["case"]: row for row in csv.DictReader(open("cases.csv"))}
assert len(rows) == 37
stack, gate, rest, towers = (rows[name] for name in ("stack-2", "gate-1", "stack_10", "towers-1"))
assert float(stack["impact"]) == 0 and float(stack["step"]) < 1e-5 and float(stack["residual"]) < 1e-5, stack
assert float(stack["follows"]) > 4, stack
# The reference's impulses keep all laws; without any, nothing pushes, and no energy is lost.
assert max(abs(float(stack[law])) for law in ("signorini", "cone", "dissipation", "penetration", "energy")) < 1e-3, stack
assert towers["signorini"] == towers["dissipation"] == towers["cone"] == "", towers
assert float(towers["energy"]) > 1 and float(towers["penetration"]) > 0, towers
assert 0.01 < float(gate["impact"]) < 10 and float(gate["follows"]) < 0.5, gate
assert rest["verdict"] == "settles" and rest["holds"] == "True" and float(rest["drift"]) < 1e-3, rest
assert float(towers["step"]) > 1 and towers["impact"] == "", towers
assert rows["wall-1"]["impact"] == rows["wall-1"]["step"] == "", rows["wall-1"]
# What fell, in the words of the verdict; two struck runs and one at rest are sound.
for row in stack, gate:
    assert f"{row['verdict']}: {row['fell']} of {row['stood']} boxes fell, first at " in row["words"], row
line = re.split("  +", open("table").read().splitlines()[1])
fell, stood = (sum(int(row[key]) for row in (stack, gate)) for key in ("fell", "stood"))
assert line[9:11] == ["3 of 3", f"{fell} of {stood}"], line
line = open("table").read().splitlines()[1].split()
assert line[0] == "entry" and line[-3:] == ["3", "of", "37"] and line[-7:-4] == ["1", "of", "1"], line
PYTHON

# A planted fault: one box of the stack at rest is let into the one below, another jumps; both are seen.
/usr/bin/python3 - <<'PYTHON'
lines = open("entry/stack_10.csv").read().splitlines(True)
head = next(line for line in lines if line.startswith("frame")).strip().split(",")
frame, body, y = (head.index(name) for name in ("frame", "body", "y"))
for i, line in enumerate(lines):
    fields = line.split(",")
    if fields[0].isdigit() and fields[body] == "4" and 1000 <= int(fields[frame]) < 1090:
        fields[y] = str(float(fields[y]) - 0.2)
        lines[i] = ",".join(fields)
open("entry/stack_10.csv", "w").writelines(lines)
PYTHON
"$score" bench entry --cases faulty.csv >table 2>progress || fail "score: $(tail -1 progress)"
equal "the verdict on a planted fault" "$(sed -n 's/^entry,stack_10,.*,False,[0-9]*,10,\(sinks\|explodes\),.*,False,.*/found/p' faulty.csv)" found

# What cannot be scored.
mkdir empty
"$score" bench empty 2>err >/dev/null && fail "an empty entry is scored"
complains "empty: neither a folder with a CASE.csv, CASE.npz or CASE.impulses.csv, nor a method that runs"
mkdir wrong
cp bench/references/stack-1.npz wrong/wall-1.npz
"$score" bench wrong 2>err >/dev/null && fail "a run of another scene is scored"
complains "wall-1: 12 bodies; the scene has 47"
finish
