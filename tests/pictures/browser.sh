# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced with the binary and the sources as $1 and $2: tests of the page in browsers.
twinbox=$1 sources=$2

skip() { echo "skipped: $1"; exit 77; }

# By Debian's Python, for NumPy.
run() {
    local script=$sources/tests/pictures/$1
    shift
    PYTHONPATH=$sources/tests/browser exec /usr/bin/python3 -B "$script" "$twinbox" "$sources" "$@"
}

# browse SCRIPT ...: in Chromium.
browse() {
    command -v chromium >/dev/null || { echo "FAILED: chromium is not installed; tests/setup --all does that"; exit 1; }
    run "$@"
}

need_live() {
    "$twinbox" page --live "$sources/scenes/single.yaml" -o /dev/null 2>&1 | grep -q "no module" &&
        skip "the build has no module for live pages"
    return 0
}
