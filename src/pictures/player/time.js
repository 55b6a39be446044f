/* Time: play, single frames, speeds, moments. */
const SPEEDS = [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4];
const CIRCLE = "M6 0a6 6 0 1 0 .1 0z", DIAMOND = "M6-1 13 6 6 13-1 6z";
const TRIANGLE = "M6 0 12 11H0z", SQUARE = "M1 1h10v10H1z";
const moments = [];
let clock = 0;

const seconds = frame => (data.first / data.every + frame) * data.dt;
const time_text = frame => seconds(frame).toFixed(3) + " s";
const number_of = frame => data.first + round(frame) * data.every;
const seek = frame => change({frame: round(frame), playing: false});
const step = by => seek((by > 0 ? floor : ceil)(view.frame) + by);

function toggle_play() {
  if (view.playing || last === 0) return seek(view.frame);
  clock = performance.now();
  change({playing: true, frame: view.frame < last ? view.frame : 0});
}

/* Goes on by the time since the last picture, or waits where frames are not decoded yet: those of the next half second are
   on their way. Slow as by render --slow 4. */
function tick(now) {
  const since = (view.frame - data.impact) * data.dt, slow = view.slow && since >= -SLOW_BEFORE && since < SLOW_AFTER ? 4 : 1;
  const frame = min(last, view.frame + min(max(now - clock, 0), 250) / 1000 * view.speed / slow / data.dt);
  clock = now;
  if (ready(frame)) Object.assign(view, {frame, playing: frame < last});
  load(min(last, frame + 0.5 / data.dt));
}

const shape = (d, run) => drawing(path(d, `fill:var(--fill${run});stroke:var(--line${run})`));
/* The verdict without figures behind what happened: "collapses; 8 of 10 fell, first at 1.2 s", "stands; 1 moved by up to 0.3
   m". Empty before the run has ended. */
const short_verdict = run => cut(runs[run].ended.split(/ \(|; (?!\d+ (of|moved) )/)[0], 100);

/* Events of one frame are one moment. */
function add_event(form, run, at, words) {
  if (!(at?.frame >= 0)) return;
  const {events} = moments[at.frame] ??= {frame: at.frame, events: []};
  events.push([form, run, words + (at.body >= 0 ? `, body\u00a0${at.body}` : "")]);
}

/* Each in the first row that has room. */
function place_moments() {
  const ends = [], number = view.stage ? 2 : 12; /* pixels, beside the first sign */
  moments.forEach(({frame, events}, i) => {
    const x = plot_x(frame) - GUTTER, free = ends.findIndex(end => end <= x - 8 - number - 6 * events.length);
    const row = free < 0 ? ends.length : free;
    ends[row] = x + 10;
    ui.marks.children[i].style = `right: calc(100% - ${x + 6}px); top: ${20 * row}px`;
  });
  ui.marks.style.height = 20 * ends.length + "px";
}

function show_time() {
  const {frame, playing} = view;
  tell(ui.play, playing ? "Pause" : "Play");
  ui.time.ariaLive = playing ? "off" : "polite";
  tell(ui.time, `t = ${time_text(frame)}, frame ${number_of(frame)} of ${data.total - 1}`);
  ui.back.disabled = frame <= 0;
  ui.forth.disabled = frame >= last;
  ui.speed.value = view.speed;
  ui.slow.checked = view.slow;
  ui.scrubber.value = frame;
  if (!playing) ui.scrubber.ariaValueText = ui.time.textContent;
}

function list_moments() {
  moments.length = 0;
  add_event(CIRCLE, runs.length, {frame: data.impact}, "impact");
  runs.forEach((each, run) => {
    const {differs, apart, verdict, elsewhere} = each;
    each.ended = verdict?.text ?? "";
    if (elsewhere) return;
    if (each.method === runs[0].method) /* others differ in a bit from the first step on */
      add_event(DIAMOND, run, differs, names[run] + " differs from here on");
    add_event(TRIANGLE, run, apart, names[run] + " is 1 mm away");
    add_event(SQUARE, run, verdict, names[run] + " " + short_verdict(run));
  });
  moments.splice(0, Infinity, ...moments.filter(moment => moment));
  ui.moments.parentNode.hidden = moments.length === 0;
  ui.marks.replaceChildren();
  ui.moments.replaceChildren();
  moments.forEach(({frame, events}, i) => {
    const onclick = () => seek(frame), shapes = () => events.map(([form, run]) => shape(form, run));
    const label = [`${i + 1}: ${time_text(frame)}`, ...events.map(event => event[2])].join(", ");
    const lines = shapes().map((mark, k) => make("div", mark, " " + events[k][2]));
    ui.marks.append(make("button", {onclick, "aria-label": label}, i + 1, shapes()));
    ui.moments.append(make("tr", {onclick}, make("td", i + 1), make("td", time_text(frame)), make("td", lines)));
  });
  ui.scrubber.max = last;
  ui.slow.disabled = data.impact < 0;
  ui.slow.parentNode.title = ui.slow.disabled ? "no bomb touches a body" : "";
  ui.play.disabled = ui.scrubber.disabled = ui.speed.disabled = last === 0;
}

on_runs.push(list_moments);
for (const speed of SPEEDS) ui.speed.append(new Option(speed < 1 ? "1/" + 1 / speed : speed, speed));
ui.speed.onchange = () => change({speed: Number(ui.speed.value)});
ui.back.onclick = () => step(-1);
ui.forth.onclick = () => step(1);
ui.scrubber.oninput = () => seek(ui.scrubber.value);
