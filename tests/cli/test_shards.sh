#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Shards of a study: three in one folder of which one is killed, and two whose folders are copied together, give the bytes of one
# process. (Shares, damaged pieces: tests/runs/test_pieces.c.)
. "$(dirname "$0")/checks.sh"

few="$scenes/stability/heavy_on_one.yaml --vary ratio=1:1000 --vary iterations=1:50 --methods engine,momentum,interior --quick"
run 0 stability $few -o whole

# All at the same time; the second is killed when a piece of it is there, and nobody starts it again.
for k in 1 3; do "$twinbox" stability $few -o three --shard $k/3 >out$k 2>err$k & done
strike KILL 137 '[ -n "$(grep -rl "^number 4$" three 2>/dev/null)" ]' stability $few -o three --shard 2/3
wait
for k in 1 3; do
    grep -q "^shard $k of 3: [1-9]" out$k || fail "shard $k: $(cat out$k err$k)"
    grep -q "the same command without --shard does what is missing and writes the results" out$k || fail "no way on: $(<out$k)"
done
equal "results before the last command" "$(cd three && echo *)" "$(cd three && echo parts-*)"
run 0 stability $few -o three
diff -r whole three >difference || fail "other files with a shard that was killed: $(head -3 difference)"

for k in 1 2; do run 0 stability $few -o "copy$k" --shard $k/2; done
mkdir both
cp -r copy1/. copy2/. both
pieces=$(find both -type f | wc -l)
run 0 stability $few -o both --shard 1/1
says "shard 1 of 1: $pieces pieces, $pieces of them done before"
run 0 stability $few -o both
diff -r whole both >difference || fail "other files from two folders: $(head -3 difference)"

# Of a chart, times are measured by the last command alone.
chart="$scenes/single.yaml $scenes/stack.yaml --quick --methods engine:k=10,pair-net"
without_times() { "$sources/golden/without_times" "$1"; }
run 0 chart $chart -o chart
run 0 chart $chart -o shared --shard 1/2
run 0 chart $chart -o shared --shard 2/2
says "left to the command without --shard, as they are timed or need others: 2"
! grep -q "^cpu ." -r shared || fail "a shard has measured times"
run 0 chart $chart -o shared
equal "files" "$(ls shared)" "$(ls chart)"
cmp -s <(without_times chart/chart.csv) <(without_times shared/chart.csv) || fail "other numbers by shards"
[ -z "$(cut -d, -f19 shared/chart.csv | grep -c '^$')" ] && fail "no processor"
! brief || finish

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
