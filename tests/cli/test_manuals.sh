#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The installed manual pages: one for each command, with all options and examples of its help; and completion in bash.
. "$(dirname "$0")/checks.sh"
build=$(dirname "$twinbox")
if [ ! -d "$build/man" ]; then
    command -v help2man >/dev/null && grep -q '^TWINBOX_SANITIZE:STRING=$' "$build/CMakeCache.txt" &&
        fail "this build has no manual pages"
    echo "no manual pages in this build (a sanitizer's, or without help2man): not tested"
    [ $failures -eq 0 ]
    exit $?
fi
command -v mandoc >/dev/null || { fail "mandoc is not installed (tests/setup --all)"; finish; }

cmake --install "$build" --prefix "$folder/prefix" >installed || fail "cmake --install"
pages=$folder/prefix/share/man/man1
commands=$("$twinbox" --help | awk '/^  [a-z]/ { print $1 }')
equal "pages" "$(cd "$pages" && echo *)" "$(printf '%s\n' twinbox $(printf 'twinbox-%s\n' $commands) | sed 's/$/.1/' | LC_ALL=C sort | xargs)"
for page in "$pages"/*; do
    # Pages have a version and no date; examples are as long as they are.
    mandoc -T lint "$page" | grep -v -e 'missing date, using ""' -e "input text line longer than 80" >warnings &&
        fail "mandoc warns: $(<warnings)"
    grep -q -e "$build" -e "$sources" -e "$HOME/" "$page" && fail "$page has a path of this machine"
    equal "header of $page" "$(sed -n 's/^\.TH [A-Z-]* 1 "" "\(.*\)" Twinbox$/\1/p' "$page")" "$("$twinbox" --version)"
done
. "$folder/prefix/share/bash-completion/completions/twinbox"
# complete_words WORD...: what the last word may become.
complete_words() {
    COMP_WORDS=(twinbox "$@") COMP_CWORD=$#
    _twinbox "$twinbox" "${!#}"
    printf '%s\n' "${COMPREPLY[@]}" | sort | xargs
}
equal "all commands" "$(complete_words "")" "$(printf '%s\n' $commands help | sort | xargs)"
equal "a command" "$(complete_words simu)" simulate
for name in $commands; do
    mandoc -T utf8 -O width=80 "$pages/twinbox-$name.1" | col -bx >text
    xargs -0 <text | tr -s ' \n' ' ' | grep -qF "twinbox-$name - $("$twinbox" --help | sed -n "s/^  $name  *//p")" || fail "no name in the page of $name"
    ARGP_HELP_FMT=rmargin=4000 "$twinbox" "$name" --help >help
    listed=$(sed -n '/^Example/q; s/^ \{1,6\}\(-[^ ], \|    \)\(--[a-z-]*\).*/\2/p' help | sort | xargs)
    equal "options in the page of $name" "$(sed -n '/^OPTIONS/,/^[B-NP-Z]/s/^       \(-., \)\?\(--[a-z-]*\).*/\2/p' text | sort | xargs)" "$listed"
    equal "completed options of $name" "$(complete_words "$name" --)" "$listed"
    sed -n '/^Example:/,/^$/s/^\(Example:\|        \) //p' help | while read -r line; do grep -qF "$line" text || echo "$line"; done >lacking
    equal "examples that the page of $name lacks" "$(<lacking)" ""
done
finish
