#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The launches and the drag of live.py in Firefox.
. "$(dirname "$0")/browser.sh"
need_live
browse_firefox live.py --browser firefox
