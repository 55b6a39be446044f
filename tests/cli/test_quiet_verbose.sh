#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# -q and -v in every command: status and errors stay; notes and progress go, or what was done is added. With -q, results stay
# that go to no file.
. "$(dirname "$0")/checks.sh"

ln -s "$scenes" scenes
run 0 simulate scenes/single.yaml -o engine.npz
run 0 simulate scenes/single.yaml --method momentum:k=3 -o momentum.npz
run 0 dataset scenes/single.yaml --bomb-x 0:1:0.25 -o data.npz
run 0 export engine.npz -o engine.csv
run 0 render engine.npz --frames 0:1 --size 64x64 -o expected
run 0 render momentum.npz --frames 0:1 --size 64x64 -o actual

# COMMAND STATUS ARGUMENT...: one line for each command; what is written goes to out_of_COMMAND.
lines="new 0 out_of_new.yaml --like wall
check 0 scenes/single.yaml -o out_of_check.png
simulate 0 scenes/single.yaml -o out_of_simulate.npz
render 0 engine.npz --frames 0:1 --size 64x64 -o out_of_render
page 0 engine.npz momentum.npz -o out_of_page.html
compare 1 expected actual --report out_of_compare
approve 0 out_of_compare
figure 0 strip engine.npz --at 0,1 -o out_of_figure.svg
import 0 engine.csv -o out_of_import.npz
export 0 engine.npz -o out_of_export.json
dataset 0 scenes/single.yaml --bomb-x 0:1:0.25 -o out_of_dataset.npz
train 0 data.npz -o out_of_train.npz --layers 10-10-2 --iterations 2
chart 0 scenes/single.yaml --quick --launches scenes/launches/far.csv --methods engine -o out_of_chart
paper 3 -o /proc/none --quick
stability 0 --study bomb_speed --methods engine:k=4 -o out_of_stability
solve 0 scenes/stack.yaml --frame 41 -o out_of_solve.npz -m engine
methods 0"

for name in $("$twinbox" --help | awk '/^  [a-z]/ { print $1 }'); do
    run 0 "$name" --help
    says "-q, --quiet"
    says "-v, --verbose"
    read -r _ status arguments < <(grep "^$name " <<<"$lines") || fail "$name has no line in this test"
    [ "$name" = approve ] && cp -r expected kept
    for level in "" -q --verbose; do
        [ "$level" = -q ] && sanitized && continue
        rm -rf out_of_"$name"*
        [ "$name" = approve ] && rm -rf expected && cp -r kept expected
        run "$status" "$name" $level $arguments
        [ "$level" ] || { grep -v " s[,)]" out >normal; continue; }
        [[ $level = -q && " $arguments" =~ " -o "|--like && "$status" -lt 2 ]] && wanted=/dev/null || wanted=normal
        grep -v " s[,)]" out | diff $wanted - >difference || fail "$name $level prints other results: $(<difference)"
        case $level in
        *q*) [ "$status" -lt 2 ] && equal "what $name $level prints besides" "$(<err)" "" ;;
        *v*)
            equal "how $name $level begins" "$(head -1 err | cut -d, -f1)" "twinbox: twinbox $name"
            complains " s of processor time, at most "
            ;;
        esac
    done
    [ "$status" -lt 2 ] || complains "error:"
    run 2 "$name" -q -v
    complains "--quiet cannot be combined with --verbose"
done

# What each of them adds.
run 0 simulate -v "$scenes/stack.yaml" --method pair-net --frames 3 -o run.npz
complains "twinbox: read $scenes/stack.yaml, "
complains "twinbox: scene stack: 11 bodies and a bomb, "
complains "twinbox: read $scenes/networks/pair-net.npz, "
complains "twinbox: method pair-net:k=10,network="
complains "twinbox: wrote run.npz, $(stat -c %s run.npz) bytes"
grep -Eq "^twinbox: twinbox simulate, version [0-9.]+, [0-9]+ threads?, (scalar|avx2|avx512) instructions$" err ||
    fail "no version, threads and instruction set: $(<err)"

# -q leaves what is asked for: JSON, data on standard output, what the run without a file was for, and errors.
run 0 check -q scenes/single.yaml
equal "what check -q prints" "$(cat out err)" ""
run 0 check -q --json scenes/single.yaml
says '"format": "twinbox check 1"'
run 0 simulate -q scenes/single.yaml --frames 2
says "verdict: "
run 2 simulate -q "$scenes/stack.yaml" --method interor
complains "did you mean 'interior'?"
finish
