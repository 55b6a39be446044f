#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
. "$(dirname "$0")/checks.sh"

# A scene: the engine and its network, side by side; frames, runs and video in one go.
sed "s|^frames:.*|frames: 7|; s|networks/|$scenes/networks/|" "$scenes/single.yaml" >single.yaml
run 0 render single.yaml -o pictures --size 192x108 --video clip.mp4
says "8 frames"
equal "files" "$(ls pictures | tr '\n' ' ')" \
    "$(printf 'frame_%06d.png ' 0 1 2 3 4 5 6 7)single-engine.npz single-pair-net.npz "
equal "frames of the video" \
    "$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,height -of csv=p=0 clip.mp4)" "192,108,8"
for frame in pictures/frame_*.png; do
    pngcheck -q "$frame" || fail "$frame"
done
/usr/bin/python3 - pictures/frame_000003.png >out <<'PYTHON'
# Keyword and text of every iTXt chunk (PNG specification, 11.3.4.5).
import struct, sys
data, at = open(sys.argv[1], "rb").read(), 8
while at < len(data):
    length, kind = struct.unpack(">I4s", data[at:at + 8])
    if kind == b"iTXt":
        key, rest = data[at + 8:at + 8 + length].split(b"\0", 1)
        print(key.decode() + ":", rest[2:].split(b"\0", 2)[2].decode())
    at += 12 + length
PYTHON
for text in "Scene: single" "Method: engine | pair-net" "Frame: 3" "State: " "Software: twinbox"; do says "$text"; done

# The same frames from the stored runs, from any number of jobs, in either context.
run 0 render pictures/single-engine.npz pictures/single-pair-net.npz -o one --size 192x108 --jobs 1 --context osmesa
run 0 compare pictures one
run 0 render pictures/single-engine.npz pictures/single-pair-net.npz -o three --size 192x108 --jobs 3 --context egl
run 0 compare pictures three

# Smaller files of the same pictures, also the same from any number of jobs.
run 0 render pictures/single-engine.npz pictures/single-pair-net.npz -o small --size 192x108 --jobs 2 --png small
run 0 compare pictures small
[ "$(cat small/*.png | wc -c)" -lt "$(cat pictures/*.png | wc -c)" ] || fail "--png small is not smaller"
run 0 render pictures/single-engine.npz pictures/single-pair-net.npz -o fast --size 192x108 --jobs 1 --png fast
for frame in pictures/frame_*.png; do
    cmp -s "$frame" "fast/${frame#*/}" || fail "$frame is not the same file"
done

# A part of it; then a shorter run, whose frames are all there is.
run 0 render one/single-engine.npz -o part --size 192x108 --frames 2:4
equal "frames of a part" "$(ls part | tr '\n' ' ')" "frame_000002.png frame_000003.png frame_000004.png single-engine.npz "
run 0 simulate single.yaml --frames 3 -o short.npz
run 0 render short.npz -o one --size 192x108
equal "frames of a shorter run" "$(ls one | grep -c png)" 4

# One scene with its parameters set, beside a stored run; a body may go before the last frame.
sed 's/until: 600/until: 2/; s/^frames:.*/frames: 4/; /^networks/d' "$scenes/stability/top_removed.yaml" >top.yaml
run 0 render top.yaml short.npz --set ratio=3 -o top --size 192x108
/usr/bin/python3 -c "
import numpy
run = numpy.load('top/top-engine.npz', allow_pickle=False)
assert (~numpy.isnan(run['angle'][:, 11])).tolist() == [True, True, False, False, False]" || fail "the top goes"
run 2 render single.yaml short.npz short.npz -o x --set ratio=3
complains "there is no parameter 'ratio' to set"
run 2 render short.npz -o x --set ratio=3
complains "--set: error: is for one scene (here there are 0)"
run 2 render top.yaml top.yaml -o x --set ratio=3
complains "is for one scene (here there are 2)"

run 2 render single.yaml -o x --size 10x10
complains "--size"
run 2 render single.yaml -o x --size 1920
run 2 render single.yaml -o x --frames 5:99
complains "beyond the last frame, 7"
run 2 render single.yaml -o x --frames 5:2
run 2 render single.yaml -o x --jobs 0
run 2 render single.yaml -o x --png tiny
complains "'tiny' is neither fast nor small"
run 2 render single.yaml -o x --context vulkan
complains "neither osmesa nor egl"
run 2 render single.yaml -o x --size 193x108 --video odd.mp4
complains "even width and height"
run 2 render single.yaml -o x --video clip.avi
complains ".mp4"
run 2 render nowhere.npz -o x
complains "nowhere.npz"
head -c 700 short.npz >cut.npz
run 2 render cut.npz -o x
complains "cut.npz: error:"
[ -e x ] && fail "a refused command made a folder"
run 3 render short.npz -o /proc/nowhere --size 192x108
run 3 render short.npz -o part --size 192x108 --video nowhere/clip.mp4
[ -z "$(ls | grep part.mp4)" ] || fail "half a video left behind"
finish
