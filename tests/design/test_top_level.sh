#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What programs leave behind, such as a fuzzer's finding, is no part of the project.
. "$(dirname "$0")/../cli/checks.sh"

known="CHANGELOG.md CMakeLists.txt CMakePresets.json LICENSE README.md golden scenes shaders src tests"
# A source archive has no repository.
entries=$(git -C "$sources" -c safe.directory='*' ls-tree --name-only HEAD 2>/dev/null || ls "$sources")
found=$(grep -v -e '^\.' -e '^build$' -e '^out$' <<<"$entries" | LC_ALL=C sort | paste -sd' ')
equal "entries at the top" "$found" "$known"
finish
