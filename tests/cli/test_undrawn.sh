#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a study has measured is kept until it is drawn: where gnuplot fails, the next run measures nothing again. (For
# `paper`, test_paper.sh.)
. "$(dirname "$0")/checks.sh"

# continues KEPT CHANGE COMMAND...: the table of the second run has a number that is changed in the file that the first
# keeps.
continues() {
    local kept=$1 change=$2
    shift 2
    run_undrawn "$@"
    equal "files that $1 keeps" "$(compgen -G "$kept" | wc -l)" 1
    sed -i "$change" $kept
    run 0 "$@"
    equal "files that $1 leaves" "$(compgen -G "$kept" | wc -l)" 0
}

continues "chart/chart-*.part.csv" 's/^\(single,engine,k=10,frozen,impact,2,.*\),1,,,,$/\1,0.5,,,,/' \
    chart "$scenes/single.yaml" -o chart --quick --methods engine:k=10 --launches 2
grep -q '^single,engine,k=10,frozen,impact,2,.*,0.5,,,,$' chart/chart.csv || fail "the chart is measured again"
[ -s chart/chart-single.pdf ] || fail "no chart"

continues "study/parts-*/heavy_on_one" 's/engine,k=4,ratio,,[0-9.]*/engine,k=4,ratio,,1.5/' \
    stability --scenes "$scenes" --study heavy_on_one --methods engine:k=4 -o study
grep -q 'engine,k=4,ratio,,1.5,' study/stability.csv || fail "the study is made again"
[ -s study/borders.svg ] || fail "no figure of the study"

finish
