#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Figures: every kind; a refused command leaves no file; every kind in every format has the bytes of golden/figures, drawn in
# another folder at another time.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 60 -o engine.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --method momentum:k=20 -o momentum.npz

# kind FORMAT NAME ARGUMENT...
kind() {
    run 0 figure "${@:2}" --width column -o "$2.$1"
    says "$2, 85.0 x "
}
kind png strip engine.npz momentum.npz --at 0.2,0.5,0.9
kind pdf annotated engine.npz momentum.npz --dpi 60
kind pdf divergence engine.npz momentum.npz --scene "$scenes/stack.yaml"
kind svg strobe engine.npz --moments 5 --dpi 60
kind pdf narrow-phase engine.npz

# 85 mm at 300 dots per inch, and no dates or paths.
pngcheck -v strip.png >checked
grep -q '1004 x' checked || fail "$(<checked)"
grep -qE 'tIME|tEXt|zTXt|iTXt' checked && fail "$(<checked)"
grep -aqE 'CreationDate|ModDate|Producer|/tmp' ./*.pdf ./*.svg && fail "a figure contains a date or a path"

run 0 figure strip engine.npz -o clear.png --transparent --dpi 100
pngcheck clear.png | grep -q 'RGB+alpha' || fail "$(pngcheck clear.png)"
run 0 figure strip engine.npz -o large.png --font-size 12 --width 120.5 --dpi 150
pngcheck large.png | grep -q '(712x' || fail "$(pngcheck large.png)"
run 0 figure strip engine.npz momentum.npz -o flat.png --at 0.5,0.6,0.9 --height 60 --bodies 1,2,3,11 --dpi 127
says "strip, 174.0 x 60.0 mm"
pngcheck flat.png | grep -q '(870x300,' || fail "$(pngcheck flat.png)"
run 0 figure strip engine.npz -o outlines.svg --outlines --dpi 60
grep -q '<text\|font-f' outlines.svg && fail "outlines with a font"
grep -q 'aria-label="engine"' outlines.svg || fail "outlines without names"
equal "title of a PDF" "$(pdfinfo annotated.pdf | sed -n 's/^Title: *//p')" "annotated of stack: engine, momentum:k=20"
equal "words of a PDF" "$(pdftotext -layout annotated.pdf - | grep -c 'impulses in N s')" 1
run 0 figure strip engine.npz --at 0.5 -o wide.png --camera 0,5,16,4 --dpi 100
run 0 figure strip engine.npz --at 0.5 -o high.png --camera 0,5,4,16 --dpi 100
cmp -s wide.png high.png && fail "--camera changes nothing"
run 0 figure strip momentum.npz --at 0.5 -o own.png --dpi 100
run 0 figure strip momentum.npz --at 0.5 -o borrowed.png --view-from momentum.npz --dpi 100
cmp -s own.png borrowed.png || fail "a run's own view is another"
rm ./*.png ./*.svg ./*.pdf

# refused MESSAGE ARGUMENT...
refused() {
    local message=$1
    shift
    run 2 figure "$@"
    complains "$message"
}
refused "'picture' is not a kind of figure; known: strip, annotated, divergence, strobe, narrow-phase" \
    picture engine.npz -o a.png
refused "a.gif: error: the name of a figure must end in .png, .svg or .pdf" strip engine.npz -o a.gif
refused "error: the name of a figure must end in" strip engine.npz -o ./png
refused "needed" strip engine.npz
refused "--camera: error: does not apply to the kind divergence" divergence engine.npz momentum.npz --camera 0,0,1,1 -o a.png
refused "--view-from: error: does not apply to the kind divergence" divergence engine.npz momentum.npz --view-from engine.npz -o a.png
refused "cannot be combined with --camera" strip engine.npz --camera 0,0,1,1 --view-from engine.npz -o a.png
refused "strobe needs 1 run (.npz), not 2" strobe engine.npz momentum.npz -o a.png
refused "divergence needs at least 2 runs (.npz), not 1" divergence engine.npz -o a.png
refused "strip needs at least 1 runs (.npz), not 0" strip -o a.png
refused "only 7 arguments can be given" strip 1 2 3 4 5 6 7 -o a.png
refused "--width: error: 'wide'" strip engine.npz -o a.png --width wide
refused "--width: error: '39'" strip engine.npz -o a.png --width 39
refused "--outlines: error: is for SVG, not for a.pdf" strip engine.npz -o a.pdf --outlines
refused "--dpi: error: '1201'" strip engine.npz -o a.png --dpi 1201
refused "--font-size: error: '0'" strip engine.npz -o a.png --font-size 0
refused "dots per inch are" strip engine.npz -o a.png --width 400 --dpi 1200
refused "dots per inch are" strip engine.npz -o a.svg --width 400 --dpi 1200
refused "--at: error: '0.5,0.2' must rise" strip engine.npz -o a.png --at 0.5,0.2
refused "--at: error: '0.5,' is not a list" strip engine.npz -o a.png --at 0.5,
refused "--at: error: 'nan' is not a list" strip engine.npz -o a.png --at nan
refused "--at: error: more than 60 moments" strip engine.npz -o a.png --at "$(seq -s, 0 0.01 0.7)"
refused "--moments: error: '61'" strip engine.npz -o a.png --moments 61
refused "--moments: error: cannot be combined with --at" strip engine.npz -o a.png --moments 3 --at 0.5
refused "engine.npz: error: has no moment at 2 s; its moments are 0 to 1 s" strip engine.npz -o a.png --at 2
refused "--scene: error: does not apply to the kind strip" strip engine.npz -o a.png --scene "$scenes/stack.yaml"
refused "--bodies: error: does not apply to the kind strobe" strobe engine.npz -o a.png --bodies 1,2
refused "--bodies: error: narrow-phase takes 2 to 2 bodies (got 1)" narrow-phase engine.npz -o a.png --bodies 1
refused "--bodies: error: narrow-phase takes 2 to 2 bodies (got 3)" narrow-phase engine.npz -o a.png --bodies 1,2,3
refused "--bodies: error: '1,' is not a list of different bodies" strip engine.npz -o a.png --bodies 1,
refused "there is no body 99" strip engine.npz -o a.png --bodies 1,99
refused "--bodies: error: cannot be combined with --camera" strip engine.npz -o a.png --bodies 1 --camera 0,1,2,3
refused "--height: error: '19'" strip engine.npz -o a.png --height 19
refused "--height: error: does not apply to the kind strobe" strobe engine.npz -o a.png --height 50
refused "--bodies: error: '1,1' is not a list of different bodies" narrow-phase engine.npz -o a.png --bodies 1,1
refused "there is no body 99" narrow-phase engine.npz -o a.png --bodies 1,99
refused "cannot be shown beside engine.npz: bodies: 12 and 3" strip engine.npz "$sources/golden/trajectories/single-engine.npz" -o a.png
refused "never diverges from engine.npz" divergence engine.npz engine.npz -o a.png
refused "single.yaml: error: is not the scene" divergence engine.npz momentum.npz --scene "$scenes/single.yaml" -o a.png
head -c 900 engine.npz >cut.npz
refused "cut.npz: error:" strip cut.npz -o a.png
refused "nowhere.npz" strip nowhere.npz -o a.png

/usr/bin/python3 - <<'PYTHON'
# Runs that no program made: without contacts, a body at the end of the world, impulses that are none, nobody there.
import numpy
run = dict(numpy.load("engine.npz", allow_pickle=False))
none = {key: value[:0] for key, value in run.items() if key.startswith("contact_") and key != "contact_start"}
numpy.savez("bare.npz", **{**run, **none, "contact_start": run["contact_start"] * 0})
far = run["position"].copy()
far[20:, 4] = 3e38
numpy.savez("far.npz", **{**run, "position": far})
numpy.savez("wild.npz", **{**run, "contact_impulse": run["contact_impulse"] * numpy.float32("nan")})
PYTHON
refused "bare.npz: error: the run has no contacts" annotated bare.npz -o a.png
refused "bare.npz: error: no two dynamic bodies touch" narrow-phase bare.npz -o a.png
run 0 figure strip bare.npz -o bare.png --dpi 60
run 0 figure strip far.npz --at 0.5 -o far.png --dpi 60
run 0 figure strobe far.npz -o far.svg --dpi 60
run 0 figure divergence engine.npz far.npz -o far.pdf
refused "wild.npz: error: step 4, contact 0: a number is NaN or infinite" annotated wild.npz -o a.png

mkdir folder.png
run 3 figure strip engine.npz -o folder.png --dpi 60
run 3 figure strip engine.npz -o nowhere/a.png --dpi 60
complains "nowhere/a.png: error:"
rm bare.png far.*
equal "left behind" "$(echo ./*.png ./*.svg ./*.pdf)" "./folder.png ./*.svg ./*.pdf"
equal "in it" "$(ls -A folder.png)" ""
! brief || finish

# The page of figures in golden/: lines and text, not pixels. Both paths may be relative.
ln -s "$twinbox" linked
"$sources/golden/figures/draw" page ./linked >out 2>err || fail "golden/figures/draw: $(cat err)"
for layout in "$sources"/golden/figures/layout/*.svg; do
    checks=$((checks + 1))
    cmp -s "$layout" "page/layout/$(basename "$layout")" || fail "$(basename "$layout") has another layout"
done
# Bytes of every kind in every format: equal on Debian 12 and 13.
equal "figures with other bytes" "$(diff "$sources/golden/figures/figures.sha256" page/figures.sha256)" ""
equal "files hashed" "$(wc -l <page/figures.sha256)" 21
cmp -s "$sources/golden/figures/README.md" page/README.md || fail "golden/figures/README.md is not what golden/figures/draw writes"

/usr/bin/python3 - <<'PYTHON' || fail "an SVG is not XML"
import xml.dom.minidom
words = {}
for name in "strip annotated divergence strobe narrow-phase".split():
    svg = xml.dom.minidom.parse(f"page/layout/{name}.svg").documentElement
    assert svg.getAttribute("width") in ("85.000mm", "174.000mm"), svg.getAttribute("width")
    words[name] = [text.firstChild.data for text in svg.getElementsByTagName("text")]
    assert len(words[name]) > 5 and not svg.getElementsByTagName("use"), words[name]
    assert svg.getElementsByTagName("title")[0].firstChild.data.startswith(name + " of "), name
assert {"engine", "pair-net", "momentum:k=20", "0.50 s"} <= set(words["strip"]), words["strip"]
PYTHON

run 2 figure engine.npz -o x.png
complains "figure: error: the kind is missing before 'engine.npz'; known: strip, annotated"
run 2 figure engine.npz
complains "the kind is missing before 'engine.npz'"
run 2 figure strip engine.npz
complains "figure: error: -o FILE is needed"
finish
