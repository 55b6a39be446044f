# SPDX-License-Identifier: GPL-3.0-or-later
# Marked blocks of all Markdown pages run in a fresh copy of the sources (pages.py).
exec /usr/bin/python3 -B "$2/tests/design/pages.py" "$1" "$2" blocks
