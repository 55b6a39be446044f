#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare --watch: another comparison for every change, a new report each time, no end before Ctrl-C.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 8 --bomb-x 1 -o b.npz
run 0 render a.npz -o expected --size 80x64 --frames 0:2
run 0 render b.npz -o changed --size 80x64 --frames 0:2
cp -r expected actual

# seen COUNT TEXT: waits until the output has so many lines with this text.
seen() {
    for _ in $(seq 2400); do
        [ "$(cat watched watched.err | grep -cF -- "$2")" -ge "$1" ] && break
        sleep 0.05
    done
    equal "lines with '$2'" "$(cat watched watched.err | grep -cF -- "$2")" "$1"
}
# stopped STATUS: Ctrl-C ends the program with it.
stopped() {
    kill -INT $watching
    wait $watching
    equal "exit status after Ctrl-C" $? "$1"
}
watch() {
    : >watched # before the program begins: seen() must not read what an earlier one wrote
    : >watched.err
    "$twinbox" compare "$@" --watch >watched 2>watched.err </dev/null &
    watching=$!
}

watch expected actual --report report
seen 1 "watching expected and actual; Ctrl-C ends"
seen 1 "equal: 3 frames, 1 trajectory"
grep -q '"verdict": "equal"' report/results.json || fail "no report of equal pictures"
cp changed/* actual/
seen 2 "watching"
seen 1 "3 of 3 frames differ"
seen 1 "verdict: physics changed"
grep -q '"verdict": "physics changed"' report/results.json || fail "the report was not written again"
# Files that were touched but are equal: another comparison with the same result.
cp expected/* actual/
seen 3 "watching"
seen 2 "equal: 3 frames"
# The same size and the time of before, set back: the file is another one.
cp actual/frame_000001.png kept.png
/usr/bin/python3 - <<'PYTHON'
import os
path = "actual/frame_000001.png"
times = os.stat(path)
data = bytearray(open(path, "rb").read())
data[-20] ^= 1
open(path, "wb").write(data)
os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
PYTHON
seen 4 "watching"
seen 1 "actual/frame_000001.png: error:"
cp kept.png actual/frame_000001.png
seen 5 "watching"
# A folder that is gone is reported, and found when it is back.
mv actual away
seen 6 "watching"
seen 1 "actual: error: cannot be read"
mv away actual
seen 7 "watching"
seen 4 "equal: 3 frames"
# Files that are no inputs of a comparison lead to none.
touch actual/notes.txt actual/.hidden.png
sleep 1.2
seen 7 "watching"
# Rules are inputs.
echo "rules: []" >expected/compare.yaml
seen 8 "watching"
seen 1 "expected/compare.yaml:1:8: error:"
rm expected/compare.yaml
seen 9 "watching"
stopped 0

# The exit status is that of the last comparison.
watch expected changed
seen 1 "3 of 3 frames differ"
seen 1 "watching"
stopped 1
watch expected nowhere
seen 1 "nowhere: error: cannot be read"
seen 1 "watching"
stopped 2
watch a.npz b.npz
seen 1 "first difference: frame 0"
cp a.npz b.npz
seen 1 "equal: 9 frames"
seen 2 "watching"
kill -TERM $watching
wait $watching
equal "exit status after SIGTERM" $? 0
finish
