/* The controls of a live page: launch, settings, methods, predictions; and the bomb under the pointer. */
const NEAR_BOMB = 22; /* pixels from its middle, for fingers */
const METHODS_MAX = 6;
const inputs = new Map(); /* of the scene's settings, by name */
let held = null, asked = false, chosen_run = null; /* the run that was chosen as the one that stands */

const parameter = name => setup.scene?.parameters.find(each => each.name === name);
/* What a setting is, or will be with the next launch: chosen, or what the scene that is shown has. A parameter may drive it. */
const value_of = name => chosen.get(name) ?? live_runs()[0]?.values?.[name] ?? parameter(name)?.value;
const label_of = name => name === "dt" ? "time step" : name.replaceAll("_", " ");
const setting_text = ({name}, value) => name === "dt" ? fraction(value) : String(six_digits(value));
/* "1/60" or a number. */
const number_in = text => text.split("/").map(Number).reduce((over, under) => over / under);

/* A step of 1/60 s is exactly that, not its six digits. */
function rounded({name, whole}, value) {
  return whole ? round(value) : name === "dt" ? number_in(fraction(value)) : six_digits(value);
}

/* Out of its range, a setting of the scene takes the end. One that has its first value is not chosen, unless a parameter of the
   file may have given it another. */
function choose(name, value) {
  const each = parameter(name);
  if (!each || !Number.isFinite(value)) return;
  const bounded = rounded(each, min(max(value, each.from), each.to));
  const driven = [...chosen.keys()].some(key => key !== name && !parameter(key)?.common);
  if (!driven && bounded === rounded(each, each.value)) chosen.delete(name); else chosen.set(name, bounded);
  link_problem = "";
  show_settings();
  launch();
}

/* Except where somebody types. */
function show_settings(typed) {
  for (const [name, [range, number]] of inputs) {
    range.value = value_of(name);
    if (number !== typed) number.value = setting_text(parameter(name), value_of(name));
  }
}

function setting_row(each) {
  const {name, unit, from, to, whole} = each, label = label_of(name), step = whole ? 1 : "any", is_time = name === "dt";
  const range = make("input", {type: "range", min: from, max: to, step, "aria-label": label,
    oninput: () => choose(name, is_time ? 1 / round(1 / range.value) : Number(range.value))});
  const number = make("input", {type: is_time ? "text" : "number", min: from, max: to, step, onchange: () => {
    choose(name, number_in(number.value));
    show_settings(); /* what is no number is not kept */
  }, "aria-label": `${label}${unit ? ", " + unit : ""}`});
  inputs.set(name, [range, number]);
  return make("tr", make("th", label), make("td", range), make("td", number), make("td", (unit ?? "").replaceAll("/", "/\u2060"))); /* "m/s" stays one word */
}

/* The text of a method, "interior:near=0.02", of its controls. */
function method_text(name, settings) {
  const given = settings.filter(([, value]) => value !== "").map(([key, value]) => `${key}=${value}`);
  return name + (given.length > 0 ? ":" + given.join() : "");
}

/* The rule of src/pictures/colours.h: panels of one method have its colour and shades of it, by their names. */
function colour_runs() {
  const head = ({method}) => method.split(":")[0], taken = new Set();
  for (const run of [...runs].sort((a, b) => a.method < b.method ? -1 : a.method > b.method ? 1 : a.index - b.index)) {
    const shades = data.live.methods.find(({name}) => name === head(run))?.shades;
    if (!shades) continue;
    let shade = run.method.includes("net=off") ? 1 : 0;
    while (taken.has(head(run) + shade)) shade++;
    taken.add(head(run) + shade);
    run.colours = shades[shade % shades.length];
  }
}

/* Another method has other colours. */
function change_method(run, text) {
  run.live = text;
  describe_run(run);
  colour_runs();
}

function set_method(run, text) {
  change_method(run, text);
  list_methods();
  launch();
}

function method_row(run) {
  const [name, rest = ""] = run.live.split(":"), given = new Map(rest.split(",").filter(Boolean).map(part => part.split("=")));
  const method = setup.methods.find(each => each.name === name);
  const usable = setup.methods.filter(each => !each.needs_network || first_runs.some(({live}) => live?.split(":")[0] === each.name));
  const select = make("select", {"aria-label": "Method", onchange: () => set_method(run, select.value)},
    usable.map(each => new Option(each.name, each.name, false, each.name === name)));
  const controls = (method?.settings ?? []).filter(({type}) => type !== "text").map(({key, summary, type, from, to}) => {
    const change_it = () => {
      given.set(key, input.value);
      set_method(run, method_text(name, [...given]));
    };
    const input = type === "bool" ? make("select", {onchange: change_it},
      ["", "on", "off"].map(value => new Option(value || "default", value, false, given.get(key) === value)))
      : make("input", {type: "number", min: from, max: to, step: type === "int" ? 1 : "any", placeholder: "default",
        value: given.get(key) ?? "", onchange: change_it});
    return make("label", {title: summary}, key, input);
  });
  const all = make("details", {ontoggle: () => { run.opened = all.open; }}, make("summary", "Settings"), controls);
  all.hidden = controls.length === 0;
  all.open = run.opened ?? given.size > 0;
  return panel_row(run, select, remove_button(run, live_runs().length > 1), all);
}

const panel_row = (run, ...parts) => make("div", {class: "bar", role: "group", "aria-label": `Panel ${run.index + 1}`},
  shape(SQUARE, run.index), parts);

function remove_button(run, can_go) {
  const button = make("button", {"aria-label": `Remove ${run.name}`, onclick: () => remove_panel(run)}, "Remove");
  button.disabled = !can_go;
  return button;
}

/* A recorded run can come back. */
function recorded_row(run) {
  if (runs.includes(run)) return panel_row(run, make("span", names[run.index]), remove_button(run, runs.length > 1));
  const add = make("button", {"aria-label": `Add ${run.name}`, onclick: () => put_back(run)}, "Add");
  add.disabled = runs.length >= METHODS_MAX;
  return make("div", {class: "bar off", role: "group", "aria-label": run.name}, make("span", cut(run.name)), add);
}

/* The focus stays where it was, or at what has taken its place. */
function list_methods() {
  const controls = () => [...ui.methods.querySelectorAll("select, input, button")];
  const at = controls().indexOf(document.activeElement);
  ui.methods.replaceChildren(...runs.map(run => run.live ? method_row(run) : recorded_row(run)),
    ...recorded.filter(run => !runs.includes(run)).map(recorded_row));
  ui.add.disabled = runs.length >= METHODS_MAX;
  if (at >= 0) (controls()[at]?.disabled === false ? controls()[at] : ui.add).focus();
}

function remove_panel(run) {
  run.worker?.terminate();
  runs.splice(runs.indexOf(run), 1);
  colour_runs();
  Object.assign(view, {body: -1, run: 0});
  take_stock();
  list_methods();
}

function put_back(run) {
  runs.push(run);
  take_stock();
  list_methods();
}

function add_panel(text = "engine") {
  const like = live_runs()[0] ?? runs[0];
  const run = Object.assign(make_states({}, 1, 0), {index: runs.length, live: text, size: [], fixed: [], bomb: -1, reached: -1,
    distances: new Float32Array(1), velocities: true, contacts: true, compared: false, why: "", scene: like.scene,
    made_of: like.made_of, iterations: like.iterations, dt: like.dt, steps: like.steps, scene_hash: "", verdict: null,
    colours: like.colours});
  describe_run(run);
  runs.push(run);
  colour_runs();
  open_worker(run);
  start(run);
  take_stock();
  list_methods();
}

/* What there is to choose from, as the first worker that is ready tells. */
function list_controls({methods, scene}) {
  if (setup.scene) return;
  Object.assign(setup, {methods, scene});
  const rank = ({name, common}) => !common ? 0 : name.startsWith("bomb") ? 1 : 2;
  ui.settings.replaceChildren(...[...setup.scene.parameters].sort((a, b) => rank(a) - rank(b)).map(setting_row));
  ui.launch.hidden = ui.panels.hidden = false;
  show_settings();
  list_methods();
}

/* Whether a bomb, or the arrow to it, is at a place. */
function is_bomb_at(x, y) {
  const eye = eye_now(), panel = to_world(planned, eye, x, y)?.panel, run = planned.panels[panel]?.run;
  if (run === undefined || !runs[run].live || asked || !setup.scene?.bomb) return false;
  const {bomb, size, arrow} = runs[run], near = (at, reach) => hypot(at.x - x, at.y - y) <= reach;
  if (arrow && near(arrow, NEAR_BOMB)) return true;
  if (!exists(run, view.frame, bomb)) return false;
  const at = pose(run, view.frame, bomb);
  return near(to_pixel(planned, eye, panel, at.x, at.y), max(NEAR_BOMB, eye.scale * max(...size[bomb]) * 0.6));
}

/* Dragging moves its launch by as much as the pointer: x; with Shift also its height; with Alt its speed. */
function grab_bomb(event) {
  if (!data.live || !is_bomb_at(event.offsetX, event.offsetY)) return false;
  held = {x: event.offsetX, y: event.offsetY, bomb_x: value_of("bomb_x"), bomb_y: value_of("bomb_y"), bomb_speed: value_of("bomb_speed")};
  stage.setPointerCapture(event.pointerId);
  change({playing: false});
  return true;
}

function drag_bomb(event) {
  if (!held) {
    stage.style.cursor = data.live && is_bomb_at(event.offsetX, event.offsetY) ? "grab" : "";
    return false;
  }
  const {scale} = eye_now(), right = (event.offsetX - held.x) / scale, up = (held.y - event.offsetY) / scale;
  if (event.altKey) choose("bomb_speed", held.bomb_speed * 2 ** (right / 4));
  else {
    if (event.shiftKey) choose("bomb_y", held.bomb_y + up);
    choose("bomb_x", held.bomb_x + right);
  }
  return true;
}

function drop_bomb() {
  const was = held !== null;
  held = null;
  if (was) frame_launch();
  return was;
}

const nudge_bomb = (name, by) => data.live && choose(name, value_of(name) + by);

/* Which panel will stand? Until it is answered only the first frame is shown. */
function ask(on) {
  asked = on;
  chosen_run = null;
  document.body.classList.toggle("asked", on);
  tell(ui.question, on ? "Which of these stands at the end? Click its panel, or press its number." : "");
  if (on) change({frame: 0, playing: false});
}

function answer(panel) {
  const run = planned.panels[panel]?.run;
  if (run === undefined || runs[run].elsewhere) return;
  ask(false);
  ui.predict.checked = false;
  chosen_run = runs[run];
  tell_answer();
  toggle_play();
}

/* In the words of the verdict, when there is one. */
function tell_answer() {
  const run = runs.indexOf(chosen_run);
  if (run >= 0) tell(ui.question, `You said ${names[run]}. It ${short_verdict(run) || "still runs"}.`);
}

on_runs.push(tell_answer);

ui.reset.onclick = () => {
  read_set(first_set);
  show_settings();
  launch();
};
ui.predict.onchange = () => ask(ui.predict.checked);
ui.add.onclick = () => add_panel();
