#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# twinbox compare on folders of runs: with the tolerance of two runs, in metres and radians.
. "$(dirname "$0")/checks.sh"

# A box that stands, and the same run with a pose moved by 1 mm and a later one moved by 3 mm and turned by 0.02 rad.
mkdir expected actual
run 0 simulate "$scenes/single.yaml" --frames 20 --no-bomb -o expected/same.npz
cp expected/same.npz actual
run 0 export expected/same.npz -o poses.csv
run 0 import poses.csv -o expected/box.npz
awk -F, -v OFS=, '/^[0-9]+,1,/ && $1 == 12 { $3 += 0.003; $5 += 0.02 }
                    /^[0-9]+,1,/ && $1 == 6 { $3 += 0.001 } { print }' poses.csv >moved.csv
grep -q '^frame,body,x,y,angle' poses.csv || fail "other columns: $(grep -m1 body poses.csv)"
! cmp -s poses.csv moved.csv || fail "no pose is moved"
run 0 import moved.csv -o actual/box.npz

# The printed line, the report and the exit status are one.
compare() {
    local report=agreed said=1 stored=1 junit=1
    [ "${*: -2:1}" = --report ] && report=${*: -1} || set -- "$@" --report agreed
    run "$1" compare expected actual "${@:2}"
    grep -q '^\(equal\|passed\): ' out && said=0
    grep -q '"passed": true' $report/results.json && stored=0
    grep -q 'failures="0"' $report/junit.xml && junit=0
    equal "what is printed, stored and in junit.xml: $*" $said$stored$junit $(($1 > 0))$(($1 > 0))$(($1 > 0))
}
compare 1
says "1 of 2 trajectories differs"
compare 1 --tolerance 0.0029
says "physics changed first in box.npz: beyond the tolerance from frame 12, body 1: 0.003"
compare 0 --tolerance 0.0031
says "passed: 0 frames, 2 trajectories, 1 of them not equal, but within tolerance"
# The page of both runs opens where they exceed the tolerance.
compare 1 --tolerance 0.0029 --report beyond
grep -q 'html#t=0.2&amp;body=1"' beyond/report.html || fail "the link: $(grep -o 'href="[^"]*#t=[^"]*"' beyond/report.html)"
compare 1 --report any
grep -q 'html#t=0.1&amp;body=1"' any/report.html || fail "the link: $(grep -o 'href="[^"]*#t=[^"]*"' any/report.html)"
compare 1 --tolerance 0.0031,0.019
says "beyond the tolerance from frame 12, body 1"
compare 0 --tolerance 0.0031,0.021 --report report
grep -q '"tolerance": "trajectories: at most 0.0031 m and 0.021 rad"' report/results.json || fail "no limit in the report"
grep -q '"trajectories_within_tolerance": 1, "trajectories_different": 0' report/results.json || fail "no counts"
grep -q '"name": "box.npz", "verdict": "within tolerance", "failed": false' report/results.json || fail "no verdict"
grep -q '<td class="odd">within tolerance</td>' report/report.html || fail "no verdict on the page"
# The two files alone give the same.
run 0 compare expected/box.npz actual/box.npz --tolerance 0.0031,0.021
run 1 compare expected/box.npz actual/box.npz --tolerance 0.0031,0.019

# A run that only one folder has fails, in every report; approve removes it, or adds it.
mv actual/box.npz actual/new.npz
compare 1 --tolerance 1.5 --report alone
equal "runs that one folder has" "$(cat out)" "only in expected: 1 trajectory: box.npz
only in actual: 1 trajectory: new.npz
verdict: 1 trajectory missing, 1 trajectory extra
report -> alone/report.html"
grep -q '"name": "box.npz", "verdict": "missing", "failed": true' alone/results.json || fail "no missing run"
grep -q 'tests="3" failures="2"' alone/junit.xml || fail "no failures in junit.xml"
cp -r expected before
run 2 approve alone
complains "no actual one: box.npz"
run 0 approve alone --remove
says "0 replaced, 1 added, 1 removed"
compare 0
rm -r expected
mv before expected
mv actual/new.npz actual/box.npz
echo text >expected/words.npz
compare 0 --tolerance 0.0031,0.021
says "not compared: 1 .npz file without a trajectory"
rm expected/words.npz

# A whole number is metres where there are no pictures, and channels of pixels where there are.
compare 0 --tolerance 1
run 0 render expected/same.npz -o frames --size 64x64 --frames 0
cp frames/frame_000000.png expected
cp frames/frame_000000.png actual
compare 1 --tolerance 1
says "1 of 2 trajectories differs"
compare 0 --tolerance 0.0031
says "passed: 1 frame, 2 trajectories, 1 of them not equal, but within tolerance"

# Runs of other lengths or worlds are not near.
run 0 simulate "$scenes/single.yaml" --frames 19 --no-bomb -o actual/same.npz
compare 1 --tolerance 100.5
rm expected/*.npz
compare 0 --tolerance 3

# A run that cannot be read, here one with a NaN, and one that was cut off: the others are compared, and no picture of its
# frames is called the renderer's.
/usr/bin/python3 - <<'PYTHON'
import numpy
run = dict(numpy.load("frames/single-engine.npz"))
numpy.savez("expected/nan.npz", **run)
run["position"][3, 1, 0] = numpy.nan
numpy.savez("actual/nan.npz", **run)
PYTHON
cp frames/single-engine.npz expected/cut.npz
head -c 999 expected/cut.npz >actual/cut.npz
cp frames/frame_000000.png expected/frame_000001.png
/usr/bin/python3 "$sources/tests/cli/png.py" - <<<'actual/frame_000001.png 64 64 3'
compare 2
says "verdict: pictures differ (cause unknown: no states), 2 trajectories not comparable"
cp frames/single-engine.npz expected/same.npz
cp frames/single-engine.npz actual/same.npz
compare 2 --report unread
complains "actual/cut.npz: error: "
complains "(further files that cannot be compared: 1)"
says "not comparable: actual/nan.npz: error: "
says "verdict: renderer changed, 2 trajectories not comparable"
grep -q '"name": "same.npz", "verdict": "equal", "failed": false' unread/results.json || fail "the other run"
grep -q '"trajectories_different": 0, "trajectories_not_comparable": 2' unread/results.json || fail "counts of runs"
grep -q '<failure type="not comparable" message="not comparable: actual/nan.npz' unread/junit.xml || fail "junit.xml"
rm actual/frame_000001.png expected/frame_000001.png
compare 2 --report unread
run 1 approve unread
says "0 replaced, 0 added, 0 removed, 2 not shown: report.html says why"

# A report that is not finished is none; and two comparisons cannot write one.
compare 2 --report unread
rm -r actual
run 2 compare expected actual --report unread
equal "files of a comparison that failed" "$(ls unread)" ""
cp -r expected actual
exec 9<unread
flock 9
(sleep 0.3; touch released) & # the lock ends with the last process that has it open
exec 9<&-
compare 0 --report unread
[ -e released ] || fail "a folder that is reserved was written into"
# A run whose verdict changed: what it was and what it is now, in the report and when it is approved. Traces are approved, too.
mkdir before after
run 0 simulate "$scenes/stack.yaml" --frames 60 -o before/stack.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --no-bomb -o after/stack.npz
printf 'frame,body,x,y,angle\n0,0,0,0,0\n' >before/trace.csv
printf 'frame,body,x,y,angle\n0,0,0,1,0\n' >after/trace.csv
run 1 compare before after --report verdicts
grep -q '; verdict before: .* fell' verdicts/report.html || fail "no verdicts on the page"
run 0 approve verdicts
says "replaced before/stack.npz
  verdict before: "
says "replaced before/trace.csv"
run 0 compare before after
says "equal: 0 frames, 2 trajectories"
finish
