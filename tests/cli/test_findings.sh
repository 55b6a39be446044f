#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The scripts behind the findings: the table of equal times, what is kept of finished studies and written into the pages, the held-out
# scenes.
. "$(dirname "$0")/checks.sh"
export TWINBOX=$twinbox PYTHONDONTWRITEBYTECODE=1
families=$sources/scenes/families

# row SCENE METHOD SETTING US ERROR, which mean and 95th percentile share.
row() { printf '%s,%s,"%s",closed,impact,5,%s,9,%s,%s,%s,1,1,0,,0,\n' "$1" "$2" "$3" "$4" "$5" "$5" "$5"; }
{
    printf 'scene,method,setting,protocol,phase,launches,us_solver,us_step,error_mean,'
    printf 'error_median,error_p95,error_worst,share_right,penetration_max,drift,energy,moved\n'
    # The rival's error is 30 times as large, 0.5 times, and too small to be seen.
    row tower momentum k=20 10 0.3
    row tower interior near=0.02 10 0.1
    row tower interior near=0.002 20 0.01
    row wall momentum k=20 10 0.1
    row wall interior near=0.02 10 0.1
    row wall interior near=0.002 20 0.2
    row gate momentum k=20 10 0.00002
    row gate interior near=0.02 10 0.00001
    row gate interior near=0.002 20 0.00001
} >chart.csv
run 0 chart chart.csv -o drawn
"$families/table" drawn >table || fail "no table"
equal "the row of the tower" "$(sed -n 3p table)" \
    "| tower | 0.3 | 0.1 | 1.0 | 1/3 | 1/3 | momentum | 0.01 | 2.0 | 1/30 | 1/30 | momentum |"
equal "the row of the wall" "$(sed -n 4p table)" \
    "| wall | 0.1 | 0.1 | 1.0 | 1 | 1 | momentum | 0.2 | 2.0 | × 2 | × 2 | momentum |"
equal "the row of the gate" "$(sed -n 5p table)" \
    "| gate | 2e-05 | 1e-05 | 1.0 | 1/2 * | 1/2 * | momentum | 1e-05 | 2.0 | 1/2 * | 1/2 * | momentum |"
equal "what the table says" "$(tail -1 table)" "- near=0.002: less error than the best rival in the same time in 1 of 2 scenes; \
the rival's is 0.5 to 30 times as large, median 0.98; behind: wall (× 2); both below 0.0001 m/s or the floor: gate (1/2 *); rivals: momentum 3"

# Studies that are finished are read, not run: what they say is kept, and changes the pages. Here a time is ten times as long.
mkdir -p copy/scenes/families copy/scenes/launches copy/src/studies copy/golden copy/out/heldout
cp -r "$sources/golden/findings" copy/golden
cp "$sources/scenes/findings" "$sources/scenes/page_numbers.py" copy/scenes
cp "$sources/README.md" copy
cp "$sources/src/studies/README.md" copy/src/studies
cp -r copy/golden/findings/*/ copy/out
cp "$sources"/tests/paper/report/{networks,constants,rates,closed_loop,laws,transfer}.csv copy/out/paper
printf '%s,0.004,0.9,0.4,0.1,%s\n' cone,1,2,0.002 0.04 cone,1,3,0.0025 0.04 >>copy/out/paper/laws.csv
echo scratch,2,8,0.5,3.5 >>copy/out/paper/transfer.csv
for table in families:families/table launches:launches/chart; do
    printf '#!/bin/sh\ncat golden/findings/%s.txt\n' "${table%%:*}" >"copy/scenes/${table#*:}"
    chmod +x "copy/scenes/${table#*:}"
done
cp copy/golden/findings/heldout.txt copy/out/heldout/table.md
mkdir -p copy/out/families copy/out/paper/figures copy/golden/figures
touch copy/out/paper/report.md copy/out/{chart,chart_net,families}/equal_time.csv copy/out/families/equal_time.png \
    copy/out/chart/chart-pyramid_settled.png copy/out/paper/figures/factors.png copy/out/stability/{map-rate_height,borders}.png \
    copy/out/buckling/borders.png

# What the made-up study of the paper found: in nine of ten splits the constant's 0.004 is below the rows of Table 1 for 0 to 100
# iterations, in all above the others; of nine networks with that target one has 1289 parameters. The baseline is better than the mean
# in one of two splits, and worse in the other: it is neither. It is right in 81 and 92% of two scenes, the constant in 80 and 95%.
# All networks have split 1: inputs-raw alone is worse than the mean. Solvers are no networks: their runs do not count. In all of three
# seeds momentum is violated less, the cone in two; the error is smaller in one of two seeds with the cone alone. In seed 1 both starts
# from scratch are worse than one with fewer launches after the smaller scenes, in seed 2 that with 8 launches is not.
copy/golden/findings/write --paper copy/out/paper || fail "golden/findings/write"
equal "what the study found" "$(cd copy/golden/findings/paper && tail -n +2 -q targets.csv definitions.csv loops.csv summary.csv && sed -n 2,3p networks.csv)" "\
pair,10,0.004,0.004,0.1,4,2,0.5,0.5,0.5,8,inputs-contact,0.2,0.2,0.2
net,10,0.001,0.001,0.001,5,1,0.5,0.5,0.5,1,net,0.7,0.7,0.7
impulse,10,0.0001,0.0001,0.0001,6,0,0.5,0.5,0.5,2,impulse,0.5,0.5,0.5
range,2,1,0.865,0.81,0.92,1,1,1
absolute,2,1,0.46,0.3,0.62,1,1,1
bodies,1,1,0.2,0.2,0.2,1,1,1
single,2,346.5,93,600,,,
stack,2,306.25,12.5,600,40,60,110
pyramid,1,4,4,4,,,
pyramid_settled,1,20,20,20,50,,600
last_frame,600
runs,6
networks,15
better_median,14
better_least,14
better_most,14
runs_complete,2
highest_cost,3
law_cases,2
obeyed_median,2
obeyed_least,1
obeyed_most,2
learned_median,0
learned_least,0
learned_most,1
transfer_rows,2
saved_median,1.5
saved_least,1
saved_most,2
baseline,baseline,10-10-2,pair,132,2,0.875,0.25,1.5,2.125,0.25,4,0.25,0.25,0.25,0.5,0.5,0.5,0,0
inputs-raw,inputs,raw,pair,152,1,1.1,1.1,1.1,1.1,1.1,1.1,1.1,1.1,1.1,0.5,0.5,0.5,0,1"
grep -q 'Of 6 runs with a network 2 stay within' copy/src/studies/README.md || fail "the page does not say how many runs stay"
cp -r copy/golden/findings kept && cp copy/src/studies/README.md kept || fail "no pages"
(cd copy && scenes/findings 1 /usr/bin/false) || fail "scenes/findings"
cmp kept/README.md copy/src/studies/README.md || fail "the page is not renewed to itself"
diff -r kept copy/golden/findings | grep -v README.md && fail "other tables are kept"
/usr/bin/python3 - copy/out/chart/chart.csv <<'PYTHON' || fail "planting"
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
for row in rows:
    if (row["scene"], row["method"], row["setting"], row["protocol"], row["phase"]) == ("pyramid_settled", "scene-net", "", "closed", "impact"):
        row["us_solver"] = str(10 * float(row["us_solver"]))
writer = csv.DictWriter(open(sys.argv[1], "w"), rows[0], lineterminator="\n")
writer.writeheader()
writer.writerows(rows)
PYTHON
was=$(grep -o '<!--net_time-->[0-9.]*' copy/src/studies/README.md)
(cd copy && scenes/findings 1 /usr/bin/false) || fail "scenes/findings, again"
is=$(grep -o '<!--net_time-->[0-9.]*' copy/src/studies/README.md)
equal "the time is ten times as long" "$(echo "${is##*>} / ${was##*>}" | awk '{ printf "%.1f", $1 / $3 }')" 10.0
equal "changed lines of the page" "$(diff kept/README.md copy/src/studies/README.md | grep -c '^>')" 2

# Held-out scenes follow from the seed alone, and stand.
"$families/heldout" one 5 0 >drawn.txt || fail "no scenes"
equal "scenes" "$(wc -l <drawn.txt)" 10
! brief || finish
"$families/heldout" again 5 0 >/dev/null && "$families/heldout" other 6 0 >/dev/null || fail "no scenes"
for scene in one/*.yaml; do
    name=$(basename "$scene")
    cmp -s "$scene" "again/$name" || fail "$name: the same seed, another scene"
    cmp -s <(tail -n +2 "$scene") <(tail -n +2 "other/$name") && fail "$name: another seed, the same scene"
    run 0 check "$scene" -o first.png
done
finish
