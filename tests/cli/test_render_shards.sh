#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A film drawn in shards and merged: the same files as the whole; what differs is refused. (Kills: tests/cluster.)
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

# The shards of a job array, and a merge of a video to standard output from another folder.
for task in 10 12; do
    SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_MIN=10 SLURM_ARRAY_TASK_MAX=12 SLURM_ARRAY_TASK_STEP=2 \
        run 0 render $film --video - -o array
done
(cd own && "$twinbox" merge ../array >../array.y4m 2>../err </dev/null) || fail "merge: $(cat err)"
"$twinbox" render $film --video - -o streamed >whole.y4m 2>err </dev/null
cmp whole.y4m array.y4m || fail "another video at standard output"
diff -r -x shards whole array >difference || fail "array: $(head -3 difference)"

# A frame that is altered or gone is missing, and drawn again by its shard; so is what a cut video had of it.
cp whole/frame_000040.png shards/frame_000039.png
rm shards/frame_000001.png shards/manifest.json
run 1 merge shards
complains "pieces are missing: pictures 0-31, pictures 32-63; run their shards (of 3) again: --array="
array=$(sed -n 's/^--array=//p' out)
for i in $(echo "$array" | sed 's/-/ /; s/,/ /'); do run 0 render $film $videos -o shards --shard "$i/3"; done
run 0 merge shards
same "frames that were drawn again" shards

# Over an earlier, longer sequence in the folder: the merge removes what remains of it.
run 0 render engine.npz --size 128x72 -o over
run 0 render $film --frames 0:69 -o part
for i in 1 2; do run 0 render $film --frames 0:69 -o over --shard $i/2; done
run 0 merge over
diff -r -x shards -x "frame_*" part over >difference || fail "over an earlier film: $(head -3 difference)"
complains "over also has "

# Other pictures, inputs or numbers are refused, and so is the whole where shards are.
unchanged shards "an argument is " render $film $videos --theme dark -o shards --shard 1/3
unchanged shards "begun in 3 shards" render $film $videos -o shards --shard 1/4
unchanged shards "shards of another study" render $film --video other.mp4 -o shards --shard 1/3
unchanged shards "belongs to shards of a study" render $film $videos -o shards
unchanged shards "cannot read standard input again" render - -o shards --shard 1/3
run 0 simulate "$scenes/stack.yaml" --method momentum:k=20 -o engine.npz
unchanged shards "the hash of the input engine.npz" render $film $videos -o shards --shard 1/3
unchanged shards "the hash of the input engine.npz" merge shards
run 0 simulate "$scenes/stack.yaml" -o engine.npz

# A file that no one knows is not overwritten; a damaged piece is named.
mkdir foreign
echo mine >foreign/manifest.json
unchanged foreign "is not a manifest" render $film -o foreign --shard 1/2
truncate -s 100 shards/shards/0000/0000002
unchanged shards "0000002: error: is damaged" merge shards
finish
