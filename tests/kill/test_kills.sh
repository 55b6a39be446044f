# SPDX-License-Identifier: GPL-3.0-or-later
# A sample of what tests/kill/run does: about twenty kills.
set -eu
some() { python3 "$2/tests/kill/kills.py" "$1" "$2" --no-terms --most "${@:3}"; }
some "$1" "$2" 4 render-jobs video approve dataset train-pair-net
