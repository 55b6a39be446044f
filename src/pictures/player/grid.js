/* The metre grid behind the bodies, and its axes: src/pictures/panel.c. */

const cycle = (values, n) => values[n % 3] * 10 ** trunc(n / 3);

/* The lines across a side, in pixels from its begin. They are every 0.1, 0.2, 0.5, 1, 2, 5, 10 m ...: 1 m if they fit, otherwise
   the nearest that do. Every `strong`-th line has a tick; where fewer than three such are in view, every line. Numbers are at
   every 1st, 2nd, 5th, 10th ... tick, so that they have `room`. 0 m is at `origin`; `sign` is -1 for pixels that count down. */
function grid_lines(origin, length, sign, room) {
  const {axis, grid: {height}} = lay, lines = [];
  const step = n => cycle([0.1, 0.2, 0.5], n), strong = n => [5, 5, 2][n % 3];
  let n = 3, k = 0;
  while (n < 60 && step(n) * eye.scale < max(MIN_SPACING * height, MIN_PIXELS)) n++;
  while (n <= 3 && n > 0 && step(n) * strong(n) * eye.scale > MAX_SPACING * height) n--;
  const spacing = step(n) * eye.scale, low = sign > 0 ? -origin : origin - length + 1;
  for (let i = ceil(low / spacing); i * spacing <= low + length - 1; i++)
    lines.push({at: rint(origin + sign * i * spacing), i, strong: i % strong(n) === 0,
      text: String(Number((i * step(n)).toPrecision(6))).replace("-", "\u2212")});
  const few = lines.filter(line => line.strong), tick = few.length < MIN_TICS && spacing > NUMBER_SPACING * axis.em ? 1 : strong(n);
  room ??= max(0, ...few.map(line => text_width(axis, line.text))) + (axis.em >> 1);
  while (k < 30 && cycle([1, 2, 5], k) * tick * spacing < room) k++;
  const number = cycle([1, 2, 5], k) * tick;
  return lines.map(line => ({...line, tick: line.i % tick === 0, numbered: line.i % number === 0}));
}

function draw_grid(columns, rows) {
  const {left, top, width, height} = here;
  for (const kind of ["grid", "grid_strong"]) {
    const chosen = lines => lines.filter(line => line.strong === (kind === "grid_strong"));
    for (const {at} of chosen(columns)) bar(left + at, top, 1, height, look[kind]);
    for (const {at} of chosen(rows)) bar(left, top + at, width, 1, look[kind]);
  }
}

/* The frame, and axes: below all panels, left of the first column only. The unit replaces a number that would touch it. */
function draw_axes(columns, rows) {
  const {axis, drop} = lay, {left, top, width, height} = here, right = left + width, bottom = top + height;
  const unit = right - text_width(axis, "m");
  for (const y of [top - 1, bottom]) bar(left - 1, y, width + 2, 1, look.frame);
  for (const x of [left - 1, right]) bar(x, top, 1, height, look.frame);
  write(axis, "m", unit, bottom + drop);
  for (const {at, text, tick, numbered} of columns) {
    const wide = text_width(axis, text), start = left + at - (wide >> 1);
    if (tick) bar(left + at, bottom + 1, 1, lay.tick, look.frame);
    if (numbered && start + wide + axis.em / 2 <= unit) write(axis, text, start, bottom + drop);
  }
  for (const {at, text, tick, numbered} of rows) {
    const start = left - 1 - 2 * lay.tick - text_width(axis, text);
    if (tick) bar(left - 1 - lay.tick, top + at, lay.tick, 1, look.frame);
    if (numbered && start >= 0) write(axis, text, start, top + at + (axis.em * 3 >> 3));
  }
}
