#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# --costs finds the row of a method whose settings are the scene's.
. "$(dirname "$0")/checks.sh"

# chart.csv with times that no clock measured: 1, 2, 3 microseconds ...
{
    echo scene,method,setting,protocol,phase,launches,us_solver,us_step,error_mean,error_median,error_p95,error_worst,share_right,penetration_max,drift,energy,moved
    time=1
    for row in engine,k=5 engine,k=10 engine,k=20 momentum,k=10 momentum,'"near=0.1,k=10"' avbd,k=4 avbd,k=10 \
        soft-step,substeps=2 soft-step,substeps=4; do
        echo "single,$row,closed,impact,1,$time,$time,1,1,1,1,1,0,0,0,0"
        time=$((time + 1))
    done
} >chart.csv
cost() { sed -n 's/.*"cost": "\([0-9.]*\) .*/\1/p' film/manifest.json | tr '\n' ' '; }
simulate() {
    local file=$1
    shift
    run 0 simulate "$scenes/single.yaml" --frames 2 -o "$file.npz" "$@"
}
draw() {
    rm -rf film
    run 0 render "$@" -o film --size 320x180 --costs chart.csv -q
}
simulate engine
simulate engine5 --iterations 5
simulate given --method engine:k=20
simulate momentum --method momentum
simulate near --method momentum:k=10,near=0.1
simulate avbd --method avbd
draw engine.npz engine5.npz given.npz momentum.npz near.npz avbd.npz
equal "costs" "$(cost)" "2.0 1.0 3.0 4.0 5.0 7.0 "
simulate soft-step --method soft-step
draw soft-step.npz
equal "cost of the method's own settings" "$(cost)" "9.0 "
equal "iterations in the run" "$(/usr/bin/python3 -c "
import numpy
print(numpy.load('engine5.npz')['iterations'])")" 5

# A run with a number of sweeps that the chart lacks has no cost, although another row is of its method.
simulate odd --iterations 7
draw odd.npz avbd.npz
equal "costs, one unknown" "$(cost)" "7.0 "
run 2 render odd.npz -o x --costs chart.csv
complains "no closed-loop time"
finish
