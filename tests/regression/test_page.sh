#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page of a comparison in a browser. Its keys, links, lists and marks; and as readers see it: contrast of all text (WCAG
# 2.2 AA: 4.5, large text 3) in both colour schemes, no clipped label at a width of 390 pixels, the frame slider
# above the fold at 1440 x 900, and the order of the Tab key.
. "$(dirname "$0")/../cli/checks.sh"
command -v chromium >/dev/null || fail "chromium is not installed; tests/setup chromium does that"

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

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 8 --bomb-x 1 -o b.npz
run 0 render a.npz -o "expected</script>" --size 80x64 --frames 0:4
run 0 render b.npz -o actual --size 80x64 --frames 1:5
cp "expected</script>/frame_000003.png" actual/frame_000003.png
rm actual/*.npz
run 1 compare "expected</script>" actual --report report

# The page has no external references.
[ "$(grep -cE '(src|href)="?(https?:|//|file:)|@import|url\(' report/report.html)" -eq 0 ] || fail "the page fetches something"
equal "files of the report" "$(ls report | paste -sd' ')" "junit.xml report.html results.json"

# Appended to the page: writes what it sees into #seen, one line per step.
cat >begin.html <<'PROBE'
<pre id="seen" hidden></pre>
<script>
(async () => {
  const get = id => document.getElementById(id), seen = [];
  const note = (what, ...values) => seen.push(what + ": " + values.join(" | "));
  const wait = async () => {
    do await new Promise(done => setTimeout(done, 20)); while (get("stage").getAttribute("aria-busy") !== "false");
  };
  const press = async (key, target) => {
    (target || document.body).dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true, cancelable: true}));
    await wait();
  };
  const all = what => [...document.querySelectorAll(what)];
  const place = () => [get("name").textContent, get("frame-verdict").textContent, get("place").textContent];
  try {
    await wait();
PROBE
cat >end.html <<'PROBE'
  } catch (error) { note("error", error); }
  const text = "BEGIN\n" + seen.join("\n") + "\nEND";
  get("seen").textContent = text;
  if (parent !== window) parent.postMessage(text, "*");
})();
</script>
PROBE
cat begin.html - end.html >probe.html <<'PROBE'
    const images = () => all("#sheet img").map(i => i.alt.split(" ")[0] + ":" + i.naturalWidth);
    const pressed = () => all("[id^=mode-][aria-pressed=true]").map(b => b.id).join();
    const follow = async link => {
      const changed = new Promise(done => addEventListener("hashchange", done, {once: true}));
      location.hash = link;
      await changed;
      await wait();
    };
    note("title", document.title);
    note("rows", all("#rows li").length);
    note("start", ...place(), pressed(), ...images());
    await press("ArrowRight");
    note("right", ...place(), pressed(), ...images());
    note("row", document.querySelector("#rows [aria-selected=true]").textContent);
    await press("]");
    note("swipe", getComputedStyle(all("#sheet img")[1]).clipPath, get("blend").value);
    await press("6");
    note("onion", pressed(), getComputedStyle(all("#sheet img")[1]).opacity);
    await press("5");
    await press("p");
    await press("b");
    note("blinked", get("blink-what").textContent, ...all("#sheet img").map(i => getComputedStyle(i).opacity));
    for (const key of ["1", "2", "3"]) { await press(key); note("key " + key, pressed(), ...images()); }
    await press("7");
    const [left, right] = all("#sheet img").map(i => i.getBoundingClientRect());
    note("side", pressed(), ...images(), right.left >= left.right, right.top === left.top);
    note("marks of both pictures", all(".ring").map(mark => mark.dataset.number));
    await press("m");
    note("no marks", all(".ring").length);
    await press("4");
    all("#rows li")[1].focus();
    await press("ArrowDown", document.activeElement);
    note("down", ...place(), document.activeElement.firstChild.textContent);
    document.activeElement.blur();
    await follow("#frame=1&mode=side");
    note("followed", ...place(), pressed(), location.hash);
    await follow("#frame=frame_000003.png&mode=nonsense");
    note("followed to an equal one", ...place(), location.hash, get("nothing").textContent);
    await press("a");
    await follow("#frame=77");
    note("followed to nothing", get("nothing").textContent, get("nothing").hidden);
    for (const key of ["largest", "severity", "name"]) {
      get("sort").value = key;
      get("sort").dispatchEvent(new Event("change"));
      await wait();
      const frames = JSON.parse(get("data").textContent).frames, value = name => frames.find(f => f.name === name)[key];
      const names = all("#rows li").map(row => row.firstChild.textContent);
      const ordered = (a, b) => key === "name" ? a <= b : (value(a) ?? Infinity) >= (value(b) ?? Infinity);
      note("sorted by " + key, names.length, names.every((name, i) => i === 0 || ordered(names[i - 1], name)));
    }
    note("regions", get("regions-part").hidden, ...all("#regions li").map(item => item.textContent), get("more-regions").textContent);
    note("causes", get("causes").textContent);
    await press("+");
    note("zoom", get("zoom").value, document.querySelector("#sheet img").style.width);
    await press("0");
    await press("End");
    note("end", ...place(), pressed(), get("mode-swipe").disabled, get("next").disabled, location.hash);
    await press("Home");
    await press("a");
    get("scrubber").value = 4;
    get("scrubber").dispatchEvent(new Event("input"));
    await press("ArrowRight", get("scrubber")); /* the slider's own */
    note("scrubbed", ...place(), get("all").checked);
    const svg = document.querySelector("#plot svg"), box = svg.getBoundingClientRect();
    svg.dispatchEvent(new MouseEvent("click", {clientX: box.left + box.width * 2.5 / 6, clientY: box.top + 9}));
    await wait();
    note("plot", ...place(), document.querySelector("#plot .cursor").getAttribute("x1"));
    await press("?");
    note("help", get("help").open, document.activeElement.tagName);
    note("unnamed", all("button, input, select, img, [role=region], [role=img]").filter(e =>
      !(e.textContent.trim() || e.getAttribute("aria-label") || e.alt || (e.labels && e.labels.length))).map(e => e.outerHTML).join());
    note("fetched", performance.getEntriesByType("resource").filter(r => !r.name.startsWith("data:")).length);
PROBE
# A name in a subfolder, two regions instead of those found, and a cause.
/usr/bin/python3 - <<'PYTHON'
import json, re
page = open("report/report.html").read()
begin, data, end = re.fullmatch(r'(.*<script type="application/json" id="data">)(.*?)(</script>.*)', page, re.DOTALL).groups()
data = json.loads(data)
data["frames"][5]["name"] = "sub/frame_000004.png" # a number that two names have
data["causes"] = ["frames 1 to 4: body 1 moved by <b>"]
for frame in data["frames"]:
    frame["region_count"] = 3
    frame["regions"] = [{"box": [10, 10, 20, 24], "pixels": 99, "largest": 7, "name": "body 1 moved"},
                        {"box": [40, 40, 50, 50], "pixels": 7, "largest": 255, "name": None}]
open("report/report.html", "w").write(begin + json.dumps(data).replace("<", "\\u003c") + end)
PYTHON
browse report/report.html
while read -r line; do says "$line"; done <<'LINES'
title: twinbox compare: physics changed, 1 frame missing, 1 frame extra
rows: 5
start: frame_000000.png | missing | 1 of 5 | mode-expected | expected:80
right: frame_000001.png | physics changed | 2 of 5 | mode-swipe | expected:80 | actual:80
row: frame_000001.pngphysics changed
swipe: inset(0px 0px 0px 55%) | 55
onion: mode-onion | 0.55
blinked: Now: actual | 0 | 1
key 1: mode-expected | expected:80
key 2: mode-actual | actual:80
key 3: mode-difference | difference:80
side: mode-side | expected:80 | actual:80 | true | true
marks of both pictures: 1,1,2,2
no marks: 0
down: frame_000002.png | physics changed | 3 of 5 | frame_000002.png
followed: frame_000001.png | physics changed | 2 of 5 | mode-side | #frame=1&mode=side
followed to an equal one: frame_000003.png | equal | 4 of 6 | #frame=3&mode=side | Equal pictures are not included in this report.
followed to nothing: This report has no frame "77". | false
sorted by largest: 5 | true
sorted by severity: 5 | true
sorted by name: 5 | true
regions: false | body 1 moved: 10 x 14 pixels at (10, 10), 99 of them differ by at most 7 | 10 x 10 pixels at (40, 40), 7 of them differ by at most 255 | and 1 more
causes: frames 1 to 4: body 1 moved by <b>
zoom: 1 | 80px
end: sub/frame_000004.png | extra | 5 of 5 | mode-actual | true | true | #frame=sub%2Fframe_000004.png&mode=actual
scrubbed: frame_000003.png | equal | 4 of 6 | true
plot: frame_000002.png | physics changed | 3 of 6 | 2.5
help: true | SUMMARY
fetched: 0
LINES
[ "$(grep '^unnamed:' out)" = "unnamed: " ] || fail "without a name: $(grep '^unnamed:' out)"
! grep '^error:' out || fail "the page's script failed"

# Of one picture there is nothing to choose; a comparison that passes has a page, too.
cat begin.html - end.html >probe.html <<<'    note("hidden", get("list").hidden, get("scrub").hidden, document.title);'
run 1 compare "expected</script>/frame_000001.png" actual/frame_000001.png --report report
browse report/report.html
says "hidden: true | true | twinbox compare: physics changed"
run 0 compare actual actual --report report
browse report/report.html
says "hidden: false | false | twinbox compare: equal"

# The looks of all verdicts: a frame within tolerance, without states, and one pixel of another colour; in a subfolder, one
# with other metadata.
mv "expected</script>" expected
rm expected/*.npz
mkdir expected/sub actual/sub
/usr/bin/python3 - <<'PYTHON'
import struct, zlib
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
for folder, first in ("expected", 9), ("actual", 10):
    rows = b"".join(b"\0" + bytes([first if row == 0 else 9]) + bytes(319 * [9]) for row in range(180))
    with open(f"{folder}/plain.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 320, 180, 8, 0, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
    with open(f"{folder}/sub/gamma.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)))
        file.write(chunk(b"gAMA", struct.pack(">I", 45454 if first == 9 else 60000)))
        file.write(chunk(b"IDAT", zlib.compress(b"\0\0")) + chunk(b"IEND", b""))
PYTHON
run 1 compare expected actual --tolerance 1 --report report

# Contrast by pictures/audit.js.
{ sed '/<script>/q' begin.html; cat "$sources/tests/pictures/audit.js"; sed '1,/<script>/d' begin.html; cat - end.html; } >probe.html <<'PROBE'
    const visible = e => e.getClientRects().length > 0;
    const name = e => e.tagName + (e.id && "#" + e.id) + (e.className.length ? "." + e.className : "") + " " + e.textContent.trim().slice(0, 20);

    note("window", innerWidth >= 390, document.documentElement.scrollWidth <= innerWidth);
    const slider = get("scrubber").getBoundingClientRect();
    /* A row far below is shown by scrolling the list, never the page. */
    get("viewer").style.paddingTop = get("rows").lastChild.style.marginTop = "3000px";
    document.body.dispatchEvent(new KeyboardEvent("keydown", {key: "End", bubbles: true}));
    await wait();
    note("not scrolled", scrollY);
    get("viewer").style.paddingTop = get("rows").lastChild.style.marginTop = "";
    note("fold", slider.top >= 0 && slider.bottom <= 900 && slider.bottom <= innerHeight);
    const labels = [...document.querySelectorAll(".plot h3, .plot span")];
    const clipped = labels.filter(e => {
      const box = e.getBoundingClientRect();
      return box.left < 0 || box.right > innerWidth || e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0;
    });
    note("labels", labels.length, clipped.map(name).join(), Math.min(...labels.map(e => parseFloat(getComputedStyle(e).fontSize))) >= 11);
    const plots = [...document.querySelectorAll(".plot")].map(e => e.getBoundingClientRect());
    note("plots", plots.length, Math.min(...plots.map(p => p.width)) >= Math.min(300, innerWidth - 90), plots.every(p => p.height < 120));

    const stops = [...document.querySelectorAll("a, button, input, select, summary, [tabindex]")].filter(e =>
      e.tabIndex >= 0 && !e.disabled && visible(e));
    note("tab", stops[0].id, stops.filter(e => get("rows").contains(e)).length, get("rows").children.length,
      stops.findIndex(e => get("viewer").contains(e)), stops.includes(get("stage")));
    get("skip").focus();
    note("skip link seen", get("skip").getBoundingClientRect().top >= 0);
    get("skip").click();
    note("skipped to", document.activeElement.id);

    get("all").click();
    await wait();
    note("metadata", get("notes").textContent.includes("metadata differs in 1 frame"),
      ...[...get("rows").lastChild.children].map(part => part.className + " " + part.textContent));
    note("looks", ...["good", "odd", "bad"].map(look => document.querySelectorAll("#rows ." + look).length > 0));
    for (const hidden of document.querySelectorAll("main [hidden]")) hidden.hidden = false;
    get("help").open = true;
    get("nothing").textContent = "text";
    const low = new Set(), look = () => {
      for (const fault of audit.text().faults) if (fault.includes("contrast")) low.add(fault);
    };
    look();
    for (const row of [...document.querySelectorAll("#rows li")]) {
      row.click();
      await wait();
      look();
    }
    note("texts", audit.text().count >= 40);
    note("low contrast", [...low].join("; "));
    note("scheme", matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
PROBE

# A browser window is at least 500 pixels wide; a frame is as narrow as it should be.
cat >narrow.html <<'NARROW'
<!DOCTYPE html>
<body style="margin: 0">
<iframe src="probed.html" width="390" height="844" style="border: 0"></iframe>
<pre id="seen"></pre>
<script>onmessage = event => { document.getElementById("seen").textContent = event.data; };</script>
NARROW

check_page() {
    says "window: true | true"
    says "not scrolled: 0"
    says "labels: 5 |  | true"
    says "plots: 1 | true | true"
    says "tab: skip | 1 | 5 | 1 | true"
    says "skip link seen: true"
    says "skipped to: stage"
    says "metadata: true | row-name sub/gamma.png | odd equal | row-figures metadata differs"
    says "looks: true | true | true"
    says "texts: true"
    [ "$(grep '^low contrast:' out)" = "low contrast: " ] || fail "$1: $(grep '^low contrast:' out)"
    says "scheme: $2"
    ! grep '^error:' out || fail "$1: the page's script failed"
}

browse report/report.html --blink-settings=preferredColorScheme=1
check_page wide light
says "fold: true"
browse report/report.html --blink-settings=preferredColorScheme=0
check_page wide dark
load narrow.html --blink-settings=preferredColorScheme=1
check_page narrow light
finish
