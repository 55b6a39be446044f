#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A report from elsewhere changes files below the current directory only, and follows no links on the way.
. "$(dirname "$0")/checks.sh"

png() { /usr/bin/python3 "$sources/tests/cli/png.py" "$1" 4 4 "$2 0 0 255"; }
mkdir -p outside/sub work/expected/sub work/actual/sub
png work/expected/a.png 10
png work/actual/a.png 200
png work/actual/b.png 100
png work/expected/sub/c.png 10
png work/actual/sub/c.png 200
cp -r work/expected expected.kept
cp work/expected/a.png outside/
cp work/expected/sub/c.png outside/sub/
base=$PWD
outside=$(sha256sum outside/*.png outside/sub/*.png)
cd work || exit 1
run 1 compare expected actual --report report
cp report/results.json good.json

# names FOLDER: the report names this expected folder. (JSON may be escaped: \u001b)
names() {
    NAME=$1 awk 'index($0, "\"expected\": \"expected\"") { $0 = "  \"expected\": \"" ENVIRON["NAME"] "\"," } { print }' \
        good.json >report/results.json
    cmp -s good.json report/results.json && [ "$1" != expected ] && fail "the report was not changed"
}
refused() {
    names "$1"
    run 2 approve report
    complains "$2"
    complains "--expected DIR"
    equal "outside, where the report names $1" "$(cd "$base" && sha256sum outside/*.png outside/sub/*.png)" "$outside"
    [ ! -e "$base/outside/b.png" ] || fail "a file was added outside, where the report names $1"
}
refused "$base/outside" "report/results.json: error: the expected folder '$base/outside' is not below the current directory"
refused ../outside "the expected folder '../outside' is not below the current directory"
refused .. "the expected folder '..' is not below"
refused "${PWD}x" "is not below the current directory"
ln -s ../outside link
refused link "the expected folder 'link' cannot be opened without following links"
refused link/sub "'link/sub' cannot be opened without following links"
refused '\u001b]0;title\u0007' "the expected folder '\\x1b]0;title\\x07' cannot be opened"
grep -q $'\e' err && fail "an escape sequence of a report reaches the terminal"

# The user may name any folder, also by a link.
names nowhere
run 2 approve report --expected nowhere
complains "nowhere: error: the folder cannot be opened"
cp -r expected there
ln -s there elsewhere
run 0 approve report --expected elsewhere
says "added elsewhere/b.png"
says "2 replaced, 1 added, 0 removed"
diff -r there actual >differences || fail "elsewhere is not as actual: $(cat differences)"

# Below it, no link is followed, whoever named it.
for option in "" "--expected expected"; do
    names expected
    rm -rf expected/sub
    ln -s ../../outside/sub expected/sub
    run 2 approve report $option
    complains "expected/sub/c.png: error: its folder cannot be opened, or is a link"
    rm expected/sub
    cp -r "$base/expected.kept/sub" expected/sub
done
equal "outside, behind a link" "$(cd "$base" && sha256sum outside/*.png outside/sub/*.png)" "$outside"

# A folder that turns into a link and back, while files below it are replaced.
swaps() {
    while [ -e going ]; do
        mv expected/sub expected/kept && ln -s ../../outside/sub expected/sub
        rm expected/sub
        mv expected/kept expected/sub
    done
}
touch going
swaps 2>/dev/null &
swapping=$!
for _ in {1..5}; do
    rm -f expected/b.png
    cp "$base/expected.kept/a.png" expected/a.png
    cp "$base/expected.kept/sub/c.png" expected/sub/c.png 2>/dev/null
    "$twinbox" approve report >out 2>err
done
rm going
wait $swapping
equal "outside, while a folder turned into a link" "$(cd "$base" && sha256sum outside/*.png outside/sub/*.png)" "$outside"
rm -rf expected
cp -r "$base/expected.kept" expected

# A file that has a second name outside is replaced, not written to.
ln -f expected/a.png "$base/outside/a.png"
run 0 approve report
equal "outside, with a second name of an expected file" "$(cd "$base" && sha256sum outside/*.png outside/sub/*.png)" "$outside"
rm -rf expected
cp -r "$base/expected.kept" expected

# The current directory, and paths below it, as users write them.
for path in .//expected "$PWD//expected/./"; do
    names "$path"
    run 0 approve report
    says "2 replaced, 1 added, 0 removed"
    diff -r expected actual >differences || fail "expected is not as actual: $(cat differences)"
    rm -rf expected
    cp -r "$base/expected.kept" expected
done
# The command on the page works where compare ran.
on_page() { sed -n 's/.*\(<code>twinbox approve .*\)<.code> replaces.*/\1/p' report/report.html | sed 's/<[^>]*>//g'; }
run 1 compare expected actual --report report
equal "the command on the page" "$(on_page)" "twinbox approve report"
cp -r expected ../beside
run 1 compare ../beside actual --report report
equal "the command on the page" "$(on_page)" "twinbox approve report --expected ../beside"
run 0 $(on_page | sed 's/^twinbox //')
says "replaced ../beside/a.png"
cd expected || exit 1
"$twinbox" compare . ../actual --report ../here >/dev/null
run 0 approve ../here
says "replaced ./a.png"
finish
