#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Traces of other programs: the printers of the page write files that are compared; one is compared with many.
. "$(dirname "$0")/checks.sh"

# Each printer of the page prints the same trace of a falling body, decimals and hexadecimal alike.
page=$sources/golden/traces.md
[ -e "$page" ] || fail "no page"
/usr/bin/python3 - "$page" <<'PYTHON' || fail "the printers of the page"
import pathlib, re, sys
for name, text in re.findall(r"```\w+ file=(\S+)\n(.*?)```", pathlib.Path(sys.argv[1]).read_text(), re.S):
    pathlib.Path(name).write_text(text)
PYTHON
${CC:-cc} -ffp-contract=off -o printer_c printer.c -lm || fail "printer.c"
./printer_c >c.csv
others=c.csv
if command -v "${CXX:-c++}" >/dev/null; then
    "${CXX:-c++}" -ffp-contract=off -o printer_cpp printer.cpp || fail "printer.cpp"
    ./printer_cpp >cpp.csv
    others+=" cpp.csv"
fi
if command -v rustc >/dev/null; then
    rustc -o printer_rust printer.rs 2>/dev/null || fail "printer.rs"
    ./printer_rust >rust.csv
    others+=" rust.csv"
fi
if command -v node >/dev/null; then
    node printer.mjs >js.csv || fail "printer.mjs"
    others+=" js.csv"
fi
cp c.csv again.csv
run 0 compare c.csv again.csv $others
says "$(($(echo "$others" | wc -w) + 1)) of $(($(echo "$others" | wc -w) + 1)) equal"

# Many inputs: a line, a table, JSON, a report. What is missing in a folder fails.
sed 's/^137,0,[^,]*,/137,0,9,/' c.csv >other.csv
run 1 compare c.csv again.csv other.csv --report report
says "1 of 2 equal; other.csv parts in frame 137 at body 0 (motion)"
says "other.csv  physics changed   frame 137, body 0: motion: more than roundings, in 1 body"
equal "files" "$(ls report | tr '\n' ' ')" "junit.xml report.html results.json run.html "
grep -q 'tests="2" failures="1"' report/junit.xml || fail "junit.xml"
grep -q 'run.html#t=2.28' report/report.html || fail "no link to the first difference"
run 1 compare c.csv again.csv other.csv --json
/usr/bin/python3 -c 'import json; j = json.load(open("out")); assert j["passed"] == 1 and j["runs"][1]["frame"] == 137, j' ||
    fail "JSON"
mkdir expected arm wasm
cp c.csv expected/one.csv
cp c.csv expected/two.csv
cp expected/* arm
cp other.csv wasm/one.csv
cp c.csv wasm/three.csv
run 1 compare expected arm wasm
says "1 of 2 equal; wasm/one.csv parts in frame 137 at body 0 (motion)"
says "wasm/two.csv    missing"
says "wasm/three.csv  extra"
run 2 compare c.csv again.csv nothing.csv
complains "nothing.csv: error: cannot open: No such file or directory"
says "1 of 2 equal; nothing.csv: "

# From standard input, and in two folders.
"$twinbox" compare c.csv - <other.csv >out && fail "standard input is not read"
says "first difference: frame 137, body 0"
run 1 compare expected wasm
says "only in expected: 1 trajectory: two.csv"
finish
