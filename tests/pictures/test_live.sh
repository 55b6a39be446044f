#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A live page: its runs, also while the bomb is dragged, are those of the program (live.py).
. "$(dirname "$0")/browser.sh"
need_live
browse live.py
