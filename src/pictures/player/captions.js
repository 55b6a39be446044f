/* The texts: src/pictures/caption*.c. */

const LEAST_WIDTH = 0.7; /* of its letters; a longer name is cut: it is whole in the page's title */

/* A text in at most `room` pixels: in the reader's font it may be wider than planned, and is narrowed. */
function write(font, text, x, baseline, colour = look.ink_soft, room = lay.width) {
  pen.font = font.css;
  pen.fillStyle = colour;
  pen.fillText(text, x, baseline, max(room, 1));
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
  const places = metres < DISTANCE_TWO_PLACES ? 2 : metres < DISTANCE_ONE_PLACE ? 1 : 0;
  const number = metres < DISTANCE_MOST ? metres.toFixed(places) : ">999";
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

/* Pixels for a run's distance from the first, and for its caption with its note in this font: in `render`'s font,
   because what is where must not depend on the reader's. */
const distance_width = run =>
  others.includes(run) && !lay.pair ? ceil(data.distance_ems * lay.method.em) + lay.method.em : 0;
function caption_width(run, font, apart) {
  const {title} = lay, gap = title.em >> 1, {ems, note, note_ems} = runs[run];
  return swatch_side(title) + gap + ceil(ems * title.em) + (apart ? 0 : distance_width(run)) +
    (font && note ? gap + ceil(note_ems * font.em) : 0);
}

/* Distances have a line of their own, nearest to the panels, if beside some name there is no room. Notes are beside the names if all have room there, with a number of bodies out of view; otherwise below; otherwise
   nowhere. The runs of an overlay share lines. */
function lay_captions(width) {
  const {panels: [{run, outlines}], title, method, axis} = lay, gap = title.em >> 1, fonts = [method, axis];
  if (!lay.overlay) {
    const every = fits => lay.panels.every(({run}) => !runs[run].note || fits(run)), out = ceil(data.out_ems * method.em);
    const apart = lay.panels.some(({run}) => distance_width(run) > 0 && caption_width(run) > width);
    const beside = fonts.find(font => every(each => caption_width(each, font, apart) + gap + out <= width));
    const below = !beside && fonts.find(font =>
      every(each => swatch_side(title) + gap + ceil(runs[each].note_ems * font.em) <= width));
    const counts = mode_base() >= 0 ? 1 : 0;
    return {beside, below, apart, counts, lines: 1 + (below ? 1 : 0) + (apart ? 1 : 0) + counts, at: [{x: 0, line: 0}]};
  }
  const flow = beside => {
    let x = 0, line = 0;
    const at = [run, ...outlines].map(each => {
      const needed = caption_width(each, beside);
      if (x > 0 && x + needed > width) [x, line] = [0, line + 1];
      const place = {x, line};
      x += needed + 3 * gap;
      return place;
    });
    return {beside, lines: line + 1, at};
  };
  const whole = flow(method);
  return whole.lines <= 6 ? whole : flow();
}

/* What a panel does not show. */
function state_of(run) {
  if (runs[run].elsewhere) return ""; /* which says more (picture.js) */
  const {fixed, frames, bomb} = runs[run], is_unseen = (still, body) =>
    !still && body !== bomb && exists(run, now, body) && !is_inside(here, place(pose(run, now, body)));
  const unseen = fixed.filter(is_unseen).length, end = now >= frames ? ["ended"] : [];
  return [...unseen > 0 ? [unseen + " out of view"] : [], ...end].join(", ");
}

/* A caption that the page's author chose is whole where it has room. */
const caption_of = run => runs[run].name === runs[run].caption ? runs[run].caption : names[run];

/* Of a run: its name, description and distance from the first run, and what cannot be seen. */
function draw_caption(run, i) {
  const {title, axis, method, captions, overlay} = lay, gap = title.em >> 1;
  const {ems, note, note_ems} = runs[run], {x, line} = captions.at[i];
  const left = here.left + x, start = left + swatch_side(title) + gap, end = here.left + here.width;
  const baseline = here.top - lay.rise - (captions.lines - 1 - line) * lay.line;
  const name = caption_of(run), planned = ceil(ems * title.em), room_of_name = end - start - (captions.apart ? 0 : distance_width(run));
  const most = overlay ? min(planned, room_of_name) : room_of_name; /* in an overlay the next caption is beside it */
  const font = min(planned, text_width(title, name)) <= most ? title : axis;
  let next = start + min(most, text_width(font, name)) + gap, right = end, free = start;
  const low = here.top - lay.rise - (captions.counts ? lay.line : 0), count = captions.counts && run !== mode_base();
  draw_swatch(run, i > 0, left, baseline, swatch_side(title));
  if (count) write(method, fitting(method, mode_count(run), end - start), start, here.top - lay.rise);
  write(font, fitting(font, name, most / LEAST_WIDTH), start, baseline, look.ink, most);
  if (distance_width(run) > 0) {
    const {width, draw} = distance_item(method, "distance ", largest(run, now));
    if (captions.apart) draw(start, low);
    else draw(overlay ? next : end - width, baseline);
    if (overlay) next += distance_width(run);
    else if (captions.apart) free = start + distance_width(run);
    else right -= width + method.em;
  }
  if (captions.beside) {
    const room = overlay ? ceil(note_ems * method.em) : right - next;
    write(captions.beside, note, next, baseline, look.ink_soft, room);
    next += min(room, text_width(captions.beside, note)) + gap;
  } else if (captions.below) write(captions.below, note, start, baseline + lay.line, look.ink_soft, end - start);
  const state = overlay ? "" : state_of(run), room = text_width(method, state);
  if (state && room <= right - next) write(method, state, right - room, baseline);
  else if (state && captions.apart && room <= right - free) write(method, state, right - room, low);
  else if (state) { /* in the panel, on its colour: what cannot be seen must be stated */
    const wide = text_width(axis, state), x = end - gap - wide, y = here.top + gap;
    bar(x - 2, y, wide + 4, axis.em + 4, look.panel);
    write(axis, state, x, y + axis.em);
  }
}
