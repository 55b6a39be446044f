#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page's states bit by bit, and where it draws boxes (states.py).
. "$(dirname "$0")/browser.sh"
browse states.py
