#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From `twinbox new` to a film, a figure, a chart and borders by the commands that are printed, each at the end of the one before.
. "$(dirname "$0")/checks.sh"

# The commands write to out/, so what they print goes elsewhere.
mkdir work && cd work || exit 1
do_run() { # STATUS ARGUMENT...
    local status
    "$twinbox" "${@:2}" >../said 2>../errors </dev/null
    status=$?
    equal "status of twinbox ${*:2}: $(head -c 400 ../errors)" $status "$1"
}
next_count() { grep -ac '^next: ' ../said; }

# do_next WHAT: runs the command that the last one printed.
do_next() {
    equal "next commands before the $1" "$(next_count)" 1
    eval "do_run 0 $(sed -n 's/^next: twinbox //p' ../said)"
}
written() {
    checks=$((checks + 1))
    [ -s "$1" ] || fail "no $1"
}

name="it's a tower"
do_run 0 new "$name.yaml" --like stack
sed -i 's/^frames: .*/frames: 70/; s/frame: 60/frame: 40/' "$name.yaml"
do_next check
do_next film
written out/it_s_a_tower.mp4
do_next figure
written out/it_s_a_tower-strip.pdf
do_next chart
written "out/it_s_a_tower-chart/chart-$name.png"
do_next borders
written out/it_s_a_tower-borders/borders.png
equal "commands after the borders" "$(next_count)" 0

# A run is rendered next; a figure of a run whose scene is not there has no next command.
do_run 0 simulate "$name.yaml" --frames 3 -o run.npz
equal "after a run" "$(tail -1 ../said)" "next: twinbox render run.npz -o out/run --video out/run.mp4"
do_run 0 export run.npz -o run.csv
do_run 0 import run.csv -o again.npz
equal "after an import" "$(tail -1 ../said)" "next: twinbox render again.npz -o out/again --video out/again.mp4"
# Not with -q, beside JSON, or beside data on standard output.
do_run 0 check "$name.yaml" --json
equal "commands beside JSON" "$(next_count)" 0
do_run 0 new -q quiet.yaml --like wall
equal "what new -q prints" "$(cat ../said ../errors)" ""
finish
