#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare of pictures: what a verdict rests on, what it says, and that none passes by mistake. (The judgements themselves:
# tests/regression. What is refused: refused/compare.txt.)
. "$(dirname "$0")/checks.sh"
draw() { /usr/bin/python3 "$sources/tests/cli/png.py" -; }
# Pairs of folders, with a subfolder.
fresh() {
    rm -rf a b report
    mkdir -p a/sub b/sub
    draw
    for name in home sub/x; do [ -e a/$name.png ] && [ ! -e b/$name.png ] && cp a/$name.png b/$name.png; done
}
compare() { run "$1" compare a b "${@:2}"; }
has() { grep -qF -- "$2" "$1" || fail "no '$2' in $1: $(head -c 400 "$1")"; }

# Films. One line for each cause, then counts; frames of equal states are equal, whatever the run does.
run 0 simulate "$scenes/stack.yaml" --frames 40 -o a.npz
/usr/bin/python3 - <<'PYTHON'
import numpy
run = dict(numpy.load("a.npz", allow_pickle=False))
run["camera"] = numpy.array([[0, 5], [18, 12]], numpy.float32)
numpy.savez("a.npz", **run)
run["position"][3:6, 7, 0] += 0.05 # below the bomb, which has not arrived
run["position"][8, 4, 1] += 1
numpy.savez("b.npz", **run)
run["camera"] = numpy.array([[0, 5], [20, 14]], numpy.float32)
numpy.savez("c.npz", **run)
PYTHON
render() { run 0 render "$1.npz" -o "$1" --size 640x360 --frames 0:9; }
for name in a b c; do render $name; done
mv a same
render a
run 0 compare a same
says "equal: 10 frames, 1 trajectory"
compare 1 --report report
for text in "first difference: frame_000003.png: " "states differ in panel 1: body 7 moved 1." " of them differ by at most 255: body 7 moved 1." \
    "frames 3 to 5, 8: states differ, body 7 first" "4 of 10 frames differ, 1 of 1 trajectory differs" "verdict: physics changed"; do
    says "$text"
done
equal "counts of the page" "$(sed -nE 's/^<li class="[a-z]+"><b>(.*)<.b> (.*)<.li>$/\1 \2/p' report/report.html | paste -sd,)" \
    "4 frames: physics changed,6 frames: equal pixels,1 trajectory differs"
/usr/bin/python3 - <<'PYTHON' || fail "results.json or junit.xml lacks regions, names or causes"
import json, xml.etree.ElementTree
results = json.load(open("report/results.json"))
assert results["causes"] == ["frames 3 to 5, 8: states differ, body 7 first"], results["causes"]
for number, frame in enumerate(results["frames"]):
    changed = number in (3, 4, 5, 8)
    assert frame["verdict"] == ("physics changed" if changed else "equal"), frame
    assert (frame["region_count"] > 0) == changed == (len(frame["regions"]) > 0)
    body = "body 4 moved" if number == 8 else "body 7 moved"
    assert all(region["name"].startswith(body) for region in frame["regions"]), frame["regions"]
    sizes = [region["pixels"] for region in frame["regions"]]
    assert sizes == sorted(sizes, reverse=True) and sum(sizes) == frame["differing"]
    for left, top, right, bottom in (region["box"] for region in frame["regions"]):
        assert frame["box"][0] <= left < right <= frame["box"][2] and frame["box"][1] <= top < bottom <= frame["box"][3]
text = xml.etree.ElementTree.parse("report/junit.xml").getroot()[3].find("failure").text
assert "of them differ by at most 255: body 7 moved" in text, text
PYTHON
# Other cameras come first, and name the option that avoids them. A manifest that makes no sense names no bodies.
run 1 compare a c
equal "the camera is the first line" "$(head -1 out | cut -d: -f1,2)" "frames 0 to 9: the camera differs"
says "; render with --view-from a/stack-engine.npz"
rm b/*.npz
for text in '{' '{"size": [640, 360], "view": 1}' \
    '{"size": [640, 360], "view": {"panels": [{"rectangle": [0, 0, 1e9, 1], "runs": ["../a.npz"], "scale": 1, "left": 0, "top": 0}], "parts": []}}'; do
    echo "$text" >b/manifest.json
    compare 1
    says "frame_000003.png: "
done
# Frames that only one side has; a trajectory that is damaged on one side, and what nobody can read on both.
mv same/frame_000003.png same/frame_000017.png
run 1 compare a same
says "only in a: 1 frame: frame_000003.png"
says "only in same: 1 frame: frame_000017.png"
says "verdict: 1 frame missing, 1 frame extra"
mv same/frame_000017.png same/frame_000003.png
head -c 1000 a.npz >same/stack-engine.npz
run 2 compare a same
complains "same/stack-engine.npz: error:"
head -c 1000 a.npz >a/stack-engine.npz
echo 1 >>a/stack-engine.npz
run 0 compare a same

# What cannot be read hides nothing: all others are compared and reported, and it is not approved.
fresh <<'END'
a/home.png 20 10 9
a/two.png 20 10 9
a/three.png 20 10 9
b/two.png 20 10 99
END
head -c 60 a/three.png >b/three.png
compare 2 --report unread
says "differs: two.png: 200 pixels differ"
says "1 of 2 frames differs"
says "verdict: pictures differ, 1 frame not comparable"
complains "b/three.png: error: not a PNG file, or damaged"
has unread/results.json '"name": "three.png", "verdict": "not comparable", "failed": true, "shown": false'
for file in report.html junit.xml; do has unread/$file three.png; done
cp a/three.png kept.png
run 1 approve unread # two.png is, three.png is not
cmp -s kept.png a/three.png || fail "an expected picture whose actual one cannot be read"

# Limits of the command line, of a rule, and of both: 15 of 1,000 pixels differ, 10 by 2 and 5 by 30. STATUS | options
fresh <<'END'
a/home.png 50 20 100
b/home.png 50 20 100 3*10 3 102 3*5 5 130
mask.png 50 20 0 3*5 5 255 3*10 3 255
half.png 50 20 "0 0 0 255" 3*10 3 255
END
compare 1
says "home.png: 15 pixels differ (1.5%) by at most 30, first at (3, 3)"
while IFS='|' read -r status options; do
    compare $status $options
    [[ $status = 1 || $options = --mask* ]] || says "passed: 1 frame, 1 of them not equal, but within tolerance"
done <<'END'
0|--tolerance 30
1|--tolerance 29
0|--tolerance 2 --beyond 0.005
1|--tolerance 2 --beyond 0.0049
1|--tolerance 1 --beyond 0.005
0|--beyond 15px
1|--beyond 14px
0|--mask 3,3,10,1 --mask 3,5,5,1 --tolerance 0
0|--mask 0,0,50,6
0|--mask mask.png
1|--mask 3,4,1000,1
1|--mask half.png
END
says "first at (3, 5)"
# Rules: for some names, later ones first; the command line replaces them. In the expected folder they need no option.
fresh <<'END'
a/home.png 50 20 100
a/sub/x.png 50 20 100
b/home.png 50 20 100 3*10 3 102
b/sub/x.png 50 20 100 3*10 3 102
END
echo 'rules: [{files: "*", tolerance: 2}, {files: sub/x.png, tolerance: 1, masks: [{rectangle: [3, 3, 9, 1]}]}]' >rules.yaml
compare 1 --rules rules.yaml
says "x.png: 1 pixel differs (0.101%) by at most 2, first at (12, 3)"
compare 0 --rules rules.yaml --tolerance 2
compare 1 --rules rules.yaml --tolerance 0
says "2 of 2 frames differ"
cp rules.yaml a/compare.yaml
compare 1
says "1 of 2 frames differ"
run 0 compare a/home.png b/home.png
cp a/sub/x.png b/sub/x.png
printf 'rules: [{files: sub/x.png, masks: [{rectangle: [0, 0, 50, 12]}]}]\n' >a/compare.yaml
compare 0 --mask 0,13,50,7 --tolerance 2
compare 2 --mask 0,12,50,8 # together they hide everything, though the files are equal
complains "a/sub/x.png: error: the masks hide all its pixels"
# Edges: what the limit allows is counted; without it, a region of edges says so.
fresh <<'END'
a/home.png 50 20 250 5*40 9 10
b/home.png 50 20 250 5*40 9 130 5*40 10 130 25 3 200
END
compare 1 --antialias
says "home.png: 1 pixel differs (0.1%) by at most 50, first at (25, 3); 80 pixels differ as limits allow"
compare 1
says "home.png: 81 pixels differ (8.1%) by at most 120, first at (25, 3): noise along edges"
# Pictures of different size: the overlap is compared, and the verdict stays.
fresh <<'END'
a/home.png 50 20 100
b/home.png 40 30 100 3*10 3 102 3*10 25 0
END
compare 1 --report report --tolerance 255
says "home.png: sizes differ: 50 x 20 and 40 x 30 pixels"
compare 1 --report report
says "overlap: 10 pixels differ (1.25%) by at most 2, first at (3, 3)"
compare 1 --mask 0,0,50,4
says "overlap: equal pixels"
/usr/bin/python3 - <<'PYTHON' || fail "the report's pictures of different size"
import base64, json, re, struct
page = open("report/report.html").read()
size = lambda kind: struct.unpack(">II", base64.b64decode(re.search('id="p0%s">([^<]*)<' % kind, page).group(1))[16:24])
assert [size(kind) for kind in "ead"] == [(50, 20), (40, 30), (50, 30)]
assert "<svg" not in page, "a plot of one picture"
frame = json.load(open("report/results.json"))["frames"][0]
assert (frame["differing"], frame["counted"], frame["box"]) == (10, 800, [3, 3, 13, 4])
PYTHON
draw <<<'b/home.png 8 7 100' # less than 1/16 of the larger one
compare 1 --report report
! grep -q overlap out || fail "an overlap of 8 x 7 pixels is compared"
grep -q '"differing": 0, .*"counted": 0, ' report/results.json || fail "an overlap in the report: $(cat report/results.json)"

! brief || finish

# Pictures that are no film: a line each, the worst first, with no line of a sequence.
rm a/home.png b/home.png
draw <<'END'
a/aa.png 40 8 255
a/logo.png 40 8 255
a/colour.png 40 8 255
a/plot3.png 40 8 255
b/aa.png 40 8 255 1 1 0
b/colour.png 40 8 255 1*2 1 0 30 6 9
b/plot3.png 40 9 255
END
compare 1 --report report
equal "lines of cases" "$(sed 's/; [0-9a-z]* regions\?, .*//; s/; one region of.*//' out)" "only in a: 1 frame: logo.png
differs: plot3.png: sizes differ: 40 x 8 and 40 x 9 pixels; overlap: equal pixels
differs: colour.png: 3 pixels differ (0.938%) by at most 255, first at (1, 1)
differs: aa.png: 1 pixel differs (0.312%) by at most 255, first at (1, 1)
3 of 3 frames differ
verdict: pictures differ, 1 frame missing
report -> report/report.html"
grep -q '<svg' report/report.html && fail "a plot over pictures that are no film"

# Subfolders. A folder beside itself tells nothing; runs are of the folder that they are in, and do not replace pictures.
fresh <<'END'
a/home.png 8 8 255
a/sub/x.png 8 8 255
b/sub/x.png 8 8 255 1 2 0
END
compare 1
says "sub/x.png: 1 pixel differs (1.56%) by at most 255, first at (1, 2)"
compare 0 --no-recursive
says "not compared: 1 picture in subfolders of a (--no-recursive)"
run 0 compare a a
says "expected and actual are the same folder"
cp a/sub/x.png b/sub/x.png
run 0 simulate "$scenes/single.yaml" --frames 3 -o a/sub/run.npz
run 0 simulate "$scenes/single.yaml" --frames 3 --bomb-x 1 -o b/sub/run.npz
compare 1 --report report
says "physics changed first in sub/run.npz: from frame 0"
has report/results.json '"name": "home.png", "verdict": "equal"'
has report/results.json '"name": "sub/x.png", "verdict": "physics changed"'
run 0 approve report
says "replaced a/sub/run.npz"
compare 0
says "equal: 2 frames, 1 trajectory"
echo text | tee a/run.npz >b/run.npz
compare 0
says "not compared: 1 .npz file without a trajectory"
! grep -q "2 trajectories" out || fail "text was counted as a trajectory"
rm b/run.npz b/home.png b/sub/x.png
compare 2 # the folder has runs, but no pictures
# Links within a folder are followed.
fresh <<'END'
a/home.png 8 8 255
a/sub/x.png 8 8 255
END
ln -s ../home.png a/sub/again.png
ln -s sub a/same
cp a/home.png b/sub/again.png
compare 0
says "equal: 3 frames"

# Metadata that changes the display of equal pixels.
fresh <<<'a/home.png 8 8 255'
while read -r chunk words; do
    draw <<<"b/home.png 8 8 255 $chunk"
    compare 0 --report report
    says "metadata differs in 1 frame, first in home.png: $words"
    has report/results.json '"notes": "metadata differs in 1 frame, first'
    has report/report.html 'id="notes">metadata differs in 1 frame, first'
    compare 1 --strict --report report
    says "verdict: metadata changed"
    has report/results.json '"name": "home.png", "verdict": "metadata changed", "failed": true'
    has report/junit.xml 'type="metadata changed"'
done <<'END'
gAMA=0001869f gAMA none and 0.99999
eXIf=4d4d002a00000008000101120003000000010006000000000000 orientation 1 and 6
bKGD=000000000000 bKGD none and set
END
run 0 approve report
says "replaced a/home.png"
compare 0 --strict

# Opaque white is not transparent white.
fresh <<'END'
a/home.png 8 8 255
b/home.png 8 8 "255 255 255 0"
END
compare 1
says "64 pixels differ (100%) by at most 255, first at (0, 0): the whole picture is another"

# Pictures of other kinds are told, and fail if told to.
fresh <<<'a/home.png 8 8 255'
echo 1 >a/x.webp
echo 2 >b/x.webp
echo 2 >b/sub/Y.JPG
compare 0 --report report
says "not compared: 1 picture in a that is no PNG file: x.webp (--strict fails)"
says "not compared: 2 pictures in b that are no PNG files: sub/Y.JPG, x.webp (--strict fails)"
has report/junit.xml "sub/Y.JPG, x.webp"
compare 2 --strict --report report
complains "a/x.webp: error: not a PNG file"
says "not comparable: b/sub/Y.JPG: error: not a PNG file"
says "verdict: 2 frames not comparable"
has report/results.json '"name": "x.webp", "verdict": "not comparable", "failed": true'
run 1 approve report
says "0 replaced, 0 added, 0 removed, 2 not shown"
rm a/home.png
compare 2
complains "no PNG files"

# More than one accepted picture: the closest counts, and approve replaces it. A damaged one is not passed over.
fresh <<'END'
a/home.png 8 8 255
a/home.1.png 8 8 9
a/home.2.png 8 8 9 0*2 0 0
b/home.png 8 8 9 0*2 0 0
END
compare 0
says "1 frame passed by another accepted picture"
draw <<<"b/home.png 8 8 9 0*3 0 0"
compare 0 --beyond 0.05
says "1 frame passed by another accepted picture"
compare 1 --report report
says "home.png: 1 pixel differs"
says "closest accepted picture: home.2.png"
cp a/home.png first.png
run 0 approve report --only home.png
says "replaced a/home.2.png"
cmp -s a/home.png first.png || fail "approve replaced another picture"
compare 0
cp a/home.1.png second.png
head -c 50 second.png >a/home.1.png
cp b/home.png another.png
for picture in a/home.png another.png; do # also where the first passes
    cp $picture b/home.png
    compare 2
    complains "a/home.1.png: error: not a PNG file"
done
cp second.png a/home.1.png
rm b/home.png
cp a/home.png b/other.png
compare 1 --report report
says "3 frames missing"
run 0 approve report --remove
says "0 replaced, 1 added, 3 removed"
finish
