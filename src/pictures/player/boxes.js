/* Boxes, filled or as outlines: src/pictures/bodies.c. Its numbers in capitals are those of src/pictures/style.h. */

/* Of colours "#rrggbb", in whole numbers as in C. */
const channels = colour => [1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16));

function mix(from, to, share) {
  const a = channels(from), b = channels(to);
  return "#" + a.map((low, i) => rint(low + (b[i] - low) * share).toString(16).padStart(2, "0")).join("");
}

/* A colour of the scale of distances. */
function ramp(share) {
  const {stops, near, far} = look.ramp, end = stops.length - 1, at = end * (near + (far - near) * share);
  const below = min(floor(at), end - 1);
  return mix(stops[below], stops[below + 1], at - below);
}

const run_colours = run => runs[run].colours[theme_name()];
const outline_colour = run => run_colours(run)[run === 0 && look.ghost_is_band ? "band" : "fill"];
const by_distance = run => others.includes(run) && (lay.difference || shows("distance"));

/* Those of distances have a band that contrasts; grey if there is no distance. */
function body_colours(run, body) {
  const {fixed, bomb} = runs[run], own = body === bomb ? look.bomb : run_colours(run);
  if (fixed[body]) return {fill: look.ground, line: look.ground_line};
  if (by_distance(run)) {
    const share = distance_share(distance(run, now, body)), {line} = run_colours(run);
    if (isNaN(share)) return {fill: look.ground, line, band: look.ground_line};
    const fill = ramp(share), light = channels(fill)[1] > LIGHT_GREEN;
    return {fill, line, band: light ? mix(fill, "#000000", BAND_DARKER) : mix(fill, "#ffffff", BAND_LIGHTER)};
  }
  if (!lay.overlay || here.outlines.length === 0) return own;
  return {fill: mix(own.fill, look.panel, FADE), line: own.line, band: mix(own.band, look.panel, FADE)};
}

const place = ({x, y}) => ({x: here.left + eye.left + eye.scale * x, y: here.top + eye.top - eye.scale * y});

/* Calls use(w, h), in pixels, with the centre of a body at (0, 0) and its axes along the canvas's; not if it does not exist. */
function with_body(run, body, use, moment = now) {
  const at = pose(run, moment, body), {x, y} = place(at), [w, h] = runs[run].size[body];
  const c = cos(at.angle) * base.a, s = sin(at.angle) * base.a;
  if (!(hypot(x, y) < MAX_COORDINATE)) return;
  pen.setTransform(c, -s, s, c, base.a * x + base.e, base.d * y + base.f);
  use(eye.scale * w, eye.scale * h);
  pen.setTransform(base);
}

const radius_of = (w, h) => min(CORNER * min(w, h), MAX_CORNER * lay.side);

const outline_of = side => side < MIN_OUTLINED_SIDE ? 0
  : min(max(OUTLINE * side, MIN_OUTLINE), max(MAX_OUTLINE * lay.side, MIN_OUTLINE));

function fill_box(w, h, colours, radius, banded) {
  const side = min(w, h), line = outline_of(side);
  const paint = (colour, inset, height) => {
    const r = max(0, radius - inset), at = [inset - w / 2, inset - h / 2, w - 2 * inset, height];
    pen.fillStyle = colour;
    if (r < 0.5) { pen.fillRect(...at); return; } /* twice as fast for thousands of bodies */
    pen.beginPath();
    pen.roundRect(...at, height < h - 2 * inset ? [r, r, 0, 0] : r);
    pen.fill();
  };
  if (line > 0) paint(colours.line, 0, h);
  paint(colours.fill, line, h - 2 * line);
  if (banded) paint(colours.band, line, min(BAND * side, h - 2 * line));
}

/* Along the inside of the edge, or so many pixels outside. */
function stroke_box(w, h, thickness, colour, outside = 0) {
  const inset = thickness / 2 - outside;
  pen.lineWidth = thickness;
  pen.strokeStyle = colour;
  pen.beginPath();
  pen.roundRect(inset - w / 2, inset - h / 2, w - 2 * inset, h - 2 * inset, max(0, radius_of(w, h) - inset));
  pen.stroke();
}

/* Width / size of the letters: digits take the same room whatever they are, letters of a name what they need. */
function label_ems(text) {
  if (view.labels !== "name") return LABEL_EMS * max(text.length, LABEL_DIGITS);
  const font = font_of(600, LABEL_MEASURED);
  return max(text_width(font, text) / font.em, LABEL_EMS * LABEL_DIGITS);
}

/* The label of a body, where it has one: with place and colour. */
function box_label(run, body) {
  const {fixed, size, mass, named} = runs[run], {left, top, width, height} = here;
  if (view.labels === "none" || fixed[body] || !exists(run, now, body)) return null;
  const text = view.labels === "name" ? named[body] : String(view.labels === "mass" ? Number(mass[body].toPrecision(3)) : body);
  if (text === "") return null;
  const most = LABEL_CIRCLE * eye.scale * min(...size[body]) / hypot(label_ems(text), LABEL_CAP);
  const font = font_of(600, max(most, LABEL_LEAST)), wide = text_width(font, text), high = ceil(LABEL_CAP * font.em);
  if (!(most >= LABEL_LEAST || hypot(wide, high) <= eye.scale * min(...size[body]))) return null;
  const {x, y} = place(pose(run, now, body)), start = rint(x - wide / 2), baseline = rint(y + high / 2);
  if (start < left || start + wide > left + width || baseline - high < top || baseline > top + height) return null;
  const [red, green, blue] = channels(body_colours(run, body).fill).map(part => part / 255);
  const light = RED_LIGHT * red * red + GREEN_LIGHT * green * green + BLUE_LIGHT * blue * blue > LABEL_DARK_FROM;
  return {font, text, start, baseline, colour: look[light ? "label_dark" : "label_light"]};
}

/* On all that is drawn in the panel. */
function draw_labels() {
  runs[here.run].fixed.forEach((_, body) => {
    const label = box_label(here.run, body);
    if (label) write(label.font, label.text, label.start, label.baseline, label.colour);
  });
}

/* The static bodies, or the others with the bomb on top. */
function draw_bodies(still) {
  const {bodies, bomb, fixed} = runs[here.run];
  const draw = body => with_body(here.run, body, (w, h) => {
    const colours = body_colours(here.run, body), r = TARGET * min(w, h);
    fill_box(w, h, colours, still ? 0 : radius_of(w, h), !still && body !== bomb);
    if (body !== bomb || box_label(here.run, body)) return;
    pen.fillStyle = colours.band; /* a dot in a ring, and a bar from the ring towards the local top */
    const half = TARGET_BAR_HEIGHT * r;
    pen.fillRect(-r / TARGET_BAR, -TARGET_BAR_RISE * r - half, 2 * r / TARGET_BAR, 2 * half);
    [r, r - r / TARGET_THIRD, r / TARGET_THIRD].forEach((radius, i) =>
      draw_discs(radius, colours[["band", "fill", "band"][i]], [{x: 0, y: 0}]));
  });
  for (let body = 0; body < bodies; body++) if (fixed[body] === still && body !== bomb) draw(body);
  if (!still && bomb >= 0) draw(bomb);
}

/* Coincident outlines of several runs: later ones are thinner, so that all are visible. The first run's bomb keeps its
   colour; the others have the colour of their run. */
function draw_outlines(run) {
  const {bodies, bomb, fixed} = runs[run], above = lay.overlay ? runs.length - 1 - run : 0;
  const thickness = max(GHOST_OUTLINE * lay.side, MIN_GHOST_OUTLINE) * (1 + above * min(NESTED_STEP, NESTED_TOTAL / runs.length));
  for (let body = 0; body < bodies; body++)
    if (!fixed[body]) with_body(run, body, (w, h) => stroke_box(w, h, min(thickness, w / 2, h / 2),
      by_distance(run) ? body_colours(run, body).fill
        : run === 0 && body === bomb ? look.bomb.fill : outline_colour(run)));
}

/* The body that is pinned, in all panels that have it. */
function draw_pinned() {
  if (view.body >= 0 && exists(here.run, now, view.body)) with_body(here.run, view.body, (w, h) => {
    stroke_box(w, h, 5, look.panel, 4);
    stroke_box(w, h, 2, look.ink, 2.5);
  });
}

/* A small box in the run's colours on the baseline of text. */
function draw_swatch(run, hollow, left, baseline, side) {
  pen.translate(left + side / 2, baseline - side / 2);
  if (hollow) stroke_box(side, side, max(MIN_SWATCH_OUTLINE, side / SWATCH_OUTLINE), outline_colour(run));
  else fill_box(side, side, run_colours(run), radius_of(side, side), true);
  pen.setTransform(base);
}

/* The corners of a body's box, from its local upper left clockwise. */
function corners(plan, camera, panel, run, frame, body) {
  const {x, y, angle} = pose(run, frame, body), [w, h] = runs[run].size[body], c = cos(angle) / 2, s = sin(angle) / 2;
  return [[-w, h], [w, h], [w, -h], [-w, -h]]
    .map(([u, v]) => to_pixel(plan, camera, panel, x + c * u - s * v, y + s * u + c * v));
}

/* The body at a point: the bomb rather than others, small ones rather than large, as the ground is. */
function body_at(plan, camera, frame, px, py) {
  const point = to_world(plan, camera, px, py);
  let best = null, least = Infinity;
  if (point === null) return null;
  for (const run of [plan.panels[point.panel].run, ...plan.panels[point.panel].outlines])
    runs[run].size.forEach(([w, h], body) => {
      const {x, y, angle} = pose(run, frame, body), u = point.x - x, v = point.y - y, c = cos(angle), s = sin(angle);
      const rank = body === runs[run].bomb ? 0 : w * h;
      if (abs(c * u + s * v) <= w / 2 && abs(c * v - s * u) <= h / 2 && rank < least)
        [best, least] = [{panel: point.panel, run, body}, rank];
    });
  return best;
}
