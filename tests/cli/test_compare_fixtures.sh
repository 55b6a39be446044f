#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare and its server on pictures with which pixelmatch, odiff and BlazeDiff test themselves (fixtures/, by their licences):
# the counts that their tests expect, or another for a reason (tests/bench/compare/fixtures.csv).
. "$(dirname "$0")/checks.sh"

"$sources/tests/bench/compare/fixtures" "$(dirname "$twinbox")" >out 2>err || fail "$(tail -n 20 out err)"
says "45 of 76 rows, 0 failures"
finish
