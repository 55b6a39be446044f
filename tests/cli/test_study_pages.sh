#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Points, verdicts and cells link into a live page of their scene, with what they were measured with.
. "$(dirname "$0")/checks.sh"
export PYTHONPATH=$sources/tests/cli:$sources/tests/browser PYTHONDONTWRITEBYTECODE=1

chart="--quick --methods engine:k=10,interior,pair-net:net=off,playback"
run 0 chart "$scenes/single.yaml" "$scenes/stack.yaml" -o charted $chart --launches 3
says "links to live pages -> charted/chart.html"
run 0 stability --scenes "$scenes" -o maps --study speed_thickness --study bomb_speed_thick --methods engine,momentum,playback
says "links to live pages -> maps/stability.html"
if ! ls charted/live-*.html >/dev/null 2>&1; then
    "$twinbox" page --live "$scenes/single.yaml" -o live.html 2>err && fail "no live page"
    ! grep -q "<a " charted/chart.html maps/stability.html || fail "links without pages"
    finish
fi
/usr/bin/python3 - "$twinbox" "$scenes" <<'PYTHON' || fail "the links"
import csv, os, subprocess, sys, pages

# The launch of a point is the one that is worst alone.
chart = list(csv.DictReader(open("charted/chart.csv")))
links = pages.Links("charted/chart.html")
points = [row for row in chart if row["protocol"] == "closed" and row["phase"] in ("impact", "after") and row["error_worst"]]
linked = [row for row in points if row["method"] != "playback"]
assert len(links.targets) == len(linked) < len(points), (links.targets, len(linked))
for row, target in zip(linked, links.targets, strict=True):
    page, link = pages.parts(target)
    assert page == f"live-{row['scene']}.html" and os.path.exists(f"charted/{page}"), page
    own, beside = link["methods"].split(";")
    assert own == row["method"] + (":" if row["setting"] else "") + row["setting"], own
    assert beside == ("engine" if row["method"] == "interior" else "interior"), beside
    if row["phase"] == "impact":
        with open("one.csv", "w") as file:
            file.write(f"x\n{link['set'].removeprefix('bomb_x=')}\n")
        subprocess.run([sys.argv[1], "chart", f"{sys.argv[2]}/{row['scene']}.yaml", "-o", "one", "--quick", "--methods", own,
                        "--launches", "one.csv"], check=True, stdout=subprocess.DEVNULL)
        alone = [one for one in csv.DictReader(open("one/chart.csv")) if one["protocol"] == "closed" and one["phase"] == "impact"]
        assert alone[0]["error_mean"] == row["error_worst"], (row, target)

# A cell has its values, a border the first that fails.
links = pages.Links("maps/stability.html")
cells = [row for row in csv.DictReader(open("maps/maps.csv")) if row["method"] != "playback" and row["verdict"] != "not applicable"]
borders = [row for row in csv.DictReader(open("maps/stability.csv")) if row["method"] != "playback" and row["holds_at"]]
wanted = {("live-bomb_speed.html", f"speed={row['fails_at'] or row['holds_at']},thickness=1", row["method"]) for row in borders}
wanted |= {("live-bomb_speed.html", f"speed={row['x']},thickness={row['y']}", row["method"]) for row in cells}
found = {(page, link["set"], link["methods"].split(";")[0]) for page, link in map(pages.parts, links.targets)}
assert found == wanted and len(links.targets) == len(cells) + len(borders), (found ^ wanted, len(links.targets))
assert os.path.exists("maps/live-bomb_speed.html")
row = next(row for row in borders if row["fails_at"])
run = subprocess.run([sys.argv[1], "simulate", f"{sys.argv[2]}/stability/bomb_speed.yaml", "-m", row["method"], "--set",
                      f"speed={row['fails_at']}", "--set", "thickness=1"], check=True, stdout=subprocess.PIPE, text=True)
assert f"verdict: {row['verdict']} at" in run.stdout, (row, run.stdout)
PYTHON
checks=$((checks + 1))
finish
