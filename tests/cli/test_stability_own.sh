#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Borders and maps of a scene file: the figures of the table's studies, the slope's law.
. "$(dirname "$0")/checks.sh"
ramp=$scenes/stability/friction_ramp.yaml

# A study of the table has the same borders as its scene on its own with the same values.
run 0 stability --scenes "$scenes" --study heavy_on_one --methods engine:k=4,momentum,scene-net -o table
run 0 stability "$scenes/stability/heavy_on_one.yaml" --vary ratio=1:1000 --methods engine:k=4,momentum,scene-net -o own
says "heavy_on_one_ratio: ratio, holds | fails"
for file in stability refusals; do
    cmp -s <(cut -d, -f2- table/$file.csv) <(cut -d, -f2- own/$file.csv) || fail "$file.csv is not that of the table's study"
done
equal "files" "$(ls own)" "$(ls table)"

# Its figure has the scene's title, the range that was given, and no row of a method that does not apply.
for text in "Scene heavy on one, by ratio" "ratio 1 to 1000"; do
    [ "$(grep -o ">$text<" own/borders.svg | wc -l)" = 1 ] || fail "not once in the figure: $text"
done
grep -q ">Heavy box on one<" table/borders.svg || fail "the title of the table's study"
for figure in own table; do
    grep -q "Left out, as not applicable: scene-net\." $figure/borders.txt || fail "$figure: not named as left out"
    ! grep -q ">scene-net" $figure/borders.svg || fail "$figure: a row without information"
done

# A box of friction 0.2 stands on a slope up to 0.2, and on one of 0.3 from a friction of 0.3 on. Without a range a
# parameter varies between its bounds.
run 0 stability "$ramp" --vary slope --vary friction=0.05:0.6 --quick --methods engine -o ramp
/usr/bin/python3 - <<'PYTHON' || fail "the borders of the slope and of the friction"
import csv
slope, friction = csv.DictReader(open("ramp/stability.csv"))
assert slope["study"] == "friction_ramp_slope" and friction["parameter"] == "friction"
assert slope["verdict"] == friction["verdict"] == "falls"
holds, fails = float(slope["holds_at"]), float(slope["fails_at"])
assert holds <= 0.2 <= fails + 1e-9 and fails - holds < 0.013, slope
holds, fails = float(friction["holds_at"]), float(friction["fails_at"])
assert fails <= 0.15 <= holds + 1e-9 and holds - fails < 0.012, friction # fails low: found, not given
cells = list(csv.DictReader(open("ramp/maps.csv")))
assert len(cells) == 16 and {cell["map"] for cell in cells} == {"friction_ramp_slope_friction"}
for cell in cells:
    gap = float(cell["y"]) - float(cell["x"])
    if abs(gap) > 0.01:
        assert (cell["verdict"] in ("settles", "moves")) == (gap > 0), cell
PYTHON
equal "figures" "$(cd ramp && echo *.png)" "borders.png map-friction_ramp_slope_friction.png"

# What every scene has needs no parameter: borders as with one.
sed 's/^iterations: .*/iterations: 10/; /iterations: {value/d' "$scenes/stability/heavy_on_one.yaml" >heavy.yaml
run 0 stability "$scenes/stability/heavy_on_one.yaml" --vary iterations=1:40 --methods engine,momentum -o named
run 0 stability heavy.yaml --vary iterations=1:40 --methods engine,momentum -o heavy
equal "borders along iterations" "$(cut -d, -f2,3,6- heavy/stability.csv)" "$(cut -d, -f2,3,6- named/stability.csv)"
equal "two methods have borders" "$(wc -l <heavy/stability.csv)" 3

# Every value of a range, also with --quick.
run 0 stability "$ramp" --vary slope=0.1:0.4:0.1 --vary friction=0.2:0.5:0.05 --quick --methods engine -o steps
equal "slopes of the map" "$(tail -n +2 steps/maps.csv | cut -d, -f6 | sort -u | xargs)" "0.1 0.2 0.3 0.4"
equal "cells of the map" "$(tail -n +2 steps/maps.csv | wc -l)" 28

# A box in a V that its friction holds apart from: at some values the reference has steps without a solution. Nothing is judged by
# it while no method explodes. A struck scene is: the values are named, shifted runs count, too, and the reference is undecided there.
{
    echo "parameters: {grip: {value: 1, from: 0.5, to: 2}}"
    sed 's/friction: 1.5/friction: $grip/' "$(dirname "$scenes")/tests/methods/scenes/wedge.yaml"
} >wedge.yaml
{ cat wedge.yaml; echo "bomb: {x: 20, y: 0.5, size: [1, 1], mass: 1}"; } >struck.yaml
run 0 stability wedge.yaml --vary grip=1.25:2:0.75 --methods engine,momentum -o wedge
says "steps of the reference that did not converge: none"
run 0 stability struck.yaml --vary grip=1.25:2:0.75 --methods engine,reference -o struck
equal "struck" "$(tail -n +2 struck/unconverged.csv | cut -d, -f2,6,10,11 | xargs)" \
    "engine,1.25,stands,360 engine,2,stands,360 reference,1.25,undecided,360 reference,2,undecided,360"
grep -Eq "at grip 1.25, 2 \([0-9]+ of 720 steps, residual up to [0-9.]+ m/s\)" struck/borders.txt || fail "borders.txt does not name them"
finish
