#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# 200 runs have the verdict that an eye gave them before it was read (labels/runs.csv); tests/run without --all judges a
# sample of them.
exec "$2/tests/runs/labels/judge" "$1" ${TWINBOX_BRIEF:+4}
