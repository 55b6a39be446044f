#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Datasets in pieces: shards and their merge give the file of one process; a recording that was cut off continues.
. "$(dirname "$0")/checks.sh"

# same NAME OPTION...: three shards and a merge give what one process writes, and what it writes from memory.
same() {
    local name=$1
    shift
    OMP_NUM_THREADS=3 run 0 dataset "$@" -o "$name-whole.npz"
    cp out whole.out
    equal "pieces that stay, $name" "$(echo "$name"-whole.npz*)" "$name-whole.npz"
    for shard in 2 3 1; do run 0 dataset "$@" -o "$name.npz" --shard $shard/3; done
    [ -e "$name.npz" ] && fail "a shard wrote $name.npz"
    run 0 merge "$name.npz"
    equal "rows of $name" "$(sed "s/-whole//" whole.out)" "$(cat out)"
    cmp -s "$name.npz" "$name-whole.npz" || fail "$name: the merge writes another file"
    "$twinbox" dataset "$@" -o - 2>err >memory.npz || fail "$name: nothing on standard output: $(cat err)"
    cmp -s "$name.npz" memory.npz || fail "$name: another file on standard output"
}
sed 's/^frames: .*/frames: 150/' "$scenes/single.yaml" >single.yaml
sed '/networks:/,$d; s/^frames: .*/frames: 150/' "$scenes/stack.yaml" >stack.yaml
printf 'x,spin\n-2,1\n-1,0\n0.3,2\n1,0\n2,-1\n4,0\n' >launches.csv
few=--bomb-x=-5:5:0.4
! brief || few=--bomb-x=-5:5:2
same pair single.yaml stack.yaml $few --context --random 6
! brief || finish
same net stack.yaml $few --target net --inputs raw --labels reference
same wedge "$sources/tests/methods/scenes/wedge_launches.yaml" --bomb-x=20:40:2 --labels reference
grep -Eq "^    steps left out, as the reference does not converge: [1-9]" out || fail "unconverged labels: $(cat out)"
same impulse stack.yaml $few --target impulse --inputs raw-unturned
same points stack.yaml $few --target points --inputs neighbours --seed 5
same table single.yaml stack.yaml --launches launches.csv --inputs contact

# Twice the same shard, and a merge from another folder.
run 0 dataset stack.yaml $few --target impulse --inputs raw-unturned -o impulse.npz --shard 2/3
says " pieces, "
mkdir elsewhere
(cd elsewhere && rm ../impulse.npz && "$twinbox" merge ../impulse.npz) >out 2>err || fail "no merge elsewhere: $(cat err)"
cmp -s impulse.npz impulse-whole.npz || fail "the merge from another folder writes another file"

# Into a pipe.
mkfifo pipe.npz
cp -r impulse.npz.shards pipe.npz.shards
cat pipe.npz >piped.npz &
run 0 merge pipe.npz
wait $!
cmp -s piped.npz impulse-whole.npz || fail "the merge writes another file into a pipe"

# Killed: what was done before stays.
pyramid="$scenes/pyramid.yaml --bomb-x=-5:5:0.5"
kill_shard killed.npz.shards/0000 dataset $pyramid -o killed.npz --shard 1/2
run 1 merge killed.npz
complains "killed.npz.shards: error: "
complains " pieces are missing: launches "
equal "shards to run again" "$(cat out)" --array=1-2
[ -e killed.npz ] && fail "a merge that misses pieces wrote a file"
run 0 dataset $pyramid -o killed.npz --shard 2/2
run 0 dataset $pyramid -o killed.npz --shard 1/2
says ", $kept of them done before -> killed.npz.shards"
run 0 merge killed.npz
run 0 dataset $pyramid -o whole.npz
cmp -s killed.npz whole.npz || fail "killed shards give another file"

# A whole recording that is interrupted continues, too.
strike INT 130 "ls part.npz.parts-*/0000/*" dataset $pyramid -o part.npz
complains "stopped; finished pieces are kept"
pieces=$(find part.npz.parts-* -type f | wc -l)
[ "$pieces" -ge 1 ] || fail "no piece was kept"
run 0 dataset $pyramid -o part.npz
cmp -s part.npz whole.npz || fail "an interrupted recording ends with another file"
equal "pieces that stay" "$(echo part.npz*)" part.npz

# The memory of a merge, and of a shard, does not grow with the rows.
limit() { (ulimit -v 60000 && OMP_NUM_THREADS=1 "$twinbox" "$@" >out 2>err </dev/null); }
limit dataset $pyramid --context -o - && fail "the rows fit into the limit: it proves nothing"
for shard in 1 2; do
    limit dataset $pyramid --context -o large.npz --shard $shard/2 || fail "a shard needs more memory: $(cat err)"
done
limit merge large.npz || fail "the merge needs more memory: $(cat err)"
[ -s large.npz ] || fail "the merge wrote nothing"

# Without rows nothing is written, and nothing stays.
sed 's/^frames: .*/frames: 2/' single.yaml >short.yaml
sed -i '/^bodies:/,/^$/s/position: \[0, -10\]/position: [0, -50]/' short.yaml
run 2 dataset short.yaml $few -o short.npz
complains "no two bodies touched in any launch"
equal "files without rows" "$(echo short.npz*)" "short.npz*"

# Refused.
run 2 dataset single.yaml stack.yaml $few --context --random 6 -o pair.npz --shard 1/4
complains "the study was begun in 3 shards, and this is one of 4"
run 2 dataset single.yaml stack.yaml $few --context --random 7 -o pair.npz --shard 1/3
complains "another study: an argument is 6 there, 7 here"
run 2 dataset single.yaml stack.yaml $few --context --random 6 -o pair.npz
complains "run.json: error: belongs to shards of a study: merge them (twinbox merge pair.npz)"
run 2 dataset single.yaml -o - --shard 1/2
complains "shards need the name of a file"
"$twinbox" dataset - -o input.npz --shard 1/2 <single.yaml >out 2>err && fail "a shard reads standard input"
complains "--shard: error: a merge cannot read standard input again"
equal "pieces of standard input" "$(echo input.npz*)" "input.npz*"
run 2 dataset single.yaml --target impulse --labels reference -o no.npz --shard 1/2
equal "pieces of refused options" "$(echo no.npz*)" "no.npz*"
echo "5,5" >>launches.csv
run 2 merge table.npz
complains "another study: the hash of the input launches.csv is "
run 0 dataset single.yaml $few -o empty.npz --shard 1/2
run 0 dataset single.yaml $few -o empty.npz --shard 2/2
truncate -s -4 empty.npz.shards/0000/0000000
run 2 merge empty.npz
complains "empty.npz.shards/0000/0000000: error: is damaged or cut off"
finish
