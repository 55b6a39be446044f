#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every #include in src/ keeps to the direction of dependencies in src/layers.txt.
set -u
cd "$2/src" || exit 1
# A header without a folder lies beside the file or is made by the build.
grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"[^"]*/' . --include='*.[ch]' | awk -F'[:"]' '
    # All rooms that this one may include from.
    function reach(room, from,    names, i, n) {
        may[room, from] = may[room, "common"] = 1
        n = split(neighbours[from], names, " ")
        for (i = 1; i <= n; i++) reach(room, names[i])
    }
    FILENAME != "-" { if (/^[a-z]/) neighbours[$1] = substr($0, length($1) + 2); next }
    {
        split($1, path, "/")
        split($4, target, "/")
        if (!(path[2] in neighbours)) {
            if (!missed[path[2]]++) print "src/" path[2] " is missing in src/layers.txt"
            failed = 1
        } else if (!reached[path[2]]++) reach(path[2], path[2])
        if (!((path[2], target[1]) in may)) {
            print substr($1, 3) ":" $2 ": may not include " $4
            failed = 1
        }
    }
    END { exit failed }' layers.txt -
