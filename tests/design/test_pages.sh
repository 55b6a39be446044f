#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Markdown pages: links, README's limits, options of commands, and the blocks marked as quick (pages.py).
exec /usr/bin/python3 -B "$(dirname "$0")/pages.py" "$1" "$2"
