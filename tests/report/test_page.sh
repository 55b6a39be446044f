#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page of a comparison in a browser: presses keys and checks what the page shows.
. "$(dirname "$0")/../cli/checks.sh"

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 8 --bomb-x 1 -o b.npz
run 0 render a.npz -o "expected</script>" --size 80x64 --frames 0:4
run 0 render b.npz -o actual --size 80x64 --frames 1:5
cp "expected</script>/frame_000003.png" actual/frame_000003.png
rm actual/*.npz
run 1 compare "expected</script>" actual --report report

# The page has no external references.
[ "$(grep -cE '(src|href)="?(https?:|//|file:)|@import|url\(' report/report.html)" -eq 0 ] || fail "the page fetches something"
[ "$(ls report)" = "$(printf 'junit.xml\nreport.html\nresults.json')" ] || fail "the report needs other files"

# Appended to the page: presses keys and writes what it sees into #seen, one line per step.
cat >probe.html <<'PROBE'
<pre id="seen"></pre>
<script>
(async () => {
  const get = id => document.getElementById(id), seen = [];
  const wait = async () => {
    do await new Promise(done => setTimeout(done, 20)); while (get("stage").getAttribute("aria-busy") !== "false");
  };
  const press = async (key, target) => {
    (target || document.body).dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true, cancelable: true}));
    await wait();
  };
  const pressed = () => [...document.querySelectorAll("[id^=mode-][aria-pressed=true]")].map(b => b.id).join();
  const images = () => [...document.querySelectorAll("#sheet img")].map(i => i.alt.split(" ")[0] + ":" + i.naturalWidth);
  const note = (what, ...values) => seen.push(what + ": " + values.join(" | "));
  const place = () => [get("name").textContent, get("frame-verdict").textContent, get("place").textContent];
  try {
    await wait();
    note("title", document.title);
    note("rows", document.querySelectorAll("#rows button").length);
    note("start", ...place(), pressed(), ...images());
    await press("ArrowRight");
    note("right", ...place(), pressed(), ...images());
    note("row", document.querySelector("#rows [aria-current=true]").textContent);
    note("swipe", getComputedStyle(document.querySelectorAll("#sheet img")[1]).clipPath);
    await press("]");
    note("swipe more", getComputedStyle(document.querySelectorAll("#sheet img")[1]).clipPath, get("blend").value);
    await press("7");
    note("onion", pressed(), getComputedStyle(document.querySelectorAll("#sheet img")[1]).opacity);
    await press("6");
    await press("p");
    note("blink", pressed(), get("blink-what").textContent, get("pause").textContent);
    await press("b");
    note("blinked", get("blink-what").textContent, ...[...document.querySelectorAll("#sheet img")].map(i => getComputedStyle(i).opacity));
    for (const key of ["1", "2", "3", "4"]) { await press(key); note("key " + key, pressed(), ...images()); }
    await press("5");
    await press("m");
    note("mark", get("ring").hidden, get("ring-button").getAttribute("aria-pressed"));
    await press("+");
    note("zoom", get("zoom").value, get("sheet").style.width);
    await press("0");
    await press("End");
    note("end", ...place(), pressed(), ...images());
    note("cannot", get("mode-swipe").disabled, get("next").disabled);
    await press("ArrowRight");
    note("beyond", ...place());
    await press("Home");
    await press("a");
    note("all", document.querySelectorAll("#rows button").length, get("all").checked, ...place());
    get("scrubber").value = 4;
    get("scrubber").dispatchEvent(new Event("input"));
    await wait();
    note("scrubbed", ...place(), get("nothing").hidden, get("nothing").textContent);
    await press("ArrowRight", get("scrubber"));
    note("own keys", get("place").textContent);
    await press("a");
    note("failures", document.querySelectorAll("#rows button").length, ...place());
    const svg = document.querySelector("#plot svg"), box = svg.getBoundingClientRect();
    svg.dispatchEvent(new MouseEvent("click", {clientX: box.left + box.width * (50 + 1140 * 2.5 / 6) / 1200, clientY: box.top + 9}));
    await wait();
    note("plot", ...place(), document.querySelector("#plot .cursor").getAttribute("x1"));
    document.querySelectorAll("#rows button")[0].click();
    await wait();
    note("click", ...place());
    await press("?");
    note("help", get("help").open, document.activeElement.tagName);
    note("unnamed", [...document.querySelectorAll("button, input, select, img, [role=region], [role=img]")].filter(e =>
      !(e.textContent.trim() || e.getAttribute("aria-label") || e.alt || (e.labels && e.labels.length))).map(e => e.outerHTML).join());
    note("fetched", performance.getEntriesByType("resource").filter(r => !r.name.startsWith("data:")).length);
  } catch (error) { note("error", error); }
  get("seen").textContent = "BEGIN\n" + seen.join("\n") + "\nEND";
})();
</script>
PROBE
browse() {
    cat report/report.html probe.html >probed.html
    timeout 120 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$folder/profile" --window-size=1280,900 \
        --virtual-time-budget=60000 --dump-dom "file://$folder/probed.html" >dom 2>chromium.err || fail "chromium: $(tail -n 3 chromium.err)"
    sed -n '/BEGIN/,/END/p' dom | sed 's/&lt;/</g; s/&gt;/>/g; s/&amp;/\&/g' >out
    grep -q END out || fail "the page's script did not come to its end: $(tail -n 3 chromium.err)"
}
if command -v chromium >/dev/null; then
    browse
    says "title: twinbox compare: physics changed, 1 frame missing, 1 frame extra"
    says "rows: 5"
    says "start: frame_000000.png | missing | 1 of 5 | mode-expected | expected:80"
    says "right: frame_000001.png | physics changed | 2 of 5 | mode-swipe | expected:80 | actual:80"
    says "row: frame_000001.pngphysics changed"
    says "swipe: inset(0px 0px 0px 50%)"
    says "swipe more: inset(0px 0px 0px 55%) | 55"
    says "onion: mode-onion | 0.55"
    says "blink: mode-blink | Now: expected | Continue"
    says "blinked: Now: actual | 0 | 1"
    says "key 1: mode-expected | expected:80"
    says "key 2: mode-actual | actual:80"
    says "key 3: mode-difference | difference:80"
    says "key 4: mode-flip | FLIP:80"
    says "mark: true | false"
    says "zoom: 1 | 80px"
    says "end: frame_000005.png | extra | 5 of 5 | mode-actual | actual:80"
    says "cannot: true | true"
    says "beyond: frame_000005.png | extra | 5 of 5"
    says "all: 6 | true | frame_000000.png | missing | 1 of 6"
    says "scrubbed: frame_000003.png | equal | 4 of 6 | false | Equal pictures are not included in this report."
    says "own keys: 4 of 6"
    says "failures: 5 | frame_000004.png | physics changed | 4 of 5"
    says "plot: frame_000002.png | physics changed | 3 of 5 | 525"
    says "click: frame_000000.png | missing | 1 of 5"
    says "help: true | SUMMARY"
    [ "$(grep '^unnamed:' out)" = "unnamed: " ] || fail "without a name: $(grep '^unnamed:' out)"
    says "fetched: 0"
    ! grep '^error:' out || fail "the page's script failed"

    # A comparison that passes has a page too.
    run 0 compare actual actual --report report
    browse
    says "title: twinbox compare: equal"
    says "rows: 0"
else
    fail "chromium is not installed; tests/setup chromium does that"
fi
finish
