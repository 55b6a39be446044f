#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The manual page of a command, from its help by help2man. The same help gives the same bytes.
#     command.sh PAGE VERSION TWINBOX SUMMARY [COMMAND]    writes the page
#     command.sh --as-help TWINBOX [COMMAND] --help        prints the help with a heading above its options, without examples
set -eu
LC_ALL=C
ARGP_HELP_FMT=rmargin=4000,opt-doc-col=60
export LC_ALL ARGP_HELP_FMT

if [ "$1" = --as-help ]; then
    shift
    "$@" | sed -e '/^\(Exit status\|Example\|Begin with\):/,/^$/d' -e '/^Mandatory or optional/d' |
        awk '!headed && /^ +-/ { print "Options:"; headed = 1 } /^[A-Z].*:$/ { print "" }
             headed && sub(/^ [A-Za-z]/, substr($0, 2, 1)) { print ""; sub(/: /, ":\n  "); } { print }'
    exit
fi

page=$1 version=$2 twinbox=$3 summary=$4 command=${5-}
name=twinbox${command:+\\\\-$command}
include=$(mktemp)
trap 'rm -f "$include" "$page.part"' EXIT
{
    printf '[EXAMPLES]\n.nf\n'
    "$twinbox" $command --help | sed -n '/^\(Example\|Begin with\):/,/^$/{s/^\(Example\|Begin with\): *//;s/^ *//;s/-/\\-/g;s/^\./\\\&./;/./p;}'
    printf '.fi\n\n[EXIT STATUS]\n0: done and equal. 1: different or incomplete. 2: bad input. 3: failure of the system. 130: interrupted.\n'
    printf '\n[SEE ALSO]\n'
    [ -z "$command" ] || echo '.BR twinbox (1)'
    [ -n "$command" ] || "$twinbox" --help | sed -n 's/^  \([a-z]*\)  .*/.BR twinbox\\-\1 (1)/p'
} >"$include"
# A page has the version, not the day on which it was made.
help2man --no-info --section 1 --manual Twinbox --source "twinbox $version" --version-string "$version" --name "$summary" \
    --include "$include" "sh '$0' --as-help '$twinbox' $command" |
    sed -e '/DO NOT MODIFY/d' -e "s/^\.TH .*/.TH TWINBOX$(printf %s "${command:+-$command}" | tr a-z A-Z) 1 \"\" \"twinbox $version\" Twinbox/" \
        -e '/^\.SH DESC/,/^\.SH O/{/^\.IP$/,/^\.PP/{s/^\.IP$/.PP\n.RS 4\n.nf/;s/^\.PP$/.fi\n.RE\n.PP/;};}' -e "/^\.SH NAME/{n;s/.*/$name \\\\- $summary/;}" >"$page.part"
mv "$page.part" "$page"
