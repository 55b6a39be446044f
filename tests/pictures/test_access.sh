#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page for readers with other eyes and hands: names, contrast, sizes, the Tab key (access.py).
. "$(dirname "$0")/browser.sh"
browse access.py
