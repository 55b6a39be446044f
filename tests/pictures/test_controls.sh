#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Keys, mouse, fingers, time, links and measured values of the page (controls.py).
. "$(dirname "$0")/browser.sh"
need_live
browse controls.py
