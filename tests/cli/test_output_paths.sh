#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Output paths are checked before the work: what cannot be written is refused while nothing has been printed or read.
. "$(dirname "$0")/checks.sh"

sed 's/^frames:.*/frames: 60/' "$scenes/single.yaml" >single.yaml
sed '/scene-net:/d; s/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stack.yaml
run 0 dataset single.yaml -o pairs.npz --bomb-x=-2:2:1
run 0 simulate single.yaml -o run.npz
run 0 train pairs.npz --iterations 1 -o pair.npz
cp run.npz run.kept
cp pair.npz pair.kept
echo text >notes.npz
mkdir folder.npz

# refused STATUS MESSAGE ARGUMENT...: nothing on standard output.
refused() {
    local status=$1 message=$2
    shift 2
    run "$status" "$@"
    complains "$message"
    equal "output of $*" "$(<out)" ""
}
trainings=("pairs.npz" "--kind scene-net stack.yaml" "--kind sain stack.yaml" "--kind hybrid stack.yaml" "--kind gns")
for training in "${trainings[@]}"; do
    refused 3 "nowhere/x.npz: error: cannot write: its folder does not exist" train $training -o nowhere/x.npz
    refused 3 "/proc/x.npz: error: cannot write: nothing new can be made there" train $training -o /proc/x.npz
    refused 2 "x.txt: error: the name must end in .npz" train $training -o x.txt
    refused 2 "folder.npz: error: is a folder" train $training -o folder.npz
    refused 2 "run.npz: error: holds a file of kind 'run', which a file of kind '" train $training -o run.npz
    refused 2 "pairs.npz: error: holds a file of kind 'dataset'" train $training -o pairs.npz
    refused 2 "notes.npz: error: holds a file of kind 'unknown'" train $training -o notes.npz
done
refused 2 "pair.npz: error: holds a file of kind 'network', which a file of kind 'scene-net' does not replace" \
    train --kind scene-net stack.yaml -o pair.npz
refused 3 "nowhere/x.npz: error: cannot write" dataset stack.yaml -o nowhere/x.npz
refused 2 "x.csv: error: the name must end in .npz" dataset stack.yaml -o x.csv
refused 2 "run.npz: error: holds a file of kind 'run', which a file of kind 'dataset'" dataset stack.yaml -o run.npz
refused 2 "pair.npz: error: holds a file of kind 'network', which a file of kind 'run'" simulate stack.yaml -o pair.npz
refused 3 "nowhere/x.npz: error: cannot write" simulate stack.yaml -o nowhere/x.npz
refused 3 "nowhere/x.csv: error: cannot write" simulate stack.yaml -o nowhere/x.csv
refused 3 "nowhere/x.html: error: cannot write" page stack.yaml -o nowhere/x.html
refused 2 "x.txt: error: the name must end in .html" page run.npz -o x.txt
refused 2 "run.npz: error: the name must end in .html" page run.npz -o run.npz
refused 3 "nowhere/hash: error: cannot write" simulate stack.yaml --hash nowhere/hash
refused 3 "nowhere/v.json: error: cannot write" simulate stack.yaml --verdict nowhere/v.json
refused 2 "pair.npz: error: holds a file of kind 'network'" solve stack.yaml --frame 41 -o pair.npz
for study in "chart stack.yaml" stability "stability $scenes/stability/friction_ramp.yaml --vary slope" paper; do
    refused 3 "cannot write" $study -o /proc/none
    refused 2 "run.npz: error: is the name of a file; expected that of a folder, such as run" $study -o run.npz
    refused 3 "run.npz/out: error: cannot write: a part of the path is not a folder" $study -o run.npz/out
done
cmp -s run.npz run.kept || fail "a run was overwritten"
cmp -s pair.npz pair.kept || fail "a network was overwritten"
equal "files left" "$(echo $(ls -A))" \
    "err folder.npz notes.npz out pair.kept pair.npz pairs.npz run.kept run.npz single.yaml stack.yaml"

refused 3 "/proc/out: error: cannot make this folder: nothing new can be made there" render run.npz -o /proc/out
refused 3 "/proc/x.pdf: error: cannot write: nothing new can be made there" figure strip run.npz -o /proc/x.pdf
refused 3 "nowhere/x.json: error: cannot write: its folder does not exist" export run.npz -o nowhere/x.json

# A file of the same kind is replaced, an empty one too; devices and links to files are written through.
run 0 train pairs.npz --iterations 2 -o pair.npz
: >empty.npz
run 0 train pairs.npz --iterations 1 -o empty.npz
run 0 simulate single.yaml -o run.npz
run 0 simulate single.yaml --hash /dev/null
run 0 simulate single.yaml -o deep.npz --hash /dev/stdout
says "frame,hash"
finish
