/* The plot of the distances from the first run over time, logarithmic as in videos (src/pictures/timeline.c). */
const GUTTER = 44, BOTTOM = 88; /* pixels */
const DASHES = ["", "", "5 3", "1 2", "7 2 1 2", "3 2 3 5"], UNITS = ["1 \u00b5m", "1 mm", "1 m", "1 km"];
let highest = 0;
const dots = [], values = []; /* of each run at this time */
let plotted = "", cursor = null;

const plot_width = () => ui.marks.clientWidth;
const plot_x = frame => GUTTER + plot_width() * frame / (last || 1);
const plot_y = metres =>
  BOTTOM - (BOTTOM - 6) * (min(highest, max(LOWEST_DECADE, log10(metres))) - LOWEST_DECADE) / (highest - LOWEST_DECADE);
const dashed = run => `stroke:var(--fill${run});stroke-dasharray:${DASHES[run]};`;

/* The largest value of each column of pixels. What is not known leaves a gap. */
function curve(run, style, value) {
  const {frames} = runs[run], columns = min(frames, plot_width()), per = frames / columns;
  let d = "", pen = "M";
  for (let i = 0; i < columns; i++) {
    let most = -1;
    for (let frame = floor(i * per), end = floor((i + 1) * per); frame < end; frame++)
      if (value(frame) > most) most = value(frame);
    if (most >= 0) d += `${pen}${plot_x(i * per)} ${plot_y(most)}`;
    pen = most >= 0 ? "L" : "M";
  }
  return path(d, dashed(run) + style);
}

/* Times are every 0.1, 0.2, 0.5, 1 ... s, so that they have 60 pixels. */
function axes() {
  const width = plot_width(), least = 60 * last * data.dt / width, power = 10 ** floor(log10(least));
  const step = power * [1, 2, 5, 10].find(factor => factor * power >= least);
  const text = (x, y, words) => make("text", {x, y}, words);
  const parts = [path(`M${GUTTER} 0h${width}V${BOTTOM}H${GUTTER}`, "fill:var(--panel)")];
  for (let decade = LOWEST_DECADE; decade <= highest; decade++) {
    const y = plot_y(10 ** decade), unit = UNITS[decade / 3 + 2] ?? "", colour = unit ? "grid_strong" : "grid";
    parts.push(path(`M${GUTTER} ${y}h${width}`, `stroke:var(--${colour})`), text(20, y + 4, unit));
  }
  for (let t = ceil(seconds(0) / step - 0.001) * step; t <= seconds(last) + step / 1000; t += step)
    parts.push(text(plot_x((t - seconds(0)) / data.dt), BOTTOM + 15, six_digits(t) + " s"));
  return parts;
}

/* What does not move, and in a group what does. */
function draw_still({body}) {
  const upright = (x, style) => path(`M${x} 0V${BOTTOM}`, style);
  cursor = make("g", {style: "stroke:var(--ink)"}, upright(0, ""), others.map(run => dots[run]));
  ui.plot.replaceChildren(...axes(), ...moments.map(({frame}) => upright(plot_x(frame), "stroke:var(--frame)")),
    ...others.map(run => curve(run, body < 0 ? "" : "opacity:.4", frame => runs[run].distances[frame])),
    ...others.map(run => body < 0 ? "" : curve(run, "stroke-width:2.5", frame => distance(run, frame, body))), cursor);
}

function draw_plot() {
  const {body, frame} = view, wanted = [plot_width(), body, body < 0 || checked().frames].join();
  if (ui.curves.hidden) return;
  if (wanted !== plotted) draw_still(view);
  plotted = wanted;
  cursor.setAttribute("transform", `translate(${plot_x(frame)})`);
  for (const run of others) {
    const metres = body < 0 ? largest(run, frame) : distance(run, frame, body);
    values[run].textContent = metric(metres, "m");
    dots[run].setAttribute("cy", metres >= 0 ? plot_y(metres) : -99);
  }
  tell(ui.curve, (body < 0 ? "Largest distance" : `Distance of body ${body}`) + " from " + names[0]);
}

function list_curves() {
  highest = min(HIGHEST_DECADE, max(LOWEST_DECADE + MIN_DECADES, ceil(log10(data.scales.largest || 1) - 1e-9)));
  plotted = "";
  ui.curves.hidden = last === 0 || others.length === 0;
  ui.key.replaceChildren(ui.curve);
  for (const run of others) {
    dots[run] = make("circle", {r: 3.5, style: `fill:var(--fill${run})`});
    values[run] = make("data");
    ui.key.append(make("span", drawing(path("M0 6h30", dashed(run))), names[run] + " ", values[run]));
  }
}

on_runs.push(list_curves);
ui.plot.onpointerdown = ui.plot.onpointermove = event => {
  if (event.buttons !== 1) return;
  ui.plot.setPointerCapture(event.pointerId);
  seek((event.clientX - ui.marks.getBoundingClientRect().left) / plot_width() * last);
};
