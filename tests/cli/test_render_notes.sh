#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# render of a scene that names no pair-net: a note tells that only the engine is drawn, and the commands for a network.
. "$(dirname "$0")/checks.sh"

draw() { run 0 render "$@" -o frames --size 320x180 --frames 0; }
notes() { equal "notes of $1" "$(grep -c 'only the engine is drawn' err)" "$2"; }

"$twinbox" new wall.yaml --like stack >out
draw wall.yaml
complains "twinbox: note: wall.yaml names no network, so only the engine is drawn. To train and draw a network beside it:"
notes wall.yaml 1
equal "panels" "$(ls frames/*.npz | wc -l)" 1

# The commands of the note work in this order (with a small network, to be quick).
sed -n 's/^    twinbox //p' err >commands
equal "commands" "$(wc -l <commands)" 2
while read -r arguments; do
    case $arguments in
    train*) arguments="$arguments --launches 10 --rounds 1 --iterations 2 --width 16" ;;
    render*) arguments="${arguments/DIR/both} --size 320x180 --frames 70" ;;
    esac
    run 0 $arguments
done <commands
equal "panels of both" "$(ls both/*.npz | wc -l)" 2

# Other networks, no family, no bomb, none of these.
cp wall.yaml sain.yaml
echo "networks: {sain: $scenes/networks/sain.npz}" >>sain.yaml
draw sain.yaml
complains "sain.yaml names no pair-net, so only the engine is drawn. To draw a network beside it:"
complains "    twinbox render sain.yaml --method engine --method sain -o DIR"
sed '/^bomb:/,/^$/d; s/^  bomb_mass.*//' wall.yaml >bare.yaml
draw bare.yaml
complains "bare.yaml names no network, so only the engine is drawn; to train one for it, give it a bomb with a family"
draw "$scenes/stack.yaml"
notes stack.yaml 0
run 0 simulate wall.yaml -o run.npz
draw run.npz
notes run.npz 0
draw wall.yaml -q
equal "errors of -q" "$(cat err)" ""
finish
