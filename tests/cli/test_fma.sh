#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The C library chooses other code for exp, log, pow, sin and cos on a CPU with fused multiply-add, which rounds once
# less: their last bits differ. What twinbox computes does not.
. "$(dirname "$0")/checks.sh"
. "$sources/tests/deep/unfused.sh"

probe='import math; print([[f(i / 997) for f in (math.exp, math.log, math.sin, math.cos)] for i in range(1, 20000)])'
if [ "$(/usr/bin/python3 -c "$probe" | md5sum)" = "$(unfused /usr/bin/python3 -c "$probe" | md5sum)" ]; then
    echo "skipped: with this C library or CPU, the setting changes no bit"
    exit 77
fi

# What the commands write, in a folder.
write() {
    mkdir "$1"
    cd "$1" || exit 1
    # Among these launches are some that meet folds of the central path; those of the stack meet none.
    run 0 simulate "$scenes/pyramid.yaml" --bomb-x=-2 -m reference --frames 250 -o run.npz
    run 0 dataset "$scenes/pyramid.yaml" --bomb-x=-2:2:1 --labels reference -o pairs.npz
    run 0 train pairs.npz --iterations 20 -o pair-net.npz
    run 0 train --kind scene-net "$scenes/pyramid_settled.yaml" --launches 16 --rounds 1 --iterations 20 --width 16 \
        -o scene-net.npz
    run 0 chart "$scenes/pyramid.yaml" --quick --methods engine:k=10,interior,reference,pair-net -o chart
    "$sources/golden/without_times" chart/chart.csv >chart.csv
    rm -r chart
    cd ..
}
write fused
unfused write separate
for file in run.npz pairs.npz pair-net.npz scene-net.npz chart.csv; do
    checks=$((checks + 1))
    cmp {fused,separate}/$file || fail "without fused multiply-add, $file has other bytes"
done
finish
