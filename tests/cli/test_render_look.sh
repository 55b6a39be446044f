#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What pictures show beside the bodies: options of render.
. "$(dirname "$0")/checks.sh"
runs=$sources/golden/trajectories
engine=$runs/single-engine.npz
network=$runs/single-pair-net.npz
draw() { run 0 render "$engine" "$network" --size 320x180 --frames 30:33 "$@"; }
hashes() { cat "$1"/*.png | md5sum; }

# Every value of every option is taken, and each gives another picture. The marks are those of the table of --show.
marks=$(sed -n 's/^ *MARK([A-Z]*, "\([a-z]*\)".*/\1/p' "$sources/src/pictures/picture.h")
draw -o plain
seen=$(hashes plain)
for options in "--compare overlay" "--compare difference" "--camera bomb" "--camera divergence" "--theme dark" \
    $(printf -- '--show=%s ' $marks) "--show ghosts,timeline --theme dark --compare overlay"; do
    rm -rf one
    draw -o one $options
    new=$(hashes one)
    case "$seen" in *"$new"*) fail "$options changes nothing" ;; esac
    seen="$seen $new"
done
draw -o same --compare split --camera fit --theme light
run 0 compare plain same

# A moving camera with everything on: the same frames from any number of jobs in either context.
everything="--camera bomb --show $(echo $marks | tr " " ,)"
draw -o three $everything --jobs 3 --context egl
draw -o single $everything --jobs 1 --context osmesa
run 0 compare three single

! brief || finish

# A view from the command line, and that of another run. (What a body that flies off changes: tests/pictures/test_camera.c.)
run 0 simulate "$scenes/stack.yaml" --frames 24 -o calm.npz
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

# Marks of contacts where there is no bomb.
sed "s|^frames:.*|frames: 3|; s|networks/|$scenes/networks/|; /^bomb:/d" "$scenes/single.yaml" >calm.yaml
run 0 render calm.yaml --size 320x180 -o calm --show contacts,impulses,velocities,trails
finish
