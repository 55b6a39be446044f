#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Numbers of README.md, of the results and of the figures' page come from files that commands wrote (numbers.py).
exec /usr/bin/python3 -B "$(dirname "$0")/numbers.py" "$2"
