#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Bodies and bombs that start inside a body are refused by all commands, before they write anything.
. "$(dirname "$0")/checks.sh"

# A wall of five courses, five bricks each, with a bomb that some launches put inside it.
cat >wall.yaml <<'END'
gravity: [0, -10]
dt: 1/60
iterations: 10
frames: 40
bodies:
  - {static: true, size: [100, 20], position: [0, -10]}
  - {pattern: stack, count: 5, spacing: [0, $high], mass: 6, size: [1.6, 0.8], position: [-3.2, 0.4]}
  - {pattern: stack, count: 5, spacing: [0, $high], mass: 6, size: [1.6, 0.8], position: [-1.6, 0.4]}
  - {pattern: stack, count: 5, spacing: [0, $high], mass: 6, size: [1.6, 0.8], position: [0, 0.4]}
bomb: {x: {from: -6, to: 6, value: 5}, y: 2, size: [1, 1], mass: 60, frame: 10, velocity: {times_position: -1.5}}
parameters:
  high: {value: 0.8, from: 0.5, to: 1}
END

# refused COMMAND...: names the bomb, the launch and the free x, and leaves no file.
refused() {
    run 2 "$@"
    complains "wall: error: "
    complains "the bomb would start "
    complains " in frame 10, more than the slop of 0.01 m"
    complains "free x"
    rmdir -- * 2>/dev/null # chart makes its folder first
    equal "files after twinbox $1" "$(echo *)" "err out wall.yaml"
}
refused simulate wall.yaml --bomb-x -2 -o run.npz
complains "the launch at x = -2 m"
refused simulate wall.yaml --bomb-x -2 --method momentum -o run.npz
refused solve wall.yaml --bomb-x -2 --frame 12 -o p.npz
refused dataset wall.yaml -o data.npz
complains "free x: -6 to -4.5, 1.3 to 6"
refused chart wall.yaml --quick -o chart
refused chart wall.yaml --quick --bomb-x=-1:1:1 -o chart
complains "launch 1 at x = -1 m"
refused train --kind scene-net wall.yaml --launches 16 -o net.npz
refused train --kind hybrid wall.yaml --launches 16 -o memory.npz
refused train --kind sain wall.yaml --launches 16 -o sain.npz
run 2 simulate wall.yaml --set high=0.5 -o run.npz
complains "wall.yaml:7:5: error: body 2 starts 0.3 m inside body 1 (line 7), more than the slop of 0.01 m"

# Beside the wall there is room.
run 0 simulate wall.yaml --bomb-x 3 -o run.npz
echo "overlaps: allowed" >>wall.yaml
run 0 simulate wall.yaml --bomb-x -2 -o run.npz
run 0 simulate wall.yaml --set high=0.5 -o run.npz
run 0 dataset wall.yaml --bomb-x=-2:2:1 -o data.npz
finish
