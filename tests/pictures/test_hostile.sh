#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Pages of runs that are strange, large or hostile (hostile.py).
. "$(dirname "$0")/browser.sh"
browse hostile.py
