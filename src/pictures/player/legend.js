/* What colours and lengths mean, below the panels: src/pictures/legend.c. An entry is a row of parts: texts, and samples with a
   width that draw themselves, given the middle of the text and its baseline. */

function entries() {
  const {overlay, difference, axis} = lay, {em} = axis, {line, decades, exceeded} = sizes, square = swatch_side(axis);
  const found = [], dot = max(sizes.dot, LEGEND_DOT * em);
  const add = (width, draw, text) => found.push([{width: ceil(width), draw}, {width: em >> 1}, text]);
  const arrow = (what, unit) => {
    const {legend, per} = sizes[what], width = legend * per;
    add(width, (x, y) => draw_arrow({x: x + 1, y}, {x: x + 1 + width, y}, false, max(line, LEGEND_LINE * em), look[what],
      look.page), `${legend} ${unit}`);
  };
  if (difference || (shows("ghosts") && !overlay))
    add(square, (x, y, baseline) => draw_swatch(0, true, x, baseline, square), names[0]);
  if (difference || shows("distance")) { /* a number stands between the colours of its two decades */
    const scale = ["distance  0.001 "], width = min(LEGEND_DECADE * em, lay.width >> 4);
    for (let i = 0; i < decades; i++)
      scale.push({width, draw: (x, y, baseline) => {
        for (let k = 0; k < width; k++) {
          pen.fillStyle = ramp((i + (k + 0.5) / width) / decades);
          pen.fillRect(x + k, baseline - square, 1, square);
        }
      }}, ` ${["0.01", "0.1", "1", "10"][i]} ` + (i + 1 < decades ? "" : exceeded ? "m or more" : "m"));
    found.push(scale);
  }
  if (view.labels !== "none")
    found.push(["in boxes that are large enough: " + {mass: "mass, kg", number: "number of the body", name: "name"}[view.labels]]);
  if (shows("trails"))
    add(2 * em, (x, y) => {
      for (let i = 0, n = LEGEND_TRAIL_PARTS; i < n; i++)
        draw_lines(line, mix(look.page, look.ink_soft, (i + 2) / (n + 1)),
          [[{x: x + 2 * em * i / n, y}, {x: x + 2 * em * (i + 1) / n, y}]]);
    },
      `path of the last ${TRAIL_DURATION} s`);
  if (shows("contacts")) add(2 * dot, (x, y) => draw_dots(dot, [{x: x + dot, y}]), "contact");
  if (shows("impulses")) arrow("impulse", "N s");
  if (shows("velocities")) arrow("velocity", "m/s");
  if (shows("impulses") || shows("velocities")) found.push([data.arrow_note]);
  if (shows("modes")) {
    const sample = i => dot * (i === 3 ? MODE_WRONG : MODE_SIDE * MODE_BAR) + MODE_HALO;
    const words = ["open", "sticks", "slips", ...mode_base() >= 0 ? ["not as the reference"] : []];
    found.push(words.flatMap((text, i) => [{width: ceil(2 * sample(i)),
      draw: (x, y) => draw_mode({x: x + sample(i), y}, i === 3 ? 1 : i, i === 3, dot)}, {width: em >> 1}, text, {width: em}]));
  }
  return found;
}

/* Entries in rows: one that would reach too far right begins a row. Returns the number of rows. */
function flow_entries(width, draw) {
  const {axis, left, right} = lay;
  let x = left, rows = 0;
  for (const entry of entries()) {
    const end = entry.reduce((sum, part) => sum + width(part), x);
    if (rows === 0 || (x > left && end > right)) [x, rows] = [left, rows + 1];
    for (const part of entry) {
      draw?.(part, x, rows - 1);
      x += width(part);
    }
    x += 2 * axis.em;
  }
  return rows;
}

/* Measures, or draws. Where the reader's font is wider than `render`'s, texts are narrowed if that takes fewer rows. */
function place_entries(drawing) {
  const {axis, legend, pitch} = lay, planned = min(1, data.arrow_note_ems * axis.em / text_width(axis, data.arrow_note));
  const own = part => part.width || text_width(axis, part), narrow = part => part.width || ceil(planned * own(part));
  const width = flow_entries(narrow) < flow_entries(own) ? narrow : own;
  return flow_entries(width, drawing ? (part, x, row) => {
    const baseline = legend + row * pitch;
    if (part.width) part.draw?.(x, baseline - axis.em * LEGEND_MIDDLE, baseline);
    else write(axis, part, x, baseline, look.ink_soft, width(part));
  } : null);
}
