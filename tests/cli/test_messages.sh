#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Values that look like options, and a lack of memory. (What others wrote: refused/hostile.txt.)
. "$(dirname "$0")/checks.sh"
scene=$scenes/single.yaml
run 2 render a.npz --tint red -o d
! grep -q "did you mean" err || fail "a suggestion from afar: $(<err)"

# What begins with a dash is a value where an option needs one.
run 0 simulate "$scene" -q --frames 2 -o "--$(printf 'x%.0s' {1..100}).npz"
[ -s ./--xxx*.npz ] || fail "a long value that begins with dashes was taken for an option"
run 0 simulate "$scene" --frames 2 -o a.npz --bomb-x -1

# Too little memory for OpenGL is not a missing package. (Sanitizers need more than any limit.)
few=60000
if (ulimit -v $few && "$twinbox" methods >/dev/null 2>&1); then
    status=$(ulimit -v $few && "$twinbox" render a.npz -o d --size 80x64 >out 2>err; echo $?)
    equal "exit status with little memory" "$status" 3
    complains "limited to $((few / 1024)) MiB (ulimit -v)"
    grep -q "install" err && fail "little memory is taken for a missing package: $(cat err)"
    grep -q "warning" err && fail "a library prints: $(cat err)"
fi
finish
