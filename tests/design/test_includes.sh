#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every #include in src/ keeps to the direction of dependencies in src/layers.txt, and no room includes another one's internal
# headers.
set -u
cd "$2/src" || exit 1
# A header without a folder lies beside the file or is made by the build.
grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]*/' . --include='*.[ch]' | awk -F'[:"]' '
    # All rooms that this one may include from.
    function reach(room, from,    names, i, n) {
        may[room, from] = may[room, "base"] = 1
        n = split(neighbours[from], names, " ")
        for (i = 1; i <= n; i++) reach(room, names[i])
    }
    function complain(what) { print what; failed = 1 }
    FILENAME != "-" { if (/^[a-z]/) neighbours[$1] = substr($0, length($1) + 2); next }
    {
        split($1, path, "/")
        split($4, target, "/")
        room = path[2]
        place = "src/" substr($1, 3) ":" $2
        if (!(room in neighbours)) {
            if (!missed[room]++) complain("src/" room " is missing in src/layers.txt")
            next
        }
        if (!reached[room]++) reach(room, room)
        if (!((room, target[1]) in may)) complain(place ": may not include " $4)
        if ($4 ~ /[\/_]internal\.h$/ && target[1] != room) complain(place ": " $4 " is for its own room")
    }
    END { exit failed }' layers.txt -
