#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# junit.xml, which CI systems read: every case with its verdict, whatever the names are, and the notes.
. "$(dirname "$0")/checks.sh"

/usr/bin/python3 - <<'PYTHON'
import os, struct, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
def picture(path, grey):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(bytes([0, 9, grey]))) + chunk(b"IEND", b""))
hostile = ["::error title=x::y", "##[add-mask]x", "a%0A::warning::b", "x,line=1:2", "a|b`c``d", "<script>alert(1)",
           "[x](javascript:1)", "# TODO later", "x # SKIP", "back\\slash\\", "]]>&amp;", "\ufffe\uffff", "@me $x$ :+1:", "_a_ *b*"]
for folder, grey in ("hostile/a", 9), ("hostile/b", 12):
    for name in hostile:
        picture(f"{folder}/{name}.png", grey)
PYTHON
run 1 compare hostile/a hostile/b --report report
/usr/bin/python3 - <<'PYTHON' || fail "hostile names: see above"
import os, re, xml.etree.ElementTree
suite = xml.etree.ElementTree.parse("report/junit.xml").getroot() # refuses what is not XML
names = sorted(re.sub("[\ufffe\uffff]", "\ufffd", name) for name in os.listdir("hostile/a"))
assert sorted(case.get("name") for case in suite) == names, [case.get("name") for case in suite]
assert all("of 1 x 1 pixels at (1, 0)" in case.find("failure").get("message") for case in suite)
PYTHON
! grep -v -e '^differs: ' -e '^and more' -e '^[0-9]* of ' -e '^verdict: ' -e '^report -> ' out || fail "a line that begins with a name"

# What a comparison leaves out is told.
mkdir -p sub.a/inner sub.b/inner
cp hostile/a/_a_*.png sub.a/x.png
cp sub.a/x.png sub.b
cp sub.a/x.png sub.a/inner
run 0 compare sub.a sub.b --no-recursive --report report
/usr/bin/python3 - <<'PYTHON' || fail "no note in junit.xml"
import xml.etree.ElementTree
assert "not compared: 1 picture in subfolders of sub.a" in xml.etree.ElementTree.parse("report/junit.xml").find("system-out").text
PYTHON
finish
