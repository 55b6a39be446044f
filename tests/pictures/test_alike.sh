#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page's canvas has the pixels of render's frames, but for the smoothing of edges (alike.py).
. "$(dirname "$0")/browser.sh"
browse alike.py
