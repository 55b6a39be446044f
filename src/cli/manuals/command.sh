#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The manual page of a command, from its help by help2man. What help2man does not read well comes from here: the synopsis,
# headings between options, examples. The same help gives the same bytes.
#     command.sh PAGE VERSION TWINBOX SUMMARY [COMMAND]    writes the page
#     command.sh --as-help TWINBOX [COMMAND] --help        prints the help as help2man reads it best
set -eu
LC_ALL=C
ARGP_HELP_FMT=rmargin=4000,opt-doc-col=60
export LC_ALL ARGP_HELP_FMT
folder=$(dirname "$0")

if [ "$1" = --as-help ]; then
    shift
    case $* in *--version) exec "$1" --version ;; esac
    "$@" | awk -f "$folder/help.awk"
    exit
fi

# The formats that name this command, or all pages.
see_also() {
    if [ -n "$command" ]; then
        printf '.BR twinbox (1)'
        formats=$(awk -F '|' -v command="$command" 'index(" " $5 " ", " " command " ") { print $1 }' "$folder/pages.txt")
    else
        separator=""
        for name in $("$twinbox" --help | awk '/^  [a-z]/ { print $1 }'); do
            printf '%s.BR twinbox\\-%s (1)' "$separator" "$name"
            separator=",
"
        done
        formats=$(cut -d '|' -f 1 "$folder/pages.txt")
    fi
    for name in $formats; do printf ',\n.BR %s (5)' "$(printf %s "$name" | sed 's/-/\\-/g')"; done
    echo
}

page=$1 version=$2 twinbox=$3 summary=$4 command=${5-}
include=$(mktemp)
trap 'rm -f "$include" "$include.page"' EXIT
"$twinbox" $command --help | awk -v part=include -f "$folder/help.awk" >"$include"
cat >>"$include" <<END
[EXIT STATUS]
.TP
.B 0
done and equal
.TP
.B 1
done and different
.TP
.B 2
bad usage or input
.TP
.B 3
the system failed (disk, memory, a missing program)
.TP
.B 130
interrupted by SIGINT (Ctrl-C) or SIGTERM

[SEE ALSO]
$(see_also)
END
# A page has the version, not the day on which it was made.
help2man --no-info --section 1 --manual Twinbox --source "twinbox $version" --version-string "$version" --name "$summary" \
    --include "$include" "sh '$0' --as-help '$twinbox' $command" |
    sed -e "/^\.\\\\\" DO NOT MODIFY/d" \
        -e "s/^\.TH .*/.TH TWINBOX$(printf %s "${command:+-$command}" | tr a-z A-Z) 1 \"\" \"twinbox $version\" Twinbox/" \
        -e "/^\.SH NAME/{n;s/.*/twinbox${command:+\\\\-$command} \\\\- $summary/;}" |
    awk -f "$folder/code.awk" >"$include.page"
grep -q '^\.SH OPTIONS' "$include.page" || [ -z "$command" ]
cp "$include.page" "$page"
