#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The module in Node.js: runs have the hashes and verdicts of twinbox simulate, and what is wrong ends in an error.
set -eu
build=$(dirname "$1") launches=${TWINBOX_LAUNCHES:-70}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$2"

skip() { echo "skipped: $1"; exit 77; }
for module in networks plain; do
    "$build/tests/pack_live" "$folder/$module.wasm" $module
done
[ -s "$folder/plain.wasm" ] || skip "this build is without the module for live pages (TWINBOX_LIVE)"
command -v node >/dev/null || skip "there is no node (Debian: nodejs)"

node tests/live/check.mjs "$folder/networks.wasm" "$1" "$build/tests/pack_live" "$launches"
node tests/live/hostile.mjs "$folder/networks.wasm" "$folder/plain.wasm" "$build/tests/pack_live"
