#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Only what a report shows can be accepted, and only in the expected folder.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 8 --bomb-x 1 -o b.npz
run 0 render a.npz -o expected --size 80x64 --frames 0:4
run 0 render b.npz -o actual --size 80x64 --frames 1:5
rm expected/manifest.json actual/manifest.json # notes of render, not pictures
cp -r expected expected.kept

restart() {
    rm -rf expected report
    cp -r expected.kept expected
    run 1 compare expected actual --report report
}
# The sums of all files below a folder.
sums() { (cd "$1" && find . -type f -o -type l | sort | xargs cksum); }

# An expected file without an actual one may be gone, or not drawn: nothing is changed until the user tells which.
restart
before=$(sums expected)
run 2 approve report
complains "report: error: 1 expected file has no actual one: frame_000000.png; --partial keeps, --remove removes such files"
equal "nothing is written" "$(sums expected)" "$before"
run 2 approve report --partial --remove
complains "--remove: error: cannot be combined with --partial"
run 0 approve report --partial
says "5 replaced, 1 added, 0 removed, 1 kept without an actual file"
cmp -s expected/frame_000000.png expected.kept/frame_000000.png || fail "--partial did not keep frame 0"
run 1 compare expected actual
says "verdict: 1 frame missing"
mkdir some
cp actual/frame_000002.png some
restart
run 1 compare expected.kept some --report partial
run 2 approve partial
complains "4 expected files have no actual one: frame_000000.png, frame_000001.png, frame_000003.png, frame_000004.png; "
run 2 approve partial --only 'frame_00000[12].png' # a glob may also match what was not drawn
complains "1 expected file has no actual one: frame_000001.png; "
run 0 approve partial --only frame_000002.png --expected expected
says "1 replaced, 0 added, 0 removed"
equal "files after a partial run" "$(ls expected)" "$(ls expected.kept)"
grep -q "<code>--partial</code>" partial/report.html || fail "the page does not tell of --partial"

restart
run 0 approve report --remove
says "replaced expected/frame_000001.png"
says "added expected/frame_000005.png"
says "removed expected/frame_000000.png"
says "replaced expected/single-engine.npz"
says "5 replaced, 1 added, 1 removed"
run 0 compare expected actual
says "equal: 5 frames"
equal "all is as in the actual folder" "$(sums expected)" "$(sums actual)"
run 0 approve report
says "0 replaced, 0 added, 0 removed, 7 already accepted"

restart
run 0 approve report --only 'frame_00000[25]*'
says "1 replaced, 1 added, 0 removed, 5 not selected"
cmp -s expected/frame_000002.png actual/frame_000002.png || fail "frame 2 was not taken over"
cmp -s expected/frame_000003.png expected.kept/frame_000003.png || fail "frame 3 was not selected"
[ -e expected/frame_000000.png ] || fail "frame 0 was removed but not selected"

unchanged expected "--only: error: 'frames_*' matches none of the 7 files that failed" approve report --only 'frames_*'

# approve leaves frames that passed: equal ones.
restart
run 0 compare expected actual/../expected.kept --report report
before=$(sums expected)
run 0 approve report
says "0 replaced, 0 added, 0 removed"

# Single files keep their names.
cp expected/frame_000001.png old.png
cp actual/frame_000001.png new.png
run 1 compare old.png new.png --report report
run 0 approve report
says "replaced ./old.png"
cmp -s old.png new.png || fail "a single file was not taken over"

# If any file has changed since the report, nothing is written.
touched() {
    before=$(sums expected)
    run 2 approve report
    complains "$1"
    equal "nothing is written where $1" "$(sums expected)" "$before"
}
restart
cp expected/frame_000003.png expected/frame_000004.png
touched "expected/frame_000004.png: error: has changed since the report was written; compare again"
restart
cp -r actual actual.kept
cp actual/frame_000003.png actual/frame_000004.png
touched "actual/frame_000004.png: error: has changed since the report was written; compare again"
rm actual/frame_000004.png
touched "actual/frame_000004.png: error: has changed"
ln -s "$PWD/actual.kept/frame_000004.png" actual/frame_000004.png
touched "is a link"
rm -r actual
mv actual.kept actual
restart
echo >secret.png
rm expected/frame_000002.png
ln -s ../secret.png expected/frame_000002.png
touched "expected/frame_000002.png: error: must be a regular file (is a link)"
restart
echo >expected/frame_000005.png
touched "expected/frame_000005.png: error: has changed"

# Names that lead out of the folder, in an edited report.
restart
cp report/results.json good.json
for name in ../secret.png /etc/secret.png a/../../secret.png 'x\u002f..\u002fy.png'; do
    sed "s#{\"name\": \"frame_000001.png\", \"size\"#{\"name\": \"${name//\\/\\\\}\", \"size\"#g" good.json >report/results.json
    touched "report/results.json:"
    complains "error:"
done
sed 's/"xxh3": "/"xxh3": "z/' good.json >report/results.json
touched "a hash must have 16 digits"
[ "$(wc -c <secret.png)" -eq 1 ] || fail "a file outside was written"

# A report too small for its pictures shows some, and only those can be accepted.
mkdir large.a large.b
/usr/bin/python3 - <<'PYTHON'
import random, struct, zlib
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
random.seed(1)
for folder in "ab":
    for i in range(3):
        rows = b"".join(b"\0" + random.randbytes(400 * 3) for _ in range(400))
        with open(f"large.{folder}/{i}.png", "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 400, 400, 8, 2, 0, 0, 0)))
            file.write(chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PYTHON
run 1 compare large.a large.b --report report --report-size 2
[ "$(wc -c <report/report.html)" -lt 2200000 ] || fail "the report is larger than --report-size"
grep -q "The pictures of 2 frames exceed" report/report.html || fail "the page does not state which pictures it omits"
run 1 approve report
says "1 replaced, 0 added, 0 removed, 2 not shown"
run 1 compare large.a large.b --report report
run 0 approve report
says "2 replaced"
run 0 compare large.a large.b

# For machines.
restart
/usr/bin/python3 - <<'PYTHON' || fail "junit.xml or results.json is not what it should be"
import json, xml.etree.ElementTree
results = json.load(open("report/results.json"))
assert results["verdict"] == "physics changed, 1 frame missing, 1 frame extra", results["verdict"]
verdicts = [frame["verdict"] for frame in results["frames"]]
assert verdicts == ["missing"] + 4 * ["physics changed"] + ["extra"], verdicts
assert results["frames"][0]["actual"] is None and len(results["frames"][1]["actual"]["xxh3"]) == 16
assert results["frames"][1]["largest"] > 0
assert [run["name"] for run in results["trajectories"]] == ["single-engine.npz"]
suite = xml.etree.ElementTree.parse("report/junit.xml").getroot()
assert suite.get("tests") == "7" and suite.get("failures") == "7"
failures = [case.find("failure").get("type") for case in suite]
assert failures == verdicts + ["physics changed"], failures
times = [float(case.get("time")) for case in suite]
assert all(0 < time < 600 for time in times) and 0 < float(suite.get("time")) < 600, times
missing, changed, extra = suite[0], suite[1], suite[5]
assert [case.get("file") for case in (missing, changed, extra)] == [
    "expected/frame_000000.png", "expected/frame_000001.png", "actual/frame_000005.png"]
assert changed.find("failure").text.startswith(
    "expected: expected/frame_000001.png\nactual: actual/frame_000001.png\n")
assert missing.find("failure").text == "expected: expected/frame_000000.png\n"
assert changed.find("system-out").text.startswith("[[ATTACHMENT|actual/frame_000001.png]]\n")
PYTHON
cp -r report again
run 1 compare expected actual --report report
sed -i 's/ time="[0-9.]*"//' report/junit.xml again/junit.xml # the only times in a report
equal "the same comparison, the same report" "$(sums report)" "$(sums again)"
finish
