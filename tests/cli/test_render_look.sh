#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What pictures show beside the bodies: options of render.
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

! brief || finish

# A box flies off in frame 20: no pixel of the frames before changes, of one run or of several side by side.
run 0 simulate "$scenes/stack.yaml" --frames 24 -o calm.npz
/usr/bin/python3 -c "
import numpy
run = dict(numpy.load('calm.npz', allow_pickle=False))
for frame in range(20, 25):
    run['position'][frame, 7] = (9 + 60 * (frame - 19), 30 * (frame - 19))
numpy.savez('wild.npz', **run)"
frames() { run 0 render "$@" --size 320x180 --frames 12:24; }
frames calm.npz -o calm
frames wild.npz -o wild
equal "frames that a body flying off later changes" \
    "$(for f in calm/*.png; do cmp -s "$f" "wild/${f#*/}" || echo "$f"; done | head -1)" calm/frame_000020.png
frames calm.npz calm.npz -o pair
frames calm.npz wild.npz -o apart
equal "frames of a pair that a body flying off later changes" \
    "$(for f in pair/*.png; do cmp -s "$f" "apart/${f#*/}" || echo "$f"; done | head -1)" pair/frame_000020.png

# A view from the command line, and that of another run.
camera() { sed -n 's/.*\("scale": [^}]*\)}.*/\1/p' "$1/manifest.json" | head -1; }
look() { run 0 render calm.npz --size 640x360 --frames 3 "$@"; }
look -o fitted
look -o set --camera 0,5,16,9
equal "pixels per metre of 596 x 297 pixels" "$(camera set | cut -d, -f1)" '"scale": 33'
run 1 compare fitted set
/usr/bin/python3 -c "
import numpy
run = dict(numpy.load('calm.npz', allow_pickle=False))
run['camera'] = numpy.array([[0, 5], [16, 9]], dtype=numpy.float32)
numpy.savez('seen.npz', **run)"
look -o borrowed --view-from seen.npz
run 0 compare set borrowed
look -o moving --camera bomb --camera 0,5,16,9
run 1 compare set moving
look -o near --camera bomb --view-from seen.npz
run 0 compare moving near

# Costs are those that a chart of the scene holds.
run 0 chart "$scenes/single.yaml" --quick --methods engine:k=10,momentum:k=20 -o chart
draw -o free --size 640x360 --jobs 1
draw -o priced --size 640x360 --jobs 2 --costs chart/chart.csv
run 1 compare free priced

# Marks of contacts where there is no bomb.
sed "s|^frames:.*|frames: 3|; s|networks/|$scenes/networks/|; /^bomb:/d" "$scenes/single.yaml" >calm.yaml
run 0 render calm.yaml --size 320x180 -o calm --show contacts,impulses,velocities,trails
finish
