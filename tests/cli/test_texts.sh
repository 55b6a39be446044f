#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Text that users write: drawn in all its letters.
. "$(dirname "$0")/checks.sh"

sed "s|^frames:.*|frames: 7|; s|networks/|$scenes/networks/|" "$scenes/single.yaml" >"Übung_Voncilă.yaml"
run 0 render "Übung_Voncilă.yaml" -o pictures --size 640x360 --frames 3:5
run 0 render "Übung_Voncilă.yaml" -o egl --size 640x360 --frames 3:5 --context egl
run 0 compare pictures egl # letters beyond the atlas have the same pixels in both contexts
engine=$(echo pictures/*-engine.npz) net=$(echo pictures/*-pair-net.npz)

# Names: two scenes that differ in one such letter have different pictures. A letter and its mark are one character.
marked=aa$'\xcc\x86' # with a combining breve, in bytes: a shell without a locale knows no letters
for name in aq aă "$marked"; do
    cp "$scenes/single.yaml" "$name.yaml"
    sed -i "s|^frames:.*|frames: 1|; /pair-net/d; s|networks/|$scenes/networks/|" "$name.yaml"
    run 0 simulate "$name.yaml" -o "$name.npz"
    run 0 render "$name.npz" -o "one-$name" --size 640x360 --frames 1
done
hash() { sed -n 's/.*"frame_000001.png".*"pixels": "\([0-9a-f]*\)".*/\1/p' "$1/manifest.json"; }
[ -n "$(hash one-aă)" ] || fail "no hash of pixels in the manifest"
[ "$(hash one-aă)" != "$(hash one-aq)" ] || fail "ă is drawn like q"
equal "a letter with its mark" "$(hash "one-$marked")" "$(hash one-aă)"

# Captions: one per run, in their order; the manifest has them.
run 0 render "$engine" "$net" -o captions --size 640x360 --frames 3 --caption "" --caption "Unser Netz → Пётр"
grep -q '"method": "engine", "caption": ""' captions/manifest.json || fail "the first caption"
grep -q '"method": "pair-net", "caption": "Unser Netz → Пётр"' captions/manifest.json || fail "the second caption"

# Figures: the text of an SVG is the text, and a PDF's can be extracted.
for format in svg pdf; do run 0 figure strip "$engine" -o "strip.$format"; done
grep -q "Übung_Voncilă" strip.svg || fail "the title of the SVG"
[ "$(wc -c <strip.pdf)" -lt 400000 ] || fail "strip.pdf is large"

run 0 figure strip "$engine" "$net" -o named.svg --caption "Moteur" --caption "Сеть → Δx"
for words in "Moteur" "Сеть → Δx"; do grep -qF ">$words</text>" named.svg || fail "no caption '$words' in the figure"; done
grep -q ">engine</text>" named.svg && fail "the name beside its caption"

# Charts: the same names in tables, SVG and PNG.
cp "$scenes/single.yaml" "Übung.yaml"
sed -i "s|networks/|$scenes/networks/|" "Übung.yaml"
run 0 chart "Übung.yaml" --quick --methods engine:k=10,momentum:k=20 -o charts
grep -q "Übung" charts/chart.csv || fail "the table has no Übung"
grep -q ">Speed and accuracy: Übung" charts/chart-Übung.svg || fail "the chart has no Übung"
finish
