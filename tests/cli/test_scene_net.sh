#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# train --kind scene-net -> simulate by the network, small.
. "$(dirname "$0")/checks.sh"

sed '/scene-net:/d; s/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stack.yaml
small="--launches 16 --rounds 2 --iterations 6 --width 16"

run 0 train --kind scene-net stack.yaml -o net.npz $small --seed 3
says "impacts left out, as the reference does not converge: 0"
equal "rounds printed" "$(awk '$1 ~ /^[0-9]+$/ && NF == 5 { printf "%s ", $1 }' out)" "0 1 "
awk '$1 == 0 { first = $2 } $1 == 1 { exit !($2 > first && first > 16) }' out || fail "samples: $(cat out)"
says "parameters -> net.npz"
OMP_NUM_THREADS=1 run 0 train --kind scene-net stack.yaml -o again.npz $small --seed 3
run 0 train --kind scene-net stack.yaml -o other.npz $small --seed 4
run 0 train --kind scene-net stack.yaml -o plain.npz $small --seed 3 --momentum off --sweeps 4
/usr/bin/python3 - <<'PYTHON' || fail "what the networks hold"
import numpy
net, again, other, plain = (numpy.load(name + ".npz", allow_pickle=False) for name in ("net", "again", "other", "plain"))
for name in net.files:
    assert name == "command" or (net[name] == again[name]).all(), name
assert (net["first_rows"] != other["first_rows"]).any() and net["first_rows"].shape[1] == 16
assert (str(net["kind"]), str(net["scene"]), int(net["sweeps"])) == ("scene-net", "stack", 14)
assert str(net["command"]).startswith("twinbox train --kind scene-net stack.yaml -o net.npz --launches 16 --rounds 2")
assert int(plain["sweeps"]) == 4 and (plain["factors"] == 0).all() and (net["factors"][1:] > 0).any()
assert int(net["bomb"]) == 11 and abs(net["bomb_inv_mass"] - 1 / 50) < 1e-6
PYTHON

for network in net again other plain; do
    run 0 simulate stack.yaml --method scene-net:network=$network.npz --bomb-x 1.3 --hash $network.hash
done
cmp -s net.hash again.hash || fail "the number of threads changes the run"
cmp -s net.hash other.hash && fail "two networks, one run"
run 0 simulate stack.yaml --method momentum:k=20 --bomb-x 1.3 --hash momentum.hash
cmp -s net.hash momentum.hash && fail "the network is never asked"
# Another bomb than it was trained with: the bits without the network.
sed 's/mass: 50/mass: 51/' stack.yaml >heavier.yaml
run 0 simulate heavier.yaml --method scene-net:network=net.npz --hash net.hash
run 0 simulate heavier.yaml --method scene-net:network=net.npz,net=off --hash momentum.hash
cmp -s net.hash momentum.hash || fail "a bomb of another mass is not the twin's"
run 0 simulate stack.yaml --method scene-net:network=net.npz,after=2,rest=3

# More sweeps follow until contacts are that near their aim: 0.02 where nothing is said.
for near in 0.02 1000; do
    run 0 simulate stack.yaml --method scene-net:network=net.npz,near=$near --bomb-x 1.3 --hash near_$near.hash
done
cmp -s again.hash near_0.02.hash || fail "0.02 m/s is not what stands for nothing said"
cmp -s again.hash near_1000.hash && fail "near=1000 changes nothing"

# Ctrl-C keeps the network of the rounds so far. (Started from a script, it would ignore the signal but for the trap.)
(trap - INT; exec "$twinbox" train --kind scene-net stack.yaml -o cut.npz $small --rounds 100 >cut.out 2>cut.err) &
training=$!
until grep -qs '^ *1 ' cut.out; do kill -0 $training || break; sleep 0.05; done
kill -INT $training
wait $training
equal "status after Ctrl-C" $? 130
grep -q "stopped early; .* -> cut.npz" cut.out || fail "Ctrl-C: $(tail -n 2 cut.out cut.err)"
run 0 simulate stack.yaml --method scene-net:network=cut.npz
finish
