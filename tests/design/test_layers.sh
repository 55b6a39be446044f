#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The diagram in src/README.md has the edges of src/layers.txt, and its table has the folders.
set -u
layers=$(grep '^[a-z]' "$2/src/layers.txt")
page=$2/src/README.md

# "cli: report paper" and "cli --> report & paper" both become "cli report" and "cli paper".
declared=$(awk -F: '{ count = split($2, names, " "); for (i = 1; i <= count; i++) print $1, names[i] }' <<<"$layers" | sort)
drawn=$(sed -n '/^```mermaid/,/^```$/{s/&//g; s/^ *\([a-z_.]*\) *--> *\(.*\)/\1:\2/p}' "$page" |
    awk -F: '{ count = split($2, names, " "); for (i = 1; i <= count; i++) print $1, names[i] }' | sort)
listed=$(sed -n '/^| room |/,/^$/{s/^| \([a-z_, ]*\) |.*/\1/p}' "$page" | grep -v '^room$' | tr -d ' ' | tr ',' '\n' | sort)
folders=$(cut -d: -f1 <<<"$layers" | grep -v '^main.c$' | sort)

status=0
[ -n "$drawn" ] || { echo "src/README.md has no diagram"; status=1; }
diff <(echo "$declared") <(echo "$drawn") || { echo "< src/layers.txt, > the diagram in src/README.md"; status=1; }
diff <(echo "$folders") <(echo "$listed") || { echo "< src/layers.txt, > the table of rooms in src/README.md"; status=1; }
exit $status
