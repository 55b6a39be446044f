#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A film drawn in shards and merged: the same files as the whole, also after kills; what differs is refused.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" -o engine.npz
film="engine.npz $scenes/stack.yaml --size 128x72 --show ghosts,timeline --frames 0:99"
videos="--video film.gif"
run 0 render $film $videos -o whole
mkdir own
mv film.gif own
last=$(ls whole | grep -c png)
[ "$last" -gt 96 ] || fail "the film has only $last pictures"

# same WHAT FOLDER: the folder and the videos are as those of the whole.
same() {
    checks=$((checks + 1))
    diff -r -x shards whole "$2" >difference || fail "$1: $(head -3 difference)"
    cmp own/film.gif film.gif || fail "$1: another video"
}

# Each shard writes frames and its pieces, and nothing else.
for i in 1 2 3; do
    run 0 render $film $videos -o shards --shard $i/3
    says "shard $i of 3: "
    says "twinbox merge shards"
    equal "files beside the frames" "$(ls shards | grep -v '^frame_.*png$')" shards
    [ -e film.gif ] && fail "a shard has written a video"
    [ $i = 3 ] && break
    run 1 merge shards
    complains "pieces are missing: pictures "
    equal "other files after a merge that misses pieces" "$(ls shards | grep -v '^frame_.*png$')" shards
done
run 0 merge shards
same "three shards" shards
! brief || finish
rm film.*
run 0 merge shards
same "a second merge" shards

# The shards of a job array, and a merge of a video to standard output from another folder.
for task in 10 12; do
    SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_MIN=10 SLURM_ARRAY_TASK_MAX=12 SLURM_ARRAY_TASK_STEP=2 \
        run 0 render $film --video - -o array
    complains "shard $((task / 2 - 4)) of 2, by SLURM_ARRAY_TASK_ID=$task"
done
(cd own && "$twinbox" merge ../array >../array.y4m 2>../err </dev/null) || fail "merge: $(cat err)"
"$twinbox" render $film --video - -o streamed >whole.y4m 2>err </dev/null
cmp whole.y4m array.y4m || fail "another video at standard output"
diff -r -x shards whole array >difference || fail "array: $(head -3 difference)"

# A frame that is altered or gone is missing, and drawn again by its shard; so is what a cut video had of it.
cp whole/frame_000040.png shards/frame_000039.png
rm shards/frame_000001.png shards/manifest.json
run 1 merge shards
complains "2 of "
complains "pieces are missing: pictures 0-31, pictures 32-63; run their shards (of 3) again: --array="
array=$(sed -n 's/^--array=//p' out)
equal "a manifest of frames that are missing" "$(ls shards/manifest.json 2>/dev/null)" ""
for i in $(echo "$array" | sed 's/-/ /; s/,/ /'); do run 0 render $film $videos -o shards --shard "$i/3"; done
run 0 merge shards
same "frames that were drawn again" shards

# Killed at any time, twice at the same time in one folder: the same.
for delay in 0.05 0.12 0.2; do
    for i in 1 2; do
        "$twinbox" render $film $videos -o killed --shard $i/2 >/dev/null 2>&1 </dev/null &
        eval "process$i=$!"
    done
    sleep $delay
    kill -KILL $process1 $process2
    wait $process1 $process2 2>/dev/null
done
for i in 1 2 2; do "$twinbox" render $film $videos -o killed --shard $i/2 >/dev/null 2>>killed.err </dev/null & done
wait
equal "errors of shards that draw at the same time" "$(grep -v drawing killed.err)" ""
run 0 merge killed
same "killed shards" killed

# An earlier sequence in the folder: a shard that is refused does it no harm, and the merge removes what remains of it.
mkdir refused
cp -r whole/* refused
run 2 render $film -o refused --shard 0/3
complains "I must be from 1 to N"
run 2 render - -o refused --shard 1/3
complains "cannot read standard input again"
run 2 render $film --video film.avi -o refused --shard 1/3
complains "must end in .mp4, .webm or .gif"
diff -r whole refused >difference || fail "refused: $(head -3 difference)"
run 0 render engine.npz --size 128x72 -o refused
run 0 render $film --frames 0:69 -o part
for i in 1 2; do run 0 render $film --frames 0:69 -o refused --shard $i/2; done
run 0 merge refused
diff -r -x shards -x "frame_*" part refused >difference || fail "over an earlier film: $(head -3 difference)"
complains "refused also has "
rm -r refused/shards
run 0 render engine.npz --size 128x72 -o refused
for i in 1 2; do run 0 render engine.npz --size 128x72 --fps 15 -o refused --shard $i/2; done
run 0 merge refused
run 0 render engine.npz --size 128x72 --fps 15 -o slow
diff -r -x shards -x "stack-*" slow refused >difference || fail "over a longer film: $(head -3 difference)"

# Other pictures, inputs or numbers are refused, and so is the whole where shards are.
cp -r shards before
run 2 render $film $videos --theme dark -o shards --shard 1/3
complains "an argument is "
run 2 render $film $videos -o shards --shard 1/4
complains "the study was begun in 3 shards"
run 2 render $film --video other.mp4 -o shards --shard 1/3
complains "shards of another study"
run 2 render $film $videos -o shards
complains "belongs to shards of a study: merge them (twinbox merge shards)"
diff -r before shards >difference || fail "what was refused has changed: $(head -3 difference)"
run 0 simulate "$scenes/stack.yaml" --method momentum:k=20 -o engine.npz
run 2 render $film $videos -o shards --shard 1/3
complains "the hash of the input engine.npz"
run 2 merge shards
complains "the hash of the input engine.npz"
run 0 simulate "$scenes/stack.yaml" -o engine.npz

# A file that no one knows is not overwritten; a damaged piece is named.
mkdir foreign
echo mine >foreign/manifest.json
run 2 render $film -o foreign --shard 1/2
complains "is not a manifest of twinbox"
equal "files" "$(ls foreign)" manifest.json
truncate -s 100 shards/shards/0000/0000002
run 2 merge shards
complains "0000002: error: is damaged or cut off"
finish
