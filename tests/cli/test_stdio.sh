#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# "-" wherever one file is read or written: the same result as with the name of a file. One table for each direction.
. "$(dirname "$0")/checks.sh"

# A scene from standard input has the name stdin.
sed 's/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stdin.yaml
cp -r "$scenes/networks" networks
run 0 simulate stdin.yaml --frames 60 -o run.npz
run 0 simulate stdin.yaml --frames 60 --method momentum:k=3 -o other.npz
run 0 export run.npz -o run.csv
sed '/^#/d' run.csv >bare.csv
sed -n 's/^# size: //p' run.csv | { echo body,width,height,static; sed 's/static$/1/; s/dynamic$/0/'; } >sizes.csv
printf 'x,rotation,spin\n' >launches.csv
for x in -2 -1 0 1 2; do echo $x,0.7,0 >>launches.csv; done
run 0 dataset stdin.yaml --launches launches.csv -o pairs.npz
run 0 train pairs.npz --iterations 5 -o net.npz

# What a command writes or prints, without the name of the input.
result() {
    sed "s/(\(-\|$1\))/(FILE)/; s/^- /$1 /" out
    [ ! -e product ] || cat product/* 2>/dev/null | cksum
}

# Options and arguments that are read: command, @ where the file stands, and the file. OUT is what it writes.
while IFS='|' read -r command file; do
    rm -rf product OUT.*
    mkdir product
    run 0 ${command//@/$file} </dev/null
    mv OUT.* product/ 2>/dev/null
    expected=$(result $file)
    rm -rf product
    mkdir product
    "$twinbox" ${command//@/-} <$file >out 2>err || fail "$command with -: $(head -c 300 err)"
    mv OUT.* product/ 2>/dev/null
    equal "$command" "$(result $file)" "$expected"
done <<'TABLE'
simulate @ --frames 20 -o OUT.csv|stdin.yaml
solve @ --frame 41 -o OUT.npz -m engine|stdin.yaml
dataset stdin.yaml --launches @ -o OUT.npz|launches.csv
compare run.npz @ --tolerance 100|other.npz
export @ -o OUT.csv|run.npz
import @ -o OUT.npz|run.csv
import bare.csv --sizes @ --dt 1/60 -o OUT.npz|sizes.csv
figure strip @ --moments 2 -o OUT.svg|run.npz
figure strip run.npz --moments 2 --view-from @ -o OUT.svg|other.npz
TABLE
"$twinbox" train pairs.npz --iterations 5 --from - -o more.npz <net.npz >out 2>err || fail "train --from -: $(head -c 300 err)"
run 0 render run.npz --frames 0:1 --size 320x180 -o frames
"$twinbox" render - --frames 0:1 --size 320x180 -o frames_run <run.npz >out 2>err || fail "render a run from -"
cmp -s frames/frame_000001.png frames_run/frame_000001.png || fail "render - draws another frame"

# A page names the file of its run, so that the command it copies finds it.
"$twinbox" page - -o - <run.npz 2>err | grep -q "^<title>Stdin: engine" || fail "page - -o -: $(head -c 300 err)"

# Long studies read their scene in the same way: a wrong one is refused with its place.
for command in "chart - -o study" "stability - -o study --vary height" "check -"; do
    echo "gravity: [0]" | "$twinbox" $command >out 2>err
    equal "status of $command" $? 2
    complains "-:1:"
done

# Options and arguments that are written. All that is printed otherwise goes to standard error.
while IFS='|' read -r command file; do
    run 0 ${command//@/$file}
    "$twinbox" ${command//@/-} >written 2>err </dev/null || fail "$command to -: $(head -c 300 err)"
    cmp -s written $file || fail "$command: - is not what $file holds"
    checks=$((checks + 1))
done <<'TABLE'
simulate stdin.yaml --frames 20 -o @|a.npz
simulate stdin.yaml --frames 20 --verdict @|a.json
export run.npz -o @|b.csv
figure strip run.npz --moments 2 -o @|a.svg
page run.npz other.npz -o @|a.html
check stdin.yaml -o @|a.png
new @ --like wall|wall.yaml
TABLE
"$twinbox" simulate stdin.yaml --frames 20 -o - 2>err >written
complains "stdin by engine: 20 steps"

# A pipe of three.
"$twinbox" simulate - --frames 20 -o - <stdin.yaml 2>err | "$twinbox" export - -o - 2>err | "$twinbox" import - -o - 2>err |
    "$twinbox" compare - a.npz >out 2>err || fail "a pipe: $(head -c 300 err)"
says "equal: 21 frames"

# Once only, and no binary data on a terminal.
run 2 compare - - <run.npz
complains "-: error: only one file can be read from standard input"
run 2 simulate stdin.yaml -o - --hash -
complains "-: error: only one file can be written to standard output"
run 2 simulate stdin.yaml -o - --json
complains "--json: error: cannot be combined with a file written to standard output"
"$twinbox" simulate stdin.yaml --frames 5 -o - >/dev/full 2>err
equal "status where standard output is full" $? 3
script -qec "'$twinbox' simulate stdin.yaml --frames 5 -o - 2>err" /dev/null >terminal
complains "binary data cannot go to a terminal"

finish
