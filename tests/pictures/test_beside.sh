#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A live page with recorded panels, and the top of a page (beside.py).
. "$(dirname "$0")/browser.sh"
need_live
browse beside.py
