#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Our stack and pyramid by the engines of scenes/engines that are installed, beside our own: tests/setup --all installs
# Chipmunk2D and Box2D 2.4; those of npm are tested where scenes/engines/setup has been run.
. "$(dirname "$0")/checks.sh"

cp "$scenes"/engines/* . 2>err
engines=()
# Programs of C and C++, built as their first comments say.
c++ -O1 -o box2d2 box2d2.cpp -lbox2d 2>err && engines+=("./box2d2") || echo "skipped: Box2D 2.4 is not installed"
cc -O1 -o chipmunk chipmunk.c -lchipmunk -lm 2>err && engines+=("./chipmunk") || echo "skipped: Chipmunk2D is not installed"
for engine in box2d3 rapier planck matter p2; do
    if [ -d "$scenes/engines/node_modules" ] && command -v node >/dev/null; then
        engines+=("node $scenes/engines/$engine.mjs")
    else
        echo "skipped: $engine.mjs needs node and scenes/engines/setup"
    fi
done
engines+=("/usr/bin/python3 toy.py")

for scene in stack pyramid; do
    run 0 simulate "$scenes/$scene.yaml" --frames 120 -o "$scene-engine.npz"
    run 0 export "$scene-engine.npz" -o "$scene-engine.csv"
    for i in "${!engines[@]}"; do
        run 0 simulate "$scenes/$scene.yaml" --frames 120 --method "exec:${engines[i]},step_limit=60" -o "$scene-$i.npz"
        run 1 compare "$scene-engine.npz" "$scene-$i.npz"
        says "largest distance: frame"
        run 0 export "$scene-$i.npz" -o "$scene-$i.csv"
    done
    run 0 figure strip "$scene-engine.npz" "$scene-0.npz" --moments 3 --dpi 60 -o "$scene.png"
done

# Laws: the bomb, the last body, falls freely until it strikes; nothing leaves the world through the ground; all begin with the
# same boxes.
/usr/bin/python3 - "${#engines[@]}" <<'PYTHON' || fail "a law does not hold"
import csv
import sys


def read(path):
    lines = [line for line in open(path) if not line.startswith("#")]
    return {(int(r["frame"]), int(r["body"])): r for r in csv.DictReader(lines)}


for scene in "stack", "pyramid":
    ours = read(f"{scene}-engine.csv")
    bomb = max(body for _, body in ours)
    for i in range(int(sys.argv[1])):
        run = read(f"{scene}-{i}.csv")
        assert run.keys() == ours.keys()
        assert all(abs(float(run[0, b][k]) - float(ours[0, b][k])) < 1e-5 for b in range(1, bomb + 1) for k in ("x", "y"))
        for k in range(10):
            t = k / 60
            for axis, gravity in ("x", 0), ("y", -10):
                start = float(run[0, bomb][axis])
                fall = start - 1.5 * start * t + gravity * t * t / 2
                # Engines move bodies by the velocity before or after the step, half a step from the exact fall.
                assert abs(float(run[k, bomb][axis]) - fall) < 1.1 * 10 / 3600 * 10 / 2, (scene, i, k, axis)
        assert min(float(run[key]["y"]) for key in run if key[1] > 0) > -0.5
PYTHON
finish
