#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Where methods fail: the printed table; a small stack; a map alone. (Any number of threads: test_threads.sh.)
. "$(dirname "$0")/checks.sh"

few="--scenes $scenes --study bomb_speed --study heavy_on_one --study tilted_stack --methods engine:k=4,engine:k=10,warm=off,scene-net"
# On a small stack; and without /proc, where that can be tried.
make_tower
tower="stability tower.yaml --vary height=1:4 --quick --methods engine -o tower"
if ! sanitized; then
    (ulimit -s 512 && "$twinbox" $tower) >out 2>err </dev/null
    equal "exit status on a stack of 512 KiB" $? 0
fi
hidden=(unshare -m sh -c 'mount -t tmpfs none /proc && exec "$@"' sh)
if ! sanitized && "${hidden[@]}" true 2>/dev/null; then # sanitizers read it, too
    "${hidden[@]}" "$twinbox" $tower >out 2>err </dev/null
    equal "exit status without /proc" $? 3
    complains "/proc/self/exe: error: "
fi

run 0 stability $few -o one
says "bomb_speed: speed in m/s, stands | falls"
says "heavy_on_one: ratio, holds | fails"
says "  scene-net                not applicable"
says "borders -> one/stability.csv; maps -> one/maps.csv"
says "steps of the reference that did not converge: none -> one/unconverged.csv"
[ "$(awk '{ if (length > n) n = length } END { print n }' out)" -le 80 ] || fail "the table is wider than 80 columns"
equal "lines a method" "$(grep -cE '^  engine:k=4 +[0-9.]+ \| [0-9.]+ [a-z]+' out)" 3
equal "lines a method with two settings" "$(grep -cE '^  engine:k=10,warm=off +[0-9.]+ \| [0-9.]+ [a-z]+' out)" 2
tables="fallbacks.csv maps.csv refusals.csv rest.csv stability.csv stability.html unconverged.csv"
equal "files" "$(echo $(ls one | grep -v ^live-))" "borders.png borders.svg borders.txt $tables"
equal "maps" "$(wc -l <one/maps.csv)" 1

# A map alone has no borders to print.
run 0 stability --scenes "$scenes" --quick --study speed_thickness --methods engine -o map
equal "header of borders" "$(cat map/stability.csv)" "study,method,setting,parameter,unit,holds_at,fails_at,verdict"
equal "cells" "$(wc -l <map/maps.csv)" 21
equal "lines printed" "$(wc -l <out)" 7
equal "figures" "$(cd map && echo *.png)" map-speed_thickness.png

! brief || finish

# 10,000 steps at rest.
run 0 stability --scenes "$scenes" --study at_rest --methods interior,pair-net -o rest
says "at_rest: the last height that holds, drift and energy after 10 falls"
says "  interior                 20 settles, "
says "  pair-net                 1 explodes"
equal "runs that stay in place" \
    "$(awk -F, '$2 == "interior" && $7 == "settles" && $8 == 10000 && $9 < 0.001' rest/rest.csv | wc -l)" 10
finish
