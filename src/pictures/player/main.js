/* Draws what changed; begins. */
let planned_for = "";
const looks = new Map(); /* the control of each */
const again = () => change({});
function undecoded() {
  page_problem = "The page is damaged: states cannot be decoded.";
  show_problems();
}

function show_look() {
  const reasons = {}, {compare, show} = view;
  for (const [look, input] of looks) {
    const why = refused(look) || (PARTS[compare].includes(look) ? "part of " + compare : "");
    input.checked = compare === look || show.has(look);
    input.disabled = why !== "";
    input.parentNode.className = why && "off";
    if (why) (reasons[why] ??= []).push(look);
  }
  ui.labels.value = view.labels;
  for (const option of ui.labels.options) option.disabled = refused(option.value) !== "";
  tell(ui.reasons, Object.keys(reasons).map(why => `${reasons[why].join(", ")}: ${why}`).join("; "));
}

/* The whole page, or the stage and its time line alone. */
function show_page() {
  document.body.classList.toggle("bare", view.stage);
  tell(ui.bare, view.stage ? "Controls" : "Stage only");
}

/* The header takes what its texts need; the rest of the window is the player's. */
function draw_stage(decoded) {
  style.setProperty("--head", ui.player.parentNode.offsetTop + "px");
  const {clientWidth: width, clientHeight: height} = stage, scale = devicePixelRatio, context = stage.getContext("2d");
  const wanted = [width, height, scale, view.compare, view.labels, ...view.show].join();
  if (wanted !== planned_for) {
    stage.width = round(width * scale);
    stage.height = round(height * scale);
    planned = plan(width, height);
    planned_for = wanted;
    place_moments();
  }
  context.setTransform(scale, 0, 0, scale, 0, 0);
  if (decoded) draw_picture(context, planned, view.frame); else load(view.frame).then(again, undecoded);
}

function draw() {
  const decoded = ready(view.frame);
  stale = false;
  apply_theme();
  show_time();
  show_look();
  show_page();
  draw_stage(decoded);
  draw_plot();
  if (!decoded) return;
  show_body();
  if (view.playing) again(); else settle();
}

for (const look of [...COMPARES, ...SHOWS]) {
  const kind = COMPARES.includes(look) ? "compare" : "show", type = kind === "compare" ? "radio" : "checkbox";
  const input = make("input", {id: kind + "-" + look, name: kind, type, onchange: () => {
    if (type === "radio") view.compare = look; else view.show[input.checked ? "add" : "delete"](look);
    again();
  }});
  looks.set(look, input);
  ui[kind].append(make("label", input, look));
}
for (const kind of LABELLINGS) ui.labels.append(new Option(kind === "mass" ? "mass, kg" : kind, kind));
ui.labels.onchange = () => change({labels: ui.labels.value});
on_checked.push(show_check, again);

/* After a change of the runs: all that depends on them. */
function runs_changed() {
  on_runs.forEach(call => call());
  themed = planned_for = "";
  again();
}
dark_wanted.onchange = onresize = again;
new ResizeObserver(again).observe(ui.frame);
begin_live();
runs_changed();
apply_theme();
onhashchange();
load(view.frame).then(check_all).catch(undecoded);
window.player = {
  view, change, plan, camera, corners, body_at, to_pixel, state_hash: (index, frame) => hash_of(runs[index], frame), load, ready, checked, runs, data, draw, choose, set_text,
  mode_count, setup, add_panel, set_method, launched: () => launched,
};
