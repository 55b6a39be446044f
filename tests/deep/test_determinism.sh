#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# One thread in the locale C, and eight in German: the same bytes in all files and messages. Quick; tests/deep/determinism does the rest.
. "$(dirname "$0")/../cli/checks.sh"
. "$sources/tests/deep/german.sh"

make_german "$folder" || fail "there is no German locale"
OMP_NUM_THREADS=1 LC_ALL=C "$sources/tests/deep/outputs" "$twinbox" "$sources" one || fail "one thread"
OMP_NUM_THREADS=8 german "$sources/tests/deep/outputs" "$twinbox" "$sources" eight || fail "eight threads"
equal "files that are written" "$(find one -type f | wc -l)" 44
diff -r one eight || fail "eight threads in German write other bytes than one in C"
finish
