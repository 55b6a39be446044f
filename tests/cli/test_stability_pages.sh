#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# stability --pages: cells at a border link to what happened there.
. "$(dirname "$0")/checks.sh"
export PYTHONPATH=$sources/tests/cli PYTHONDONTWRITEBYTECODE=1

methods=engine,momentum,pair-net
maps="--study speed_thickness --study slope_friction --study friction_ramp --study bomb_speed_thick"
run 0 stability --scenes "$scenes" -o maps --pages $maps --methods $methods
says " MB together -> maps/pages; links to them -> maps/stability.html"
/usr/bin/python3 - <<'PYTHON' || fail "stability.html"
import collections, csv, os, pages
HOLDS = {"settles", "moves", "creeps"}
cells = collections.defaultdict(dict)
for row in csv.DictReader(open("maps/maps.csv")):
    cells[row["map"], row["method"], row["setting"]][float(row["x"]), float(row["y"])] = row
listed = list(csv.DictReader(open("maps/map_pages.csv")))
links = pages.Links("maps/stability.html")
assert links.targets and set(links.targets) == {row["page"] for row in listed}
assert {pages.moment(row["page"])[0] for row in listed} == {f"pages/{name}" for name in os.listdir("maps/pages")}
chosen = collections.Counter()
for row in listed:
    name = row["map"], row["method"], row["setting"]
    if name[0] in ("friction_ramp", "bomb_speed_thick"):
        continue
    grid, at = cells[name], (float(row["x"]), float(row["y"]))
    cell = grid[at]
    chosen[name] += 1
    assert cell["verdict"] not in HOLDS, row
    assert (row["frame"], row["body"]) == (cell["frame"], cell["body"] or "-1"), (row, cell)
    xs, ys = (sorted({place[i] for place in grid}) for i in (0, 1))
    i, j = xs.index(at[0]), ys.index(at[1])
    beside = [grid[xs[a], ys[b]]["verdict"] for a, b in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1))
              if 0 <= a < len(xs) and 0 <= b < len(ys)]
    assert HOLDS & set(beside) or not HOLDS & {other["verdict"] for other in grid.values()}, (row, beside)
    page = pages.check_shown("maps", row["page"])
    path, time, body = pages.moment(row["page"])
    own = page["runs"][-1]
    assert own["method"] == row["method"] and own["verdict"]["text"].startswith(cell["verdict"] + " at "), own["verdict"]
    assert page["first"] + own["verdict"]["frame"] * page["every"] == round(time / page["dt"]), (page["first"], own["verdict"])
    assert str(own["verdict"]["body"]) == row["body"]
    assert page["frames"] <= 9 / page["dt"] + 2, page["frames"]
    assert row["page"].endswith("&run=1") == (len(page["runs"]) == 2), row["page"]
    assert links.names[row["page"]].startswith(cell["verdict"] + " at ")
    # Beside the first method that holds there, if one does.
    holder = next((other[1] for other in cells if other[0] == name[0] and at in cells[other]
                   and cells[other][at]["verdict"] in HOLDS), None)
    assert [run["method"] for run in page["runs"]] == ([holder] if holder else []) + [row["method"]], (row, holder)
for name, grid in cells.items():
    failing = sum(cell["verdict"] not in HOLDS | {"not applicable"} for cell in grid.values())
    assert (chosen[name] > 0) == (failing > 0) and chosen[name] <= 8, (name, chosen[name], failing)
assert max(chosen.values()) == 8, chosen
# Borders: where each fails, beside the first method that holds there.
borders = list(csv.DictReader(open("maps/stability.csv")))
for row in borders:
    page = [p for p in listed if (p["map"], p["method"], p["setting"]) == (row["study"], row["method"], row["setting"])
            and p["x"] == row["fails_at"]]
    assert len(page) == (row["fails_at"] != ""), (row, page)
    if not page:
        continue
    assert page[0]["y"] == ("1" if row["study"] == "bomb_speed_thick" else ""), page
    shown = pages.check_shown("maps", page[0]["page"])
    own = shown["runs"][-1]
    assert own["method"] == row["method"] and own["verdict"]["text"].startswith(row["verdict"] + " at "), (row, own)
    holder = next((b["method"] for b in borders if b["study"] == row["study"] and b["holds_at"]
                   and float(b["holds_at"]) >= float(row["fails_at"])), None)
    assert [run["method"] for run in shown["runs"]] == ([holder] if holder else []) + [row["method"]], (row, holder)
html = open("maps/stability.html").read()
assert "Box on a slope" in html and html.count("<dd>") == len(borders), html.count("<dd>")
names = {row["method"] for row in borders}
assert all(html.count(f"<dt>{name}</dt>") == len({row["study"] for row in borders if row["method"] == name}) for name in names), names
PYTHON
checks=$((checks + 1))

! brief || finish

# A scene of one's own, whose steps are thinned to 60 a second.
run 0 stability "$scenes/stability/time_step.yaml" --vary height=2:40 --vary rate=30:240 --quick --methods engine \
    -o own --pages
/usr/bin/python3 - <<'PYTHON' || fail "pages of an own scene"
import csv, pages
listed = list(csv.DictReader(open("own/map_pages.csv")))
assert listed
for row in listed:
    page = pages.check_shown("own", row["page"])
    assert 29 < 1 / page["dt"] < 120, page["dt"]
assert any(float(row["y"] or 0) > 100 or float(row["x"]) > 100 for row in listed), listed
PYTHON
checks=$((checks + 1))

# However many methods there are, none is beyond the window.
many=$(printf 'engine:k=%d,' {1..13})
run 0 stability --scenes "$scenes" -o many --pages --study friction_ramp --methods "${many%,}"
equal "methods" "$(grep -o '<dt>engine:k=[0-9]*</dt>' many/stability.html | wc -l)" 13
if command -v chromium >/dev/null; then
    PYTHONPATH=$sources/tests/browser /usr/bin/python3 - <<'PYTHON' || fail "methods are beyond the window"
from chromium import Chromium

with Chromium() as browser:
    for width in 1440, 390:
        beyond = browser.open("many/stability.html", width=width).beyond()
        assert not beyond, (width, beyond)
PYTHON
else
    echo "skipped: the window of stability.html; tests/setup --all installs chromium"
fi

run 0 stability --scenes "$scenes" --quick --study speed_thickness --methods engine -o plain
[ -e plain/stability.html ] && fail "pages that nobody asked for"
finish
