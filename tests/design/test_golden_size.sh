#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What is expected is kept small: at most 10 MB.
bytes=$(find "$2/golden" -type f -printf '%s\n' | awk '{ sum += $1 } END { print sum }')
echo "golden: $bytes bytes"
[ "$bytes" -gt 0 ] && [ "$bytes" -le 10000000 ]
