# SPDX-License-Identifier: GPL-3.0-or-later
# A small study by scenes/cluster/parallel.sh, whose shards are killed twice; tests/cluster/run has larger ones.
exec python3 "$2/tests/cluster/scripts.py" "$1" "$2" parallel --small
