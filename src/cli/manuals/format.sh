#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The manual page of a file format, from sections of the Markdown page that explains it, by cmark-gfm. A line of pages.txt
# has the name, the summary, the page, whether its introduction is taken (1), the commands to see also, and the sections.
#     format.sh PAGE VERSION SOURCES NAME        writes the page
set -eu
output=$1 version=$2 sources=$3 name=$4
LC_ALL=C.UTF-8
export LC_ALL
folder=$(dirname "$0")
line=$(grep "^$name|" "$folder/pages.txt")
IFS='|' read -r _ summary page intro commands sections <<END
$line
END
escaped=$(printf %s "$name" | sed 's/-/\\-/g')
# A section that has got another name is left out; tests/cli/test_manuals.sh fails then, not every build.
markdown=$(awk -v intro="$intro" -v sections="$sections" -f "$folder/page.awk" "$sources/$page") || true

{
    cat <<END
'\\" t
.TH $(printf %s "$name" | tr a-z A-Z) 5 "" "twinbox $version" Twinbox
.ad l
.SH NAME
$escaped \\- $summary
.SH DESCRIPTION
END
    printf '%s\n' "$markdown" | cmark-gfm --extension table --to man | awk -f "$folder/man.awk"
    printf '.SH SEE ALSO\n.BR twinbox (1)'
    for command in $commands; do printf ',\n.BR twinbox\\-%s (1)' "$command"; done
    echo
} >"$output.part"
mv "$output.part" "$output"
