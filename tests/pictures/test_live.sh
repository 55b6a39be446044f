#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A live page: its runs, also while the bomb is dragged, are those of the program (live.py).
. "$(dirname "$0")/browser.sh"
"$twinbox" page --live "$sources/scenes/single.yaml" -o /dev/null 2>&1 | grep -q "no module" &&
    echo "skipped: the build has no module for live pages" && exit 77
browse live.py
