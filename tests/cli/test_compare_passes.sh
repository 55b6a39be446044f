#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare never passes by mistake: files that are equal but no pictures, pictures in subfolders, masks that hide everything,
# metadata. And approve in subfolders and where several pictures are accepted.
tests=$(cd "$(dirname "$0")" && pwd)
. "$tests/checks.sh"
png() { /usr/bin/python3 "$tests/png.py" "$@"; }
white="255 255 255 255"

fresh() {
    rm -rf a b report
    mkdir -p a/sub b/sub
    png a/home.png 8 8 "$white"
    png a/sub/x.png 8 8 "$white"
    cp a/home.png b
    cp a/sub/x.png b/sub
}

# Equal files that are no pictures.
pointer="version https://git-lfs.github.com/spec/v1
oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393
size 12345"
broken() {
    cp b/home.png a/home.png
    run 2 compare a b
    complains "a/home.png: error: $1"
    run 2 compare a/home.png b/home.png
    complains "a/home.png: error: $1"
}
fresh
run 0 compare a b
says "equal: 2 frames"
head -c 60 a/sub/x.png >b/home.png
broken "not a PNG file, or damaged: unexpected end of file"
: >b/home.png
broken "not a PNG file, or damaged: it is empty"
echo "$pointer" >b/home.png
broken "a Git LFS pointer, not the file itself; run: git lfs pull"
echo "404 Not Found" >b/home.png
broken "not a PNG file"
sed 's/IDAT/IDAS/' a/sub/x.png >b/home.png
broken "not a PNG file, or damaged: wrong checksum of the chunk IDAS"
fresh
echo "$pointer" >b/home.png
run 2 compare a b
complains "b/home.png: error: a Git LFS pointer"
fresh
echo "$pointer" | tee a/run.npz >b/run.npz
run 2 compare a b
complains "a/run.npz: error: a Git LFS pointer"
run 2 compare a/run.npz b/run.npz
complains "a/run.npz: error: a Git LFS pointer"
echo text | tee a/run.npz >b/run.npz
run 0 compare a b
says "equal: 2 frames"
says "not compared: 1 .npz file without a trajectory"
! grep -q "1 trajectory" out || fail "text was counted as a trajectory"
rm b/run.npz
run 0 compare a b
says "not compared: 1 .npz file only in a"

# A comparison with itself tells nothing.
fresh
ln -s a same
run 2 compare a same
complains "same: error: is the same folder as a: nothing would be compared"
run 2 compare a/home.png a/../same/home.png
complains "a/../same/home.png: error: is the same file as a/home.png: nothing would be compared"
run 0 compare same same
says "expected and actual are the same folder"
run 0 compare a/home.png a/home.png
says "expected and actual are the same file"
run 0 compare a b
! grep -q "the same" out || fail "two folders are taken for one"

# Pictures that are no film: a line each, the worst first, with no line of a sequence.
rm -rf case.a case.b
mkdir case.a case.b
for name in aa logo colour plot3 same; do png case.a/$name.png 40 8 "$white" && cp case.a/$name.png case.b; done
png case.b/aa.png 40 8 "$white" 1 1 "0 0 0 255"
png case.b/colour.png 40 8 "$white" 1 1 "0 0 0 255" 2 1 "0 0 0 255" 30 6 "9 9 9 255"
png case.b/plot3.png 40 9 "$white"
rm case.b/logo.png
run 1 compare case.a case.b --report report
equal "lines of cases" "$(cat out)" "only in case.a: 1 frame: logo.png
differs: plot3.png: sizes differ: 40 x 8 and 40 x 9 pixels; overlap: equal pixels
differs: colour.png: 3 pixels differ (0.938%) by at most 255, first at (1, 1): added; 2 regions, the largest of 2 x 1 pixels at (1, 1)
differs: aa.png: 1 pixel differs (0.312%) by at most 255, first at (1, 1): added; one region of 1 x 1 pixels at (1, 1)
3 of 4 frames differ
verdict: pictures differ, 1 frame missing
report -> report/report.html"
grep -q '<svg' report/report.html && fail "a plot over pictures that are no film"

# Subfolders.
fresh
png b/sub/x.png 8 8 "$white" 1 2 "0 0 0 255"
run 1 compare a b
says "sub/x.png: 1 pixel differs (1.56%) by at most 255, first at (1, 2): added; one region of 1 x 1 pixels at (1, 2)"
run 0 compare a b --no-recursive
says "equal: 1 frame"
says "not compared: 1 picture in subfolders of a (--no-recursive)"
says "not compared: 1 picture in subfolders of b (--no-recursive)"
mkdir b/new
cp a/home.png b/new/.hidden.png
cp a/home.png b/new
run 1 compare a b
says "only in b: 1 frame: new/home.png"
rm a/home.png b/home.png
run 2 compare a b --no-recursive
complains "a: error: the folder of the expected pictures has no PNG files (such as frame_000000.png), only its subfolders do"
rm -r a/sub
run 2 compare a b
complains "a: error: the folder of the expected pictures is empty"
run 2 compare b a
complains "a: error: the folder of the actual pictures is empty"
echo text >a/notes.txt
run 2 compare b a
complains "a: error: the folder of the actual pictures has no PNG files (such as frame_000000.png)"
run 0 simulate "$scenes/single.yaml" --frames 3 -o one.npz
cp one.npz a
run 2 compare a b # trajectories do not replace pictures
rm -r b/*
cp one.npz b
run 0 compare a b
says "equal: 0 frames, 1 trajectory"

# The state of a picture is that of the runs in its own folder.
fresh
run 0 simulate "$scenes/single.yaml" --frames 3 --bomb-x 1 -o other.npz
cp one.npz a/sub/run.npz
cp other.npz b/sub/run.npz
run 1 compare a b --report report
says "physics changed first in sub/run.npz: from frame 0"
grep -q '"name": "home.png", "verdict": "equal"' report/results.json || fail "a run of another folder counts"
grep -q '"name": "sub/x.png", "verdict": "physics changed"' report/results.json || fail "the run does not count"
run 0 approve report
says "replaced a/sub/run.npz"
run 0 compare a b
says "equal: 2 frames, 1 trajectory"

# Links.
fresh
ln -s ../.. a/sub/up
run 2 compare a b
complains "a/sub/up: error: is a link to $(pwd -P), out of a; such links are not followed"
rm a/sub/up
ln -s ../home.png a/sub/again.png
ln -s sub a/same
cp a/home.png b/sub/again.png
run 0 compare a b
says "equal: 3 frames"
ln -s "$PWD/b/home.png" a/far.png
run 2 compare a b
complains "a/far.png: error: is a link to"

# Masks that leave nothing, also where the files are equal.
fresh
for mask in 0,0,8,8 -5,-5,100,100; do
    run 2 compare a b --mask $mask
    complains "a/home.png: error: the masks hide all its pixels: nothing is compared"
done
run 2 compare a b --mask 0,0,8,4 --mask 0,4,8,4
run 0 compare a b --mask 0,0,8,7
run 0 compare a b --mask 0,0,8,7 --mask 0,0,8,7 # their areas add up to more than the picture
png mask.png 8 8 "$white"
run 2 compare a b --mask mask.png
complains "nothing is compared"
png mask.png 8 8 "$white" 0 0 "0 0 0 255"
run 0 compare a b --mask mask.png
png b/home.png 8 8 "0 0 0 255"
run 2 compare a b --mask 0,0,8,8
complains "nothing is compared"

# Metadata that changes the display of equal pixels.
fresh
png b/home.png 8 8 "$white" gAMA=0001869f
run 0 compare a b --report report
says "equal: 2 frames"
says "metadata differs in 1 frame, first in home.png: gAMA none and 0.99999 (--metadata strict fails)"
grep -q '"metadata": "gAMA none and 0.99999"' report/results.json || fail "results.json has no metadata"
grep -q '"notes": "metadata differs in 1 frame, first' report/results.json || fail "results.json has no notes"
grep -q 'id="notes">metadata differs in 1 frame, first' report/report.html || fail "the page has no notes"
run 1 compare a b --metadata strict --report report
says "verdict: metadata changed"
says "first in home.png: gAMA none and 0.99999"
grep -q '"name": "home.png", "verdict": "metadata changed", "failed": true' report/results.json || fail "results.json lacks it"
grep -q 'type="metadata changed"' report/junit.xml || fail "junit.xml lacks it"
run 0 approve report
says "replaced a/home.png"
run 0 compare a b --metadata strict
png b/home.png 8 8 "$white" eXIf=4d4d002a00000008000101120003000000010006000000000000
png a/home.png 8 8 "$white"
run 1 compare a b --metadata strict
says "orientation 1 and 6"
# Brightness of the screen that it was made on, the brightest pixel, the background, the depth, the shape of a pixel.
for chunk in mDCV=$(printf '%048d' 1) cLLI=0000000100000001 bKGD=000000000000 sBIT=05050505 pHYs=000000010000000200; do
    png b/home.png 8 8 "$white" "$chunk"
    run 0 compare a b
    says "metadata differs in 1 frame, first in home.png: ${chunk%=*} none and set"
    run 1 compare a b --metadata strict
done
png b/home.png 8 8 "$white" mDCV=00 cLLI=00 bKGD=00 sBIT=00 pHYs=00 cHRM=00 gAMA=0001869f sRGB=00 cICP=00 iCCP=00
run 1 compare a b --metadata strict
says "bKGD none and set, pHYs none and set"
png b/home.png 8 8 "$white" tEXt=4100
run 0 compare a b --metadata strict
run 2 compare a b --metadata loose
complains "--metadata"

# Opaque white is not transparent white, in numbers and in the report's pictures: the larger of FLIP on white and on black.
fresh
png b/home.png 8 8 "255 255 255 0"
run 1 compare a b --report report
says "64 pixels differ (100%) by at most 255"
/usr/bin/python3 - <<'PYTHON' || fail "the report shows no difference"
import base64, json, re, struct, zlib
frame = json.load(open("report/results.json"))["frames"][0]
assert abs(frame["flip"] - 0.9674) < 1e-3, frame["flip"]
page = open("report/report.html").read()


def pixels(kind):
    """The RGB of each pixel of a report's picture."""
    data = base64.b64decode(re.search(f'id="p0{kind}">([^<]*)<', page).group(1))
    at, parts, palette = 8, b"", None
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at : at + 8])
        if name == b"PLTE":
            palette = data[at + 8 : at + 8 + length]
        parts += data[at + 8 : at + 8 + length] if name == b"IDAT" else b""
        at += length + 12
    assert data[24] == 8 and data[25] in (2, 3), "8 bits, RGB or palette"
    channels = 3 if data[25] == 2 else 1
    raw, size = zlib.decompress(parts), 8 * channels
    rows = [raw[y * (size + 1) : (y + 1) * (size + 1)] for y in range(8)]
    above, found = bytes(size), set()
    for row in rows:
        out = bytearray(size)
        for i in range(size):
            left, up, corner = (out[i - channels] if i >= channels else 0), above[i], (above[i - channels] if i >= channels else 0)
            guess = left + up - corner
            paeth = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]
            out[i] = (row[1 + i] + [0, left, up, (left + up) // 2, paeth][row[0]]) & 255
        above = out
        for x in range(8):
            found.add(bytes(out[3 * x : 3 * x + 3]) if palette is None else palette[3 * out[x] : 3 * out[x] + 3])
    return found


assert pixels("d") == {bytes((72, 0, 110))}, pixels("d")  # the colour of the largest difference
assert all(max(color) > 200 for color in pixels("f")), pixels("f")  # the upper end of the heat
PYTHON

# More than one accepted picture.
fresh
png a/home.1.png 8 8 "9 9 9 255"
png a/home.2.png 8 8 "9 9 9 255" 0 0 "0 0 0 255" 1 0 "0 0 0 255"
run 0 compare a b
! grep -q "another accepted" out || fail "home.png itself passes"
cp a/home.2.png b/home.png
run 0 compare a b --report report
says "equal: 2 frames"
says "1 frame passed by another accepted picture"
png b/home.png 8 8 "9 9 9 255" 0 0 "0 0 0 255" 1 0 "0 0 0 255" 2 0 "0 0 0 255"
run 0 compare a b --fuzzy 9,0.05
says "1 frame passed by another accepted picture"
run 1 compare a b --report report
says "home.png: 1 pixel differs"
says "closest accepted picture: home.2.png"
# approve replaces the picture that the report shows.
cp a/home.png first.png
cp a/home.1.png second.png
run 0 approve report --only home.png
says "replaced a/home.2.png"
says "1 replaced, 0 added, 0 removed"
cmp -s a/home.png first.png && cmp -s a/home.1.png second.png || fail "approve replaced another picture"
run 0 compare a b
# A damaged one is not passed over, also where another passes.
head -c 50 second.png >a/home.1.png
cp a/home.png b/home.png
run 2 compare a b
complains "a/home.1.png: error: not a PNG file, or damaged: unexpected end of file"
png b/home.png 8 8 "7 7 7 255"
run 2 compare a b
complains "a/home.1.png"
# Without an actual picture each is missing.
cp second.png a/home.1.png
rm b/home.png
run 1 compare a b --report report
says "3 frames missing"
run 0 approve report --remove
says "0 replaced, 0 added, 3 removed"
run 0 compare a b

# approve makes folders below the expected one, and follows no link out of it.
fresh
mkdir -p b/new/deep
png b/new/deep/y.png 8 8 "1 2 3 255"
png b/sub/x.png 8 8 "1 2 3 255"
run 1 compare a b --report report
run 0 approve report
says "added a/new/deep/y.png"
says "replaced a/sub/x.png"
run 0 compare a b
says "equal: 3 frames"
fresh
png b/sub/x.png 8 8 "1 2 3 255"
mkdir b/new
png b/new/y.png 8 8 "1 2 3 255"
run 1 compare a b --report report
mv a/sub elsewhere
ln -s ../elsewhere a/sub
before=$(cksum elsewhere/*)
run 2 approve report --only 'sub/*'
complains "a/sub/x.png: error: its folder cannot be opened, or is a link"
mkdir outside
ln -s ../outside a/new
run 2 approve report --only 'new/*'
complains "a/new/y.png: error: its folder cannot be opened, or is a link"
equal "nothing is written through links" "$(cksum elsewhere/*) $(ls outside)" "$before "
rm a/sub a/new
mv elsewhere a/sub
run 0 approve report
says "1 replaced, 1 added"
for name in sub/../../x.png sub//x.png sub/.x.png /x.png sub/ sub/./x.png; do
    sed "s#\"name\": \"sub/x.png\", \"size\"#\"name\": \"$name\", \"size\"#g" report/results.json >edited
    mkdir -p hostile
    cp edited hostile/results.json
    run 2 approve hostile
    complains "a name must end with .png or .npz and lie below the folder"
done
finish
