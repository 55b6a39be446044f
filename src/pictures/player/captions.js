/* The texts: src/picture/caption*.c. */

function write(font, text, x, baseline, colour = look.ink_soft) {
  pen.font = font.css;
  pen.fillStyle = colour;
  pen.fillText(text, x, baseline);
}

/* A number with its label and unit. The width of digits does not depend on their values, so that text does not move between
   frames. */
function item(font, label, number, longest, unit) {
  const digits = text => text_width(font, text.replace(/\d/g, "0"));
  const end = text_width(font, label) + max(digits(number), digits(longest));
  return {width: end + text_width(font, unit), draw: (left, baseline) => {
    write(font, label, left, baseline);
    write(font, number, left + end - digits(number), baseline, look.ink);
    write(font, unit, left + end, baseline);
  }};
}

function distance_item(font, label, metres) {
  const places = metres < 9.995 ? 2 : metres < 99.95 ? 1 : 0, number = metres < 999.5 ? metres.toFixed(places) : ">999";
  return item(font, label, isNaN(metres) ? "\u2013" : number, "0.00", " m");
}

/* Time, frame and, for two panels, their distance; what has no room is left out, from the end. */
function draw_header() {
  const {status, scene, margin, header} = lay;
  const items = [item(status, "t = ", seconds(now).toFixed(3), seconds(last).toFixed(3), " s"),
    item(status, "frame ", String(number_of(now)), String(number_of(last)), "")];
  if (lay.pair) items.push(distance_item(status, "distance ", largest(1, now)));
  let right = lay.right;
  for (const {width, draw} of items) {
    if (right - width < margin) break;
    draw(right - width, header);
    right -= width + (status.em * 5 >> 2);
  }
  write(scene, fitting(scene, data.title, right - margin), margin, header, look.ink);
}

const swatch_side = font => trunc(font.em * 3 / 4);
const name_width = name => swatch_side(lay.title) + (lay.title.em >> 1) + text_width(lay.title, name);

/* What a panel does not show. */
function state_of(run) {
  const {fixed, frames} = runs[run], is_unseen = (still, body) =>
    !still && exists(run, now, body) && !is_inside(here, place(pose(run, now, body)));
  const unseen = fixed.filter(is_unseen).length, end = now >= frames ? ["ended"] : [];
  return [...unseen > 0 ? [unseen + " out of view"] : [], ...end].join(", ");
}

/* Of a run, between two edges: its name, description and distance from the first run, and what cannot be seen. The name keeps
   its width, but of very long settings only a part. */
function draw_caption(run, hollow, left, right, state) {
  const {title, axis, method} = lay, gap = title.em >> 1, name = names[run], {note} = runs[run];
  const start = left + swatch_side(title) + gap, baseline = here.top - lay.rise, room = text_width(method, state);
  const kept = left + gap + min(name_width(name), trunc((right - left) * 3 / 5));
  if (others.includes(run) && !lay.pair) {
    const {width, draw} = distance_item(method, right - left > 25 * title.em ? "distance " : "", largest(run, now));
    if (right - width >= kept) {
      draw(right - width, baseline);
      right -= width + method.em;
    }
  }
  if (state && room <= right - kept) {
    right -= room + gap;
    write(method, state, right + gap, baseline);
  } else if (state) /* in the panel: what cannot be seen must be stated */
    write(axis, state, here.left + here.width - gap - text_width(axis, state), here.top + gap + axis.em);
  draw_swatch(run, hollow, left, baseline, swatch_side(title));
  const text = fitting(title, name, right - start), end = start + text_width(title, text) + gap;
  write(title, text, start, baseline, look.ink);
  if (right - end >= 5 * method.em) write(method, fitting(method, note, right - end), end, baseline);
}

/* The runs of an overlay share the line above it. */
function draw_captions(all) {
  const space = lay.title.em, at = i => trunc(here.left + i * (here.width + space) / all.length);
  all.forEach((run, i) => draw_caption(run, i > 0, at(i), at(i + 1) - space, all.length > 1 ? "" : state_of(run)));
}
