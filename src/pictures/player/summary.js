/* The runs in words: what happens in each, where they part, what cannot be compared, where they come from. */
const FACTS = {
  method: "method", description: "note", scene: "scene", iterations: "iterations", "time step, s": "dt", steps: "steps",
  verdict: "ended", "state hash": "hash", "scene hash": "scene_hash", twinbox: "version",
};
const VISIBLE = 0.1; /* of a box: what a hall sees of the distance between two panels */
const sentence = (start, parts) => parts.length > 0 ? start + parts.join("; ") + ". " : "";
const away = frame => `at ${time_text(frame)}`;

/* Without figures: "collapses; 8 of 10 fell". */
const outcome = run => (short_verdict(run) || (runs[run].live ? "still runs" : "")).split(", first at")[0];

/* Whether a live page has all states of a run. The verdict is there from the beginning. */
const is_whole = run => run.live ? Boolean(run.hash) : known(run) === run.frames - 1;
const may_yet_part = run => data.live && ![runs[0], run].every(is_whole);

/* When a run is seen to part from the first one. */
function parting(run) {
  const {compared, why, differs, distances} = run, visible = distances.findIndex(metres => metres > VISIBLE * data.scales.box);
  if (!compared) return why && `cannot be compared (${cut(why, 200)})`;
  if (visible >= 0) return `parts from ${names[0]} at ${seconds(visible).toFixed(2)} s`;
  if (may_yet_part(run)) return "";
  const most = distances.reduce((largest, metres) => metres > largest ? metres : largest, 0);
  return differs ? `stays within ${metric(most, "m")} of ${names[0]}` : `equals ${names[0]}, bit for bit`;
}

/* One for each panel, in its colour: who stands, who fell, when it parts from the first. */
function headline(run, index) {
  const {elsewhere} = run, told = elsewhere ? `shows another launch: ${elsewhere}` : outcome(index);
  const soft = elsewhere || index === 0 ? "" : parting(run);
  return make("p", {class: elsewhere ? "off" : "", style: `border-color: var(--fill${index})`}, make("b", names[index]), " ",
    make("span", told), soft && make("span", {class: "off"}, told && ", ", soft));
}

/* The figures, on demand. */
function figures(run, index) {
  const {compared, elsewhere, ended, differs, apart} = run, from = names[0], parts = [ended];
  if (index > 0 && compared && !elsewhere)
    parts.push(!differs ? !may_yet_part(run) && `equals ${from}, bit for bit`
      : `first differs from ${from} ${away(differs.frame)}` + (apart ? ` and is 1 mm away ${away(apart.frame)}` : ", never by 1 mm"));
  return make("p", swatch(index), ": ", parts.filter(text => text).join("; "));
}

function tell_runs() {
  const seen = six_digits(VISIBLE * data.scales.box) + " m";
  ui.title.textContent = cut(data.title, 80);
  ui.title.title = data.title;
  ui.summary.replaceChildren(...runs.map(headline));
  ui.facts.replaceChildren(make("p", `${runs.length} run${runs.length > 1 ? "s" : ""} of ` +
    `${six_digits((data.total - 1) * data.dt / data.every)} s, ${[...new Set(runs.map(run => run.bodies))].join(" and ")} bodies.` +
    (others.length > 0 ? ` A run parts from ${names[0]} where a body is ${seen} away, a tenth of a box.` : "")), ...runs.map(figures));
  ui["left-out"].textContent = sentence("Left out of this page: ", data.left_out);

  /* Equal values of all runs stand once. */
  ui.runs.replaceChildren(row("td", "", ...runs.map((_, run) => swatch(run))));
  for (const name in FACTS) {
    const key = FACTS[name];
    const texts = runs.map(run => String(key === "dt" ? fraction(run.dt) : (run[key] ?? data[key]) || ""));
    const same = texts.every(text => text === texts[0]);
    const cells = texts.map(title => make(name.endsWith("hash") ? "code" : "span", {title}, cut(title, 160)));
    if (same && texts[0] === "") continue;
    ui.runs.append(row("td", name, ...same ? [cells[0]] : cells));
    if (same) cells[0].parentNode.colSpan = runs.length;
  }
}

on_runs.push(tell_runs);
ui.figures.onclick = () => {
  ui.facts.hidden = !ui.facts.hidden;
  ui.figures.ariaExpanded = !ui.facts.hidden;
  again();
};

function check_text() {
  const {frames, of, wrong} = checked(), whose = recorded.length > 1 ? recorded.length + " runs" : "the run";
  return wrong > 0 ? `${wrong} of ${of} states do not have the hashes of the run files.`
    : frames < of ? `${frames} of ${of} states checked.`
    : `All ${of} states of ${data.live ? "recorded runs" : whose} have the hashes of the run files.`;
}

function show_check() {
  if (checked().wrong > 0) page_problem = check_text();
  show_problems();
  if (!data.live) ui.check.textContent = check_text();
}
