#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Shards of a stability study: merged, they give the files of one process; what does not belong together is refused. (Shares,
# environments, and what a merge waits for: tests/runs/test_shard.c, test_pieces.c. Kills: tests/cluster.)
. "$(dirname "$0")/checks.sh"

few="--scenes $scenes --study bomb_speed --study friction_ramp --study speed_thickness --methods engine:k=4,momentum,scene-net"
run 0 stability $few -o whole
same_as_whole() {
    equal "files of $1" "$(echo $(ls "$1"))" "$(echo $( (ls whole && echo shards) | sort))"
    for file in whole/*; do
        cmp -s "$file" "$1/${file#*/}" || fail "$1: another ${file#*/}"
    done
}

# Three shards, by option and by the environment; a merge before the last one names what is missing and writes nothing.
run 0 stability $few -o three --shard 1/3
says "when all shards are done: twinbox merge three"
SLURM_PROCID=2 SLURM_NTASKS=3 run 0 stability $few -o three
says "shard 3 of 3"
run 1 merge three
complains "pieces are missing: "
complains "run their shards (of 3) again: --array=2"
equal "what sbatch needs" "$(cat out)" --array=2
equal "files before all shards are done" "$(echo three/*)" three/shards
run 0 stability $few -o three --shard 2/3
run 0 merge three
same_as_whole three
! brief || finish

# Again, and from another folder.
mkdir elsewhere
(cd elsewhere && rm ../three/maps.csv && "$twinbox" merge ../three) >out 2>err || fail "no merge from another folder: $(cat err)"
same_as_whole three
# A job array: a retried task has other bounds, and none of another array is taken.
task() {
    SLURM_ARRAY_TASK_ID=$1 SLURM_ARRAY_TASK_MIN=$2 SLURM_ARRAY_TASK_MAX=$3 SLURM_ARRAY_TASK_STEP=$4 \
        run "$5" stability $few -o array
}
task 10 10 14 2 0
complains "shard 1 of 3, by SLURM_ARRAY_TASK_ID=10 of 10-14:2"
task 14 10 14 2 0
run 1 merge array
equal "the task that is missing" "$(cat out)" --array=12
task 12 12 12 1 0
run 0 merge array
same_as_whole array
task 13 10 14 1 2
complains "run.json: error: the study was begun by the job array 10-14:2, which has no task 13"
SLURM_ARRAY_TASK_ID=3 run 0 stability $few -o all --shard 1/1
equal "files of --shard 1/1" "$(echo $(ls all))" "$(echo $(ls whole))"

# Refused before any work: another study, other inputs, damaged files.
refused() { unchanged three "$@"; }
refused "an argument is --methods there, --quick here" \
    stability --scenes "$scenes" --study bomb_speed --study friction_ramp --study speed_thickness --quick \
    --methods engine:k=4,momentum,scene-net -o three --shard 1/3
refused "run.json: error: belongs to shards of a study" stability $few -o three
cp "$scenes/stability/bomb_speed.yaml" own.yaml
vary="own.yaml --vary speed --quick --methods engine,nncg -o vary"
run 0 stability $vary --shard 1/2
sed -i 's/^frames: .*/frames: 100/' own.yaml
for command in "stability $vary --shard 2/2" "merge vary"; do unchanged vary "the hash of the input own.yaml is " $command; done
piece=three/shards/0000/0000001
cp $piece piece
truncate -s -3 $piece
refused "$piece: error: is damaged or cut off" merge three
cp piece $piece && sed -i 's/^key .*/key 0123456789abcdef/' $piece
refused "$piece: error: is a piece of another study" merge three
cp three/shards/0000/0000000 $piece
refused "$piece: error: is the piece 'friction_ramp 1-3', not 'bomb_speed 1-3'" merge three
cp piece $piece
cp three/shards/run.json record
while IFS='|' read -r words edit; do
    sed "$edit" record >three/shards/run.json
    cmp -s record three/shards/run.json && fail "the edit $edit changes nothing"
    refused "three/shards/run.json: error: $words" merge three
done <<'END'
the folder has shards of another study: the version of twinbox is 0.0|s/"version": "[^"]*"/"version": "0.0"/
the folder has shards of another study: the hash of the program is abcdef|s/"program": "....../"program": "abcdef/
the folder has shards of another study: the hash of options and inputs is abcdef|s/"key": "....../"key": "abcdef/
has been changed since the first shard wrote it|s/"shards": 3/"shards": 4/
has been changed since the first shard wrote it|s/"array_step": 0/"array_step": 1/
END
cp record three/shards/run.json
run 0 merge three
same_as_whole three
finish
