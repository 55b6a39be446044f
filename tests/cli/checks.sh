# SPDX-License-Identifier: GPL-3.0-or-later
# What the command line tests share. Sourced with the binary and the sources as $1 and $2; leaves a fresh folder as
# the working directory. Ends with `finish`.
set -u
twinbox=$1
sources=$2
scenes=$sources/scenes
failures=0
checks=0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# Whether the binary is a sanitizer's, which is up to ten times slower: it runs fewer cases of a kind (sanitized.h).
sanitized() { grep -q "^TWINBOX_SANITIZE:STRING=." "$(dirname "$twinbox")/CMakeCache.txt" 2>/dev/null; }

# Whether a script ends once it has been through its command's code: by a sanitizer, and by tests/run without --all.
brief() { [ "${TWINBOX_BRIEF-}" ] || sanitized; }

# run STATUS ARGUMENT...: output goes to out, errors to err; the exit status must be STATUS. Tests run side by side, and a
# second process that draws takes longer to start than small frames take to draw: one process, unless the test says how many.
run() {
    local wanted=$1 status
    shift
    [ "${1-}" != render ] || [[ " $* " == *" --jobs"* ]] || set -- render --jobs 1 "${@:2}"
    "$twinbox" "$@" >out 2>err </dev/null
    status=$?
    checks=$((checks + 1))
    [ $status -eq "$wanted" ] || fail "twinbox $*: exit status $status, not $wanted: $(head -c 400 err)"
}

# The last run's output, or errors, contain this text.
says() {
    checks=$((checks + 1))
    grep -qF -- "$1" out || fail "no '$1' in the output: $(head -c 400 out)"
}
complains() {
    checks=$((checks + 1))
    grep -qF -- "$1" err || fail "no '$1' in the errors: $(head -c 400 err)"
}

# equal WHAT A B
equal() {
    checks=$((checks + 1))
    [ "$2" = "$3" ] || fail "$1: '$2', not '$3'"
}

# unchanged FOLDER TEXT ARGUMENT...: the command is refused with this text, and the folder's files stay as they are.
unchanged() {
    local place=$1 text=$2 before
    shift 2
    before=$(find "$place" -type f | sort | xargs md5sum)
    run 2 "$@"
    complains "$text"
    equal "files after '$text'" "$(find "$place" -type f | sort | xargs md5sum)" "$before"
}

# strike SIGNAL STATUS WHEN ARGUMENT...: sends the signal to the command once the shell command WHEN succeeds, and checks
# how it ends.
strike() {
    local signal=$1 wanted=$2 when=$3
    shift 3
    nice "$twinbox" "$@" >out 2>err </dev/null & # after this loop on a busy machine: the signal has to come in time
    until eval "$when" >/dev/null 2>&1 || ! kill -0 $! 2>/dev/null; do sleep 0.01; done
    kill -"$signal" $!
    wait $! 2>/dev/null
    equal "exit status of $1 after $signal" $? "$wanted"
}

# run_undrawn PICTURE ARGUMENT...: a folder in the place of the picture lets drawing fail, and so the command.
run_undrawn() {
    mkdir -p "$1"
    run 3 "${@:2}"
    complains "$1: error: cannot write: Is a directory"
    rmdir "$1"
}

# make_tower: tower.yaml, a stack whose height is a parameter.
make_tower() {
    cat >tower.yaml <<'YAML'
parameters: {height: {from: 1, to: 4, value: 2, whole: on}}
gravity: [0, -10]
dt: 1/60
iterations: 10
frames: 60
bodies:
  - {static: true, size: [100, 20], position: [0, -10], friction: 0.2}
  - {pattern: stack, count: $height, size: [1, 1], mass: 1, position: [0, 0.5], spacing: [0, 1], friction: 0.2}
YAML
}

finish() {
    echo "$checks checks, $failures failed"
    [ $checks -gt 0 ] && [ $failures -eq 0 ]
    exit $?
}
