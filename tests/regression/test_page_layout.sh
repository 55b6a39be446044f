#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The report's page as readers see it: contrast of all text (WCAG 2.2 AA: 4.5, large text and graphics 3) in both colour
# schemes, no clipped label at a width of 390 pixels, the frame slider above the fold at 1440 x 900, and the order of the
# Tab key.
. "$(dirname "$0")/../cli/checks.sh"
. "$sources/tests/regression/browser.sh"

run 0 simulate "$scenes/single.yaml" --frames 8 -o a.npz
run 0 simulate "$scenes/single.yaml" --frames 8 --bomb-x 1 -o b.npz
run 0 render a.npz -o expected --size 320x180 --frames 0:4
run 0 render b.npz -o actual --size 320x180 --frames 1:5
cp expected/frame_000003.png actual/frame_000003.png
rm expected/*.npz actual/*.npz
# A frame within tolerance: without states, and one pixel of another colour. In a subfolder, one with other metadata.
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
run 1 compare expected actual --fuzzy 1,0.01 --report report

cat >probe.html <<'PROBE'
<pre id="seen" hidden></pre>
<script>
(async () => {
  const get = id => document.getElementById(id), seen = [];
  const note = (what, ...values) => seen.push(what + ": " + values.join(" | "));
  const wait = async () => {
    do await new Promise(done => setTimeout(done, 20)); while (get("stage").getAttribute("aria-busy") !== "false");
  };
  const visible = e => e.getClientRects().length > 0;
  const name = e => e.tagName + (e.id && "#" + e.id) + (e.className.length ? "." + e.className : "") + " " + e.textContent.trim().slice(0, 20);

  const channels = color => color.match(/[\d.]+/g).map(Number);
  const over = ([r, g, b, alpha = 1], [R, G, B]) => [r * alpha + R * (1 - alpha), g * alpha + G * (1 - alpha), b * alpha + B * (1 - alpha)];
  const luminance = color => {
    const [r, g, b] = color.map(c => c / 255).map(c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ratio = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  const ground = e => {
    if (e === null) return [255, 255, 255];
    const color = channels(getComputedStyle(e).backgroundColor);
    return color[3] === 0 || color.length < 3 ? ground(e.parentElement) : over(color, color.length > 3 ? ground(e.parentElement) : [0, 0, 0]);
  };
  const pairs = new Set(), low = [];
  const measure = (what, color, behind, least) => {
    const found = ratio(over(channels(color), behind), behind);
    pairs.add(color + " on " + behind);
    if (!(found >= least)) low.push(`${what}: ${color} on ${behind.map(Math.round)}: ${found.toFixed(2)}, at least ${least}`);
  };
  const measure_text = e => {
    const style = getComputedStyle(e), size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    measure(name(e), style.color, ground(e), large ? 3 : 4.5);
  };
  const has_text = e => [...e.childNodes].some(n => n.nodeType === Node.TEXT_NODE && n.textContent.trim());

  try {
    await wait();
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

    const style = getComputedStyle(document.documentElement), of = key => style.getPropertyValue(key);
    const rgb = text => { /* "#abc" and "#aabbcc" */
      const digits = text.trim().slice(1), full = digits.length === 3 ? digits.replace(/./g, "$&$&") : digits;
      return [0, 2, 4].map(i => parseInt(full.slice(i, i + 2), 16));
    };
    get("all").click();
    await wait();
    note("metadata", get("notes").textContent.includes("metadata differs in 1 frame"),
      ...[...get("rows").lastChild.children].map(part => part.className + " " + part.textContent));
    note("looks", ...["good", "odd", "bad"].map(look => document.querySelectorAll("#rows ." + look).length > 0));
    for (const hidden of document.querySelectorAll("main [hidden]")) hidden.hidden = false;
    get("help").open = true;
    get("nothing").textContent = "text";
    for (const e of document.querySelectorAll("body *"))
      if (has_text(e) && visible(e) && !e.closest("button:disabled, script, style, noscript, option")) measure_text(e);
    for (const row of [...document.querySelectorAll("#rows li")]) {
      row.click();
      await wait();
      [...row.children].forEach(measure_text);
      measure("focus of a row", "rgb(" + rgb(of("--accent-ink")) + ")", ground(row), 3);
    }
    for (const [graphic, behind] of [["--accent", "--page"], ["--accent", "--panel"], ["--bad", "--panel"], ["--ring", "--panel"], ["--ring", "--stage"]])
      measure(graphic + " on " + behind, "rgb(" + rgb(of(graphic)) + ")", rgb(of(behind)), 3);
    measure("number of a mark", "rgb(255, 255, 255)", rgb(of("--mark")), 4.5);
    note("pairs", pairs.size >= 15);
    note("low contrast", low.join("; "));
    note("scheme", luminance(ground(document.body)) < 0.5 ? "dark" : "light");
  } catch (error) { note("error", error); }
  const text = "BEGIN\n" + seen.join("\n") + "\nEND";
  get("seen").textContent = text;
  if (parent !== window) parent.postMessage(text, "*");
})();
</script>
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
    says "labels: 10 |  | true"
    says "plots: 2 | true | true"
    says "tab: skip | 1 | 5 | 1 | true"
    says "skip link seen: true"
    says "skipped to: stage"
    says "metadata: true | row-name sub/gamma.png | odd equal | row-figures metadata differs"
    says "looks: true | true | true"
    says "pairs: true"
    [ "$(grep '^low contrast:' out)" = "low contrast: " ] || fail "$1: $(grep '^low contrast:' out)"
    says "scheme: $2"
    ! grep '^error:' out || fail "$1: the page's script failed"
}

if command -v chromium >/dev/null; then
    browse report/report.html --blink-settings=preferredColorScheme=1
    check_page wide light
    says "fold: true"
    browse report/report.html --blink-settings=preferredColorScheme=0
    check_page wide dark
    load narrow.html --blink-settings=preferredColorScheme=1
    check_page narrow light
else
    fail "chromium is not installed; tests/setup chromium does that"
fi
finish
