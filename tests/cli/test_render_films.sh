#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Films of any rate and length, and what render notes about them.
. "$(dirname "$0")/checks.sh"
# No note; a slow run may have drawn a progress bar.
silent() { checks=$((checks + 1)) && ! grep -q note err || fail "not silent: $(cat err)"; }
probe() { ffprobe -v error -count_frames -show_entries stream="$2" -of csv=p=0 "$1"; }
draw() { run 0 render "$@" --size 96x64 -q; }

# One second of 20, 60 and 120 frames plays in one second at every rate: pictures 0 to 1 s.
for rate in 20 60 120; do
    run 0 simulate "$scenes/single.yaml" --dt 1/$rate --frames $rate -o $rate.npz
done
while read -r rate fps; do
    draw $rate.npz -o film$rate --fps $fps --video film.mp4
    equal "film of $rate Hz at $fps" "$(probe film.mp4 avg_frame_rate,nb_read_frames)" "$fps/1,$((fps + 1))"
done <<<"20 24
120 60"
! brief || finish
draw 60.npz -o same

# The whole film lasts as long as --duration: two cards of 2 s, the run, 1 s of its last frame. (Which frame a picture shows:
# tests/pictures/test_moments.c.)
seven="60.npz -o seven --fps 10 --duration 7 --title One --end Two --hold 1 --slow 4"
draw $seven --video seven.mp4
equal "seven seconds" "$(probe seven.mp4 duration,nb_read_frames)" 7.000000,70
cp -r seven before
rm seven/frame_000033.png
run 0 render $seven --size 96x64 --resume
says "frame_000069.png, 69 of them kept"
diff -r seven before >out || fail "resumed: $(cat out)"
run 0 render $seven --size 96x64 --fps 12 --resume
says "nothing to resume: seven/manifest.json"

# --slow around an impact that the frames lack: in this run, the bomb strikes in frame 32.
impact="twinbox: note: --slow: frames"
run 0 render "$sources/golden/trajectories/single-engine.npz" -o slow --size 96x64 --slow 4 --frames 20:60
silent
run 0 render "$sources/golden/trajectories/single-engine.npz" -o early --size 96x64 --slow 4 --frames 0:5
complains "$impact 0 to 5 do not contain the impact, frame 32; nothing is slowed down"
run 0 render "$sources/golden/trajectories/single-engine.npz" -o late --size 96x64 --slow 4 --frames 40:75
complains "$impact 40 to 75 do not contain the impact, frame 32; frames 40 to 68 beside it are slowed down"
run 0 simulate "$scenes/single.yaml" --no-bomb --frames 5 -o calm.npz
run 0 render calm.npz -o calm --size 96x64 --slow 4
complains "twinbox: note: --slow: no run has a contact of the bomb with a box; nothing is slowed down"
run 0 render calm.npz -o calm --size 96x64 --slow 4 -q
silent

# Runs of different scenes: another file, or another launch. An imported run has no scene_hash.
run 0 simulate "$scenes/single.yaml" --frames 3 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 3 --method momentum -o b.npz
run 0 simulate "$scenes/single.yaml" --frames 3 --bomb-x 1 -o launched.npz
run 0 simulate "$scenes/stack.yaml" --frames 3 -o stack.npz
run 0 render a.npz b.npz -o ab --size 96x64
silent
run 0 render a.npz b.npz launched.npz -o ac --size 96x64
complains "twinbox: note: the runs of single by engine and by engine are of different scenes: their launches, settings or files differ (scene_hash "
run 0 render a.npz stack.npz -o ad --size 96x64
complains "twinbox: note: the runs are of different scenes: single (by engine) and stack (by engine)"
/usr/bin/python3 -c "
import numpy
run = dict(numpy.load('stack.npz', allow_pickle=False))
run['scene_hash'] = numpy.uint64(0)
numpy.savez('imported.npz', **run)"
run 0 render a.npz imported.npz -o ae --size 96x64
silent

# Frames of an earlier, longer sequence go, if its manifest lists them and they are as it left them; whatever else may be
# mistaken for a part of this one is named. Inputs and videos are not.
draw 60.npz -o folder --fps 20
cp folder/frame_000020.png folder/frame_000777.png
printf x >>folder/frame_000015.png
cp a.npz folder/other.npz
run 0 render a.npz -o folder --size 96x64 --video folder/film.gif
equal "frames that stay" "$(ls folder | tr '\n' ' ')" \
    "film.gif frame_000000.png frame_000001.png frame_000002.png frame_000003.png frame_000015.png frame_000777.png manifest.json other.npz single-engine.npz "
complains "twinbox: note: folder also has 3 files that are not of this sequence: frame_000015.png, frame_000777.png, other.npz"
rm folder/frame_000015.png folder/frame_000777.png
run 0 render folder/other.npz -o folder --size 96x64
silent

# Some frames of a run leave the others of the folder, and name them.
cp -r same part
run 0 render 60.npz -o part --size 96x64 --frames 7:9
complains "twinbox: note: part also has 58 files that are not of this sequence: frame_000000.png ... frame_000006.png, frame_000010.png ... frame_000060.png"
for i in 1 3 5 7 9 b d f; do : >part/$i.png; done
run 0 render 60.npz -o part --size 96x64 --frames 7:9
complains "1.png, 3.png, 5.png, 7.png, 9.png and 61 more"

# Also if the shorter sequence is interrupted, and resumed later.
cp -r same twice
rm twice/frame_000002.png
mkdir twice/frame_000002.png
run 3 render a.npz -o twice --size 96x64 -q
rmdir twice/frame_000002.png
run 0 render a.npz -o twice --size 96x64 --resume
silent
equal "frames of the shorter one" "$(ls twice | grep -c png)" 4
finish
