#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The page of a comparison in a browser: presses keys and checks what the page shows.
. "$(dirname "$0")/../cli/checks.sh"
. "$sources/tests/regression/browser.sh"

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 8 --bomb-x 1 -o b.npz
run 0 render a.npz -o "expected</script>" --size 80x64 --frames 0:4
run 0 render b.npz -o actual --size 80x64 --frames 1:5
cp "expected</script>/frame_000003.png" actual/frame_000003.png
rm actual/*.npz
run 1 compare "expected</script>" actual --report report

# The page has no external references.
[ "$(grep -cE '(src|href)="?(https?:|//|file:)|@import|url\(' report/report.html)" -eq 0 ] || fail "the page fetches something"
[ "$(ls report)" = "$(printf 'junit.xml\nreport.html\nresults.json\nresults.tap')" ] || fail "the report needs other files"

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
  const shown = () => [...document.querySelectorAll("#rows li")].map(row => row.firstChild.textContent);
  const follow = async link => {
    const changed = new Promise(done => addEventListener("hashchange", done, {once: true}));
    location.hash = link;
    await changed;
    await wait();
  };
  const note = (what, ...values) => seen.push(what + ": " + values.join(" | "));
  const place = () => [get("name").textContent, get("frame-verdict").textContent, get("place").textContent];
  try {
    await wait();
    note("title", document.title);
    note("rows", document.querySelectorAll("#rows li").length);
    note("start", ...place(), pressed(), ...images());
    await press("ArrowRight");
    note("right", ...place(), pressed(), ...images());
    note("row", document.querySelector("#rows [aria-selected=true]").textContent);
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
    await press("8");
    const [left, right] = [...document.querySelectorAll("#sheet img")].map(i => i.getBoundingClientRect());
    note("side", pressed(), ...images(), right.left >= left.right, right.top === left.top, get("side-row").hidden);
    await press("5");
    document.querySelectorAll("#rows li")[1].focus();
    await press("ArrowDown", document.activeElement);
    note("down", ...place(), document.activeElement.firstChild.textContent);
    await press("ArrowUp", document.activeElement);
    document.activeElement.blur();
    note("link", location.hash);
    await follow("#frame=2&mode=side");
    note("followed", ...place(), pressed(), location.hash);
    await follow("#frame=frame_000003.png&mode=nonsense");
    note("followed to an equal one", ...place(), location.hash);
    await press("a");
    await follow("#frame=77");
    note("followed to nothing", get("nothing").textContent, get("nothing").hidden);
    await follow("#frame=1&mode=swipe");
    note("followed back", ...place(), pressed(), get("nothing").hidden);
    const sorted = {};
    for (const key of ["flip", "largest", "severity"]) {
      get("sort").value = key;
      get("sort").dispatchEvent(new Event("change"));
      await wait();
      const all = JSON.parse(get("data").textContent).frames, none = key === "severity" ? Infinity : -1;
      const of = name => all.find(f => f.name === name)[key] ?? none;
      sorted[key] = shown().every((name, i, names) => i === 0 || of(names[i - 1]) >= of(name));
      note("sorted by " + key, shown().length, sorted[key], get("name").textContent);
    }
    get("sort").value = "name";
    get("sort").dispatchEvent(new Event("change"));
    await wait();
    note("sorted by name", shown().join(), ...place());
    note("figures", document.querySelector("#rows [aria-selected=true] .row-figures").textContent);
    const marks = () => document.querySelectorAll(".ring").length;
    await press("8");
    note("marks of both pictures", marks(), [...document.querySelectorAll(".ring")].map(mark => mark.dataset.number));
    await press("5");
    note("regions", get("regions-part").hidden, ...[...document.querySelectorAll("#regions li")].map(item => item.textContent), get("more-regions").textContent);
    note("causes", get("causes").textContent);
    note("marks", marks() > 0, get("ring-button").getAttribute("aria-pressed"));
    await press("m");
    note("no marks", marks(), get("ring-button").getAttribute("aria-pressed"));
    await press("+");
    note("zoom", get("zoom").value, get("sheet").style.width);
    await press("0");
    await press("End");
    note("end", ...place(), pressed(), ...images());
    note("link by name", location.hash);
    await follow("#frame=frame_000004.png");
    note("followed by name", ...place());
    await follow("#frame=sub%2Fframe_000004.png");
    note("followed by name again", ...place());
    note("cannot", get("mode-swipe").disabled, get("next").disabled);
    await press("ArrowRight");
    note("beyond", ...place());
    await press("Home");
    await press("a");
    note("all", document.querySelectorAll("#rows li").length, get("all").checked, ...place());
    get("scrubber").value = 4;
    get("scrubber").dispatchEvent(new Event("input"));
    await wait();
    note("scrubbed", ...place(), get("nothing").hidden, get("nothing").textContent);
    await press("ArrowRight", get("scrubber"));
    note("own keys", get("place").textContent);
    await press("a");
    note("failures", document.querySelectorAll("#rows li").length, ...place());
    const svg = document.querySelector("#plot svg"), box = svg.getBoundingClientRect();
    svg.dispatchEvent(new MouseEvent("click", {clientX: box.left + box.width * 2.5 / 6, clientY: box.top + 9}));
    await wait();
    note("plot", ...place(), document.querySelector("#plot .cursor").getAttribute("x1"));
    document.querySelectorAll("#rows li")[0].click();
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
# A name in a subfolder, two regions instead of those found, and a cause: a mark around most of the picture is left out.
/usr/bin/python3 - <<'PYTHON'
import json, re
page = open("report/report.html").read()
begin, data, end = re.fullmatch(r'(.*<script type="application/json" id="data">)(.*?)(</script>.*)', page, re.DOTALL).groups()
data = json.loads(data)
data["frames"][5]["name"] = "sub/frame_000004.png" # a number that two names have
data["causes"] = ["frames 1 to 4: body 1 moved by <b>"]
for frame in data["frames"]:
    frame["region_count"] = 3
    frame["regions"] = [{"box": [10, 10, 20, 24], "pixels": 99, "name": "body 1 moved"},
                        {"box": [40, 40, 50, 50], "pixels": 7, "name": None}]
open("report/report.html", "w").write(begin + json.dumps(data).replace("<", "\\u003c") + end)
PYTHON
if command -v chromium >/dev/null; then
    browse report/report.html
    says "title: twinbox compare: physics changed, 1 frame missing, 1 frame extra"
    says "rows: 5"
    says "start: frame_000000.png | missing | 1 of 5 | mode-expected | expected:80"
    says "right: frame_000001.png | physics changed | 2 of 5 | mode-swipe | expected:80 | actual:80"
    says "row: frame_000001.pngphysics changedFLIP 0."
    says "swipe: inset(0px 0px 0px 50%)"
    says "swipe more: inset(0px 0px 0px 55%) | 55"
    says "onion: mode-onion | 0.55"
    says "blink: mode-blink | Now: expected | Continue"
    says "blinked: Now: actual | 0 | 1"
    says "key 1: mode-expected | expected:80"
    says "key 2: mode-actual | actual:80"
    says "key 3: mode-difference | difference:80"
    says "key 4: mode-flip | FLIP:80"
    says "side: mode-side | expected:80 | actual:80 | true | true | false"
    says "down: frame_000002.png | physics changed | 3 of 5 | frame_000002.png"
    says "link: #frame=1&mode=swipe"
    says "followed: frame_000002.png | physics changed | 3 of 5 | mode-side | #frame=2&mode=side"
    says "followed to an equal one: frame_000003.png | equal | 4 of 6 | #frame=3&mode=side"
    says 'followed to nothing: This report has no frame "77". | false'
    says "followed back: frame_000001.png | physics changed | 2 of 5 | mode-swipe | true"
    says "sorted by flip: 5 | true | frame_000001.png"
    says "sorted by largest: 5 | true | frame_000001.png"
    says "sorted by severity: 5 | true | frame_000001.png"
    says "sorted by name: frame_000000.png,frame_000001.png,frame_000002.png,frame_000004.png,sub/frame_000004.png | frame_000001.png | physics changed | 2 of 5"
    says "figures: FLIP 0."
    says "marks: true | true"
    says "marks of both pictures: 4 | 1,1,2,2"
    says "regions: false | body 1 moved: 10 x 14 pixels at (10, 10), 99 of them differ | 10 x 10 pixels at (40, 40), 7 of them differ | and 1 more"
    says "causes: frames 1 to 4: body 1 moved by <b>"
    says "no marks: 0 | false"
    says "zoom: 1 | 80px"
    says "end: sub/frame_000004.png | extra | 5 of 5 | mode-actual | actual:80"
    says "link by name: #frame=sub%2Fframe_000004.png&mode=actual"
    says "followed by name: frame_000004.png | physics changed | 4 of 5"
    says "followed by name again: sub/frame_000004.png | extra | 5 of 5"
    says "cannot: true | true"
    says "beyond: sub/frame_000004.png | extra | 5 of 5"
    says "all: 6 | true | frame_000000.png | missing | 1 of 6"
    says "scrubbed: frame_000003.png | equal | 4 of 6 | false | Equal pictures are not included in this report."
    says "own keys: 4 of 6"
    says "failures: 5 | frame_000004.png | physics changed | 4 of 5"
    says "plot: frame_000002.png | physics changed | 3 of 5 | 2.5"
    says "click: frame_000000.png | missing | 1 of 5"
    says "help: true | SUMMARY"
    [ "$(grep '^unnamed:' out)" = "unnamed: " ] || fail "without a name: $(grep '^unnamed:' out)"
    says "fetched: 0"
    ! grep '^error:' out || fail "the page's script failed"

    # A comparison that passes has a page too.
    run 0 compare actual actual --report report
    browse report/report.html
    says "title: twinbox compare: equal"
    says "rows: 0"

    # Of one picture there is nothing to choose, but of several there is.
    cat >probe.html <<'PROBE'
<pre id="seen" hidden></pre>
<script>
document.getElementById("seen").textContent =
  ["BEGIN", "hidden: " + ["list", "scrub"].map(id => document.getElementById(id).hidden), "END"].join("\n");
</script>
PROBE
    run 1 compare "expected</script>/frame_000001.png" actual/frame_000001.png --report report
    browse report/report.html
    says "hidden: true,true"
    grep -q "<b>1</b> frame: physics changed" report/report.html || fail "the count of one frame"
    run 1 compare "expected</script>" actual --report report
    browse report/report.html
    says "hidden: false,false"
else
    fail "chromium is not installed; tests/setup chromium does that"
fi
finish
