#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What CI systems read: annotations and step summary of GitHub Actions, TAP, JUnit. No name can become a command, a
# directive or markup.
. "$(dirname "$0")/checks.sh"
unset GITHUB_STEP_SUMMARY
umask 022

/usr/bin/python3 - <<'PYTHON'
import os, struct, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
def picture(path, grey):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 1, 8, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(bytes([0, 9, grey]))) + chunk(b"IEND", b""))
for folder, grey in ("few/a", 9), ("few/b", 12):
    for i in range(4):
        picture(f"{folder}/f_{i}.png", grey if i in (1, 3) else 9)
# Every second of 40 frames fails; in a row, every one of 30.
for folder, grey in ("many/a", 9), ("many/b", 12):
    for i in range(40):
        picture(f"{folder}/f_{i}.png", grey if i % 2 == 0 else 9)
for folder, grey in ("row/a", 9), ("row/b", 12):
    for i in range(30):
        picture(f"{folder}/f_{i}.png", grey)
    picture(f"{folder}/home.png", grey)
    picture(f"{folder}/menu.png", grey)
hostile = ["::error title=x::y", "##[add-mask]x", "a%0A::warning::b", "x,line=1:2", "a|b`c``d", "<script>alert(1)",
           "[x](javascript:1)", "# TODO later", "x # SKIP", "back\\slash\\", "]]>&amp;", "\ufffe\uffff", "@me $x$ :+1:", "_a_ *b*"]
for folder, grey in ("hostile/a", 9), ("hostile/b", 12):
    for name in hostile:
        picture(f"{folder}/{name}.png", grey)
for folder, grey in ("crowd/a", 9), ("crowd/b", 12):
    for i in range(3000):
        picture(f"{folder}/{'`' * 120}{i}.png", grey)
PYTHON

# Without the option there are no commands, and no summary is written.
GITHUB_STEP_SUMMARY=$folder/no.md run 1 compare few/a few/b
! grep -q '^::' out || fail "commands without --annotations"
[ ! -e no.md ] || fail "a summary without --annotations"
run 2 compare few/a few/b --annotations gitlab
complains "--annotations: error: 'gitlab'"

# annotated FOLDER: the annotations, in annotations.
annotated() {
    run 1 compare "$1/a" "$1/b" --annotations github --report report
    grep '^::error' out >annotations
}
annotated few
cat >wanted <<'TEXT'
::error file=few/a/f_1.png,title=pictures differ::f_1.png: 1 pixel differs (50%25) by at most 3, first at (1, 0): noise
::error file=few/a/f_3.png,title=pictures differ::f_3.png: 1 pixel differs (50%25) by at most 3, first at (1, 0): noise
TEXT
equal "the annotations" "$(cat annotations)" "$(cat wanted)"
# What names files stands where the runner does not look for commands.
token=$(sed -n 's/^::stop-commands:://p' out)
[ "$(sed -n "/^::stop-commands::$token\$/,/^::$token::\$/p" out | grep -c 'f_[0-9]')" -eq "$(grep -v '^::error' out | grep -c 'f_[0-9]')" ] ||
    fail "names outside of the part without commands"
cp out before
run 1 compare few/a few/b --annotations github
[ "$(sed -n 's/^::stop-commands:://p' out)" != "$token" ] || fail "the token can be known before"

annotated many
equal "annotations of 20 failures" "$(wc -l <annotations)" 10
equal "the last one" "$(tail -n 1 annotations)" "::error title=twinbox compare::11 more failures; the step summary and the report list them"
annotated row
equal "annotations of a sequence and two pictures" "$(cut -d' ' -f2- annotations | cut -c1-80)" "file=row/a/f_0.png,title=pictures differ::f_0.png to f_29.png, 30 frames; the fi
file=row/a/home.png,title=pictures differ::home.png: 1 pixel differs (50%25) by 
file=row/a/menu.png,title=pictures differ::menu.png: 1 pixel differs (50%25) by "
run 0 compare few/a few/a --annotations github
! grep '^::error' out || fail "an annotation of equal pictures"
head -c 40 few/a/f_1.png >few/b/f_1.png
run 2 compare few/a few/b --annotations github
grep -q '^::error title=twinbox compare::few/b/f_1.png: error' out || fail "a damaged file has no annotation: $(cat out)"

export GITHUB_STEP_SUMMARY=$folder/summary.md
annotated hostile
run 1 compare many/a many/b --annotations github
/usr/bin/python3 - <<'PYTHON' || fail "hostile names: see above"
import json, os, re, urllib.parse, xml.etree.ElementTree
names = sorted(os.listdir("hostile/a"))
assert 'of 1 x 1 pixels at (1, 0)' in open("report/junit.xml", encoding="utf-8").read()
lines = open("annotations", encoding="utf-8").read().splitlines()
assert len(lines) == 10, lines
for line in lines[:9]:
    found = re.fullmatch(r"::error file=([^:,]*),title=pictures differ::(.*)", line)
    assert found, line
    file, message = map(urllib.parse.unquote, found.groups())
    assert os.path.exists(file) and message.startswith(os.path.basename(file) + ": 1 pixel"), line

# The summary: every name in a code span of its own, and five cells in every row.
def cells(row):
    return [part.strip() for part in re.split(r"(?<!\\)\|", row)[1:-1]]
text = open("summary.md", encoding="utf-8").read()
first = text.split("### twinbox compare: ")[1]
rows = [line for line in first.split("\n") if line.startswith("| `")]
shown = []
for row in rows:
    assert len(cells(row)) == 5, row
    span = re.fullmatch(r"(`+) (.*) \1", cells(row)[0])
    assert span and span[1] not in re.findall("`+", span[2]), row
    shown.append(span[2].replace("\\|", "|"))
assert sorted(shown) == names, (shown, names)
assert cells(rows[0])[1] == "pictures differ" and cells(rows[0])[4] == "3", rows[0]
assert float(cells(rows[0])[3]) > 0, "FLIP of a report"
assert text.count("### twinbox compare: pictures differ") == 2, "the second comparison replaced the first summary"
assert not re.search(r"<script|javascript", re.sub(r"(`+) .*? \1", "", text))

tests = [line for line in open("report/results.tap", encoding="utf-8") if re.match("(not )?ok ", line)]
assert len(tests) == len(names) and all(line.startswith("not ok") for line in tests)
assert not any(re.search(r"(?<!\\)#", line) for line in tests), tests
suite = xml.etree.ElementTree.parse("report/junit.xml").getroot() # refuses what is not XML
clean = [re.sub("[\ufffe\uffff]", "\ufffd", name) for name in names]
assert sorted(case.get("name") for case in suite) == sorted(clean), [case.get("name") for case in suite]
PYTHON
# TAP as Perl's own reader sees it.
if command -v prove >/dev/null; then
    prove --exec cat report/results.tap >proved 2>&1
    grep -q "Failed 14/14 subtests" proved || fail "prove: $(cat proved)"
fi

# What a comparison leaves out is in all of them.
mkdir sub.a sub.b sub.a/inner sub.b/inner
cp few/a/f_0.png sub.a/ && cp few/a/f_0.png sub.b/
cp few/a/f_0.png sub.a/inner/ && cp few/a/f_1.png sub.b/inner/
GITHUB_STEP_SUMMARY=$folder/sub.md run 0 compare sub.a sub.b --no-recursive --annotations github --report report
grep -q '^# not compared: 1 picture in subfolders of sub.a' report/results.tap || fail "no note in results.tap"
grep -q '^- not compared.*1 picture in subfolders of sub.a' sub.md || fail "no note in the summary: $(cat sub.md)"
/usr/bin/python3 - <<'PYTHON' || fail "no note in junit.xml"
import xml.etree.ElementTree
assert "not compared: 1 picture in subfolders of sub.a" in xml.etree.ElementTree.parse("report/junit.xml").find("system-out").text
PYTHON

! brief || finish

# A summary of which GitHub would refuse all is cut, and what was there before counts.
rm summary.md
run 1 compare crowd/a crowd/b --annotations github
size=$(wc -c <summary.md)
[ "$size" -lt 1048576 ] && [ "$size" -gt 100000 ] || fail "the summary has $size bytes"
rows=$(grep -c '^| `' summary.md)
grep -q "^$((3000 - rows)) more failures are in the report.\$" summary.md || fail "the summary does not count what it leaves out"
for _ in 1 2; do run 1 compare crowd/a crowd/b --annotations github; done
[ "$(wc -c <summary.md)" -lt 1048576 ] || fail "three summaries have $(wc -c <summary.md) bytes"
head -c 1048500 /dev/zero >summary.md
run 1 compare few/a many/b --annotations github
equal "a full summary" "$(wc -c <summary.md)" 1048500
GITHUB_STEP_SUMMARY=$folder/nowhere/summary.md
run 3 compare many/a many/b --annotations github
complains "nowhere/summary.md: error: cannot write"
GITHUB_STEP_SUMMARY=
run 1 compare many/a many/b --annotations github
finish
