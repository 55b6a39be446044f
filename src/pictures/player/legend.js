/* What colours and lengths mean, below the panels: src/pictures/theme.c. An entry is a row of parts: texts, and samples with a
   width that draw themselves, given the middle of the text and its baseline. */

function entries() {
  const {overlay, difference, axis} = lay, {em} = axis, {line, decades, exceeded} = sizes, square = swatch_side(axis);
  const found = [], dot = max(sizes.dot, 0.18 * em);
  const add = (width, draw, text) => found.push([{width: ceil(width), draw}, {width: em >> 1}, text]);
  const arrow = (what, unit) => {
    const {legend, per} = sizes[what], width = legend * per;
    add(width, (x, y) => draw_arrow({x: x + 1, y}, {x: x + 1 + width, y}, false, max(line, 0.11 * em), look[what],
      look.page), `${legend} ${unit}`);
  };
  if (difference || (shows("ghosts") && !overlay))
    add(square, (x, y, baseline) => draw_swatch(0, true, x, baseline, square), names[0]);
  if (difference || shows("distance")) { /* a number stands between the colours of its two decades */
    const scale = ["distance  0.001 "], width = min(3 * em, lay.width >> 4);
    for (let i = 0; i < decades; i++)
      scale.push({width, draw: (x, y, baseline) => {
        for (let k = 0; k < width; k++) {
          pen.fillStyle = ramp((i + (k + 0.5) / width) / decades);
          pen.fillRect(x + k, baseline - square, 1, square);
        }
      }}, ` ${["0.01", "0.1", "1", "10"][i]} ` + (i + 1 < decades ? "" : exceeded ? "m or more" : "m"));
    found.push(scale);
  }
  if (shows("trails"))
    add(2 * em, (x, y) => draw_lines(line, look.ink_soft, [[{x, y}, {x: x + 2 * em, y}]]),
      `path of the last ${TRAIL} s`);
  if (shows("contacts")) add(2 * dot, (x, y) => draw_dots(dot, [{x: x + dot, y}]), "contact");
  if (shows("impulses")) arrow("impulse", "N s");
  if (shows("velocities")) arrow("velocity", "m/s");
  if (shows("impulses") || shows("velocities")) found.push(["(two heads: ten times as much is a third longer)"]);
  return found;
}

/* Measures, or draws. An entry that would reach too far right begins a row. Returns the number of rows. */
function place_entries(drawing) {
  const {axis, left, right, legend, pitch} = lay, width = part => part.width || text_width(axis, part);
  let x = left, rows = 0;
  for (const entry of entries()) {
    const end = entry.reduce((sum, part) => sum + width(part), x);
    if (rows === 0 || (x > left && end > right)) [x, rows] = [left, rows + 1];
    for (const part of entry) {
      const baseline = legend + (rows - 1) * pitch;
      if (drawing && !part.width) write(axis, part, x, baseline);
      else if (drawing) part.draw?.(x, baseline - axis.em * 0.36, baseline);
      x += width(part);
    }
    x += 2 * axis.em;
  }
  return rows;
}
