#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The report of a comparison links to a page that plays both runs, where they differ.
. "$(dirname "$0")/checks.sh"
export PYTHONPATH=$sources/tests/cli:$sources/tests/browser PYTHONDONTWRITEBYTECODE=1

run 0 simulate "$scenes/stack.yaml" --frames 80 -o one.npz
run 0 simulate "$scenes/stack.yaml" --frames 80 --no-warm-starting -o other.npz
run 0 render one.npz -o expected --frames 70:71 --size 320x180
run 0 render other.npz -o actual --frames 70:71 --size 320x180
cp one.npz expected/same.npz
cp one.npz actual/same.npz
run 1 compare expected actual --report report
says "report -> report/report.html"
equal "pages" "$(ls report | grep '^run-')" run-stack-engine.html
cat >check.py <<'PYTHON'
import json, re, sys, html, pages
folder = sys.argv[1]
text = open(f"{folder}/report.html").read()
links = [html.unescape(link) for link in re.findall(r'<a href="(run-[^"]*)"', text)]
# At the top of the page, that of the run that differs first; then all in their table.
assert links[0] in links[1:], links
links = links[1:]
runs = {run["name"]: run for run in json.load(open(f"{folder}/results.json"))["trajectories"]}
PYTHON
cat check.py - >first.py <<'PYTHON'
frame, body = map(int, re.search(r"from frame (\d+), body (\d+):", runs["stack-engine.npz"]["words"]).groups())
path, time, at = pages.moment(*links)
page = pages.check_shown(folder, *links)
assert at == body and round(time / page["dt"]) == frame > 0, (links, frame, body)
assert page["runs"][1]["differs"] == {"frame": frame, "body": body}, page["runs"][1]["differs"]
assert [run["name"] for run in page["runs"]] == ["expected", "actual"], page["runs"]
assert f">play both runs from frame {frame}, body {body}</a>" in text
PYTHON
/usr/bin/python3 first.py report || fail "the link of a run"
checks=$((checks + 1))

# The report is still one that can be approved.
run 0 approve report
run 0 compare expected actual --report report
equal "links of equal runs" "$(grep -c '<a href="run-' report/report.html)" 0

# Runs of one name when written as file names; other worlds; another time step; runs too long for a page.
mkdir many many/expected many/actual
cp expected/frame_000070.png many/expected
cp expected/frame_000070.png many/actual
/usr/bin/python3 - <<'PYTHON' || exit 1
import numpy

one, other = (dict(numpy.load(f"{name}.npz")) for name in ("one", "other"))
def save(name, expected, actual):
    numpy.savez_compressed(f"many/expected/{name}.npz", **expected)
    numpy.savez_compressed(f"many/actual/{name}.npz", **actual)
for name in "a b", "a_b":
    save(name, one, other)
bare = {key: value for key, value in one.items() if not key.startswith(("contact_", "verdict"))}
fewer = {key: value[:, :-1] if value.ndim > 1 and len(value) == 81 else value for key, value in bare.items()}
fewer |= {key: bare[key][:-1] for key in ("size", "fixed", "mass")} | {"bomb": numpy.int32(-1)}
save("fewer", bare, fewer)
save("slower", bare, bare | {"dt": numpy.float32(0.01)})
long = {key: numpy.repeat(value, 300, 0) if len(value.shape) > 1 and len(value) == 81 else value for key, value in bare.items()}
long["position"][:, 1:] += numpy.random.default_rng(1).normal(0, 0.01, long["position"][:, 1:].shape).astype("f4")
moved = long | {"position": long["position"].copy()}
moved["position"][20000:, 4, 0] += 1
save("long", long, moved)
PYTHON
run 1 compare many/expected many/actual --report many/report
equal "pages" "$(cd many/report && echo run-*)" "run-a_b-2.html run-a_b.html run-fewer.html run-long.html"
cat check.py - >many.py <<'PYTHON'
assert [pages.moment(link)[0] for link in links] == ["run-a_b.html", "run-a_b-2.html", "run-fewer.html", "run-long.html"], links
shown = {pages.moment(link)[0]: pages.check_shown(folder, link) for link in links}
assert not shown["run-fewer.html"]["runs"][1]["compared"]
page = shown["run-long.html"]
assert page["total"] == 24300 > page["frames"] and page["every"] == 1, (page["total"], page["frames"])
assert round(pages.moment(links[3])[1] / page["dt"]) == 20000
assert page["runs"][1]["differs"]["frame"] + page["first"] == 20000
PYTHON
/usr/bin/python3 many.py many/report || fail "pages of many runs"
checks=$((checks + 1))

# Beyond the report's size they are left out. A text in a name is no markup.
cp many/expected/long.npz 'many/expected/zz<b>&.npz'
cp many/actual/long.npz 'many/actual/zz<b>&.npz'
run 1 compare many/expected many/actual --report small --report-size 1
equal "pages that fit" "$(cd small && echo run-*)" "run-a_b-2.html run-a_b.html run-fewer.html run-long.html"
grep -q "Without a page, as these exceed the report's size limit: 1\." small/report.html || fail "a page is left out silently"
run 1 compare many/expected many/actual --report large
[ -e large/run-zz_b__.html ] || fail "no page: $(ls large)"
grep -q 'zz<b>' large/report.html && fail "a name is markup"

# A page that cannot be written ends the report, which is then not complete.
mkdir -p taken/run-long.html
run 3 compare many/expected many/actual --report taken
complains "taken/run-long.html"
[ ! -e taken/results.json ] || fail "a report without its pages has results"
finish
