#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The installed manual pages: one for each command and file format, with all that the help and the Markdown page have.
. "$(dirname "$0")/checks.sh"
build=$(dirname "$twinbox")
manuals=$sources/src/cli/manuals
if [ ! -d "$build/man" ]; then
    command -v help2man cmark-gfm >/dev/null && grep -q '^TWINBOX_SANITIZE:STRING=$' "$build/CMakeCache.txt" &&
        fail "this build has no manual pages"
    echo "no manual pages in this build (a sanitizer's, or without help2man or cmark-gfm): not tested"
    [ $failures -eq 0 ]
    exit $?
fi

cmake --install "$build" --prefix "$folder/prefix" >installed || fail "cmake --install"
pages=$folder/prefix/share/man
commands=$("$twinbox" --help | awk '/^  [a-z]/ { print $1 }')
formats=$(cut -d '|' -f 1 "$manuals/pages.txt")
equal "formats with a page" "$(echo $formats | tr ' ' '\n' | sort | xargs)" \
    "$(printf 'twinbox-%s\n' scene run problem dataset network json verdict rules report manifest shards | sort | xargs)"
equal "pages of section 1" "$(cd "$pages/man1" && echo *)" "$(printf '%s\n' twinbox $(printf 'twinbox-%s\n' $commands) | sed 's/$/.1/' | LC_ALL=C sort | xargs)"
equal "pages of section 5" "$(cd "$pages/man5" && echo *)" "$(printf '%s.5\n' $formats | sort | xargs)"

# shown PAGE: as text of 80 columns, without bold and underlining.
shown() { mandoc -T utf8 -O width=80 "$1" | col -bx; }
# section NAME: the lines of that section of text, as one.
section() { awk -v name="$1" '/^[A-Z]/ { found = $0 == name; next } found { print }' text | xargs -0 | tr -s ' \n' ' ' | sed 's/^ //; s/ $//'; }

# lacking FILE <LINES: those that are nowhere in the file.
lacking() { awk 'NR == FNR { text = text $0 "\n"; next } !index(text, $0)' "$1" -; }

if ! command -v mandoc >/dev/null; then
    fail "mandoc is not installed (tests/setup --all)"
    finish
fi
version=$("$twinbox" --version)
groff=
if ! command -v groff >/dev/null; then
    :
elif printf '.TH A 1\n.SH B\n' | groff -man -ww -z 2>&1 | grep -q .; then
    echo "groff has no macros for manual pages: not tested"
else
    groff=yes
fi
for page in "$pages"/man?/*; do
    checks=$((checks + 1))
    # Pages have a version and no date; examples are as long as they are.
    mandoc -T lint "$page" | grep -v -e 'missing date, using ""' -e "input text line longer than 80" >warnings &&
        fail "mandoc warns: $(<warnings)"
    if [ $groff ]; then
        LC_ALL=C.UTF-8 groff -t -k -man -T utf8 -ww -z "$page" 2>warnings
        [ -s warnings ] && fail "groff warns: $(<warnings)"
    fi
    grep -q -e "$build" -e "$sources" -e "$HOME/" "$page" && fail "$page has a path of this machine"
    equal "header of $page" "$(sed -n 's/^\.TH [A-Z-]* [15] "" "\(.*\)" Twinbox$/\1/p' "$page")" "$version"
    # Every page that it refers to is there.
    sed -n 's/^\.BR \(.*\) (\([15]\)).*/\1.\2/p' "$page" | tr -d '\\' | sort -u >named
    [ -s named ] || fail "$page has nothing to see also"
    while read -r name; do [ -s "$pages/man${name##*.}/$name" ] || fail "$page refers to $name, which is not there"; done <named
done

for name in $commands; do
    page=$pages/man1/twinbox-$name.1
    summary=$("$twinbox" --help | sed -n "s/^  $name  *//p")
    shown "$page" >text
    equal "name in $page" "$(section NAME)" "twinbox-$name - $summary"
    ARGP_HELP_FMT=rmargin=4000 "$twinbox" "$name" --help >help
    equal "synopsis in $page" "$(section SYNOPSIS)" \
        "$(sed -n 's/^\(Usage\|  or\): *//p' help | xargs -0 | tr -s ' \n' ' ' | sed 's/ $//')"
    sed -n '/^Example/q; s/^ \{1,6\}\(-[^ ], \|    \)\(--[a-z-]*\).*/\2/p' help | sort >listed
    sed -n '/^OPTIONS/,/^[B-NP-Z]/s/^       \(-., \)\?\(--[a-z-]*\).*/\2/p' text | sort >paged
    equal "options in $page" "$(<paged)" "$(<listed)"
    checks=$((checks + $(wc -l <listed)))
    sed -n '/^Example:/,$s/^\(Example:\|        \) /       /p' help >examples
    equal "examples that $page lacks" "$(lacking text <examples)" ""
    checks=$((checks + $(wc -l <examples)))
    equal "defaults that $page lacks" "$(sed -n 's/.*(default: \([^);,]*\)).*/\1/p' help | tr ' ' '\n' | lacking text)" ""
done

# Indented lines of a description are code.
shown "$pages/man1/twinbox-import.1" | grep -qx ' *# dt: 1/60' || fail "the code in the page of import is filled"

# Each line of code and each key of a table is in the page of its format.
for name in $formats; do
    line=$(grep "^$name|" "$manuals/pages.txt")
    IFS='|' read -r _ _ file intro _ wanted <<<"$line"
    awk -v intro="$intro" -v sections="$wanted" -f "$manuals/page.awk" "$sources/$file" >markdown ||
        fail "src/cli/manuals/pages.txt: not all sections of $name are in $file"
    shown "$pages/man5/$name.5" >page
    equal "code that $name.5 lacks" \
        "$(awk '/^ *```/ { fenced = !fenced; next } fenced && NF { print; n++ } END { print n > "count" }' markdown | lacking page)" ""
    sed -n 's/^| *`\([a-z_]*\)` .*/       \1 /p' markdown >keys
    equal "keys of tables that $name.5 lacks" "$(lacking page <keys)" ""
    checks=$((checks + $(<count) + $(wc -l <keys)))
    [ "$(grep -c '^|' markdown)" -eq 0 ] || grep -q '^\.TS' "$pages/man5/$name.5" || fail "$name.5 has no table"
    equal "marks of Markdown in $name.5" "$(grep -cF -e '](' -e '```' -e '**' page)" 0
done

# The same sources give the same pages, from any folder and on any day.
mkdir again
sh "$manuals/format.sh" again/run.5 "$("$twinbox" --version | cut -d ' ' -f 2)" "$sources" twinbox-run
cmp again/run.5 "$pages/man5/twinbox-run.5" || fail "another page of runs"
SOURCE_DATE_EPOCH=1 sh "$manuals/command.sh" again/solve.1 "$("$twinbox" --version | cut -d ' ' -f 2)" "$twinbox" \
    "$("$twinbox" --help | sed -n 's/^  solve *//p')" solve
cmp again/solve.1 "$pages/man1/twinbox-solve.1" || fail "another page of solve"
sed 's/^## Datasets/## Data/' "$sources/src/runs/README.md" >changed.md
awk -v intro=1 -v sections=Datasets -f "$manuals/page.awk" changed.md >out 2>err && fail "a section that is gone is not missed"
complains "not all of these sections are there: Datasets"
finish
