#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# dataset -> train -> simulate by the network, small.
. "$(dirname "$0")/checks.sh"

sed 's/^frames:.*/frames: 60/' "$scenes/single.yaml" >single.yaml
sed 's/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stack.yaml
grep -q '^frames: 60' single.yaml || fail "no frames in single.yaml"

run 0 dataset single.yaml stack.yaml -o pairs.npz --bomb-x=-2:2:0.5
says "of 18 launches -> pairs.npz"
OMP_NUM_THREADS=1 run 0 dataset single.yaml stack.yaml -o again.npz --bomb-x=-2:2:0.5
cmp -s pairs.npz again.npz || fail "the dataset depends on the number of threads"
run 0 dataset single.yaml stack.yaml -o other.npz --bomb-x=-2:2:0.5 --seed 2
cmp -s pairs.npz other.npz && fail "--seed has no effect on the split"

# A table and a sweep of the same places are the same launches; so are the scene's family and its grid.
printf 'x\n-2\n-1\n0\n1\n2\n' >places.csv
run 0 dataset single.yaml -o swept.npz --bomb-x=-2:2:1
run 0 dataset single.yaml -o listed.npz --launches places.csv
cmp -s swept.npz listed.npz || fail "a sweep and a table differ"
run 0 dataset single.yaml -o grid.npz --bomb-x=-5:5:0.05
run 0 dataset single.yaml -o family.npz
cmp -s grid.npz family.npz || fail "the family of the single box is not its grid"

run 0 dataset single.yaml -o raw.npz --random 10 --inputs raw --target net --labels reference
says "    steps left out, as the reference does not converge: 0"
says "of 10 launches -> raw.npz"
run 0 dataset single.yaml -o mixed.npz --random 10 --bomb-x=-2:2:1 --inputs raw-unturned --target impulse
says "of 15 launches -> mixed.npz"
/usr/bin/python3 - <<'PYTHON' || fail "what the other datasets hold"
import numpy
raw, mixed = numpy.load("raw.npz"), numpy.load("mixed.npz")
assert (str(raw["view"]), str(raw["target"]), str(raw["labels"])) == ("raw", "net", "reference")
assert raw["inputs"].shape[1] == 12 and mixed["inputs"].shape[1] == 10
assert abs(raw["launch_x"]).max() > 5 and abs(raw["launch_rotation"]).max() > 0.5
assert mixed["launch_x"][:5].tolist() == [-2, -1, 0, 1, 2] and (mixed["launch_spin"][:5] == 0).all()
PYTHON
run 0 train raw.npz -o raw-net.npz --layers 12-8-6 --iterations 10
run 0 simulate single.yaml --method pair-net:network=raw-net.npz -o raw-run.npz

# Seen from the contact: impulses for its points, which the scene may name a network for.
run 0 dataset single.yaml -o points.npz --bomb-x=-2:2:1 --inputs contact --target points
run 0 dataset single.yaml -o around.npz --bomb-x=-2:2:1 --inputs neighbours --target net
run 0 train points.npz -o points-net.npz --layers 20-8-4 --iterations 5
run 0 train around.npz -o around-net.npz --layers 32-8-6 --iterations 5
run 0 train mixed.npz -o impulse-net.npz --layers 10-8-2 --iterations 5
/usr/bin/python3 - <<'PYTHON' || fail "what is seen from the contact"
import numpy
points, around, network = (numpy.load(name + ".npz") for name in ("points", "around", "points-net"))
assert (str(points["view"]), str(points["target"])) == ("contact", "points")
assert points["inputs"].shape[1] == 20 and points["changes"].shape[1] == 4
assert around["inputs"].shape[1] == 32 and around["changes"].shape[1] == 6
assert str(network["target"]) == "points" and str(network["outputs"]) == "dpn1 dpt1 dpn2 dpt2"
PYTHON
grep -v "contact-net:" single.yaml >unnamed.yaml
# The file ends in the networks of the scene.
(cat unnamed.yaml; echo "  contact-net: points-net.npz") >named.yaml
run 0 simulate named.yaml --method contact-net --hash named.hash
run 0 simulate single.yaml --method contact-net:network=points-net.npz --hash given.hash
cmp -s named.hash given.hash || fail "the scene's network for contact-net"
run 0 simulate single.yaml --method contact-net:network=points-net.npz,net=off --hash constant.hash
cmp -s constant.hash given.hash && fail "net=off says what the network says"
run 0 simulate single.yaml --method pair-net:network=around-net.npz
run 0 simulate single.yaml --method pair-net:network=impulse-net.npz,k=3 --hash three.hash
run 0 simulate single.yaml --method pair-net:network=impulse-net.npz --hash ten.hash
run 0 simulate single.yaml --method pair-net:network=impulse-net.npz,k=10 --hash same.hash
cmp -s ten.hash same.hash || fail "pair-net does not take the scene's sweeps"
cmp -s ten.hash three.hash && fail "k has no effect on single impulses"

# Options reach the training, and the network's file (what they do: tests/learning).
run 0 dataset single.yaml stack.yaml -o lawful.npz --bomb-x=-2:2:0.5 --context
mkdir nets
train() { run 0 train "$1" -o "nets/$2.npz" --iterations 3 "${@:3}"; }
run 0 train pairs.npz -o nets/net.npz --iterations 100 --seed 3
equal "iterations printed" "$(awk '$1 ~ /^[0-9]+$/ && NF == 5 { printf "%s ", $1 }' out)" "0 10 50 100 "
train pairs.npz more --from nets/net.npz
train pairs.npz same --seed 3
train pairs.npz again --seed 3
train pairs.npz other --seed 4
train lawful.npz lawful --layers 10-8-6 --laws momentum=10,cone=0.5
train lawful.npz lawless --layers 10-8-6
train pairs.npz smooth --loss smooth-l1
train pairs.npz standard --output-activation linear
for optimizer in bfgs gd lm; do train pairs.npz $optimizer --optimizer $optimizer; done
for hidden in sigmoid tanh relu; do train pairs.npz $hidden --hidden $hidden --output-activation linear --scale minmax; done
/usr/bin/python3 - <<'PYTHON' || fail "the files of networks"
import numpy
read = lambda name: numpy.load(f"nets/{name}.npz", allow_pickle=False)
def alike(a, b):
    return all((read(a)[f"weights_{layer}"] == read(b)[f"weights_{layer}"]).all() for layer in (0, 1))
assert alike("same", "again")
pairs = ("same", "other"), ("lawful", "lawless"), ("same", "smooth"), ("same", "bfgs"), ("bfgs", "gd"), ("gd", "lm"), ("same", "more")
assert not any(alike(*pair) for pair in pairs)
assert read("net")["widths"].tolist() == [10, 10, 2] and str(read("net")["activations"]) == "sigmoid sigmoid"
for hidden in "sigmoid", "tanh", "relu":
    assert str(read(hidden)["activations"]) == hidden + " linear"
    assert (read(hidden)["output_scale"] == read("net")["output_scale"]).all()
assert (read("standard")["output_scale"] != read("net")["output_scale"]).any()
for name, end in (("net", "--seed 3"), ("relu", "--hidden relu --output-activation linear --scale minmax"), ("smooth", "--loss smooth-l1"),
                  ("lawful", "--laws momentum=10,cone=0.5")):
    command = str(read(name)["command"])
    assert command.startswith("twinbox train ") and command.endswith(end), command
plain, data = numpy.load("pairs.npz"), numpy.load("lawful.npz")
assert data["context"].shape == (len(data["launch"]), 17) and "context" not in plain and (plain["changes"] == data["changes"]).all()
PYTHON
# Trained on, it starts where the other ended: as far as it had come after 100 iterations, in the training score.
run 0 train pairs.npz -o nets/start.npz --iterations 1 --from nets/net.npz
first=$(awk '$1 == 0 { print $3 }' out)
run 0 train pairs.npz -o nets/net.npz --iterations 100 --seed 3
/usr/bin/python3 -c "import sys; sys.exit(not float('$first') <= 1.02 * float('$(awk '$1 == 100 { print $3 }' out)'))" ||
    fail "--from does not start from the network's weights"
for network in net lm relu lawful; do run 0 simulate single.yaml --method pair-net:network=nets/$network.npz --hash $network.hash; done
cmp -s net.hash lm.hash && fail "two networks, one run"
finish
