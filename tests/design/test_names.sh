#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The files and folders that comments of C name exist: files by their name, or any end of their path; folders by their whole path.
cd "$2" || exit 1
find src tests golden shaders scenes | awk '
    function check(name, where) {
        if (name in known || name ~ /[A-Z]/) return # NAME.c: any
        print where ": there is no " name
        failed = 1
    }
    {
        if ($0 ~ /^(src|tests)\/.*\.[ch]$/) sources[++count] = $0
        end = $0
        do known[end]; while (sub(/^[^\/]*\//, "", end))
    }
    END {
        known["cmocka.h"] known["sanitizer/allocator_interface.h"] # of libraries
        for (i = 1; i <= count; i++)
            for (line = 1; (getline text < sources[i]) > 0; line++) {
                if (text ~ /^ *#/) continue
                where = sources[i] ":" line
                gsub(/"([^"\\]|\\.)*"/, "", text)
                rest = text
                while (match(rest, /[A-Za-z0-9_\/-]+\.(c|h|cmake|sh|py|js|mjs|vert|frag|css)([^a-z0-9_]|$)/)) {
                    name = substr(rest, RSTART, RLENGTH)
                    rest = substr(rest, RSTART + RLENGTH)
                    sub(/[^a-z]$/, "", name)
                    check(name, where)
                }
                while (match(text, /(^|[^A-Za-z0-9_\/.-])(src|tests|golden|shaders)\/[A-Za-z0-9_\/-]*[A-Za-z0-9_]([^A-Za-z0-9_.*]|[.]([^a-z]|$)|$)/)) {
                    name = substr(text, RSTART, RLENGTH)
                    text = substr(text, RSTART + RLENGTH)
                    gsub(/^[^a-z]+|[^A-Za-z0-9_]+$/, "", name)
                    check(name, where)
                }
            }
        exit failed
    }'
