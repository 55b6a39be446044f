/* The runs in words: what happens in each, where they part, what cannot be compared, where they come from. */
const FACTS = {
  method: "method", description: "note", scene: "scene", iterations: "iterations", "time step, s": "dt", steps: "steps",
  verdict: "ended", "state hash": "hash", "scene hash": "scene_hash", twinbox: "version",
};
const sentence = (start, parts) => parts.length > 0 ? start + parts.join("; ") + ". " : "";
const of_run = (text, run) => text && `${names[run]} ${text}`;

function where_apart({compared, why, differs, apart}) {
  if (!compared) return `cannot be compared (${cut(why, 200)})`;
  const far = apart ? `1 mm from ${time_text(apart.frame)} on` : "less than 1 mm";
  return differs ? `differs from ${time_text(differs.frame)} on, by ${far}` : "is equal, bit for bit";
}

function tell_runs() {
  ui.title.textContent = `${cut(data.title, 80)}: ${names.join(", ")}`;
  ui.title.title = data.title;
  const verdicts = runs.map((_, run) => sentence("", [of_run(short_verdict(run), run)].filter(text => text)));
  ui.summary.replaceChildren(make("strong", verdicts.join("")), `${runs.length} run${runs.length > 1 ? "s" : ""} of ` +
    `${six_digits((data.total - 1) * data.dt / data.every)} s, ` +
    `${[...new Set(runs.map(run => run.bodies))].join(" and ")} bodies. ` +
    sentence(`Against ${names[0]}: `, runs.map(where_apart).map(of_run).slice(1)));
  ui["left-out"].textContent = sentence("Left out of this page: ", data.left_out);

  /* Equal values of all runs stand once. */
  ui.runs.replaceChildren(row("td", "", ...runs.map((_, run) => swatch(run))));
  for (const name in FACTS) {
    const key = FACTS[name];
    const texts = runs.map(run => String(key === "dt" ? six_digits(run.dt) : (run[key] ?? data[key]) || ""));
    const same = texts.every(text => text === texts[0]);
    const cells = texts.map(title => make(name.endsWith("hash") ? "code" : "span", {title}, cut(title, 160)));
    if (same && texts[0] === "") continue;
    ui.runs.append(row("td", name, ...same ? [cells[0]] : cells));
    if (same) cells[0].parentNode.colSpan = runs.length;
  }
}

on_runs.push(tell_runs);

function show_check() {
  if (data.live) return;
  const {frames, of, wrong} = checked(), whose = runs.length > 1 ? runs.length + " runs" : "the run";
  ui.check.textContent = wrong > 0 ? `${wrong} of ${of} states do not have the hashes of the run files.`
    : frames < of ? `${frames} of ${of} states checked.`
    : `All ${of} states of ${whose} have the hashes of the run files.`;
}
