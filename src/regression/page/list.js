/* The list of frames: its rows, its order, the frame that is chosen, and links to it. */

/* The list is one stop of the Tab key: only the current row, or the first, can be reached. */
function mark_row() {
  const rows = [...get("rows").children], focused = get("rows").contains(document.activeElement);
  rows.forEach((row, i) => {
    row.setAttribute("aria-selected", String(i === at));
    row.tabIndex = i === (at < rows.length ? at : 0) ? 0 : -1;
  });
  if (at < 0 || at >= rows.length) return;
  if (focused) rows[at].focus({preventScroll: true});
  /* Not scrollIntoView(), which scrolls the page, too. */
  const list = get("rows"), top = rows[at].offsetTop - list.offsetTop, bottom = top + rows[at].offsetHeight;
  if (top < list.scrollTop) list.scrollTop = top;
  if (bottom > list.scrollTop + list.clientHeight) list.scrollTop = bottom - list.clientHeight;
}

function go(to) {
  if (listed.length === 0) return;
  at = Math.max(0, Math.min(listed.length - 1, to));
  const f = frame();
  get("name").textContent = f.name;
  get("frame-verdict").textContent = f.verdict;
  get("frame-verdict").className = look(f);
  get("figures").textContent = f.words;
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
  if (f.differing > 0)
    part("row-figures", `${Number((100 * f.differing / f.counted).toPrecision(3))}% \u00b7 at most ${f.largest}`);
  if (f.metadata) part("row-figures", "metadata differs");
  return item;
}

/* As frame_severity(). */
const severity = f => !f.failed ? -1 : f.severity === null ? Infinity : f.severity;

/* By the order of the report, or the largest first. */
const value_of = i => order === "name" ? 0 : order === "severity" ? severity(data.frames[i]) : data.frames[i][order];

function list() {
  const index = at >= 0 ? listed[at] : -1, rows = get("rows");
  listed = data.frames.map((_, i) => i).filter(i => all || data.frames[i].failed);
  listed.sort((a, b) => (value_of(b) > value_of(a)) - (value_of(b) < value_of(a)) || a - b);
  rows.replaceChildren(...listed.slice(0, MOST_ROWS).map(row_of));
  get("more").hidden = listed.length <= MOST_ROWS;
  get("all").checked = all;
  get("sort").value = order;
  get("viewer-part").hidden = data.frames.length === 0;
  const alone = data.frames.length === 1 && listed.length === 1; /* there is nothing to choose from */
  get("list").hidden = get("scrub").hidden = alone;
  get("viewer").classList.toggle("alone", alone);
  at = -1;
  const same = listed.indexOf(index), after = order === "name" && index >= 0 ? listed.findIndex(i => i >= index) : 0;
  if (listed.length > 0) go(same >= 0 ? same : after >= 0 ? after : listed.length - 1);
  else {
    for (const id of ["name", "frame-verdict", "figures", "place"]) get(id).textContent = "";
    say("No frame failed. Select \"Show all\" to see the others.");
    turns++;
    get("sheet").replaceChildren();
    get("regions-part").hidden = true;
    get("stage").setAttribute("aria-busy", "false");
    controls();
  }
}
