"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const get = id => document.getElementById(id);
  const MODES = ["expected", "actual", "difference", "flip", "swipe", "blink", "onion", "side"];
  const KINDS = {expected: "e", actual: "a", difference: "d", flip: "f"};
  const MOST_ROWS = 2000, BLINK = 600, GAP = 8;
  const reduced = matchMedia("(prefers-reduced-motion: reduce)");
  const plots = [...document.querySelectorAll("#plot svg")];

  let all = false, listed = [], at = -1, mode = "swipe", wanted = "swipe", zoom = "fit", blend = 50, order = "name";
  let ring = true, running = !reduced.matches, second = false, timer = 0, turns = 0;

  const frame = () => data.frames[listed[at]];
  const stored = (index, kind) => get("p" + index + kind);
  const usable = name => {
    const index = listed[at], has = kind => stored(index, kind) !== null;
    return KINDS[name] ? has(KINDS[name]) : has("e") && has("a");
  };

  function look(f) { return f.failed ? "bad" : f.verdict === "equal" ? "good" : "odd"; }

  function picture(kind) {
    const image = new Image();
    image.alt = {e: "expected", a: "actual", d: "difference", f: "FLIP"}[kind] + " picture of " + frame().name;
    image.draggable = false;
    image.decoding = "sync"; /* prevents an empty flash before a new picture */
    image.loaded = new Promise(done => { image.onload = image.onerror = done; });
    image.src = "data:image/png;base64," + stored(listed[at], kind).textContent;
    return image;
  }

  function say(text) { get("nothing").textContent = text; get("nothing").hidden = text === ""; get("sheet").hidden = text !== ""; }

  async function show() {
    const sheet = get("sheet"), turn = ++turns, ready = usable(mode);
    const images = !ready ? [] : (KINDS[mode] ? [KINDS[mode]] : ["e", "a"]).map(picture);
    get("stage").setAttribute("aria-busy", "true");
    await Promise.all(images.map(image => image.loaded));
    if (turn !== turns) return; /* another picture was requested meanwhile */
    const split = document.createElement("div"), marks = document.createElement("div");
    split.id = "split";
    marks.id = "marks";
    sheet.replaceChildren(...(ready ? [...images, split, marks] : []));
    lay_out(true);
    get("stage").setAttribute("aria-busy", "false");
  }

  function scale_for(width, height, gap_x, gap_y) {
    if (zoom !== "fit") return Number(zoom);
    const stage = get("stage");
    const most = Math.min((stage.clientWidth - 2 - gap_x) / width, (stage.clientHeight - 2 - gap_y) / height);
    return most > 1 ? Math.floor(most) : most;
  }

  /* The scale, and where the second picture is. Side by side: beside or below the first one, whichever is larger. */
  function arrange(width, height) {
    if (mode !== "side") return {scale: scale_for(width, height, 0, 0), right: 0, down: 0};
    const across = scale_for(2 * width, height, GAP, 0), below = scale_for(width, 2 * height, 0, GAP);
    return across >= below ? {scale: across, right: width * across + GAP, down: 0}
                           : {scale: below, right: 0, down: height * below + GAP};
  }

  /* Of the differences: regions, largest first, or all of them in one. */
  const regions = () => frame().regions && frame().regions.length > 0 ? frame().regions : frame().box ? [{box: frame().box}] : [];

  /* Outlines a region in each picture that is beside another one. */
  function mark({box}, i, width, height, {scale, right, down}) {
    /* A mark around most of the picture would be useless. */
    if (!ring || (box[2] - box[0]) * (box[3] - box[1]) > 0.5 * width * height) return;
    const margin = 6, places = right + down > 0 ? [[0, 0], [right, down]] : [[0, 0]];
    for (const [x, y] of places) {
      const outline = document.createElement("div");
      outline.className = "ring";
      if (regions().length > 1) outline.dataset.number = i + 1;
      outline.style.left = box[0] * scale - margin + x + "px";
      outline.style.top = box[1] * scale - margin + y + "px";
      outline.style.width = (box[2] - box[0]) * scale + 2 * margin + "px";
      outline.style.height = (box[3] - box[1]) * scale + 2 * margin + "px";
      get("marks").append(outline);
    }
  }

  /* What the marks are, by number. */
  function list_regions() {
    const known = frame().regions || [], more = (frame().region_count || 0) - known.length;
    get("regions").replaceChildren(...known.map(region => {
      const item = document.createElement("li"), [left, top, right, bottom] = region.box;
      const where = `${right - left} x ${bottom - top} pixels at (${left}, ${top}), ${region.pixels} of them differ`;
      item.textContent = region.name ? `${region.name}: ${where}` : where;
      return item;
    }));
    get("more-regions").textContent = more > 0 ? `and ${more} more` : "";
    get("regions-part").hidden = known.length === 0;
  }

  function lay_out_image(image, scale, x, y) {
    image.style.left = x + "px";
    image.style.top = y + "px";
    image.style.width = image.naturalWidth * scale + "px";
    image.style.height = image.naturalHeight * scale + "px";
    image.style.clipPath = "none";
    image.style.opacity = 1;
  }

  /* Sets sizes and styles of the elements on the stage; centre: scrolls to the difference. */
  function lay_out(centre) {
    const sheet = get("sheet"), stage = get("stage"), images = [...sheet.querySelectorAll("img")];
    if (images.length === 0) return;
    const width = Math.max(...images.map(i => i.naturalWidth)), height = Math.max(...images.map(i => i.naturalHeight));
    const place = arrange(width, height), scale = place.scale, found = regions();
    sheet.style.width = width * scale + place.right + "px";
    sheet.style.height = height * scale + place.down + "px";
    sheet.classList.toggle("smooth", scale < 1);
    images.forEach((image, i) => lay_out_image(image, scale, i * place.right, i * place.down));
    const [bottom, top] = images;
    if (mode === "swipe") {
      top.style.clipPath = `inset(0 0 0 ${top.naturalWidth ? blend * width / top.naturalWidth : 0}%)`;
      bottom.style.clipPath = `inset(0 ${Math.max(0, 100 - blend * width / bottom.naturalWidth)}% 0 0)`;
    }
    if (mode === "onion") top.style.opacity = blend / 100;
    if (mode === "blink") (second ? bottom : top).style.opacity = 0;
    get("split").hidden = mode !== "swipe";
    get("split").style.left = blend + "%";
    get("side-row").textContent = place.down > 0 ? "Above: expected. Below: actual." : "Left: expected. Right: actual.";
    get("marks").replaceChildren();
    found.forEach((region, i) => mark(region, i, width, height, place));
    if (centre && found.length > 0) {
      const box = found[0].box;
      stage.scrollLeft = (box[0] + box[2]) / 2 * scale - stage.clientWidth / 2;
      stage.scrollTop = (box[1] + box[3]) / 2 * scale - stage.clientHeight / 2;
    }
  }

  function controls() {
    for (const name of MODES) {
      const button = get("mode-" + name);
      button.setAttribute("aria-pressed", String(name === mode));
      button.disabled = at < 0 || !usable(name);
    }
    const blends = mode === "swipe" || mode === "onion";
    get("blend-row").hidden = !blends;
    get("blend").value = blend;
    get("blend-label").textContent = mode === "swipe" ? "Split (expected left, actual right)" : "Opacity of the actual picture";
    get("blend-value").textContent = blend + " %";
    get("blink-row").hidden = mode !== "blink";
    get("pause").textContent = running ? "Pause" : "Continue";
    get("blink-what").textContent = "Now: " + (second ? "actual" : "expected");
    get("difference-row").hidden = mode !== "difference";
    get("flip-row").hidden = mode !== "flip";
    get("side-row").hidden = mode !== "side";
    get("ring-button").setAttribute("aria-pressed", String(ring));
    get("zoom").value = zoom;
    get("previous").disabled = at <= 0;
    get("next").disabled = at < 0 || at + 1 >= listed.length;
    clearInterval(timer);
    if (mode === "blink" && running) timer = setInterval(flip, BLINK);
  }

  function flip() {
    second = !second;
    get("blink-what").textContent = "Now: " + (second ? "actual" : "expected");
    lay_out(false);
  }

  /* The list is one stop of the Tab key: only the current row, or the first, can be reached. */
  function mark_row() {
    const rows = [...get("rows").children], focused = get("rows").contains(document.activeElement);
    rows.forEach((row, i) => {
      row.setAttribute("aria-selected", String(i === at));
      row.tabIndex = i === (at < rows.length ? at : 0) ? 0 : -1;
    });
    if (at < 0 || at >= rows.length) return;
    if (focused) rows[at].focus();
    rows[at].scrollIntoView({block: "nearest"});
  }

  function choose(mode_name) {
    if (at < 0 || !usable(mode_name)) return;
    const same = !KINDS[mode_name] && !KINDS[mode] && get("stage").getAttribute("aria-busy") === "false";
    mode = wanted = mode_name;
    second = false;
    say("");
    controls();
    if (same) lay_out(false); else show();
    write_link();
  }

  function go(to) {
    if (listed.length === 0) return;
    at = Math.max(0, Math.min(listed.length - 1, to));
    const f = frame();
    get("name").textContent = f.name;
    get("frame-verdict").textContent = f.verdict;
    get("frame-verdict").className = look(f);
    get("figures").textContent = f.words + (f.flip === null ? "" : "; FLIP " + f.flip);
    get("scrubber").max = listed.length;
    get("scrubber").value = at + 1;
    get("scrubber").setAttribute("aria-valuetext", f.name + ", " + f.verdict);
    get("place").textContent = at + 1 + " of " + listed.length;
    for (const cursor of document.querySelectorAll("#plot .cursor")) {
      cursor.setAttribute("x1", listed[at] + 0.5);
      cursor.setAttribute("x2", listed[at] + 0.5);
      cursor.removeAttribute("visibility");
    }
    mode = usable(wanted) ? wanted : MODES.find(usable) || wanted;
    say(MODES.some(usable) ? "" : f.failed || f.verdict === "within tolerance"
      ? "The pictures of this frame exceed the report's size limit."
      : "Equal pictures are not included in this report.");
    list_regions();
    mark_row();
    controls();
    show();
    write_link();
  }

  /* Shows a frame, in the list of all frames if it is not in that of failures. */
  function go_to(index) {
    if (!listed.includes(index)) { all = true; list(); }
    go(listed.indexOf(index));
  }

  /* "#frame=12&mode=swipe": the number of a name if only one name has it, else the name. */
  const number = name => { const digits = /(\d+)\.[^.]*$/.exec(name); return digits ? String(BigInt(digits[1])) : ""; };

  const with_number = {};
  for (const f of data.frames) with_number[number(f.name)] = (with_number[number(f.name)] || 0) + 1;

  function write_link() {
    const own = number(frame().name);
    const link = new URLSearchParams({frame: own !== "" && with_number[own] === 1 ? own : frame().name, mode});
    try { history.replaceState(null, "", "#" + link); } catch { /* not allowed where the page is shown */ }
  }

  function follow_link(text) {
    const link = new URLSearchParams(text.slice(1)), to = link.get("frame"), name = link.get("mode");
    if (MODES.includes(name)) wanted = name;
    if (to === null) { if (MODES.includes(name)) choose(name); return; }
    let index = data.frames.findIndex(f => f.name === to);
    if (index < 0 && /^\d+$/.test(to)) index = data.frames.findIndex(f => number(f.name) === String(BigInt(to)));
    if (index >= 0) go_to(index); else say(`This report has no frame "${to}".`);
  }

  function row_of(index, row) {
    const f = data.frames[index], item = document.createElement("li");
    const part = (look_of, text) => {
      const element = document.createElement("span");
      element.className = look_of;
      element.textContent = text;
      item.append(element);
    };
    item.setAttribute("role", "option");
    item.dataset.at = row;
    part("row-name", f.name);
    part(look(f), f.verdict);
    const share = Number((100 * f.differing / f.counted).toPrecision(3));
    if (f.differing > 0) part("row-figures", `FLIP ${f.flip} \u00b7 at most ${f.largest} \u00b7 ${share} %`);
    return item;
  }

  /* By the order of the report, or the largest first. */
  const value_of = i => order === "name" ? 0 : data.frames[i][order] === null ? -1 : data.frames[i][order];

  function list() {
    const index = at >= 0 ? listed[at] : -1, rows = get("rows");
    listed = data.frames.map((_, i) => i).filter(i => all || data.frames[i].failed);
    listed.sort((a, b) => value_of(b) - value_of(a) || a - b);
    rows.replaceChildren(...listed.slice(0, MOST_ROWS).map(row_of));
    get("more").hidden = listed.length <= MOST_ROWS;
    get("all").checked = all;
    get("sort").value = order;
    get("viewer-part").hidden = data.frames.length === 0;
    at = -1;
    const same = listed.indexOf(index), after = order === "name" && index >= 0 ? listed.findIndex(i => i >= index) : 0;
    if (listed.length > 0) go(same >= 0 ? same : after >= 0 ? after : listed.length - 1);
    else {
      get("name").textContent = get("frame-verdict").textContent = get("figures").textContent = get("place").textContent = "";
      say("No frame failed. Select \"Show all frames\" to see the others.");
      turns++;
      get("sheet").replaceChildren();
      get("regions-part").hidden = true;
      get("stage").setAttribute("aria-busy", "false");
      controls();
    }
  }

  function set_blend(value) {
    blend = Math.max(0, Math.min(100, Math.round(value)));
    controls();
    lay_out(false);
  }

  function set_zoom(value) { zoom = value; controls(); lay_out(true); }
  function toggle_all() { all = !all; list(); }
  function sort() { order = get("sort").value; list(); }
  function toggle_ring() { ring = !ring; controls(); lay_out(false); }
  function toggle_run() { running = !running; controls(); }

  const ZOOMS = [...get("zoom").options].map(option => option.value);
  const KEYS = {
    ArrowRight: () => go(at + 1), ArrowLeft: () => go(at - 1), Home: () => go(0), End: () => go(listed.length - 1),
    "[": () => set_blend(blend - 5), "]": () => set_blend(blend + 5), a: toggle_all, m: toggle_ring,
    "+": () => set_zoom(ZOOMS[Math.min(ZOOMS.length - 1, ZOOMS.indexOf(zoom) + 1)]),
    "-": () => set_zoom(ZOOMS[Math.max(0, ZOOMS.indexOf(zoom) - 1)]), "0": () => set_zoom("fit"),
    b: () => { if (mode === "blink") flip(); }, p: () => { if (mode === "blink") toggle_run(); },
    "?": () => { get("help").open = true; get("help").querySelector("summary").focus(); },
  };
  MODES.forEach((name, i) => { KEYS[i + 1] = () => choose(name); get("mode-" + name).onclick = () => choose(name); });

  addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const moves = /^(Arrow|Home|End)/.test(event.key), stage = event.target.closest("#stage");
    const scrolls = stage !== null && (stage.scrollWidth > stage.clientWidth || stage.scrollHeight > stage.clientHeight);
    if (moves && (scrolls || event.target.closest("input, select, .scroll"))) return;
    const row = {ArrowDown: at + 1, ArrowUp: at - 1}[event.key];
    if (row !== undefined && event.target.closest("#rows")) { go(row); event.preventDefault(); return; }
    const action = KEYS[event.key] || KEYS[event.key.toLowerCase()];
    if (action) { action(); event.preventDefault(); }
  });
  get("rows").onclick = event => { const row = event.target.closest("li"); if (row) go(Number(row.dataset.at)); };
  get("scrubber").oninput = () => go(Number(get("scrubber").value) - 1);
  get("blend").oninput = () => set_blend(Number(get("blend").value));
  get("zoom").onchange = () => set_zoom(get("zoom").value);
  get("all").onchange = toggle_all;
  get("sort").onchange = sort;
  get("skip").onclick = event => { get("stage").focus(); event.preventDefault(); }; /* the address is for frames */
  get("ring-button").onclick = toggle_ring;
  get("pause").onclick = toggle_run;
  get("previous").onclick = () => go(at - 1);
  get("next").onclick = () => go(at + 1);

  /* Dragging on the stage moves the split. */
  function drag(event) {
    if (mode !== "swipe" || event.buttons !== 1) return;
    const box = get("sheet").getBoundingClientRect();
    if (box.width > 0) set_blend(100 * (event.clientX - box.left) / box.width);
  }
  get("stage").onpointerdown = drag;
  get("stage").onpointermove = drag;
  for (const plot of plots) plot.onclick = event => {
    const box = plot.getBoundingClientRect(), index = Math.floor((event.clientX - box.left) / box.width * data.frames.length);
    if (index >= 0 && index < data.frames.length) go_to(index);
  };
  addEventListener("resize", () => lay_out(false));
  addEventListener("hashchange", () => follow_link(location.hash));
  for (const cause of data.causes || []) {
    const item = document.createElement("li");
    item.textContent = cause;
    get("causes").append(item);
  }
  get("causes-part").hidden = get("causes").children.length === 0;
  const link = location.hash; /* list() writes another one */
  list();
  follow_link(link);
})();
