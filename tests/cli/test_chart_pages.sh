#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# chart --pages: each point of a chart links to the launch that was worst for it.
. "$(dirname "$0")/checks.sh"
export PYTHONPATH=$sources/tests/cli PYTHONDONTWRITEBYTECODE=1

few=engine:k=10,momentum:k=20,pair-net:net=off
run 0 chart "$scenes/single.yaml" "$scenes/stack.yaml" -o charted --quick --pages --methods $few
says " MB together -> charted/pages; links to them -> charted/chart.html"
/usr/bin/python3 - <<'PYTHON' || fail "chart.html"
import csv, os, pages
chart = list(csv.DictReader(open("charted/chart.csv")))
listed = list(csv.DictReader(open("charted/chart_pages.csv")))
worst = {tuple(row[key] for key in ("scene", "method", "setting", "phase")): row["error_worst"]
         for row in chart if row["protocol"] == "closed" and row["phase"] != "rest" and row["error_worst"]}
assert {tuple(row[key] for key in ("scene", "method", "setting", "phase")): row["error_worst"] for row in listed} == worst
links = pages.Links("charted/chart.html")
assert links.pictures == ["chart-single.svg", "chart-stack.svg"], links.pictures
assert all(os.path.getsize(f"charted/{name}") > 0 for name in links.pictures)
assert set(links.targets) == {row["page"] for row in listed}, links.targets
# Each point is a link in the table, and each that is drawn one on the picture.
counts = [links.targets.count(row["page"]) for row in listed]
assert set(counts) == {1, 2}, counts
assert all(links.targets.count(row["page"]) == 2 for row in listed if (row["method"], row["setting"]) == ("engine", "k=10"))
for row in listed:
    page = pages.check_shown("charted", row["page"])
    assert [run["method"] for run in page["runs"]] == ["reference", f"{row['method']}:{row['setting']}"], page["runs"]
    path, time, body = pages.moment(row["page"])
    assert row["page"].endswith(f"&body={body}&run=1"), row["page"]
    assert str(body) == row["body"] and round(time / page["dt"]) == int(row["frame"])
    assert os.path.getsize(f"charted/{path}") == int(row["bytes"])
    # The worst step is worse than the mean of its launch.
    assert float(row["error"]) >= (1 - 1e-5) * float(row["error_worst"]), row
files = {pages.moment(row["page"])[0] for row in listed}
assert files == {f"pages/{name}" for name in os.listdir("charted/pages")}
assert len(files) < len(listed), "no two phases share a page"
PYTHON
checks=$((checks + 1))

! brief || finish

# The worst launch, and the error of its worst step, measured in another way.
printf 'x\n1.02\n-2.02\n0.3\n' >launches.csv
run 0 chart "$scenes/stack.yaml" -o own --quick --pages --methods engine:k=10 --launches launches.csv
for x in 1.02 -2.02 0.3; do
    printf 'x\n%s\n' $x >one.csv
    run 0 chart "$scenes/stack.yaml" -o "own$x" --quick --methods engine:k=10 --launches one.csv
done
IFS=, read -r x frame error body <<<"$(/usr/bin/python3 - <<'PYTHON'
import csv
row = next(row for row in csv.DictReader(open("own/chart_pages.csv")) if row["phase"] == "impact")
means = {}
for x in ("1.02", "-2.02", "0.3"):
    means[x] = next(float(row["error_mean"]) for row in csv.DictReader(open(f"own{x}/chart.csv"))
                    if row["protocol"] == "closed" and row["phase"] == "impact")
x = max(means, key=means.get)
print(x if abs(float(x) - float(row["x"])) < 1e-6 else "wrong", row["frame"], row["error"], row["body"], sep=",")
PYTHON
)"
run 0 solve "$scenes/stack.yaml" --bomb-x="$x" --frame "$frame" --run-by engine:k=10 -m engine:k=10 --json
/usr/bin/python3 - "$error" <<'PYTHON' || fail "the error of the worst step"
import json, sys
solved = json.load(open("out"))["methods"][0]["error"]
assert abs(solved / float(sys.argv[1]) - 1) < 1e-5, (solved, sys.argv)
PYTHON
checks=$((checks + 1))

# A scene's name is text.
cp "$scenes/single.yaml" "a&b'<i>#1.yaml"
sed -i "s|networks/|$scenes/networks/|" "a&b'<i>#1.yaml"
run 0 chart "a&b'<i>#1.yaml" -o named --quick --pages --methods engine:k=10 --launches 2
/usr/bin/python3 - <<'PYTHON' || fail "names in chart.html"
import os, pages
links = pages.Links("named/chart.html")
assert links.pictures == ["chart-a&b'<i>#1.svg"] and os.path.exists("named/" + links.pictures[0]), links.pictures
assert "<i>" not in open("named/chart.html").read()
for target in links.targets:
    assert pages.check_shown("named", target)["runs"][0]["scene"] == "a&b'<i>#1"
PYTHON
checks=$((checks + 1))

run 0 chart "$scenes/single.yaml" -o plain --quick --methods engine:k=10 --launches 2
[ -e plain/chart.html ] && fail "pages that nobody asked for"
finish
