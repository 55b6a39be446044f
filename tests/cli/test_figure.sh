#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Figures: every kind; every kind in every format has the bytes of golden/figures, drawn in another folder at another time.
. "$(dirname "$0")/checks.sh"

run 0 simulate "$scenes/stack.yaml" --frames 60 -o engine.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 --method momentum:k=20 -o momentum.npz

# kind FORMAT NAME ARGUMENT...
kind() {
    run 0 figure "${@:2}" --width column -o "$2.$1"
    says "$2, 85.0 x "
}
strip="engine.npz momentum.npz --at 0.2,0.5,0.9"
kind png strip $strip
kind svg strip $strip
kind pdf annotated engine.npz momentum.npz --dpi 60
kind svg annotated engine.npz momentum.npz --dpi 60
kind svg divergence engine.npz momentum.npz --scene "$scenes/stack.yaml"
kind svg strobe engine.npz --moments 5 --dpi 60
/usr/bin/python3 - <<'PYTHON' || fail "an SVG is not XML"
import xml.dom.minidom
words = {}
for name in "strip annotated divergence strobe".split():
    svg = xml.dom.minidom.parse(name + ".svg").documentElement
    assert svg.getAttribute("width") == "85.000mm", svg.getAttribute("width")
    words[name] = [text.firstChild.data for text in svg.getElementsByTagName("text")]
    assert len(words[name]) > 5 and not svg.getElementsByTagName("use"), words[name]
    assert svg.getElementsByTagName("title")[0].firstChild.data.startswith(name + " of "), name
assert {"engine", "momentum:k=20", "0.50 s"} <= set(words["strip"]), words["strip"]
PYTHON

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

/usr/bin/python3 - <<'PYTHON'
# Runs that no program made: without contacts, a body at the end of the world.
import numpy
run = dict(numpy.load("engine.npz", allow_pickle=False))
none = {key: value[:0] for key, value in run.items() if key.startswith("contact_") and key != "contact_start"}
numpy.savez("bare.npz", **{**run, **none, "contact_start": run["contact_start"] * 0})
far = run["position"].copy()
far[20:, 4] = 3e38
numpy.savez("far.npz", **{**run, "position": far})
PYTHON
run 0 figure strip bare.npz -o bare.png --dpi 60
run 0 figure strip far.npz --at 0.5 -o far.png --dpi 60
run 0 figure strobe far.npz -o far.svg --dpi 60
run 0 figure divergence engine.npz far.npz -o far.pdf
! brief || finish

# The page of figures in golden/, and the bytes of every kind in every format: equal on Debian 12 and 13. Both paths may be relative.
ln -s "$twinbox" linked
"$sources/golden/figures/draw" page ./linked >out 2>err || fail "golden/figures/draw: $(cat err)"
equal "figures with other bytes" "$(diff "$sources/golden/figures/figures.sha256" page/figures.sha256)" ""
equal "files hashed" "$(wc -l <page/figures.sha256)" 18
cmp -s "$sources/golden/figures/README.md" page/README.md || fail "golden/figures/README.md is not what golden/figures/draw writes"
finish
