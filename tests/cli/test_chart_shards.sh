#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Shards of a chart: merged, they give the tables of one process, but for times; what does not belong together is refused.
# (Records and damaged pieces: test_stability_shards.sh; kills: tests/cluster.)
. "$(dirname "$0")/checks.sh"
without_times() { "$sources/golden/without_times" "$1"; }

few="$scenes/single.yaml $scenes/stack.yaml --quick --pages --methods engine:k=10,momentum:k=20,pair-net,soft-step"
run 0 chart $few -o whole
sed '/^error at/,$d' out >summary
# Files, numbers and pages are those of the whole; times differ.
same_as_whole() {
    equal "files of $1" "$(echo $(ls "$1"))" "$(echo $( (ls whole && echo shards) | sort))"
    cmp -s <(without_times whole/chart.csv) <(without_times "$1/chart.csv") || fail "$1: other numbers"
    cmp -s whole/chart_pages.csv "$1/chart_pages.csv" || fail "$1: another list of pages"
    for page in whole/pages/*; do
        cmp -s "$page" "$1/pages/$(basename "$page")" || fail "$1: another $page"
    done
}

# Three shards; before the last one, a merge names what is missing and writes nothing.
run 0 chart $few -o three --shard 2/3
says "shard 2 of 3: 4 pieces, 0 of them done before -> three/shards"
says "    this is one part of 3; when all shards are done: twinbox merge three"
SLURM_PROCID=0 SLURM_NTASKS=3 run 0 chart $few -o three
complains "twinbox: note: shard 1 of 3, by SLURM_PROCID=0, SLURM_NTASKS=3; --shard 1/1 does all"
says "    this is one part of 3; when all shards are done: twinbox merge three"
run 1 merge three
equal "what sbatch needs" "$(cat out)" --array=3
complains "4 of 12 pieces are missing: "
equal "files of shards" "$(echo three/*)" three/shards
run 0 chart $few -o three --shard 3/3
run 0 merge three
same_as_whole three
equal "what a merge says" "$(sed '/^error at/,$d' out)" "$(sed s/whole/three/ summary)"
times=$(md5sum three/chart.csv three/equal_time.csv three/chart-stack.svg)
run 0 merge three
same_as_whole three
equal "tables and charts of a second merge" "$(md5sum three/chart.csv three/equal_time.csv three/chart-stack.svg)" "$times"
run 0 merge three --times first
equal "tables and charts of one processor" "$(md5sum three/chart.csv three/equal_time.csv three/chart-stack.svg)" "$times"
cpu=$(/usr/bin/python3 -c 'import csv; print(next(csv.DictReader(open("three/chart.csv")))["cpu"])')
[ "$cpu" ] || fail "no processor"
grep -qF "Times measured on $cpu." three/chart.html || fail "chart.html does not name the processor $cpu"

! brief || finish

# Times that a merge leaves out: the scene has no chart, and the others say so.
/usr/bin/python3 - <<'PYTHON'
import csv
rows = list(csv.DictReader(open("three/chart.csv")))
with open("first.csv", "w") as file:
    table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
    table.writeheader()
    for row in rows:
        timed = row["scene"] == "single"
        table.writerow({key: value if timed or not (key.startswith("us_") or key in ("instructions", "cpu")) else ""
                        for key, value in row.items()})
PYTHON
run 0 chart first.csv -o first
says "single -> first/chart-single.png, .svg, .pdf, .txt"
says "stack: no chart, as its times were measured on another processor than the first"
[ -e first/chart-stack.png ] && fail "a chart without times"
for figure in chart-single equal_time; do
    grep -qF "Times measured on $cpu. Those of other processors are left out." first/$figure.txt ||
        fail "$figure.txt does not say whose times are left out"
done

# Refused, and nothing is changed.
unchanged three "begun in 3 shards" chart $few -o three --shard 1/2
unchanged three "three/shards/run.json: error: belongs to shards of a study" chart $few -o three
unchanged three "another study: " chart $few --launches 4 -o three --shard 1/3

# The memory of a shard does not grow with the launches.
peak() {
    /usr/bin/python3 - "$twinbox" chart "$scenes/stack.yaml" --quick --methods engine:k=4 -o "peak$1" --launches "$1" \
        --shard 1/2 <<'PYTHON'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
PYTHON
}
small=$(OMP_NUM_THREADS=2 peak 10) large=$(OMP_NUM_THREADS=2 peak 400)
[ $((large - small)) -lt 3000 ] || fail "a shard takes $small kB for 10 launches, and $large kB for 400"
checks=$((checks + 1))
finish
