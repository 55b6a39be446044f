/* The state of the page, its elements and its colours. */
const COMPARES = ["split", "overlay", "difference"], THEMES = ["auto", "light", "dark"], FIT = {kind: "fit"};
const LABELLINGS = ["none", "number", "mass", "name"];
const SHOWS = Object.keys(data.shows); /* each with what it needs: SHOW_MARKS in src/pictures/picture.h */
const PARTS = {split: "", overlay: "ghosts", difference: "ghosts distance"}; /* which are no choice there */
const view = {
  frame: 0, playing: false, speed: 1, slow: false, compare: "split", show: new Set(), body: -1, run: 0, camera: FIT,
  theme: "auto", stage: false, labels: "none",
};
/* Of the runs; live ones come, go and change. on_runs: what depends on them. */
let last = 0, most_bodies = 0, others = [], names = [];
const on_runs = [];
const dark_wanted = matchMedia("(prefers-color-scheme: dark)"), {style} = document.documentElement;
const ui = {}; /* the elements that have names */
for (const named of document.querySelectorAll("body :not(script)[id]")) ui[named.id] = named;
let scheduled = 0, stale = false, themed = "";

const tell = (node, text) => { if (node.textContent !== text) node.textContent = text; };
const six_digits = value => Number(value.toPrecision(6));
/* A time step as people say it: "1/60". */
function fraction(value) {
  const parts = round(1 / value);
  return parts > 1 && abs(parts * value - 1) < 1e-5 ? "1/" + parts : String(six_digits(value));
}

/* An element of its attributes, handlers of events and children. */
function make(name, ...parts) {
  const space = /svg|path|text|circle|^g$/.test(name) ? "2000/svg" : "1999/xhtml";
  const made = document.createElementNS("http://www.w3.org/" + space, name);
  for (const part of parts.flat())
    if (part.constructor !== Object) made.append(part);
    else for (const key in part) part[key].call ? made[key] = part[key] : made.setAttribute(key, part[key]);
  return made;
}

const path = (d, style) => make("path", {d, style});
const drawing = part => make("svg", {"aria-hidden": true}, part);

/* Long names keep their beginning and end. */
function cut(text, most = 40) {
  const all = [...text], half = most / 2;
  return all.length > most ? [...all.slice(0, half), "\u2026", ...all.slice(-half)].join("") : text;
}

function count_runs() {
  last = max(...runs.map(frames_of)) - 1;
  most_bodies = max(...runs.map(run => run.bodies));
  others = [...runs.keys()].filter(run => run > 0 && runs[run].compared);
  names = runs.map(({name}, i) => { /* of the same name they are numbered */
    const before = runs.slice(0, i).filter(run => run.name === name).length;
    return cut(name) + (before > 0 ? ` (${before + 1})` : "");
  });
}

on_runs.push(count_runs);

const theme_name = () => view.theme !== "auto" ? view.theme : dark_wanted.matches ? "dark" : "light";
const theme = () => data.themes[theme_name()];

function apply_theme() {
  const name = theme_name();
  tell(ui.theme, "Colours: " + view.theme);
  if (themed === name) return;
  themed = style.colorScheme = name;
  for (const [key, value] of Object.entries(theme()).filter(([, value]) => value.at)) /* colours alone: texts */
    style.setProperty("--" + key, value);
  [...runs.map(run => run.colours[name]), theme().bomb].forEach(({fill, line}, run) => {
    style.setProperty("--fill" + run, fill);
    style.setProperty("--line" + run, line);
  });
}

/* Why a look cannot be had; "" if it can. */
function refused(look) {
  const needs = {...data.shows, overlay: "others", difference: "others", mass: "masses", name: "names"};
  const need = needs[look], lacks = run => need?.split(" and ").find(each => run[each] === false);
  const lacking = runs.findIndex(lacks);
  if (lacking >= 0) return `${names[lacking]} has no ${lacks(runs[lacking])}`;
  return need === "others" && others.length === 0 ? "no run compares with the first" : "";
}

/* Shows what the pointer is at, and all that changed, with the next picture of the screen. */
function measure() {
  scheduled ||= requestAnimationFrame(now => {
    scheduled = 0;
    if (view.playing) tick(now);
    if (stale) draw(); else show_body();
  });
}

function change(patch) {
  Object.assign(view, patch);
  view.frame = min(max(view.frame || 0, 0), last);
  view.slow &&= data.impact >= 0;
  if (view.body < 0) view.run = 0;
  if (refused(view.compare)) view.compare = "split";
  if (refused(view.labels)) view.labels = "none";
  view.show = new Set(SHOWS.filter(name => view.show.has(name) && !refused(name)));
  stale = true;
  measure();
}
