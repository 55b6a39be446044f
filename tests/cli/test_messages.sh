#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Messages: what others wrote cannot command a terminal or a log, length is bounded, and the reason is the true one.
. "$(dirname "$0")/checks.sh"
scene=$scenes/single.yaml
hostile=$'\e[31mred\n::error::x\u009b'

# Nothing that the last run printed has a control character but ends of lines, nor a line of the hostile text's own.
visible() {
    checks=$((checks + 1))
    LC_ALL=C grep -qP '[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|^::' out err && fail "$1: $(cat -v out err | head -c 300)"
    [ "$(cat out err | wc -c)" -lt 1500 ] || fail "$1: $(cat out err | wc -c) bytes"
}
refuse() {
    run 2 "$@"
    visible "${*: -2}"
    complains "${seen:-\\x1b[31mred\\n::error::x\\u009b}"
}
refuse "$hostile"
refuse help "$hostile"
refuse simulate "--$hostile"
refuse simulate "--$hostile=1" "$scene"
refuse simulate "-$hostile"
refuse simulate "-q$hostile"
refuse methods "$hostile"
refuse compare a b "$hostile"
refuse simulate "$hostile" -o a.npz
refuse check "$hostile"
seen="--frames: error: the text has the control character U+001B"
refuse simulate "$scene" --frames "$hostile"
refuse simulate "$scene" "--fram=$hostile"
seen="control character U+001B"
refuse simulate "$scene" --method "$hostile"
refuse simulate "$scene" --set "$hostile=1"
refuse simulate "$scene" -o "$hostile.npz"
refuse simulate "$scene" "-o$hostile.npz"
refuse simulate "$scene" "-qo$hostile.npz"
refuse render a.npz -o d --title "$hostile"
refuse render a.npz -o d --title "-$hostile"
refuse compare a b --report "$hostile"
refuse approve report --only "$hostile"
refuse simulate -- "$hostile"
seen="control character U+202E"
refuse simulate "$scene" -o $'gpj\u202e.npz'
equal "files that were made" "$(find . -type f | sort | xargs)" "./err ./out"

# A mistyped option gets a suggestion, where one is near.
seen="twinbox render: error: unrecognized option '--vidoe'; did you mean '--video'?"
refuse render a.npz --vidoe=b.mp4 -o d
seen="did you mean '--help'?"
refuse render --hepl
seen="unrecognized option '--tint'"
refuse render a.npz --tint red -o d
! grep -q "did you mean" err || fail "a suggestion from afar: $(<err)"
seen="option '--s' is ambiguous"
refuse render a.npz --s 2 -o d

# Long texts are echoed in part, and the reason follows them.
long=$(head -c 100000 /dev/zero | tr '\0' x)
short=xxxxxxxx
seen="$short' is not a command"
refuse "$long"
seen="unrecognized option '--$short"
refuse simulate "--$long"
seen="unrecognized option '--$short"
refuse simulate "--$long=1"
seen="$short' is not expected"
refuse methods "$long"
seen="$short' is one more"
refuse simulate "$scene" "$long"
seen="$short: error: "
refuse check "$long"
seen=".yaml: error: "
refuse check "$long.yaml"
seen="is not a whole number"
refuse simulate "$scene" --frames "$long"
refuse simulate "$scene" --frames "--$long"
seen="is not a number"
refuse simulate "$scene" --bomb-x "$long"
seen="is not NAME=VALUE"
refuse simulate "$scene" --set "$long"

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
