#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page in Firefox: states, keys and a picture (smoke.py). Firefox is large: `tests/deep/run firefox` installs it, and
# without it this test is skipped.
if ! command -v firefox-esr >/dev/null && ! command -v firefox >/dev/null; then
    echo "skipped: firefox-esr is not installed; tests/setup firefox-esr does that"
    exit 77
fi
PYTHONPATH=$2/tests/browser exec /usr/bin/python3 -B "$2/tests/pictures/smoke.py" "$1" "$2"
