#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs of our stack and pyramid by Chipmunk2D and Box2D, made by the scripts in scenes/import, beside the engine's. tests/setup
# installs what they need.
. "$(dirname "$0")/checks.sh"

if ! c++ -O1 -o box2d "$scenes/import/box2d.cpp" -lbox2d -lyaml-cpp 2>err; then
    grep -q "b2World\|No such file" err && echo "skipped: Box2D 2.4 and yaml-cpp are not installed" && exit 0
    fail "box2d.cpp: $(head -c 400 err)"
fi
for scene in stack pyramid; do
    run 0 simulate "$scenes/$scene.yaml" --frames 120 -o "$scene-engine.npz"
    sed 's/^frames: .*/frames: 120/' "$scenes/$scene.yaml" >"$scene.yaml"
    /usr/bin/python3 "$scenes/import/chipmunk.py" "$scene.yaml" "$scene-chipmunk.npz" 2>err || fail "chipmunk: $(tail -3 err)"
    ./box2d "$scene.yaml" | "$twinbox" import - -o "$scene-box2d.npz" >out 2>err || fail "box2d: $(tail -1 err)"
    says "$scene by Box2D 2.4: 121 frames of"
    complains "assumed: velocities are unknown"
    for engine in chipmunk box2d; do
        # Only runs of the same boxes have a distance.
        run 1 compare "$scene-engine.npz" "$scene-$engine.npz"
        says "only poses are compared: a run has no velocities"
        says "largest distance: frame"
    done
    run 0 render "$scene-engine.npz" "$scene-chipmunk.npz" "$scene-box2d.npz" --size 640x360 --frames 40:41 -o "$scene"
    run 0 figure strip "$scene-engine.npz" "$scene-chipmunk.npz" --moments 3 --dpi 60 -o "$scene.png"
    run 0 export "$scene-chipmunk.npz" -o "$scene-chipmunk.csv"
    run 0 import "$scene-chipmunk.csv" -o back.npz
    run 0 compare "$scene-chipmunk.npz" back.npz
done

# Laws: the bomb, the last body, falls freely until it strikes; nothing leaves the world through the ground; all three begin
# with the same boxes.
/usr/bin/python3 - <<'PYTHON' || fail "a law does not hold"
import numpy as np
for scene, strikes in ("stack", 10), ("pyramid", 10):
    runs = [np.load(f"{scene}-{engine}.npz") for engine in ("engine", "chipmunk", "box2d")]
    for run in runs:
        start = run["position"][0]
        assert np.abs(start - runs[0]["position"][0]).max() < 1e-5
        assert np.array_equal(run["size"], runs[0]["size"]) and np.array_equal(run["fixed"], runs[0]["fixed"])
        assert run["bomb"] == len(start) - 1 and np.float32(run["dt"]) == runs[0]["dt"]
        k, dt, v = np.arange(strikes), 1 / 60, -1.5 * start[-1]
        fall = start[-1] + np.outer(k * dt, v) + np.outer(k**2 * dt**2 / 2, (0, -10))
        # Each of the three moves bodies by the velocity after the step, which adds g dt² k / 2 to the exact fall.
        assert np.abs(run["position"][:strikes, -1] - fall).max() < 1.1 * 10 * dt**2 * strikes / 2
        # The bomb presses boxes into the ground, in the engine by 0.37 m, but not through it.
        assert np.nanmin(run["position"][:, 1:, 1]) > 0
        assert run["position"][100, 1:, 0].std() > 1.05 * start[1:, 0].std(), "the bomb moves nothing"
PYTHON
finish
