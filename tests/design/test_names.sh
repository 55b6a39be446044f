#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The C files and headers that comments name exist: alone, with their folder, or with their path.
cd "$2" || exit 1
find src tests -name '*.[ch]' | awk '
    { paths[NR] = $0; n = split($0, part, "/"); known[$0]; known[part[n]]; known[part[n - 1] "/" part[n]] }
    END {
        known["cmocka.h"] known["sanitizer/allocator_interface.h"] # of libraries
        for (i = 1; i <= NR; i++)
            for (line = 1; (getline text < paths[i]) > 0; line++) {
                if (text ~ /^ *#/) continue
                while (match(text, /[A-Za-z0-9_\/]+\.[ch]([^a-z0-9_"]|$)/)) {
                    name = substr(text, RSTART, RLENGTH)
                    text = substr(text, RSTART + RLENGTH)
                    sub(/[^ch]$/, "", name)
                    if (name in known || name ~ /[A-Z]/) continue # NAME.c: any
                    print paths[i] ":" line ": there is no " name
                    failed = 1
                }
            }
        exit failed
    }'
