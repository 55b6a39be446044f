#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
. "$(dirname "$0")/checks.sh"

# A scene: the engine and its network, side by side; frames, runs and video in one go.
sed "s|^frames:.*|frames: 7|; s|networks/|$scenes/networks/|" "$scenes/single.yaml" >single.yaml
run 0 render single.yaml -o pictures --size 192x108 --video clip.mp4
says "8 frames"
equal "files" "$(ls pictures | tr '\n' ' ')" \
    "$(printf 'frame_%06d.png ' 0 1 2 3 4 5 6 7)manifest.json single-engine.npz single-pair-net.npz "
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

# Some frames only; then a shorter run, which removes the later frames of the longer one.
run 0 render one/single-engine.npz -o part --size 192x108 --frames 2:4
equal "frames of a part" "$(ls part | tr '\n' ' ')" "frame_000002.png frame_000003.png frame_000004.png manifest.json single-engine.npz "
run 0 simulate single.yaml --frames 3 -o short.npz
run 0 render short.npz -o one --size 192x108
equal "frames of a shorter run" "$(ls one | grep -c png)" 4

# One scene with its parameters set, beside a stored run; a body may go before the last frame.
sed "s/until: 600/until: 2/; s/^frames:.*/frames: 4/; s|\.\./networks/|$scenes/networks/|g" \
    "$scenes/stability/top_removed.yaml" >top.yaml
run 0 render top.yaml short.npz --set ratio=3 -o top --size 192x108
/usr/bin/python3 -c "
import numpy
run = numpy.load('top/top-engine.npz', allow_pickle=False)
assert (~numpy.isnan(run['angle'][:, 11])).tolist() == [True, True, False, False, False]" || fail "the top goes"
run 3 render short.npz -o part --size 192x108 --video /proc/nowhere/clip.mp4
run 0 render short.npz -o part --size 192x108 --frames 0:1 --video films/clip.gif # a folder that is not there yet
[ -s films/clip.gif ] || fail "no video in a new folder"
[ -z "$(ls | grep part.gif)" ] || fail "half a video left behind"

# No ffmpeg: reported before anything is drawn.
mkdir empty
PATH=$folder/empty run 3 render short.npz -o x --size 192x108 --video clip.mp4
complains "ffmpeg: error: cannot be run"
[ -e x ] && fail "frames were drawn for a video that cannot be"

! brief || finish

# Slow motion, hold and cards in one go, with all forms of video, y4m into a pipe (moments: tests/pictures/test_moments.c; looks and
# frames of videos: test_video.c, test_y4m.c). A card is 120 pictures, 30 are held; three come between each two slow frames.
run 0 simulate single.yaml --frames 60 -o slow.npz
"$twinbox" render slow.npz -o slow --size 96x64 --slow 4 --hold 0.5 --title "One box" --end "Thanks" --video - \
    --video slow.webm --video slow.gif 2>err </dev/null | ffmpeg -v error -i - -pix_fmt yuv444p -crf 0 piped.mp4
equal "statuses of the pipe" "${PIPESTATUS[*]}" "0 0"
read -r pictures title end frames slow <<<"$(/usr/bin/python3 -c "
import json
kinds = [picture['shows'] for picture in json.load(open('slow/manifest.json'))['pictures']]
print(len(kinds), *(kinds.count(kind) for kind in ('title', 'end', 'frame', 'between')))")"
equal "cards, frames with those that are held, and slow ones by threes" "$title $end $frames $((slow % 3))" "120 120 91 0"
[ $slow -gt 60 ] && [ $pictures -eq $((title + end + frames + slow)) ] || fail "$pictures pictures, $slow of them slow"
count() { ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "$1"; }
equal "pictures, frames of the pipe, the webm and the gif" \
    "$(ls slow | grep -c png) $(count piped.mp4) $(count slow.webm) $(count slow.gif)" \
    "$pictures $pictures $pictures $(((pictures + 2) / 3))"
"$twinbox" render single.yaml -o grey --size 96x64 --frames 0:0 --video - 2>err </dev/null |
    ffmpeg -v error -colorspace bt709 -i - back.png
/usr/bin/python3 - <<'PYTHON' || fail "the ffmpeg command of src/pictures/README.md gives other colours back"
import subprocess
def pixels(path):
    command = ["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    return subprocess.run(command, check=True, capture_output=True).stdout
there, back = pixels("grey/frame_000000.png"), pixels("back.png")
assert len(there) == 96 * 64 * 3 and max(abs(a - b) for a, b in zip(there, back, strict=True)) <= 2
PYTHON
"$twinbox" render slow.npz -o slow --size 96x64 --slow 4 --video - 2>err </dev/null | head -c 1000 >/dev/null
equal "status where nobody reads" "${PIPESTATUS[0]}" 3
complains "standard output: error: cannot write: Broken pipe"

# No file is written outside the folder, whatever the name of a run.
/usr/bin/python3 -c "
import numpy
run = dict(numpy.load('short.npz', allow_pickle=False))
run['scene'], run['method'] = numpy.array('../../evil'), numpy.array('/tmp/../x')
numpy.savez('evil.npz', **run)"
mkdir -p jail
run 0 render evil.npz -o jail/frames --size 192x108
equal "files in the folder" "$(ls jail/frames | grep -v '^frame_')" "$(printf '_._.._evil-_tmp_.._x.npz\nmanifest.json')"
equal "folders beside it" "$(ls jail)" frames

finish
