#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a study has measured is kept until it is drawn: where drawing fails, the next run measures nothing again. (For
# `paper`, test_paper.sh.)
. "$(dirname "$0")/checks.sh"

# continues DIR TABLE PICTURE COMMAND...: the first run keeps its pieces, and the second reads them: one that is cut off is refused.
continues() {
    local kept
    run_undrawn "$1/$3" "${@:4}"
    kept=$(compgen -G "$1/parts-*/0000/0000000")
    cp "$kept" piece
    cp "$1/$2" measured.csv
    truncate -s -1 "$kept"
    run 2 "${@:4}"
    complains "$kept: error: is damaged or cut off"
    cp piece "$kept"
    run 0 "${@:4}"
    cmp -s "$1/$2" measured.csv || fail "$1/$2 is measured again"
    equal "pieces that are left in $1" "$(compgen -G "$1/parts-*")" ""
}

continues chart chart.csv chart-single.svg chart "$scenes/single.yaml" -o chart --quick --methods engine:k=10 --launches 2
[ -s chart/chart-single.pdf ] || fail "no chart"

continues study stability.csv borders.png stability --scenes "$scenes" --study heavy_on_one --methods engine:k=4 -o study
[ -s study/borders.svg ] || fail "no figure of the study"

finish
