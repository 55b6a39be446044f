#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Speed against accuracy: the numbers of a quick chart except times.
. "$(dirname "$0")/checks.sh"

without_times() { "$sources/golden/without_times" "$1"; }

run 0 chart "$scenes/single.yaml" "$scenes/stack.yaml" -o quick --quick
says "stack: "
equal "left out of single" "$(grep -A1 '^single: ' out | tail -n 1)" "    left out, as no network is named for them: scene-net"
equal "left out of stack" "$(grep -A1 '^stack: ' out | tail -n 1)" "    left out, as no network is named for them: scene-net"
says "not scored, as the reference does not converge: 0 of 55 frozen steps"
for file in chart-single.png chart-stack.png chart-stack.svg chart-stack.pdf; do
    [ -s "quick/$file" ] || fail "no $file"
done
equal "files" "$(ls quick | grep -vc ^live-)" 16
says "error at equal time -> quick/equal_time.csv, equal_time_methods.csv, equal_time.png, .svg, .pdf, .txt"
without_times quick/chart.csv >figures.csv
diff "$sources/golden/chart_quick.csv" figures.csv >difference || fail "other numbers: $(head -5 difference)"
/usr/bin/python3 - <<'PYTHON' || fail "times are not in order"
import csv
for row in csv.DictReader(open("quick/chart.csv")):
    # A phase that a method's run never came to has neither.
    assert (row["us_solver"] == "") == (row["error_mean"] == "") == (row["cpu"] == ""), row
    if row["us_solver"]:
        assert float(row["us_step"]) > 0, row
PYTHON

/usr/bin/python3 - <<'PYTHON' || fail "equal_time.csv is not of this chart"
import csv
roles = {"reference", "playback"}
chart = [row for row in csv.DictReader(open("quick/chart.csv"))
         if row["protocol"] == "closed" and row["phase"] != "rest" and row["us_solver"] and row["method"] not in roles]
table = list(csv.DictReader(open("quick/equal_time.csv")))
assert len(table) == 3 * len(chart) > 100, (len(table), len(chart))
for i, row in enumerate(table):
    of = chart[i // 3]
    for key in ("scene", "method", "setting", "phase", "launches", "us_solver"):
        assert row[key] == of[key], (row, of)
    assert row["statistic"] == ("mean", "median", "p95")[i % 3], row
    assert row["error"] == of["error_" + row["statistic"]], (row, of)
    assert (row["rival"] == "") == (row["reach"] == "before") == (row["rival_error"] == ""), row
    assert row["rival"].split(":")[0] != row["method"], row
    if row["ratio"]:
        error, rival = float(row["error"]), float(row["rival_error"])
        assert abs(float(row["ratio"]) / (max(error, 1e-9) / rival) - 1) < 1e-4, row
        below = {(0, 0): "none", (1, 0): "method", (0, 1): "rival", (1, 1): "both"}[error < 1e-4, rival < 1e-4]
        assert row["below"] == below, row
    assert row["method"] != "momentum" or row["setting"] != "k=20" or row["time_momentum_20"] == "1", row
methods = list(csv.DictReader(open("quick/equal_time_methods.csv")))
assert {row["method"].split(":")[0] for row in methods} == {row["method"] for row in chart}, methods
PYTHON

# The charts of a finished table, in another folder.
run 0 chart quick/chart.csv -o again
for file in quick/*.png quick/*.svg quick/equal_time*.csv; do
    checks=$((checks + 1))
    cmp -s "$file" "again/$(basename "$file")" || fail "$file is drawn differently from its table"
done

run 0 chart quick/chart.csv -o frozen --frozen
for scene in single stack; do
    grep -q "on the engine's steps" frozen/chart-$scene.svg || fail "$scene: errors in closed loop"
done

! brief || finish

# A box in a V that its friction holds apart from: steps of the converged runs without a solution are counted.
sed 's/x: {from: 20, to: 40, value: 20}, y: 0.5/x: {from: -3, to: 3, value: 0}, y: 8/; s/frames: 60/frames: 120/' \
    "$sources/tests/methods/scenes/wedge_launches.yaml" >wedge.yaml
run 0 chart wedge.yaml -o wedge --quick --methods engine
grep -Eq "^    not scored, as the reference does not converge: [1-9][0-9]* of [0-9]+ frozen steps, [1-9]" out ||
    fail "unconverged steps of a chart: $(cat out)"
grep -Eq "^    energy and drift are compared before the converged runs' steps that did not converge: [1-9]" out ||
    fail "unconverged steps of the converged runs: $(cat out)"
few=engine:k=10,momentum:k=20,pair-net,scene-net
run 0 chart "$scenes/pyramid_settled.yaml" -o pyramid --quick --methods $few
without_times pyramid/chart.csv | diff "$sources/golden/chart_pyramid.csv" - >difference ||
    fail "other numbers of the pyramid: $(head -5 difference)"

# A slide is drawn of an earlier chart.
run 0 chart quick/chart.csv -o slide --size slide --words --highlight nncg

# Own launches.
printf 'x,spin\n1.02,5\n-2.02,-5\n0.3,0\n' >launches.csv
run 0 chart "$scenes/single.yaml" -o own --quick --methods engine:k=10,reference --launches launches.csv
says "single: 2 methods and settings, 3 launches -> own/chart-single.png"
equal "left out of a list" "$(grep -c 'left out' out)" 0
equal "rows" "$(wc -l <own/chart.csv)" 13

# The worst launch is the one that is worst on its own; frozen steps are no launch's.
for number in 2 3 4; do
    sed -n "1p;${number}p" launches.csv >one.csv
    run 0 chart "$scenes/single.yaml" -o "own$number" --quick --methods engine:k=10,reference --launches one.csv
done
/usr/bin/python3 - <<'PYTHON' || fail "another launch is the worst"
import csv
together, *alone = (list(csv.DictReader(open(f"{name}/chart.csv"))) for name in ("own", "own2", "own3", "own4"))
worst = set()
for row, *single in zip(together, *alone, strict=True):
    if row["protocol"] == "frozen":
        assert row["error_worst"] == "" != row["error_mean"], row
        continue
    errors = [one["error_mean"] for one in single]
    assert [one["error_worst"] for one in single] == errors, single
    assert row["error_worst"] == max(errors, key=float), (row, errors)
    worst.add(errors.index(row["error_worst"]))
# Neither the first nor the last, so that neither could pass for it.
assert 1 in worst, worst
PYTHON
checks=$((checks + 1))

# Launches by number are the family's; a sweep and a table of the same places give the same numbers.
few="--quick --methods engine:k=10"
run 0 chart "$scenes/single.yaml" -o five $few
run 0 chart "$scenes/single.yaml" -o counted $few --launches 5
cmp -s <(without_times five/chart.csv) <(without_times counted/chart.csv) || fail "5 launches are not the quick chart's"
run 0 chart "$scenes/single.yaml" -o swept $few --bomb-x=-2:2:2
says "single: 1 method and settings, 3 launches"
printf 'x\n-2\n0\n2\n' >places.csv
run 0 chart "$scenes/single.yaml" -o listed $few --launches places.csv
cmp -s <(without_times swept/chart.csv) <(without_times listed/chart.csv) || fail "a sweep and a table differ"
sed 's/x: {[^}]*}/x: 4/' "$scenes/single.yaml" | sed "s|networks/|$scenes/networks/|" >alone.yaml
# Large scenes have fewer launches, unless their number is given.
sed "s|networks/|$scenes/networks/|; s|size: \[100, 20\]|size: [2000, 20]|" "$scenes/single.yaml" |
    sed '/^bodies:/a\  - {pattern: row, count: 200, spacing: [2, 0], mass: 1, size: [1, 1], position: [50, 0.5]}' >large.yaml
run 0 chart large.yaml -o large $few
says "large: 1 method and settings, 4 launches"
run 0 chart large.yaml -o large $few --launches 5
says "large: 1 method and settings, 5 launches"
# A family of the scene alone decides.
sed 's/x: 4/x: {from: 1, to: 3}/' alone.yaml >family.yaml
run 0 chart family.yaml -o family $few --launches 2
printf 'x\n1.505\n2.505\n' >places.csv
run 0 chart alone.yaml -o alone $few --launches places.csv
cmp -s <(without_times family/chart.csv | sed s/family/alone/) <(without_times alone/chart.csv) ||
    fail "a family from 1 to 3 is not what it says"
finish
