#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What pictures show beside the bodies: options of render, right and wrong.
. "$(dirname "$0")/checks.sh"
runs=$sources/golden/trajectories
engine=$runs/single-engine.npz
network=$runs/single-pair-net.npz
draw() { run 0 render "$engine" "$network" --size 320x180 --frames 30:33 "$@"; }
hashes() { cat "$1"/*.png | md5sum; }

# Every value of every option is taken, and each gives another picture.
draw -o plain
seen=$(hashes plain)
for options in "--compare overlay" "--compare difference" "--camera bomb" "--camera divergence" "--theme dark" \
    "--show ghosts" "--show distance" "--show trails" "--show contacts" "--show impulses" "--show velocities" \
    "--show timeline" "--show ghosts,timeline --theme dark --compare overlay"; do
    rm -rf one
    draw -o one $options
    new=$(hashes one)
    case "$seen" in *"$new"*) fail "$options changes nothing" ;; esac
    seen="$seen $new"
done
draw -o same --compare split --camera fit --theme light
run 0 compare plain same

# A moving camera with everything on: the same frames from any number of jobs in either context.
everything="--camera bomb --show ghosts,distance,trails,contacts,impulses,velocities,timeline"
draw -o three $everything --jobs 3 --context egl
draw -o single $everything --jobs 1 --context osmesa
run 0 compare three single

# Costs are those that a chart of the scene holds.
run 0 chart "$scenes/single.yaml" --quick --methods engine:k=10,momentum:k=20 -o chart
draw -o free --size 640x360 --jobs 1
draw -o priced --size 640x360 --jobs 2 --costs chart/chart.csv
run 1 compare free priced
run 2 render "$runs/stack-engine.npz" -o x --costs chart/chart.csv
complains "chart.csv: error: has no closed-loop time at the impact for any of these runs"
run 2 render "$engine" -o x --costs nowhere.csv
complains "nowhere.csv"
printf 'method,us\nengine,3\n' >other.csv
run 2 render "$engine" -o x --costs other.csv
complains "other.csv:1:1: error"

run 2 render "$engine" -o x --compare both
complains "--compare: error: 'both' is not a valid value; known: split, overlay, difference"
run 2 render "$engine" -o x --camera ''
complains "--camera: error: '' is not a valid value; known: fit, bomb, divergence"
run 2 render "$engine" -o x --theme grey
complains "'grey' is not a valid value; known: light, dark"
run 2 render "$engine" -o x --show trails,ghost
complains "--show: error: 'ghost' is not a valid value; known: ghosts, distance, trails, contacts, impulses, velocities, timeline"
run 2 render "$engine" -o x --show trails,
complains "'' is not a valid value"
run 2 render "$engine" -o x --show "$(printf 'x%.0s' $(seq 5000))"
complains "xxx' is not a valid value"
run 2 render "$engine" -o x --show timeline
complains "'timeline' compares runs, but there is only one"
run 2 render "$engine" "$runs/stack-engine.npz" -o x --compare overlay
complains "their worlds differ (bodies: "
sed "s|^frames:.*|frames: 3|; s|networks/|$scenes/networks/|; /^bomb:/d" "$scenes/single.yaml" >calm.yaml
run 2 render calm.yaml -o x --camera bomb
complains "the camera cannot follow the bomb"
[ -e x ] && fail "a refused command made a folder"
run 0 render calm.yaml --size 320x180 -o calm --show contacts,impulses,velocities,trails
finish
