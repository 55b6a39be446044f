#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# twinbox page: the same bytes, sizes, nothing that is left behind, and whether the scripts are JavaScript.
export PYTHONPATH=$2/tests/browser PYTHONDONTWRITEBYTECODE=1
. "$(dirname "$0")/../cli/checks.sh"

names() { find . -mindepth 1 -printf '%P\n' | LC_ALL=C sort | tr '\n' ' '; }
make() { /usr/bin/python3 -B "$sources/tests/pictures/hostile_runs.py" "$@" || fail "no runs $*"; }

# The same bytes from another folder; nothing of the machine.
run 0 simulate "$scenes/stack.yaml" --frames 60 -o engine.npz
run 0 simulate "$scenes/stack.yaml" --frames 60 -m momentum -o momentum.npz
run 0 page engine.npz momentum.npz -o first.html
says "2 runs of 61 frames, "
mkdir elsewhere
TZ=Asia/Tokyo LC_ALL=C run 0 page "$PWD/engine.npz" "$PWD/momentum.npz" -o elsewhere/second.html
cmp -s first.html elsewhere/second.html || fail "the same runs give other bytes"
/usr/bin/python3 - <<'PYTHON' >texts || fail "the packed texts"
import player_page
page = open("first.html", encoding="utf-8").read()
for element in "data", "viewer":
    print(player_page.unpacked(page, element).decode())
PYTHON
for word in "$PWD" "$sources" "$(date +%Y)-"; do
    ! grep -qF -- "$word" first.html texts || fail "the page holds '$word'"
done
! grep -qE '(src|href)="?(https?:|//|file:)|@import|url\(' first.html texts || fail "the page fetches something"

# An older page stays where a run is refused (all that is: tests/cli/refused/render.txt), the disk is full, or files are limited.
make names nan_velocity
echo older >kept.html
kept=$(names)
run 2 page nan_velocity.npz -o kept.html
complains "nan_velocity.npz: error: frame 1, body 1"
equal "files after a refused command" "$(names)" "$kept"
equal "the older page" "$(<kept.html)" older
run 3 page engine.npz -o /dev/full
complains "No space left"
ulimit -S -f 8 # blocks of 1 KiB
run 3 page engine.npz -o kept.html
complains "kept.html: error: cannot write: File too large"
run 3 page engine.npz -o new.html
ulimit -S -f unlimited
equal "files of pages beyond the limit" "$(names)" "$kept"
equal "the older page" "$(<kept.html)" older

# 100,000 frames that do not pack are refused with a step that suffices.
if ! brief; then
    make too_long
    run 2 page too_long.npz -o long.html
    complains "--every"
    [ ! -e long.html ] || fail "a refused page was written"
    run 0 page too_long.npz $(grep -o -- '--every [0-9]*' err) -o long.html
    [ "$(stat -c %s long.html)" -le $((64 << 20)) ] || fail "a page of $(stat -c %s long.html) bytes"
    rm -f too_long.npz long.html
fi

# Sizes: two runs of ten seconds of the settled pyramid, and what is not data.
if ! brief; then
    for method in engine pair-net; do
        run 0 simulate "$scenes/pyramid_settled.yaml" --frames 600 -m $method -o "pyramid-$method.npz"
    done
    run 0 page pyramid-engine.npz pyramid-pair-net.npz -o pyramid.html
    bytes=$(stat -c %s pyramid.html)
    [ "$bytes" -le 1000000 ] || fail "two runs of the settled pyramid take $bytes bytes"
fi
run 0 page names.npz -o names.html
/usr/bin/python3 - <<'PYTHON' || fail "the code"
import base64, hashlib, re
import player_page
page = open("names.html", encoding="utf-8").read()
begin, = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
viewer = player_page.unpacked(page, "viewer")
open("begin.js", "w", encoding="utf-8").write(begin)
open("viewer.js", "wb").write(viewer)
# The policy allows these two scripts, by their hashes, and no other.
allowed = [base64.b64encode(hashlib.sha256(script).digest()).decode()
           for script in (begin.encode(), viewer)]
assert f"script-src 'sha256-{allowed[0]}' 'sha256-{allowed[1]}'\">" in page, "another policy"
# Names are in data only, and end no element there.
assert page.count("</script>") == page.count("<script"), "another element"
assert page.count("<img") == 0 and "<!--" not in page, "markup of a name"
style = re.search(r"<style>.*</style>", page, re.DOTALL)[0]
body = page[page.index("<body>"):page.index('<script type="text/plain"')]
size = len((style + body + re.search('id="viewer">.*', page)[0] + begin).encode())
assert size <= 60000, f"{size} bytes of script, style and markup"
PYTHON
checks=$((checks + 1))

# The scripts as the page has them, and each as it is written.
if ! brief; then
    command -v node >/dev/null || fail "node is not installed; tests/setup --all does that"
    for script in begin.js viewer.js "$sources"/src/pictures/player/*.js "$sources"/tests/pictures/*.js; do
        checks=$((checks + 1))
        node --check "$script" >out 2>&1 || fail "$script: $(head -c 400 out)"
    done
    # It sees a name that is declared twice.
    sed 's/^const COMPONENTS = /const COMPONENTS = 0; &/' viewer.js >twice.js
    ! node --check twice.js 2>/dev/null || fail "node --check accepts anything"
fi
finish
