#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Small files that would cost much: refused within the budgets of README.md.
. "$(dirname "$0")/../cli/checks.sh"
here=$sources/tests/hostile
any=
! sanitized || any=any
[ -n "$any" ] || command -v valgrind >/dev/null || fail "valgrind is not installed; tests/setup --all does that"
/usr/bin/python3 "$here/make_files.py" || fail "no files"
/usr/bin/python3 "$here/measure.py" "$twinbox" "$scenes" $any || fail "a budget"
checks=1
finish
