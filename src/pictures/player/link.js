/* The address: #stage&t=0.55&body=7&compare=overlay&show=ghosts,trails&view=X,Y,W,H&speed=0.25&theme=dark */
let writing = 0, followed = "";

/* Times in links are rounded: one within 0.02 of a stored frame means that frame. */
function frame_at(t) {
  const frame = t / data.dt - data.first / data.every;
  return abs(frame - round(frame)) < 0.02 ? round(frame) : frame;
}

/* As few digits as lead back to the frame. */
function link_time() {
  let digits = 2, t = "";
  do t = seconds(view.frame).toFixed(digits++); while (digits < 13 && abs(frame_at(t) - view.frame) > 0.01);
  return Number(t);
}

/* Keys with values, but those that are as usual. */
const words = (mark, join, pairs) =>
  pairs.filter(([, value, usual]) => value !== usual).map(([key, value]) => mark + key + join + value);

/* What links and commands have in common. */
function shown(key) {
  const {x, y, w, h} = shown_view(), text = [x.toFixed(6), y.toFixed(6), w, h].map(Number).join();
  return [["compare", view.compare, "split"], ["show", [...view.show].join(), ""],
    ["labels", view.labels, "none"],
    [key, view.camera.kind === "fit" ? "" : text, ""]];
}

function link_text() {
  const {camera, body, run, speed, slow, theme, stage} = view;
  return "#" + words("", "=", [["t", link_time()], ["body", body, -1], ["run", run, 0], ...shown("view"),
    ["follow", camera.kind === "body" ? "body" : "", ""], ["speed", speed, 1], ["slow", slow ? 1 : 0, 0],
    ["theme", theme, "auto"], ["stage", stage ? 1 : 0, 0], ...live_words()]).join("&");
}

/* The launch of a live page, where it is not the first one. */
const live_words = () => !data.live ? [] : [["set", encodeURIComponent(set_text()), encodeURIComponent(first_set)],
  ["methods", live_runs().map(run => encodeURIComponent(run.live)).join(";"),
    first_runs.filter(each => each.live).map(each => encodeURIComponent(each.live)).join(";")],
  ["without", recorded.filter(run => !runs.includes(run)).map(run => run.stored).join(), ""]];

/* What is absent or malformed has its default. */
onhashchange = () => {
  followed = location.hash;
  if (data.live) follow_link(location.hash);
  const link = new URLSearchParams(location.hash.slice(1)), text = key => link.get(key) ?? "";
  const one_of = (key, list, usual) => list.find(each => String(each) === text(key)) ?? usual;
  const [x, y, w, h] = text("view").split(",").map(Number), body = one_of("body", [...Array(most_bodies).keys()], -1);
  const kind = text("follow") === "body" && body >= 0 ? "body" : "free";
  change({
    frame: frame_at(Number(text("t"))), playing: false, body, run: one_of("run", [...runs.keys()], 0),
    slow: text("slow") === "1", speed: one_of("speed", SPEEDS, 1), compare: one_of("compare", COMPARES, "split"),
    show: new Set(text("show").split(",")), labels: one_of("labels", LABELLINGS, "none"), theme: one_of("theme", THEMES, "auto"),
    stage: link.has("stage") && text("stage") !== "0", camera: is_view({x, y, w, h}) ? {kind, x, y, w, h} : FIT,
  });
  if (!data.live) return;
  launch();
  if (text("predict") === "1" && !asked) ui.predict.click();
};

/* The launch that a fragment names. */
function follow_link(fragment) {
  const link = new URLSearchParams(fragment.slice(1)), set = link.get("set") ?? first_set;
  const methods = (link.get("methods") ?? first_runs.filter(each => each.live).map(each => each.live).join(";")).split(";");
  if (set !== set_text()) {
    read_set(set);
    if (launched === 0) live_runs().forEach(run => { run.reached = -1; }); /* the page has another first frame */
  }
  methods.filter(Boolean).slice(0, METHODS_MAX).forEach((text, i) => {
    const run = live_runs()[i];
    if (!run) add_panel(text);
    else if (run.live !== text) change_method(run, text);
  });
  const without = (link.get("without") ?? "").split(",");
  for (const run of recorded) {
    const is_there = runs.includes(run), wanted = !without.includes(String(run.stored));
    if (is_there && !wanted && runs.length > 1) remove_panel(run);
    if (wanted && !is_there && runs.length < METHODS_MAX) put_back(run);
  }
  show_settings();
}

/* Where time stands still: browsers allow few changes of the address per second. The label is for those who do not see
   the picture. */
function settle() {
  clearTimeout(writing);
  writing = setTimeout(() => {
    if (view.playing || location.hash !== followed) return; /* a link is still to be followed */
    const far = others.map(run => `; ${names[run]} is ${metric(largest(run, view.frame), "m")} from ${names[0]}`);
    stage.ariaLabel = [ui.time.textContent, ...far, view.body < 0 ? "" : "; " + ui.named.textContent].join("");
    try { history.replaceState(null, "", link_text()); } catch { /* not allowed where the page is shown */ }
    followed = location.hash;
  }, 250);
}
