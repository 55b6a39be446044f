/* Live runs: a worker for each steps it (worker.js), with the bits of the C program. After a change of the launch, of a setting
   or of a method, all start again. */
const LARGE = 4e5, PATIENCE = 150, WORDS = 9; /* states of a run without contacts; ms; 32-bit words of a contact */
const chosen = new Map(); /* settings of the scene, by name */
let first_set = ""; /* those that the page begins with, as set_text() */
const first_runs = data.runs.map(({live, hash, scene_hash}) => ({live, hash, scene_hash}));
const first_scene = first_runs.find(({live}) => live)?.scene_hash;
const setup = {scene: null, methods: [], url: ""};
let launched = 0, swapped = 0, arrivals = null, announce = null;

const arrival = () => arrivals ??= new Promise(done => { announce = done; });
const live_runs = () => runs.filter(run => run.live);
const set_text = () => [...chosen].map(([name, value]) => `${name}=${value}`).join();
/* Whether a run has what it has of the latest launch: states, or an error. */
const has_failed = run => run.broken || run.failed === launched;
const is_settled = run => has_failed(run) || run.next?.shown === launched || run.shown === launched;

/* What is wrong with a link stays until a setting is chosen; what is wrong with a run, until it can be launched. */
let link_problem = "", page_problem = "";
function show_problems() {
  const found = [page_problem, link_problem, ...live_runs().map(run => run.problem ?? "")].filter(text => text);
  // A link may have characters that turn the order of the others.
  tell(ui.problem, [...new Set(found)].join(" ").replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu, "?"));
  ui.problem.hidden = found.length === 0;
}

function complain(run, text) {
  run.problem = text && `${run.live}: ${text}`;
  show_problems();
}

function read_set(text) {
  chosen.clear();
  link_problem = "";
  for (const part of text.split(",").filter(Boolean)) {
    const [name, value] = part.split("=");
    if (!/^\w+$/.test(name) || value === undefined || value.trim() === "" || !Number.isFinite(Number(value)))
      link_problem = `"${cut(part)}" is no setting: NAME=NUMBER is needed.`;
    else chosen.set(name, Number(value));
  }
  show_problems();
}

/* Workers keep the latest launch until they are ready. */
function start(run) {
  run.worker.postMessage({id: launched, set: set_text(), method: run.live, until: min(ceil(view.frame), last),
    contacts: (last + 1) * most_bodies < LARGE ? 1 : 0});
}

/* Steps all live runs from the start. */
function launch() {
  launched++;
  if (chosen_run) ask(false); /* the answer was of another launch */
  live_runs().forEach(start);
}

/* Floats of the columns of a part go to their places in the arrays of a run. */
function copy_part(run, {first, bodies, positions, velocities, angles, spins, starts, contacts, modes, last: end}) {
  const at = first * bodies;
  for (let i = 0; i < angles.length; i++) {
    run.x[at + i] = positions[2 * i];
    run.y[at + i] = positions[2 * i + 1];
    run.vx[at + i] = velocities[2 * i];
    run.vy[at + i] = velocities[2 * i + 1];
  }
  run.angle.set(angles, at);
  run.omega.set(spins, at);
  for (let frame = first; frame <= end; frame++) {
    const from = starts[frame - first] - starts[0], to = starts[frame - first + 1] - starts[0];
    run.lists[frame] = contacts.subarray(WORDS * from, WORDS * to);
    run.modes[frame] = modes.subarray(from, to);
  }
  run.reached = end;
}

/* The contacts of the step that follows from a frame; of the last one, of its own step. */
function live_contacts(run, frame) {
  const step = min(frame + 1, run.frames - 1), words = run.lists[step] ?? [], all = [];
  const number = words.length > 0 && new Float32Array(words.buffer, words.byteOffset, words.length);
  for (let i = 0; i < words.length; i += WORDS) {
    const [x, y, nx, ny, normal, tangent] = number.subarray(i + 3, i + WORDS);
    const mode = run.modes[step][i / WORDS];
    all.push({a: words[i], b: words[i + 1], feature: words[i + 2], mode, x, y, nx, ny, normal, tangent});
  }
  return all;
}

/* The first frame in which the bomb touches a box; -1: none. */
function impact_of({bomb, fixed, lists, reached}) {
  for (let frame = 1; bomb >= 0 && frame <= reached; frame++)
    for (let i = 0; i < lists[frame].length; i += WORDS) {
      const a = lists[frame][i], b = lists[frame][i + 1];
      if ((a === bomb || b === bomb) && !fixed[a + b - bomb]) return frame;
    }
  return -1;
}

/* The last frame of a run whose states are there. */
function known(run) {
  if (run.live) return run.reached;
  const chunk = run.done.findIndex(done => !done);
  return min(chunk < 0 ? run.done.length * data.chunk : chunk * data.chunk, run.frames) - 1;
}

/* Where a run parts from the first one, as far as both are known. */
function compare_run(run) {
  const end = min(known(run), known(runs[0]));
  run.distances.fill(NaN);
  for (let frame = 0; frame <= end; frame++) {
    let most = NaN;
    for (let body = 0, at = frame * run.bodies; body < run.bodies; body++, at++) {
      const metres = distance(run.index, frame, body);
      if (!(metres <= most) && !Number.isNaN(metres)) most = metres;
      if (metres > data.visible) run.apart ??= {frame, body};
      if (!run.differs && COMPONENTS.some(name => run.bits[name][at] !== runs[0].bits[name][at])) run.differs = {frame, body};
    }
    run.distances[frame] = most;
  }
}

/* The launch that a run shows, by the hash of its scene. A run of another program has none: it is one of the first launch. */
const launch_of = run => run.scene_hash || first_scene;
const is_elsewhere = run => !run.live && (run.why !== "" || launch_of(run) !== (live_runs()[0] ?? run).scene_hash);

/* Which launch a recorded run shows. */
function launch_words(run) {
  const first = new Map(first_set.split(",").filter(Boolean).map(part => part.split("=")));
  const then = name => Number(first.get(name) ?? parameter(name)?.value);
  const other = [...new Set([...first.keys(), ...chosen.keys()])].filter(name => parameter(name) && then(name) !== value_of(name));
  if (run.why) return run.why;
  if (launch_of(run) !== first_scene || other.length === 0) return "its settings are not those of the page";
  return other.map(name => `${label_of(name)} ${setting_text(parameter(name), then(name)).replace("-", "\u2212")}\u00a0` +
    (parameter(name).unit ?? "")).map(text => text.trim()).join(", ");
}

/* The view is what `render` shows of this launch, when the launch rests: a view that moves along would hide what a drag changes. A
   recorded run of another scene keeps that of the beginning. */
let framing_due = 0;
function frame_launch() {
  clearTimeout(framing_due);
  framing_due = setTimeout(() => {
    const {framing} = live_runs()[0] ?? {};
    if (held || !framing || runs.some(run => !run.live && run.why)) return;
    Object.assign(data.framing, framing);
    planned_for = "";
    again();
  }, PATIENCE);
}

/* Width of a name, ems. */
const weigh = text => text_width({css: "600 100px Inter, system-ui, sans-serif"}, text) / 100;

function describe_run(run) {
  const method = data.live.methods.find(({name}) => name === run.live.split(":")[0]);
  const name = run.live.replace(/network=[^,]*\//, "network="); /* without its folders */
  Object.assign(run, {method: run.live, name, ems: name === method?.name ? method.ems : weigh(name),
    note: method?.note ?? "", note_ems: method?.note_ems ?? 0, file: null},
    run.given?.live === run.live ? run.given : {}); /* as the page was written */
}

/* All runs that have arrived are shown, together if they can. */
function show_arrived() {
  const arrived = live_runs().filter(run => run.next);
  if (!live_runs().every(is_settled) && performance.now() - swapped < PATIENCE) return;
  for (const run of arrived) {
    Object.assign(run, run.next, {next: null});
    describe_run(run);
  }
  swapped = performance.now();
  show_settings(document.activeElement);
  take_stock();
}

/* What the page says of the runs that it has now. */
function take_stock() {
  runs.forEach((run, index) => Object.assign(run, {index, elsewhere: is_elsewhere(run) ? launch_words(run) : ""}));
  for (const run of runs)
    run.compared = run === runs[0] || (run.bodies === runs[0].bodies && !run.why && !runs[0].why &&
      ((run.live && runs[0].live) || launch_of(run) === launch_of(runs[0])));
  const {dt} = live_runs()[0] ?? data;
  if (dt !== data.dt) { /* the moment stays */
    view.frame = round(view.frame * data.dt / dt);
    data.dt = dt;
  }
  for (const run of recorded) run.pace = data.dt / stored_dt;
  data.frames = data.total = max(...runs.map(frames_of));
  frame_launch();
  data.scales.largest = 0;
  for (const run of runs) run.differs = run.apart = null;
  for (const run of runs.filter(each => each.compared && each !== runs[0])) {
    compare_run(run);
    data.scales.largest = run.distances.reduce((most, metres) => metres > most ? metres : most, data.scales.largest);
  }
  data.impact = live_runs().map(impact_of).find(frame => frame >= 0) ?? -1;
  if (view.frame > data.frames - 1) view.frame = data.frames - 1;
  runs_changed();
  show_proof();
  announce?.();
  arrivals = null;
}

function take_part(run, part) {
  if (part.methods) return list_controls(part);
  if (part.error) {
    run.failed = part.id;
    run.broken = !part.id;
    complain(run, part.error);
    return show_arrived();
  }
  let into = run.shown === part.id ? run : run.next;
  if (into?.shown !== part.id) {
    if (part.first !== 0) return; /* the rest of a launch that is not shown any more */
    into = run.next = make_states({shown: part.id, reached: -1}, part.frames, part.bodies);
    Object.assign(into, {size: pairs(part.sizes), fixed: Array.from(part.fixed, Boolean), mass: part.masses,
      named: part.named, bomb: part.bomb, ...part.scene, contacts: part.recorded, distances: new Float32Array(part.frames).fill(NaN), verdict: null, hash: ""});
  }
  copy_part(into, part);
  into.framing = part.framing ?? into.framing;
  if (part.ended) {
    into.hash = part.hash;
    into.verdict = part.verdict && {text: part.verdict.words, frame: part.verdict.frame, body: part.verdict.body};
    if (part.failure || part.id === launched) complain(run, part.failure);
  }
  if (into === run) take_stock(); else show_arrived();
}

/* A worker begins while the module is compiled. */
function open_worker(run) {
  run.worker = new Worker(setup.url);
  run.worker.onmessage = ({data: part}) => {
    try { take_part(run, part); } catch (error) { complain(run, error.message); } /* memory is short */
  };
  run.worker.onerror = event => complain(run, event.message || "the worker has ended");
  live_parts.then(([module, bundle]) => run.worker.postMessage({module, bundle})).catch(cannot_step);
}

function cannot_step(error) {
  live_runs().forEach(run => { run.broken = true; });
  page_problem = `The runs cannot be stepped in this browser: ${error.message}`;
  show_problems();
  again();
}

function begin_live() {
  if (!data.live) return;
  for (const run of live_runs()) {
    const {live, name, ems, note, note_ems} = run;
    run.given = {live, name, ems, note, note_ems};
    run.hash = ""; /* until its states are here */
  }
  for (const run of recorded) Object.assign(run, {name: run.name + " (recorded)", ems: weigh(run.name + " (recorded)")});
  on_checked.push(take_stock);
  read_set(data.set);
  first_set = set_text();
  setup.url = URL.createObjectURL(new Blob([`(${panel_worker})()`], {type: "text/javascript"}));
  try { live_runs().forEach(open_worker); } catch (error) { cannot_step(error); }
}

/* The hash of each run beside that of the C program, where it made the same run; the check of the recorded ones. */
function show_proof() {
  if (!data.live) return;
  const marks = live_runs().map(run => {
    const wanted = set_text() === first_set && first_runs.find(each => each.live === run.live)?.hash;
    if (!run.hash) return make("p", `${names[run.index]}: ${run.reached} of ${run.frames - 1} steps`);
    const mark = wanted ? wanted === run.hash ? " = that of the C program" : " is NOT that of the C program, " + wanted : "";
    return make("p", {class: wanted && wanted !== run.hash ? "wrong" : ""}, `${names[run.index]}: hash `,
      make("code", run.hash), mark);
  });
  if (recorded.length > 0) marks.push(make("p", {class: checked().wrong > 0 ? "wrong" : ""}, check_text()));
  ui.check.replaceChildren(...marks);
}
