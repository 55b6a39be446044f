#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What compare lets pass: limits on pixels and on FLIP, edges, rules for names; and pictures of different size.
. "$(dirname "$0")/checks.sh"

# png FILE WIDTH HEIGHT GREY [X Y W GREY]...: grey lines of W pixels.
png() {
    local head=("$1" "$2" "$3" "$4 $4 $4 255") pixels=() x
    shift 4
    while [ $# -gt 0 ]; do
        for ((x = $1; x < $1 + $3; x++)); do pixels+=("$x" "$2" "$4 $4 $4 255"); done
        shift 4
    done
    /usr/bin/python3 "$sources/tests/cli/png.py" "${head[@]}" "${pixels[@]}"
}
mkdir a b

# 1,000 pixels; 10 differ by 2, and 5 by 30.
png a/x.png 50 20 100
png b/x.png 50 20 100 3 3 10 102 3 5 5 130
run 1 compare a b
says "x.png: 15 pixels differ (1.5%) by at most 30, first at (3, 3)"
for passing in "--tolerance 30" "--tolerance 29 --beyond 0.005" "--tolerance 2 --beyond 0.005" "--beyond 0.015" \
    "--beyond 15px" "--tolerance 2 --beyond 5px" "--fuzzy 30,15px"; do
    run 0 compare a b $passing
    says "not equal, but within tolerance"
done
for failing in "--tolerance 29" "--tolerance 2 --beyond 0.0049" "--tolerance 1 --beyond 0.005" "--beyond 0.0149" \
    "--beyond 14px" "--tolerance 2 --beyond 4px" "--fuzzy 30,14px" "--fuzzy 29,15px" "--beyond 1 --fuzzy 255,14px"; do
    run 1 compare a b $failing
done
# Every limit must hold.
run 0 compare a b --tolerance 2 --beyond 0.005 --fuzzy 30,0.015
run 1 compare a b --tolerance 2 --beyond 0.005 --fuzzy 29,0.015
run 1 compare a b --tolerance 1 --beyond 0.005 --fuzzy 30,0.015
run 2 compare a b --tolerance 256
complains "--tolerance: error: '256' is not a whole number from 0 to 255"
for wrong in 2 15 -1px 1.5px px "15 px" 15pxx; do
    run 2 compare a b --beyond "$wrong"
    complains "--beyond: error: '$wrong' is not a share from 0 to 1 or a number of pixels, such as 20px"
done
run 2 compare a b --fuzzy 2,2
complains "--fuzzy: error: '2,2' is not MAX,SHARE with MAX from 0 to 255 and SHARE a share from 0 to 1 or a number of pixels"

# A share passes in a long page what it does not pass in a small picture; a number of pixels says the same of both.
mkdir page badge
png page/long.png 50 400 100
png page/small.png 50 20 100
png badge/long.png 50 400 100 3 3 10 130
png badge/small.png 50 20 100 3 3 10 130
run 1 compare page badge --beyond 0.001
says "1 of 2 frames differs"
run 1 compare page badge --beyond 9px
says "2 of 2 frames differ"
run 0 compare page badge --beyond 10px
echo 'rules: [{files: "*", beyond: 10px}, {files: small.png, beyond: 9px}]' >rules.yaml
run 1 compare page badge --rules rules.yaml
says "differs: small.png: 10 pixels differ (1%)"
says "1 of 2 frames differs"
run 2 compare a b --flip p50=0.1
complains "--flip: error: 'p50=0.1' is not MAX, mean=MAX or p99=MAX"

# A FLIP of 0 is what 8 bits show; a limit of 0 lets nothing differ.
/usr/bin/python3 - <<'PYTHON'
import struct, zlib
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
for name, low in ("a", 0), ("b", 1):
    rows = b"".join(b"\0" + struct.pack(">8H", *[25700 + low] * 8) for _ in range(8))
    with open(f"deep.{name}.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 16, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PYTHON
for limit in 0 mean=0 p99=0; do run 1 compare deep.a.png deep.b.png --flip $limit; done
run 0 compare deep.a.png deep.b.png --flip 0.0001 --flip p99=0.0001

# With a limit, FLIP is printed for the frame named, and its limits are those numbers.
run 1 compare a b
grep -q FLIP out && fail "FLIP without --flip"
run 1 compare a b --flip 0
mean=$(sed -n 's/^  FLIP: mean \([0-9.e-]*\), .*/\1/p' out)
p99=$(sed -n 's/^  FLIP: .*99th percentile \([0-9.e-]*\)$/\1/p' out)
above() { /usr/bin/python3 -c "print($1 * 1.01)"; }
below() { /usr/bin/python3 -c "print($1 * 0.99)"; }
run 0 compare a b --flip "$(above "$mean")"
run 1 compare a b --flip "$(below "$mean")"
run 0 compare a b --flip "p99=$(above "$p99")" --flip "mean=$(above "$mean")"
run 1 compare a b --flip "p99=$(below "$p99")"
run 1 compare a b --flip "p99=$(above "$p99")" --flip "$(below "$mean")"
run 1 compare a b --flip 1 --tolerance 29
run 0 compare a b --flip 0 --mask 0,0,50,6

# A crisp line whose picture has it half a pixel lower; the line erased; the line a pixel lower.
png a/x.png 50 20 250 5 9 40 10
png b/x.png 50 20 250 5 9 40 130 5 10 40 130
run 1 compare a b
run 0 compare a b --antialias
says "not equal, but within tolerance"
png b/x.png 50 20 250 5 9 40 130 5 10 40 130 25 3 1 200
run 1 compare a b --antialias
says "x.png: 1 pixel differs (0.1%) by at most 50, first at (25, 3); 80 pixels differ as limits allow"
png b/x.png 50 20 250
run 1 compare a b --antialias
png b/x.png 50 20 250 5 10 40 10
run 1 compare a b --antialias

# Content that moves by a pixel, in the whole picture or in a region; what vanishes; a rule that lets everything pass.
png a/x.png 50 20 250 5 9 40 10 20 3 2 10
png b/x.png 50 20 250 5 10 40 10 20 3 2 10
run 1 compare a b --tolerance 9
for rule in "shift: 1" "{shift: 2, region: [0, 8, 50, 4]}" "{tolerance: 240, region: [0, 8, 50, 4]}"; do
    rule=${rule#\{} rule=${rule%\}}
    echo "rules: [{files: x.png, $rule}]" >rules.yaml
    run 0 compare a b --rules rules.yaml --report report
    says "not equal, but within tolerance"
done
png b/x.png 50 20 250 5 10 40 10
for rule in "shift: 1" "shift: 2, region: [0, 8, 50, 4]"; do
    echo "rules: [{files: x.png, $rule}]" >rules.yaml
    run 1 compare a b --rules rules.yaml
    says "x.png: 2 pixels differ (0.2%) by at most 240, first at (20, 3); 80 pixels differ as limits allow"
done
echo "rules: [{files: x.png, tolerance: 255}]" >rules.yaml
run 2 compare a b --rules rules.yaml
complains "rules.yaml:1:9: error: a limit of this rule ignores every difference"

# Rules: for some names, later ones first; the command line replaces them.
png a/x.png 50 20 100
png b/x.png 50 20 100 3 3 10 102
cp a/x.png a/y.png
cp b/x.png b/y.png
cat >rules.yaml <<'YAML'
rules:
  - files: "?.png"
    tolerance: 2
  - files: y.png
    tolerance: 1
    masks:
      - rectangle: [3, 3, 9, 1]
YAML
run 1 compare a b --rules rules.yaml
says "y.png: 1 pixel differs (0.101%) by at most 2, first at (12, 3)"
says "1 of 2 frames differ"
run 0 compare a b --rules rules.yaml --tolerance 2
run 1 compare a b --rules rules.yaml --tolerance 0
says "2 of 2 frames differ"
cp rules.yaml a/compare.yaml
run 1 compare a b
says "1 of 2 frames differ"
run 0 compare a/x.png b/x.png
run 1 compare a/y.png b/y.png
png a/mask.png 50 20 0 3 3 10 255
mv a/mask.png mask.png
cat >a/compare.yaml <<'YAML'
rules:
  - files: x.png
    masks: [{picture: ../mask.png}]
  - files: y.png
    masks: [{colour: "#646464"}, {rectangle: [0, 0, 1, 1]}]
YAML
png a/y.png 50 20 100 40 10 1 90
png b/y.png 50 20 100 3 3 10 102 40 10 1 90
run 0 compare a b
run 1 compare a b --rules rules.yaml
cat >a/compare.yaml <<'YAML'
rules:
  - files: "*"
    tolerance: 30
  - files: "z*.png"
    antialias: on
YAML
run 2 compare a b
complains "a/compare.yaml:4:13: error: no picture has a name that matches 'z*.png'"
complains '    4 |   - files: "z*.png"'
sed -i 's/antialias/antialais/' a/compare.yaml
run 2 compare a b
complains "a/compare.yaml:5:5: error: 'antialais' is not a key of a rule; did you mean 'antialias'?"
# Masks of rules and of the command line together hide everything, though the files are equal.
cp a/x.png b/x.png
printf 'rules: [{files: x.png, masks: [{rectangle: [0, 0, 50, 12]}]}]\n' >a/compare.yaml
run 1 compare a b --mask 0,13,50,7
run 2 compare a b --mask 0,12,50,8
complains "a/x.png: error: the masks hide all its pixels"
run 2 compare a b --rules none.yaml
complains "none.yaml"
rm a/compare.yaml a/y.png b/y.png

# Pictures of different size: the overlap is compared, and the verdict stays.
png a/x.png 50 20 100
png b/x.png 40 30 100
run 1 compare a b
says "x.png: sizes differ: 50 x 20 and 40 x 30 pixels; overlap: equal pixels"
png b/x.png 40 30 100 3 3 10 102 3 25 10 0
run 1 compare a b --report report
says "overlap: 10 pixels differ (1.25%) by at most 2, first at (3, 3)"
run 1 compare a b --tolerance 255
run 1 compare a b --flip 1
run 1 compare a b --mask 12,3,38,1
says "overlap: 9 pixels differ"
run 1 compare a b --mask 0,0,50,4
says "overlap: equal pixels"

# One more row or column, with a rule: what both have is compared, by the limits.
larger() {
    png c/x.png "$1" "$2" 100
    png d/x.png "$3" "$4" 100 3 3 10 102 $([ "$4" -le "$2" ] || echo 3 "$2" 10 0) # what only one has is not judged
    run "$5" compare c d "${@:6}"
}
mkdir c d
echo 'rules: [{files: "*", size: 1, tolerance: 2}]' >c/compare.yaml
for sizes in "50 20 50 21" "50 21 50 20" "50 20 51 20" "50 20 49 21"; do
    larger $sizes 0 --report sizes
    says "passed: 1 frame, 1 of them not equal, but within tolerance"
    grep -q "sizes differ: 50 x 2[01] and [45][019] x 2[01] pixels; overlap: 10 pixels differ" sizes/results.json ||
        fail "the report does not tell the sizes $sizes"
done
larger 50 20 50 21 1 --tolerance 1
says "differs: x.png: sizes differ: 50 x 20 and 50 x 21 pixels; overlap: 10 pixels differ (1%) by at most 2"
larger 50 20 50 22 1
says "differs: x.png: sizes differ: 50 x 20 and 50 x 22 pixels"
larger 50 20 50 21 2 --mask 0,0,50,20
complains "c/x.png: error: the masks hide all its pixels"
echo 'rules: [{files: "*", size: 1}]' >c/compare.yaml
larger 50 20 50 21 1
larger 50 20 50 21 0 --mask 3,3,10,1

# A plot is drawn for frames of a sequence only.
film() {
    mkdir -p film.a film.b
    cp a/x.png film.a/x1.png && cp b/x.png film.b/x1.png
    cp a/x.png film.a/x2.png && cp a/x.png film.b/x2.png
    run 1 compare film.a film.b --report film
}
film
/usr/bin/python3 - <<'PYTHON' || fail "the report's pictures of different size"
import base64, json, re, struct
page = open("report/report.html").read()
size = lambda kind: struct.unpack(">II", base64.b64decode(re.search('id="p0%s">([^<]*)<' % kind, page).group(1))[16:24])
assert [size(kind) for kind in "eadf"] == [(50, 20), (40, 30), (50, 30), (40, 20)]
assert "<svg" not in page, "a plot of one picture"
assert re.search('<path class="largest" d="M', open("film/report.html").read()), "the plot lacks the overlap"
frame = json.load(open("report/results.json"))["frames"][0]
assert (frame["differing"], frame["counted"], frame["box"]) == (10, 800, [3, 3, 13, 4]) and frame["flip"] > 0
PYTHON

# The overlap is less than 1/16 of the larger picture: it is not compared.
png b/x.png 8 7 100
run 1 compare a b
says "x.png: sizes differ: 50 x 20 and 8 x 7 pixels"
! grep -q overlap out || fail "an overlap of 8 x 7 pixels is compared"
run 1 compare a b --report report --flip 1 --mask 0,0,50,20
film
/usr/bin/python3 - <<'PYTHON' || fail "the report of pictures without overlap"
import json, re
page = open("report/report.html").read()
assert [kind for kind in "eadf" if 'id="p0%s">' % kind in page] == ["e", "a"]
assert re.search('<path class="largest" d="M1 ', open("film/report.html").read()), "the plot has a difference"
frame = json.load(open("report/results.json"))["frames"][0]
assert (frame["differing"], frame["counted"], frame["box"], frame["flip"]) == (0, 0, None, None)
PYTHON
run 2 compare a b --max-pixels 999
complains "a/x.png: error: the picture has 50 x 20 pixels; at most 999 pixels can be read"
cp a/x.png whole.png
head -c -1 whole.png >a/x.png
run 2 compare a b
complains "a/x.png: error: not a PNG file, or damaged: unexpected end of file"

run 0 simulate "$scenes/stack.yaml" --frames 2 -o run.npz
for option in "--beyond 0.1" "--flip 0.1" --antialias "--rules rules.yaml"; do
    run 2 compare run.npz run.npz $option
    complains "apply to pictures only"
done
finish
