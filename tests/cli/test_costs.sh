#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What commands cost, in instructions, and pages in bytes: at most 2% more than in golden/costs.csv.
exec "$2/tests/costs" "$1"
