/* Buttons, keys and the pointer. */

function controls() {
  for (const name of MODES) {
    const button = get("mode-" + name);
    button.setAttribute("aria-pressed", String(name === mode));
    button.disabled = at < 0 || !usable(name);
  }
  const blends = mode === "swipe" || mode === "onion";
  get("blend-row").hidden = !blends;
  get("blend").value = blend;
  get("blend-label").textContent =
    mode === "swipe" ? "Split (expected left, actual right)" : "Opacity of the actual picture";
  get("blend-value").textContent = blend + " %";
  get("blink-row").hidden = mode !== "blink";
  get("pause").textContent = running ? "Pause" : "Continue";
  get("blink-what").textContent = "Now: " + (second ? "actual" : "expected");
  get("difference-row").hidden = mode !== "difference";
  get("side-row").hidden = mode !== "side";
  get("ring-button").setAttribute("aria-pressed", String(ring));
  get("zoom").value = zoom;
  get("previous").disabled = at <= 0;
  get("next").disabled = at < 0 || at + 1 >= listed.length;
  clearInterval(timer);
  if (mode === "blink" && running) timer = setInterval(change_sides, BLINK);
}

function change_sides() {
  second = !second;
  get("blink-what").textContent = "Now: " + (second ? "actual" : "expected");
  lay_out(false);
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
  b: () => { if (mode === "blink") change_sides(); }, p: () => { if (mode === "blink") toggle_run(); },
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
for (const plot of document.querySelectorAll("#plot svg")) plot.onclick = event => {
  const box = plot.getBoundingClientRect(), share = (event.clientX - box.left) / box.width;
  const index = Math.floor(share * data.frames.length);
  if (index >= 0 && index < data.frames.length) go_to(index);
};
addEventListener("resize", () => lay_out(false));
addEventListener("hashchange", () => follow_link(location.hash));
for (const cause of data.causes || []) {
  const item = document.createElement("li");
  item.textContent = cause;
  get("causes").append(item);
}
const link = location.hash; /* list() writes another one */
list();
follow_link(link);
