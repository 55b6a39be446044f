#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Training ends with a verdict, and --from never replaces a network by a worse one.
. "$(dirname "$0")/checks.sh"

sed 's/^frames:.*/frames: 60/' "$scenes/single.yaml" >single.yaml
sed '/scene-net:/d; s/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stack.yaml
run 0 dataset single.yaml -o pairs.npz --bomb-x=-2:2:0.5

# Random weights are no better than always predicting the mean; 20 steps of Levenberg-Marquardt are.
run 0 train pairs.npz -o net.npz --iterations 0
says "of the constant predictor's: worse than the constant"
run 0 train pairs.npz -o net.npz --optimizer lm --iterations 20
equal "worse than the constant" "$(grep -c 'worse' out)" 0
share=$(sed -nE 's/^verdict: held-out error [0-9.]+, ([0-9.]+) of the constant predictor.s$/\1/p' out)
awk -v share="$share" 'BEGIN { exit !(share > 0 && share < 1) }' || fail "share of the constant's error: '$share'"
# The last line of the table and the verdict have the same error (training that ends at its best).
equal "held-out error" "$(awk '$1 == 20 { print $2 }' out)" "$(sed -nE 's/^verdict: held-out error ([0-9.]+),.*/\1/p' out)"

# Ten more steps lower the training error and raise the held-out error: the file keeps the network that it had.
cp net.npz kept.npz
run 1 train pairs.npz --from net.npz -o net.npz --optimizer lm --iterations 10
says "verdict: worse than the network in net.npz, which is kept: held-out error "
cmp -s net.npz kept.npz || fail "a network was replaced by a worse one"
run 0 train pairs.npz --from net.npz -o other.npz --optimizer lm --iterations 10

# A network is known by its content: the name is the same, or another.
for name in kept other; do
    cp $name.npz net.npz
    run 0 simulate single.yaml --method pair-net:network=net.npz -o of_$name.npz
done
run 0 simulate single.yaml --method pair-net:network=other.npz -o renamed.npz
run 0 render of_other.npz -o film --frames 0:0 --size 320x180
/usr/bin/python3 - <<'PYTHON' || fail "hashes of networks"
import json, numpy
kept, other, renamed = (f"{int(numpy.load(run + '.npz')['network_hash']):016x}" for run in ("of_kept", "of_other", "renamed"))
assert kept != other == renamed, (kept, other, renamed)
assert json.load(open("film/manifest.json"))["runs"][0]["network_hash"] == other
assert f"Network\0\0\0\0\0{other}".encode() in open("film/frame_000000.png", "rb").read()
open("words", "w").write(f'not compared: the network, "{kept}" in run 1, "{other}" in run 2')
PYTHON
run 1 compare of_kept.npz of_other.npz
says "$(cat words)"
cp kept.npz net.npz
run 0 train pairs.npz --from net.npz -o net.npz --iterations 0
run 0 train pairs.npz -o net.npz --iterations 0
cmp -s net.npz kept.npz && fail "training without --from did not replace the file"

# Sixteen launches and few epochs are not enough: the network is worse than sweeps, and the table says the same.
run 0 train --kind scene-net stack.yaml -o scene.npz --launches 16 --rounds 2 --iterations 6 --width 16 --seed 3
says "verdict: no better than momentum with 20 sweeps"
awk '$1 == 1 && NF == 5 { last = $4 > $5 } END { exit !last }' out || fail "the verdict is not that of the table: $(cat out)"
finish
