#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Studies by one thread and by three give the same tables. Small, for the thread sanitizer.
. "$(dirname "$0")/checks.sh"

for threads in 1 3; do
    export OMP_NUM_THREADS=$threads
    run 0 chart "$scenes/single.yaml" --quick --methods engine:k=10,momentum:k=20,pair-net -o chart$threads
    "$sources/golden/without_times" chart$threads/chart.csv >chart$threads.csv
    # Five launches: threads share the methods of each. Twelve launches of two scenes: each thread has some.
    run 0 chart "$scenes/single.yaml" "$scenes/stack.yaml" --quick --launches 6 --methods engine:k=10,soft-step -o many$threads
    "$sources/golden/without_times" many$threads/chart.csv >many$threads.csv
    run 0 stability --scenes "$scenes" --quick --study bomb_speed --study speed_thickness \
        --methods engine:k=4,engine:k=10,interior -o stability$threads
done
equal "rows of the chart" "$(wc -l <chart1.csv)" 25 # with the twin of pair-net
cmp -s chart1.csv chart3.csv || fail "three threads chart other numbers"
cmp -s many1.csv many3.csv || fail "three threads with launches of their own chart other numbers"
equal "borders" "$(wc -l <stability1/stability.csv)" 4
for table in stability maps rest; do
    cmp -s stability1/$table.csv stability3/$table.csv || fail "three threads write another $table.csv"
done

# Whatever the environment asks for, threads fit on the stack.
export OMP_NUM_THREADS=100000
run 0 dataset "$scenes/single.yaml" -o pairs.npz --bomb-x=-2:2:1
run 0 train pairs.npz --iterations 3 -o pair.npz
run 0 train --kind scene-net "$scenes/stack.yaml" -o scene.npz --launches 10 --rounds 1 --iterations 1 --width 16
finish
