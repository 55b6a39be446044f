"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const get = id => document.getElementById(id);
  const MODES = ["expected", "actual", "difference", "flip", "swipe", "blink", "onion"];
  const KINDS = {expected: "e", actual: "a", difference: "d", flip: "f"};
  const MOST_ROWS = 2000, BLINK = 600;
  const reduced = matchMedia("(prefers-reduced-motion: reduce)");
  const plot = document.querySelector("#plot svg"), cursor = document.querySelector("#plot .cursor");

  let all = false, listed = [], at = -1, mode = "swipe", wanted = "swipe", zoom = "fit", blend = 50;
  let ring = true, running = !reduced.matches, second = false, timer = 0, turns = 0;

  const frame = () => data.frames[listed[at]];
  const stored = (index, kind) => get("p" + index + kind);
  const usable = name => {
    const index = listed[at], has = kind => stored(index, kind) !== null;
    return KINDS[name] ? has(KINDS[name]) : has("e") && has("a");
  };

  function look(verdict) { return verdict === "equal" ? "good" : verdict === "within tolerance" ? "odd" : "bad"; }

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
    const split = document.createElement("div"), circle = document.createElement("div");
    split.id = "split";
    circle.id = "ring";
    sheet.replaceChildren(...(ready ? [...images, split, circle] : []));
    lay_out(true);
    get("stage").setAttribute("aria-busy", "false");
  }

  function scale_for(width, height) {
    if (zoom !== "fit") return Number(zoom);
    const stage = get("stage"), most = Math.min((stage.clientWidth - 2) / width, (stage.clientHeight - 2) / height);
    return most > 1 ? Math.floor(most) : most;
  }

  /* Sets sizes and styles of the elements on the stage; centre: scrolls to the difference. */
  function lay_out(centre) {
    const sheet = get("sheet"), stage = get("stage"), images = [...sheet.querySelectorAll("img")];
    if (images.length === 0) return;
    const width = Math.max(...images.map(i => i.naturalWidth)), height = Math.max(...images.map(i => i.naturalHeight));
    const scale = scale_for(width, height), box = frame().box;
    sheet.style.width = width * scale + "px";
    sheet.style.height = height * scale + "px";
    sheet.classList.toggle("smooth", scale < 1);
    for (const image of images) {
      image.style.width = image.naturalWidth * scale + "px";
      image.style.height = image.naturalHeight * scale + "px";
    }
    const top = images[1];
    if (top) {
      top.style.clipPath = mode === "swipe" ? `inset(0 0 0 ${top.naturalWidth ? blend * width / top.naturalWidth : 0}%)` : "none";
      top.style.opacity = mode === "onion" ? blend / 100 : mode === "blink" && !second ? 0 : 1;
      images[0].style.clipPath = mode === "swipe" ? `inset(0 ${Math.max(0, 100 - blend * width / images[0].naturalWidth)}% 0 0)` : "none";
      images[0].style.opacity = mode === "blink" && second ? 0 : 1;
    }
    const split = get("split"), circle = get("ring");
    split.hidden = mode !== "swipe";
    split.style.left = blend + "%";
    /* A ring around most of the picture would be useless. */
    circle.hidden = !ring || !box || (box[2] - box[0]) * (box[3] - box[1]) > 0.5 * width * height;
    if (!box) return;
    const margin = 6, left = box[0] * scale - margin, above = box[1] * scale - margin;
    circle.style.left = left + "px";
    circle.style.top = above + "px";
    circle.style.width = (box[2] - box[0]) * scale + 2 * margin + "px";
    circle.style.height = (box[3] - box[1]) * scale + 2 * margin + "px";
    if (centre) {
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

  function mark_row(scroll) {
    for (const button of get("rows").querySelectorAll("button")) {
      const current = Number(button.dataset.at) === at;
      button.setAttribute("aria-current", String(current));
      if (current && scroll) button.scrollIntoView({block: "nearest"});
    }
  }

  function choose(mode_name) {
    if (at < 0 || !usable(mode_name)) return;
    const same = !KINDS[mode_name] && !KINDS[mode] && get("stage").getAttribute("aria-busy") === "false";
    mode = wanted = mode_name;
    second = false;
    controls();
    if (same) lay_out(false); else show();
  }

  function go(to) {
    if (listed.length === 0) return;
    at = Math.max(0, Math.min(listed.length - 1, to));
    const f = frame();
    get("name").textContent = f.name;
    get("frame-verdict").textContent = f.verdict;
    get("frame-verdict").className = look(f.verdict);
    get("figures").textContent = f.words + (f.flip === null ? "" : "; FLIP " + f.flip);
    get("scrubber").max = listed.length;
    get("scrubber").value = at + 1;
    get("scrubber").setAttribute("aria-valuetext", f.name + ", " + f.verdict);
    get("place").textContent = at + 1 + " of " + listed.length;
    if (cursor) {
      const x = Number(plot.dataset.left) + (listed[at] + 0.5) * Number(plot.dataset.step);
      cursor.setAttribute("x1", x);
      cursor.setAttribute("x2", x);
      cursor.removeAttribute("visibility");
    }
    mode = usable(wanted) ? wanted : MODES.find(usable) || wanted;
    say(MODES.some(usable) ? "" : f.failed || f.verdict === "within tolerance"
      ? "The pictures of this frame exceed the report's size limit."
      : "Equal pictures are not included in this report.");
    mark_row(true);
    controls();
    show();
  }

  function list() {
    const index = at >= 0 ? listed[at] : -1, rows = get("rows");
    listed = data.frames.map((_, i) => i).filter(i => all || data.frames[i].failed);
    rows.replaceChildren(...listed.slice(0, MOST_ROWS).map((i, row) => {
      const item = document.createElement("li"), button = document.createElement("button"), small = document.createElement("small");
      button.dataset.at = row;
      button.append(data.frames[i].name);
      small.textContent = data.frames[i].verdict;
      small.className = look(data.frames[i].verdict);
      button.append(small);
      item.append(button);
      return item;
    }));
    get("more").hidden = listed.length <= MOST_ROWS;
    get("all").checked = all;
    get("viewer-part").hidden = data.frames.length === 0;
    at = -1;
    const nearest = listed.findIndex(i => i >= index);
    if (listed.length > 0) go(nearest < 0 ? listed.length - 1 : nearest);
    else {
      get("name").textContent = get("frame-verdict").textContent = get("figures").textContent = get("place").textContent = "";
      say("No frame failed. Select \"Show all frames\" to see the others.");
      turns++;
      get("sheet").replaceChildren();
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
    const moves = /^(Arrow|Home|End)/.test(event.key);
    if (moves && event.target.closest("input, select, #stage, .scroll")) return;
    const action = KEYS[event.key] || KEYS[event.key.toLowerCase()];
    if (action) { action(); event.preventDefault(); }
  });
  get("rows").onclick = event => { const b = event.target.closest("button"); if (b) go(Number(b.dataset.at)); };
  get("scrubber").oninput = () => go(Number(get("scrubber").value) - 1);
  get("blend").oninput = () => set_blend(Number(get("blend").value));
  get("zoom").onchange = () => set_zoom(get("zoom").value);
  get("all").onchange = toggle_all;
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
  if (plot) plot.onclick = event => {
    const box = plot.getBoundingClientRect(), x = (event.clientX - box.left) / box.width * plot.viewBox.baseVal.width;
    const index = Math.floor((x - Number(plot.dataset.left)) / Number(plot.dataset.step));
    if (index < 0 || index >= data.frames.length) return;
    const row = listed.indexOf(index);
    if (row >= 0) { go(row); return; }
    all = true;
    list();
    go(listed.indexOf(index));
  };
  addEventListener("resize", () => lay_out(false));
  list();
})();
