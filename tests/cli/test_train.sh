#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Options of train belong to kinds: the help lists them by kind, other kinds refuse them, networks store them.
. "$(dirname "$0")/checks.sh"

run 0 train --help
# The options of a section of the help, which begins with " NAME" and ends with an empty line.
listed() { sed -n "/^ $1/,/^\$/p" out | sed -nE 's/^      --([a-z-]+).*/\1/p' | sort | tr '\n' ' '; }
equal "options of pair-net" "$(listed 'pair-net (default): ')" \
    "from hidden iterations laws layers loss optimizer output-activation scale seed "
equal "options of momentum-schedule" "$(listed 'momentum-schedule: ')" "bomb-x iterations seed "
equal "options of scene-net" "$(listed 'scene-net: ')" \
    "iterations launches momentum rounds seed smallest sweeps width within "
says "  or:  twinbox train [OPTION...] --kind scene-net SCENE"
equal "options of interior-net" "$(listed 'interior-net: ')" "epochs rounds scenes seed "
says "  or:  twinbox train [OPTION...] --kind interior-net"

# Refused before a file is read; the kind may come first or last.
run 2 train --kind scene-net nowhere.yaml -o x.npz --optimizer lm
complains "--optimizer: error: is an option of pair-net, not of scene-net"
run 2 train nowhere.yaml -o x.npz --bomb-x=0:1:1 --kind scene-net
complains "--bomb-x: error: is an option of momentum-schedule, not of scene-net"
run 2 train nowhere.npz -o x.npz --smallest
complains "--smallest: error: is an option of scene-net, not of pair-net"
run 2 train --kind pair-net nowhere.npz -o x.npz --width 16
complains "--width: error: is an option of scene-net, not of pair-net"
run 2 train --kind magic nowhere.npz -o x.npz
complains "--kind: error: 'magic' is not a kind; known: pair-net, momentum-schedule, scene-net, interior-net"
run 2 train --kind momentum-schedule nowhere.yaml -o x.npz --seed 2 --iterations 1
complains "nowhere.yaml"
run 2 train -o x.npz
complains "pair-net: error: a file to train on is needed: DATA.npz"
run 2 train --kind interior-net nowhere.yaml -o x.npz
complains "nowhere.yaml: error: interior-net takes no file to train on"
run 3 train --kind interior-net -o nowhere/x.npz
complains "nowhere/x.npz: error: cannot write"
run 2 train one.npz two.npz -o x.npz
complains "only 1 file can be given ('two.npz' is one more)"

# The command that is stored trains the same again.
sed 's/^frames:.*/frames: 60/' "$scenes/single.yaml" >single.yaml
sed '/scene-net:/d; s/^frames:.*/frames: 60/' "$scenes/stack.yaml" >stack.yaml
run 0 dataset single.yaml -o pairs.npz --bomb-x=-2:2:1
run 0 train --loss smooth-l1 pairs.npz --iterations 3 -o pair.npz --hidden tanh
run 0 train single.yaml --bomb-x=1:2:1 --iterations 1 -o schedule.npz --kind momentum-schedule
run 0 train --kind scene-net stack.yaml -o scene.npz --launches 10 --rounds 1 --iterations 1 --width 16
run 0 train --kind interior-net -o interior.npz --scenes 7 --rounds 1 --epochs 1
stored() { /usr/bin/python3 -c "import numpy; print(numpy.load('$1')['command'])"; }
equal "command of pair-net" "$(stored pair.npz)" \
    "twinbox train pairs.npz -o pair.npz --layers 10-10-2 --optimizer adam --iterations 3 --seed 1 --hidden tanh --loss smooth-l1"
equal "command of momentum-schedule" "$(stored schedule.npz)" \
    "twinbox train --kind momentum-schedule single.yaml -o schedule.npz --iterations 1 --seed 1 --bomb-x=1:2:1"
equal "command of scene-net" "$(stored scene.npz)" \
    "twinbox train --kind scene-net stack.yaml -o scene.npz --launches 10 --rounds 1 --iterations 1 --width 16 --sweeps 14 --momentum on --seed 1"
equal "command of interior-net" "$(stored interior.npz)" \
    "twinbox train --kind interior-net -o interior.npz --scenes 7 --rounds 1 --epochs 1 --seed 1"
run 0 simulate "$scenes/stack.yaml" --method interior-net:network=interior.npz -o run.npz
finish
