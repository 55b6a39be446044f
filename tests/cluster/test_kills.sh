# SPDX-License-Identifier: GPL-3.0-or-later
# A few random kills of shards and of merges; tests/cluster/run has 40.
exec python3 "$2/tests/cluster/kills.py" "$1" "$2" 6
