#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# compare --server: the protocol of odiff --server, spoken from Python; and odiff's own client, where it is installed
# (in a folder of NODE_PATH, or where tests/bench/compare installs it).
. "$(dirname "$0")/checks.sh"

run 2 compare --server a.png
complains "--server: error: stands alone"
run 2 compare a.png
complains "twinbox compare: error: two inputs are needed"
/usr/bin/python3 -B "$sources/tests/cli/compare_server.py" "$twinbox" || fail "the protocol"

export NODE_PATH=${NODE_PATH:-$(dirname "$twinbox")/npm/node_modules}
if node -e 'require("odiff-bin")' 2>/dev/null; then
    TWINBOX=$twinbox node "$sources/tests/cli/compare_server.js" "$sources/golden/npm" || fail "odiff's client"
else
    echo "skipped: odiff's client needs node, and npm install --prefix build/npm odiff-bin"
fi
finish
