# SPDX-License-Identifier: GPL-3.0-or-later
# What the tests of the report's page share. Sourced after cli/checks.sh.

# browse PAGE [OPTION...]: opens the page, with probe.html behind it, in a browser 1440 pixels wide and 900 high. What
# the probe's script writes into #seen goes to out.
browse() {
    local page=$1
    shift
    /usr/bin/python3 - "$page" <<'PYTHON' || fail "the page allows more scripts than its own"
import base64, hashlib, re, sys
page, probe = open(sys.argv[1], encoding="utf-8").read(), open("probe.html", encoding="utf-8").read()
allow = lambda script: "'sha256-" + base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() + "'"
find = lambda text: re.search(r"<script>(.*?)</script>", text, re.DOTALL)[1]
policy = f"script-src {allow(find(page))}\">"
assert page.count(policy) == 1, policy
open("probed.html", "w", encoding="utf-8").write(page.replace(policy, f"{policy[:-2]} {allow(find(probe))}\">") + probe)
PYTHON
    load probed.html "$@"
}

# load PAGE [OPTION...]
load() {
    local page=$1
    shift
    timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$folder/profile" \
        --window-size=1440,900 --virtual-time-budget=60000 "$@" --dump-dom "file://$folder/$page" >dom 2>chromium.err ||
        fail "chromium: $(tail -n 3 chromium.err)"
    sed -n '/BEGIN/,/END/p' dom | sed 's/&lt;/</g; s/&gt;/>/g; s/&amp;/\&/g' >out
    grep -q END out || fail "the page's script did not come to its end: $(tail -n 3 chromium.err)"
}
