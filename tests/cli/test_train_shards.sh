#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Launches of trainings in shards: a training that reads them gives the network of one that runs them, byte for byte.
. "$(dirname "$0")/checks.sh"
sed '/networks:/,$d' "$scenes/stack.yaml" >stack.yaml

# The path is stored in the network, so the two have the same.
mkdir whole shards
same() {
    (cd whole && "$twinbox" train "$@" -o net.npz >out 2>err </dev/null) || fail "train $*: $(cat whole/err)"
    cd shards && rm -rf net.npz* || exit 1
    for shard in 3 1 2; do
        run 0 train "$@" -o net.npz --shard $shard/3
        says "when all shards are done: twinbox merge net.npz"
    done
    [ -e net.npz ] && fail "a shard wrote a network"
    run 0 merge net.npz
    # But for the line with times, and the verdict that follows from them.
    equal "what $* prints" "$(grep -v -e momentum -e verdict out)" "$(grep -v -e momentum -e verdict ../whole/out)"
    cmp -s net.npz ../whole/net.npz || fail "$*: the merge gives another network"
    equal "files of $*" "$(echo net.npz*)" "net.npz net.npz.shards"
    equal "the stored command has no shard" "$(python3 - <<'PYTHON'
import io, struct, zipfile
data = zipfile.ZipFile("net.npz").read("command.npy")
print("shard" in data[128:].decode("utf-32-le", "replace"))
PYTHON
)" False
    cd .. || exit 1
}
scene_net="--kind scene-net ../stack.yaml --launches 230 --iterations 1 --width 16"
same $scene_net --rounds 2

! brief || finish

# Every width of --smallest reads the same launches.
smallest="--kind scene-net stack.yaml --launches 12 --iterations 1 --rounds 1 --smallest --within 0.1"
run 2 train $smallest -o smallest.npz
cp out whole.out
run 0 train $smallest -o smallest.npz --shard 1/2
run 0 train $smallest -o smallest.npz --shard 2/2
run 2 merge smallest.npz
complains "no network up to 256 wide comes within 0.1 m/s"
equal "scores of all widths" "$(cat out)" "$(cat whole.out)"
equal "widths" "$(grep -c wide out)" 8

# The merge reads the launches: without a piece it does not train.
cd shards || exit 1
rm net.npz net.npz.shards/0000/0000002
run 1 merge net.npz
complains "1 of 5 pieces are missing: launches by momentum 58-115"
[ -e net.npz ] && fail "trained without all pieces"
run 0 train $scene_net --rounds 2 -o net.npz --shard 1/3
run 0 train $scene_net --rounds 2 -o net.npz --shard 2/3
run 0 train $scene_net --rounds 2 -o net.npz --shard 3/3
OMP_NUM_THREADS=1 run 0 merge net.npz
cmp -s net.npz ../whole/net.npz || fail "a repeated merge gives another network"

# From another folder, and by another name of the file, the network is the same: it stores the command.
for name in "$PWD/net.npz" ../shards/net.npz; do
    rm net.npz
    (cd ../whole && "$twinbox" merge "$name") >out 2>err || fail "no merge of $name: $(cat err)"
    cmp -s net.npz ../whole/net.npz || fail "the merge of $name gives another network"
done
rm net.npz
run 0 merge ./net.npz
cmp -s net.npz ../whole/net.npz || fail "the merge of ./net.npz gives another network"
cp -r net.npz.shards moved.npz.shards
run 0 merge moved.npz
says " parameters -> moved.npz"

# A shard that was killed continues.
large="--kind scene-net ../stack.yaml --launches 1200 --iterations 1 --rounds 1 --width 16 -o killed.npz"
kill_shard killed.npz.shards/0000 train $large --shard 1/2
run 0 train $large --shard 1/2
says ", $kept of them done before -> killed.npz.shards"

# Refused.
run 2 train $scene_net --rounds 2 -o net.npz
complains "run.json: error: belongs to shards of a study: merge them (twinbox merge net.npz), or delete the folder"
run 2 train $scene_net --rounds 2 -o net.npz --shard 1/2
complains "the study was begun in 3 shards, and this is one of 2"
run 2 train $scene_net --rounds 1 -o net.npz --shard 1/3
complains "another study: an argument is 2 there, 1 here"
run 2 train $scene_net --rounds 1 -o - --shard 1/2
complains "shards need the name of a file"
run 2 train --kind sain ../stack.yaml -o sain.npz --shard 1/2
complains "--shard: error: is an option of scene-net, not of sain"
cp -r net.npz.shards other.npz.shards
sed -i 's/"scene-net"/"sain"/; s/--iterations/--steps/; s/"--width", "16", //' other.npz.shards/run.json
run 2 merge other.npz
complains "--kind: error: sain has no shards that could be merged"
run 2 train $scene_net --width 17 -o odd.npz --shard 1/2
equal "pieces of refused options" "$(echo odd.npz*)" "odd.npz*"
SLURM_ARRAY_TASK_ID=2 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=4 run 0 train $scene_net --rounds 1 -o array.npz
complains "note: shard 2 of 4, by SLURM_ARRAY_TASK_ID=2 of 1-4:1; --shard 1/1 does all"
cd .. || exit 1
finish
