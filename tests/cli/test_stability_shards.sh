#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Shards of a stability study: merged, they give the files of one process; what does not belong together is refused.
. "$(dirname "$0")/checks.sh"

few="--scenes $scenes --study bomb_speed --study friction_ramp --study speed_thickness --methods engine:k=4,momentum,scene-net"
run 0 stability $few -o whole
same_as_whole() {
    equal "files of $1" "$(echo $(ls "$1"))" "$(echo $( (ls whole && echo shards) | sort))"
    for file in whole/*; do
        cmp -s "$file" "$1/${file#*/}" || fail "$1: another ${file#*/}"
    done
}

# Three shards; a merge before the last one names what is missing and writes nothing.
run 0 stability $few -o three --shard 1/3
says "when all shards are done: twinbox merge three"
run 0 stability $few -o three --shard 3/3
equal "files of shards" "$(echo three/*)" three/shards
run 1 merge three
complains "pieces are missing: "
complains "run their shards (of 3) again: --array=2"
equal "what sbatch needs" "$(cat out)" --array=2
equal "files before all shards are done" "$(echo three/*)" three/shards
run 0 stability $few -o three --shard 2/3
run 0 merge three
same_as_whole three
run 0 merge three
same_as_whole three

! brief || finish

# From another folder, and twice the same shard.
run 0 stability $few -o three --shard 2/3
mkdir elsewhere
(cd elsewhere && rm ../three/maps.csv && "$twinbox" merge ../three) >out 2>err || fail "no merge from another folder: $(cat err)"
same_as_whole three

# The environment says what a task is to do; a retried array has other bounds.
task() {
    SLURM_ARRAY_TASK_ID=$1 SLURM_ARRAY_TASK_MIN=$2 SLURM_ARRAY_TASK_MAX=$3 SLURM_ARRAY_TASK_STEP=$4 \
        run "$5" stability $few -o array
}
task 10 10 14 2 0
complains "note: shard 1 of 3, by SLURM_ARRAY_TASK_ID=10 of 10-14:2; --shard 1/1 does all"
task 14 10 14 2 0
run 1 merge array
equal "the task that is missing" "$(cat out)" --array=12
task 12 12 12 1 0
says "shard 2 of 3: "
run 0 merge array
same_as_whole array
task 13 10 14 1 2
complains "run.json: error: the study was begun by the job array 10-14:2, which has no task 13"
PMI_RANK=1 PMI_SIZE=2 run 0 stability $few -o ranks
says "shard 2 of 2"
OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2 run 0 stability $few -o ranks
says "shard 1 of 2"
run 0 merge ranks
same_as_whole ranks
SLURM_PROCID=2 SLURM_NTASKS=3 run 0 stability $few -o procs
says "shard 3 of 3"
SLURM_PROCID=0 SLURM_NTASKS=1 run 0 stability $few -o one
equal "files of one task" "$(echo $(ls one))" "$(echo $(ls whole))"
SLURM_ARRAY_TASK_ID=3 run 0 stability $few -o all --shard 1/1
equal "files of --shard 1/1" "$(echo $(ls all))" "$(echo $(ls whole))"
SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=4 PMI_RANK=0 PMI_SIZE=2 run 2 stability $few -o both
complains "this is a task of a job array, and one of 2 ranks (PMI_RANK)"
PMI_RANK=two PMI_SIZE=2 run 2 stability $few -o both
complains "PMI_RANK: error: 'two' in the environment is not a number from 0 to 1"

# Refused before any work.
refused() { unchanged three "$@"; }
refused "'0/3': I must be from 1 to N" stability $few -o three --shard 0/3
refused "'4/3': I must be from 1 to N" stability $few -o three --shard 4/3
refused "'1/0': N must be from 1 to 1000000" stability $few -o three --shard 1/0
refused "'1/1000001': N must be from 1 to 1000000" stability $few -o three --shard 1/1000001
refused "'3' is not I/N" stability $few -o three --shard 3
refused "'3/x' is not I/N" stability $few -o three --shard 3/x
refused "the study was begun in 3 shards, and this is one of 4" stability $few -o three --shard 1/4
refused "another study: an argument is --methods there, --quick here" \
    stability --scenes "$scenes" --study bomb_speed --study friction_ramp --study speed_thickness --quick \
    --methods engine:k=4,momentum,scene-net -o three --shard 1/3
refused "run.json: error: belongs to shards of a study: merge them (twinbox merge three), or delete the folder" \
    stability $few -o three
refused "whole: error: has no shards" merge whole

# Other inputs.
mkdir own && cp "$scenes/stability/bomb_speed.yaml" own/scene.yaml
vary="own/scene.yaml --vary speed --quick --methods engine,nncg -o vary"
run 0 stability $vary --shard 1/2
sed -i 's/^frames: .*/frames: 100/' own/scene.yaml
run 2 stability $vary --shard 2/2
complains "another study: the hash of the input own/scene.yaml is "
run 2 merge vary
complains "another study: the hash of the input own/scene.yaml is "

# Damaged files.
piece=three/shards/0000/0000001
cp $piece piece
truncate -s -3 $piece
refused "$piece: error: is damaged or cut off; delete it, and its shard does it again" merge three
cp piece $piece && sed -i 's/^key .*/key 0123456789abcdef/' $piece
refused "$piece: error: is a piece of another study (key 0123456789abcdef, not " merge three
cp three/shards/0000/0000000 $piece
refused "$piece: error: is the piece 'friction_ramp 1-3', not 'bomb_speed 1-3'" merge three
echo nothing >$piece
refused "$piece: error: is not a piece of a study; delete it" merge three
cp piece $piece
cp three/shards/run.json record
for edit in 's/"shards": 3/"shards": 1/' 's/twinbox shards 1/twinbox shards 2/' 's/"key": "./"key": "x/' '$d' 's/stability"/remove"/'; do
    sed "$edit" record >three/shards/run.json
    refused "three/shards/run.json" merge three
done
changed_record() { # WHAT EDIT
    sed "$2" record >three/shards/run.json
    cmp -s record three/shards/run.json && fail "the edit $2 changes nothing"
    refused "three/shards/run.json: error: $1" merge three
}
other="the folder has shards of another study:"
changed_record "$other the version of twinbox is 0.0 there" 's/"version": "[^"]*"/"version": "0.0"/'
changed_record "$other the hash of the program is abcdef" 's/"program": "....../"program": "abcdef/'
changed_record "$other the hash of the input " 's/\("file": .*"hash": "\)....../\1abcdef/'
changed_record "$other the hash of options and inputs is abcdef" 's/"key": "....../"key": "abcdef/'
changed_record "has been changed since the first shard wrote it" 's/"shards": 3/"shards": 4/'
changed_record "has been changed since the first shard wrote it" 's/"array_step": 0/"array_step": 1/'
cp record three/shards/run.json
run 0 merge three
same_as_whole three
finish
