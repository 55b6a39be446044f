#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Options of train belong to kinds: the help lists them by kind, networks store them.
. "$(dirname "$0")/checks.sh"

run 0 train --help
# The options of a section of the help, which begins with " NAME" and ends with an empty line.
listed() { sed -n "/^ $1/,/^\$/p" out | sed -nE 's/^      --([a-z-]+).*/\1/p' | sort | tr '\n' ' '; }
equal "options of pair-net" "$(listed 'pair-net (default): ')" \
    "from hidden iterations laws layers loss optimizer output-activation scale seed "
equal "options of scene-net" "$(listed 'scene-net: ')" \
    "iterations launches momentum rounds seed sweeps width "
says "  or:  twinbox train [OPTION...] --kind scene-net SCENE"
equal "options of sain" "$(listed 'sain: ')" "launches rounds seed steps with "
equal "options of hybrid" "$(listed 'hybrid: ')" "launches limit seed steps tolerance "
equal "options of gns" "$(listed 'gns: ')" "batch launches noise radius rate rounds scenes seed steps width "
equal "options of subspace" "$(listed 'subspace: ')" "epochs launches seed width "

# The command that is stored trains the same again.
sed 's/^frames:.*/frames: 60/' "$scenes/single.yaml" >single.yaml
sed '/scene-net:/d; s/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stack.yaml
run 0 dataset single.yaml -o pairs.npz --bomb-x=-2:2:1
run 0 train --loss smooth-l1 pairs.npz --iterations 3 -o pair.npz --hidden tanh
run 0 train --kind scene-net stack.yaml -o scene.npz --launches 10 --rounds 1 --iterations 1 --width 16
run 0 train --kind sain stack.yaml --with single.yaml -o sain.npz --launches 2 --rounds 1 --steps 4
equal "problems left out" "$(awk '$1 == "0" { print $3 }' out)" "0"
run 0 train --kind hybrid stack.yaml -o memory.npz --launches 3 --steps 4 --limit 0.03
says "  full"
run 0 train --kind gns -o gns.npz --scenes single.yaml --launches 2 --steps 20 --rounds 1
stored() { /usr/bin/python3 -c "import numpy; print(numpy.load('$1')['command'])"; }
equal "command of pair-net" "$(stored pair.npz)" \
    "twinbox train pairs.npz -o pair.npz --layers 10-10-2 --optimizer adam --iterations 3 --seed 1 --hidden tanh --loss smooth-l1"
equal "command of scene-net" "$(stored scene.npz)" \
    "twinbox train --kind scene-net stack.yaml -o scene.npz --launches 10 --rounds 1 --iterations 1 --width 16 --sweeps 14 --momentum on --seed 1"
equal "command of sain" "$(stored sain.npz)" \
    "twinbox train --kind sain stack.yaml -o sain.npz --with single.yaml --launches 2 --rounds 1 --steps 4 --seed 1"
equal "command of hybrid" "$(stored memory.npz)" \
    "twinbox train --kind hybrid stack.yaml -o memory.npz --launches 3 --steps 4 --tolerance 0.1 --limit 0.03 --seed 1"
run 0 simulate "$scenes/stack.yaml" --method hybrid:network=memory.npz -o run.npz
run 0 simulate "$scenes/stack.yaml" --method sain:network=sain.npz -o run.npz
equal "command of gns" "$(stored gns.npz)" \
    "twinbox train --kind gns -o gns.npz --scenes single.yaml --launches 2 --width 16 --rounds 1 --radius 0.6 --noise 0.1 --steps 20 --batch 8 --rate 0.005 --seed 1"
run 0 simulate "$scenes/stack.yaml" --method gns:network=gns.npz --frames 5 -o run.npz

# Of a short run with few windows.
run 0 train --kind subspace single.yaml -o subspace.npz --launches 3 --epochs 1 --width 16
says "components      loss  floor          linear term    with network"
says "2 bodies -> subspace.npz"
equal "command of subspace" "$(stored subspace.npz)" \
    "twinbox train --kind subspace single.yaml -o subspace.npz --launches 3 --epochs 1 --width 16 --seed 1"
run 0 simulate single.yaml --method subspace:network=subspace.npz,components=8 -o run.npz
finish
