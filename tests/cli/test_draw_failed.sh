#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a study has measured is kept until it is drawn: where gnuplot fails, the next run draws, and measures nothing again.
. "$(dirname "$0")/checks.sh"

mkdir programs
cat >programs/gnuplot <<'END'
#!/bin/sh
[ "$1" = --version ] || { echo "no space left" >&2; exit 1; }
END
chmod +x programs/gnuplot

# continues KEPT COMMAND...: KEPT is a pattern of the files that are kept. The same command with the real gnuplot ends well,
# and removes them, but does not make them.
continues() {
    local kept=$1
    shift
    PATH="$PWD/programs:$PATH" run 3 "$@"
    complains "no space left"
    equal "what is kept of $1" "$(compgen -G "$kept" | wc -l)" 1
    sed -i "$change" $kept
    run 0 "$@"
    equal "what is left of $1" "$(compgen -G "$kept" | wc -l)" 0
}

change='s/engine,k=10,\(.*\),frozen,\(.*\),[^,]*$/&/'
