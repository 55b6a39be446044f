# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced with the binary and the sources as $1 and $2: tests of the page in Chromium.
twinbox=$1 sources=$2

# browse SCRIPT: by Debian's Python, for NumPy.
browse() {
    command -v chromium >/dev/null || { echo "FAILED: chromium is not installed; tests/setup --all does that"; exit 1; }
    PYTHONPATH=$sources/tests/browser exec /usr/bin/python3 -B "$sources/tests/pictures/$1" "$twinbox" "$sources"
}
