#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# SIGINT and SIGTERM end every command with exit status 130: while it waits for a file, in the middle of work, and
# between two charts. What was begun has no name, and other programs' failures are no reason.
. "$(dirname "$0")/../cli/checks.sh"

# interrupted WHAT: the signal's run has ended as it should.
interrupted() {
    for _ in $(seq 3000); do
        grep -qs '^State:.[^Z]' /proc/$running/status || break
        sleep 0.01
    done
    kill -KILL $running 2>/dev/null # it does not end
    wait "$running"
    equal "exit status of $1" $? 130
    complains "error: "
}

# start COMMAND...: returns when it handles signals. Its input is a pipe without a byte.
mkfifo pipe
exec 3<>pipe
start() {
    "$twinbox" "$@" >out 2>err <&3 &
    running=$!
    # Bit 14 of the caught signals is SIGTERM; before, the process is still the shell.
    for _ in $(seq 3000); do
        [ "$(readlink /proc/$running/exe)" = "$(readlink -f "$twinbox")" ] &&
            grep -q '^SigCgt:.*[4-7c-f]...$' /proc/$running/status && break
        sleep 0.01
    done 2>/dev/null
}

# one_request TARGET: signals again and again until the run ends, its last words included, for less than the second in which
# all signals are one request: as timeout(1) and schedulers do, which signal the process and then its group.
one_request() {
    local first=${EPOCHREALTIME/./}
    while kill -TERM -- "$1" && [ $((${EPOCHREALTIME/./} - first)) -lt 400000 ]; do :; done 2>/dev/null
}

# waiting SIGNAL COMMAND...: the command reads its input.
waiting() {
    start "${@:2}"
    kill "-$1" $running
    interrupted "$2, which waits"
    complains "twinbox: error: interrupted"
}

# working SIGNAL COMMAND...: the command would work for a long time.
working() {
    start "${@:2}"
    # A study is at work once its folder is there, which a busy machine makes late.
    for _ in $(seq 1000); do
        [ -e "${folder:-.}" ] && break
        sleep 0.01
    done
    sleep 0.2
    kill "-$1" $running
    interrupted "$2, which works"
}

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 render a.npz -o frames --size 64x64
run 0 solve "$scenes/single.yaml" --frame 45 -o problem.npz
for command in "simulate -" "render - -o drawn" "dataset - -o new.npz" "solve - -m engine" "stability - --vary height -o study" \
    "compare a.npz - --json" "export - -o new.csv" "figure strip - -o new.pdf" "train - -o new.npz"; do
    waiting TERM $command
done
for command in "check -" "solve - --frame 3 -o new.npz" "chart - -o chart" "import - -o new.npz" "compare a.npz -" "page - -o new.html" \
    "train --kind scene-net - -o new.npz"; do
    waiting INT $command
done

working TERM simulate "$scenes/pyramid.yaml" --frames 500000 -o new.npz --verdict new.json
complains "stopped after step"
working INT page "$scenes/pyramid.yaml" -o new.html
working INT dataset "$scenes/pyramid.yaml" --random 5000 -o new.npz
working TERM train --kind scene-net "$scenes/stack.yaml" -o new.npz --iterations 100000
[ -e new.json ] && fail "an interrupted run has a verdict"
folder=paper working TERM paper -o paper --scenes "$scenes"
[ -e paper/report.md ] && fail "an interrupted study has a report"
folder=study working INT stability -o study --scenes "$scenes"
folder=chart working TERM chart "$scenes/pyramid.yaml" -o chart
equal "tables of interrupted studies" "$(find study chart paper -name '*.csv')" ""
# Signals within a second are one request: what would be kept is.
run 0 dataset "$scenes/single.yaml" --bomb-x=-2:2:1 -o pairs.npz
start train pairs.npz -o kept.npz --iterations 1000000 --optimizer lm --layers 10-60-2 # steps of half a second
until grep -qs '^ *0 ' out || ! kill -0 $running; do sleep 0.01; done
one_request $running
interrupted "train, signalled often"
grep -q "^stopped early; .* -> kept.npz" out || fail "a training that was signalled often: $(cat out err)"
[ -s kept.npz ] || fail "a training that was signalled often is lost"

# Processes that draw leave a signal to the one that started them, from their start on.
run 0 simulate "$scenes/pyramid.yaml" --frames 600 -o long.npz
for moment in '[ "$(pgrep -c -g $running)" -eq 3 ]' '[ -e group/frame_000001.png ]'; do
    rm -rf group
    setsid "$twinbox" render long.npz -o group --size 1920x1080 --jobs 2 >out 2>err &
    running=$!
    until eval "$moment" || ! kill -0 $running; do sleep 0.01; done 2>/dev/null
    one_request -$running
    interrupted "render, whose group is signalled once $moment"
    complains "render: error: stopped"
    equal "files that are not whole" "$(ls -A group | grep -cv '^frame_[0-9]*.png$\|^pyramid-engine.npz$\|^manifest.json.part$')" 0
done
rm -rf group long.npz kept.npz pairs.npz

# A training that was stopped early is stored, once it has reported.
rm -f new.npz
equal "files" "$(ls -A | tr '\n' ' ')" \
    "a.npz chart err frames out paper pipe problem.npz study "

# Ctrl-C reaches ffmpeg, too.
mkdir -p ffmpeg-ends
printf '#!/bin/sh\nkill -TERM $PPID\nkill -INT $$\nsleep 9\n' >ffmpeg-ends/ffmpeg
chmod +x ffmpeg-ends/ffmpeg
PATH="$PWD/ffmpeg-ends:$PATH" run 130 render a.npz -o frames --size 64x64 --video new.mp4
equal "files" "$(ls -A | grep mp4)" ""

# A signal is noticed between two charts: one that comes with the first file of the first (faults/shim.c).
run 0 chart "$scenes/single.yaml" "$scenes/stack.yaml" -o two --quick --methods engine:k=10
LD_PRELOAD=$(dirname "$twinbox")/tests/libfault_shim.so ASAN_OPTIONS=verify_asan_link_order=0 TWINBOX_FAULT=rename:1:term \
    TWINBOX_FAULT_COUNTS=$PWD/counts run 130 chart two/chart.csv -o drawn
complains "stopped; chart.csv is finished"
equal "charts" "$(ls -A drawn | tr '\n' ' ')" "chart-single.pdf chart-single.png chart-single.svg chart-single.txt "
run 0 chart two/chart.csv -o whole
run 0 chart two/chart.csv -o drawn
diff -r whole drawn >out || fail "the charts differ after an interrupt: $(cat out)"
finish
