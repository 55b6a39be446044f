#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Networks from outside: scenes/networks/from_weights makes files of weights, and layers that do not fit are refused.
. "$(dirname "$0")/checks.sh"

from_weights=$scenes/networks/from_weights
python() { /usr/bin/python3 - "$@"; }

# A network's own weights, in double and by rows, as PyTorch has them, or by columns, give the same run.
python "$scenes/networks" <<'PYTHON'
import sys
import numpy
for name in "pair-net", "contact-net", "scene-stack":
    net = numpy.load(f"{sys.argv[1]}/{name}.npz")
    if name == "scene-stack":
        weights = {f"weights_{l}": net[f"{part}_rows"] if part == "last" else net[f"{part}_rows"].T
                   for l, part in enumerate(("first", "second", "last"))}
        weights |= {f"biases_{l}": net[f"{part}_biases"] for l, part in enumerate(("first", "second", "last"))}
    else:
        weights = {key: net[key] for key in net.files if key.startswith(("weights_", "biases_"))}
    for order in "C", "F":
        numpy.savez(f"{name}-{order}.npz", **{key: array.astype("float64", order=order) for key, array in weights.items()})
PYTHON
for network in pair-net contact-net scene-stack; do
    method=${network/scene-stack/scene-net}
    for order in C F; do
        "$from_weights" "$network-$order.npz" "$scenes/networks/$network.npz" "$network-by-$order.npz" || fail "$network $order"
    done
    for file in "$scenes/networks/$network.npz" "$network-by-C.npz" "$network-by-F.npz"; do
        run 0 simulate "$scenes/stack.yaml" --frames 60 --method "$method:network=$file" --hash "$network.csv"
        md5sum <"$network.csv" >>"$network.md5"
    done
    equal "runs by $network" "$(uniq "$network.md5" | wc -l)" 1
done

# Other layers and activations, and inputs that are not normalised: what the file predicts is in closed form. A slope of -1 for
# the relative velocity along y stops a box that falls on the ground without slop or friction.
cat >drop.yaml <<'YAML'
gravity: [0, 0]
dt: 1/60
iterations: 10
frames: 2
bodies:
  - {static: true, size: [100, 20], position: [0, -10], friction: 0}
  - {size: [1, 1], mass: 1, position: [0, 0.499], velocity: [0, -1], friction: 0}
YAML
python <<'PYTHON'
import numpy
first, last = numpy.zeros((3, 10)), numpy.zeros((2, 3))
first[0, [3, 5]], first[1, [3, 5]] = (1, -1), (-1, 1)  # inputs: dx dy vxa vya vxb vyb ...; vy of a less that of b, and back
last[1, :2] = 1, -1
one, none = numpy.ones, numpy.zeros
numpy.savez("stop.npz", weights_0=first, biases_0=none(3), weights_1=last, biases_1=none(2), input_offset=none(10),
            input_scale=one(10), output_offset=none(2), output_scale=one(2))
PYTHON
"$from_weights" stop.npz "$scenes/networks/pair-net.npz" stop-net.npz relu linear || fail "from_weights stop"
run 0 simulate drop.yaml --method pair-net:network=stop-net.npz -o stop-run.npz
run 0 export stop-run.npz -o stop-run.json
python <<'PYTHON' || fail "the box does not stop"
import json
x, y, angle, vx, vy, omega = json.load(open("stop-run.json"))["frames"][1]["states"][1]
assert abs(vy) < 1e-6 and abs(vx) < 1e-6 and abs(y - 0.499) < 1e-6, (y, vy)
PYTHON

# Layers that do not fit each other, or the inputs that LIKE names. (Arrays of another type, shape or value:
# tests/learning/test_network_files.c.)
python <<'PYTHON'
import numpy
numpy.savez("chain.npz", weights_0=numpy.ones((4, 10)), biases_0=numpy.ones(4), weights_1=numpy.ones((2, 5)), biases_1=numpy.ones(2))
numpy.savez("wide.npz", weights_0=numpy.ones((2, 11)), biases_0=numpy.ones(2))
PYTHON
for network in chain wide; do
    "$from_weights" $network.npz "$scenes/networks/pair-net.npz" $network-net.npz
    run 2 simulate "$scenes/stack.yaml" --method pair-net:network=$network-net.npz
    complains "$network-net.npz: error: array '"
    complains " has shape ("
done

# Another scene with as many bodies elsewhere: steps unlike the training are counted.
sed -e 's/size: \[1, 1\], position: \[0, 0.51\]/size: [1.2, 1], position: [3, 0.51]/' -e '/^networks/,$d' "$scenes/stack.yaml" >other.yaml
run 0 simulate other.yaml --method "scene-net:network=$scenes/networks/scene-stack.npz"
says "steps unlike the training of the network: "
finish
