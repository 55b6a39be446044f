#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page in Firefox: states, keys and a picture (smoke.py).
. "$(dirname "$0")/browser.sh"
browse_firefox smoke.py
