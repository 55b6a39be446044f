#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# twinbox check: a summary and the first frame of a scene in order; what is wrong with any other.
. "$(dirname "$0")/checks.sh"

# scene LINE...: a stack with a bomb, the lines behind it.
scene() {
    cat >tower.yaml <<'END'
gravity: [0, -10]
dt: 1/60
iterations: 10
frames: 120
bodies:
  - {static: true, size: [100, 20], position: [0, -10]}
  - {pattern: stack, count: $height, spacing: [0, 1], mass: 2, size: [1, 1], position: [0, 0.5]}
END
    printf '%s\n' "$@" >>tower.yaml
}
height='parameters: {height: {value: 5, from: 1, to: 20, unit: boxes, whole: on}}'
bomb() { echo "bomb: {x: {from: -5, to: 5, value: 4}, y: $1, size: [1, 1], mass: 20, frame: 30, velocity: {times_position: -1.5}}"; }

# size FILE: width and height of a PNG.
size() { python3 -c "import struct,sys; d = open(sys.argv[1], 'rb').read(); assert d[:4] == b'\x89PNG'; print(*struct.unpack('>II', d[16:24]))" "$1"; }

scene "$(bomb 25)" "$height"
run 0 check tower.yaml
cat >expected <<'END'
tower.yaml is valid
    bodies: 5 boxes of 10 kg together, and 1 static
    duration: 120 steps of 0.0166667 s, 2 s; 10 iterations per step
    bomb: 20 kg, added after step 30 at (4, 25) m with (-6, -37.5) m/s
    launches: x from -5 to 5 m
    parameter height: 5, from 1 to 20 boxes
first frame -> tower-first-frame.png
next: twinbox render tower.yaml -o out/tower --video out/tower.mp4
END
cmp -s out expected || fail "the summary: $(diff out expected)"
equal "size of the picture" "$(size tower-first-frame.png)" "1280 720"
run 0 check tower.yaml -o first.png
cmp -s first.png tower-first-frame.png || fail "-o changes the picture"

run 0 check tower.yaml --json
/usr/bin/python3 - <<'PYTHON' || fail "the summary as JSON: $(<out)"
import json
found = json.load(open("out"))
assert found["format"] == "twinbox check 1" and found["scene"] == "tower.yaml", found
assert (found["bodies"], found["static"], found["steps"], found["iterations"]) == (5, 1, 120, 10), found
assert found["bomb"]["position"] == [4, 25] and found["bomb"]["launches"] == {"x": [-5, 5]}, found
assert found["parameters"] == [{"name": "height", "value": 5, "from": 1, "to": 20, "unit": "boxes"}], found
assert found["size"] is None and found["bomb"]["misses"] == {"tried": 41, "missed": 0, "x": []}, found
assert found["networks"] == {} and found["picture"] == "tower-first-frame.png", found
PYTHON
run 0 check "$scenes/single.yaml" --json
grep -q '"pair-net": ".*networks/pair-net.npz"' out || fail "no networks: $(<out)"

# A bomb that falls straight down from x beyond 1 m strikes no box of the tower.
scene "bomb: {x: {from: -5, to: 5, value: 4}, y: 25, size: [1, 1], mass: 20, frame: 30, velocity: [0, -20]}" "$height"
run 0 check tower.yaml -o misses.png
says "    misses: launches from x = -4.9 to -1.25 and from 1.25 to 4.9 m strike no box (32 of 41 tried)"
# What needs an impact goes on with the launches that strike.
run 0 chart tower.yaml --quick --methods engine:k=10 -o chart
complains "twinbox: note: tower: 4 of 5 launches strike no box; the impact is scored and timed on the others"
says "tower: 1 method and settings, 5 launches of which 1 strikes a box"
equal "times of the impact" "$(awk -F, '$4 == "closed" && $5 == "impact" && $7 > 0' chart/chart.csv | wc -l)" 1
scene "bomb: {x: 4, y: 25, size: [1, 1], mass: 20, frame: 30}" "$height"
run 0 check tower.yaml -o misses.png
says "    misses: the bomb strikes no box"
sed 's/^frames: .*/frames: 200000/' tower.yaml >long.yaml
run 0 check long.yaml -o misses.png
says "    misses: not looked for, as the scene is large"

# The picture is what render draws of that frame. The path of the bomb is in it, too.
run 0 render tower.yaml -o frames --frames 0 --size 1280x720
run 1 compare first.png frames/frame_000000.png
sed '/^bomb:/d; s/^frames: .*/frames: 1/' tower.yaml >still.yaml
run 0 check still.yaml -o still.png
run 0 render still.yaml -o still --frames 0 --size 1280x720
run 0 compare still.png still/frame_000000.png
run 0 check "$scenes/stack.yaml" -o stack.png
says "    network of pair-net: "

# wrong MESSAGE: the scene is refused with it, and nothing is drawn or said to be valid.
wrong() {
    rm -f *.png
    run 2 check tower.yaml
    complains "$1"
    equal "output of a wrong scene" "$(cat out)" ""
    equal "pictures of a wrong scene" "$(ls | grep -c png)" 0
}
scene "massa: 3" "$height"
wrong "tower.yaml:8:1: error: 'massa' is not a key of a scene"
scene "  - {mass: 1, size: [1, 1], position: [0.5, 0.5]}" "$height"
wrong "tower.yaml:8:5: error: body 6 starts 0.5 m inside body 1 (line 7)"
# The bomb has room over 5 boxes for the value of x, but not beside them, or not over 20.
scene "$(bomb 2)" "$height"
wrong "tower: error: launch 82 at x = -0.95 m"
wrong "free x: -5 to -0.99, 1 to 5"
# Parameters that are not valid at an end.
scene "camera: {center: [0, 0], size: [\$width, 1]}" "parameters: {height: {value: 5, from: 0, to: 6}, width: {value: 1, from: 1, to: 2}}"
wrong "tower.yaml:7:29: error: count must be a whole number from 1 to 25000 (got 0, from \$height with height = 0)"
# Networks that are missing, for another scene, or of a method without one.
scene "networks: {pair-net: missing.npz}" "$height"
wrong "missing.npz: error: "
scene "$(bomb 25)" "networks: {scene-net: $scenes/networks/scene-stack.npz}" "$height"
wrong "scene-net: error: the network is for the scene stack of 11 bodies; this one has 6"
scene "networks: {pair-net: $scenes/networks/sain.npz}" "$height"
wrong "sain.npz: error: "
scene "networks: {engine: $scenes/networks/pair-net.npz}" "$height"
wrong "pair-net.npz: error: the method engine has no network"

# Scenes of the repository are in order (tests/scenes/test_stability.c and tests/runs/test_launch_check.c read them all).
! brief || finish
for file in "$scenes"/*.yaml "$scenes"/families/g*.yaml "$scenes"/stability/{arch,overlap}.yaml; do run 0 check "$file" -o first.png; done
# Where slop and steps do not fit the size of the boxes: 10 mm of 50 mm; 10 m/s^2 (1/60 s)^2 are 2.8 mm.
printf '%s\n' "gravity: [0, -10]" "dt: 1/60" "iterations: 10" "frames: 2" "bodies:" \
    "  - {static: true, size: [10, 1], position: [0, -0.5]}" "  - {mass: 1, size: [1, 0.05], position: [0, 0.025]}" >thin.yaml
run 0 check thin.yaml -o thin.png
says "    size: of the smallest side, 0.05 m, contacts leave 20% as overlap (slop, 0.01 m), and a box falls by 5.56% in a step: "
sed 's/0.05]/0.5]/; s/0.025]/0.25]/' thin.yaml >thick.yaml
run 0 check thick.yaml -o thick.png
equal "lines about the size" "$(grep -c size: out)" 0
# A motion that float32 cannot hold at x = 100 m, where positions are 2^-17 m apart.
for dt in 1e-5 1e-3; do
    printf '%s\n' 'gravity: [0, 0]' "dt: $dt" 'iterations: 10' 'frames: 100' 'bodies:' \
        '  - {mass: 1, size: [1, 1], position: [100, 0], velocity: [0.3, 0]}' >slide.yaml
    run 0 check slide.yaml
    mv out $dt.out
done
grep -q '    rounding: 100 m from 0, positions are 7.63e-06 m apart (float32), and a body moves by 3e-06 m in a step: ' 1e-5.out ||
    fail "no word about rounding: $(<1e-5.out)"
! grep rounding 1e-3.out || fail "0.3 mm are enough"
finish
