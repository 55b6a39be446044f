/* Boxes, filled or as outlines: src/pictures/parts.c. */

const CORNER = 0.11, OUTLINE = 0.045, BAND = 0.13, TARGET = 0.3; /* of a box's shorter side */
const FADE = 0.55;      /* share of the panel's colour in boxes behind outlines */
const OFF_SCREEN = 1e9; /* pixels; no visible body is farther away */

const mix = (from, to, share) => `color-mix(in srgb, ${to} ${100 * share}%, ${from})`;

/* A colour of the scale of distances. */
function ramp(share) {
  const at = 10 * share, below = min(floor(at), 9);
  return mix(look.ramp[below], look.ramp[below + 1], at - below);
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
    const fill = ramp(share), light = share < 0.46 === (theme_name() === "light"); /* on a dark page, the far are light */
    return {fill, line, band: light ? mix(fill, "#000", 0.6) : mix(fill, "#fff", 0.7)};
  }
  if (!lay.overlay || here.outlines.length === 0) return own;
  return {fill: mix(own.fill, look.panel, FADE), line: own.line, band: mix(own.band, look.panel, FADE)};
}

const place = ({x, y}) => ({x: here.left + eye.left + eye.scale * x, y: here.top + eye.top - eye.scale * y});

/* Calls use(w, h), in pixels, with the centre of a body at (0, 0) and its axes along the canvas's; not if it does not exist. */
function with_body(run, body, use) {
  const at = pose(run, now, body), {x, y} = place(at), [w, h] = runs[run].size[body];
  const c = cos(at.angle) * base.a, s = sin(at.angle) * base.a;
  if (!(hypot(x, y) < OFF_SCREEN)) return;
  pen.setTransform(c, -s, s, c, base.a * x + base.e, base.d * y + base.f);
  use(eye.scale * w, eye.scale * h);
  pen.setTransform(base);
}

const radius_of = (w, h) => min(CORNER * min(w, h), 0.009 * lay.side);

function fill_box(w, h, colours, radius, banded) {
  const side = min(w, h), line = side < 5 ? 0 : max(min(OUTLINE * side, 0.0026 * lay.side), 1);
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

/* The static bodies, or the others with the bomb on top. */
function draw_bodies(still) {
  const {bodies, bomb, fixed} = runs[here.run];
  const draw = body => with_body(here.run, body, (w, h) => {
    const colours = body_colours(here.run, body), r = TARGET * min(w, h);
    fill_box(w, h, colours, still ? 0 : radius_of(w, h), !still && body !== bomb);
    if (body !== bomb) return;
    pen.fillStyle = colours.band; /* a dot in a ring, and a bar from the ring towards the local top */
    pen.fillRect(-r / 7, -1.5 * r, 2 * r / 7, 0.6 * r);
    ["band", "fill", "band"].forEach((part, i) => draw_discs((3 - i) / 3 * r, colours[part], [{x: 0, y: 0}]));
  });
  for (let body = 0; body < bodies; body++) if (fixed[body] === still && body !== bomb) draw(body);
  if (!still && bomb >= 0) draw(bomb);
}

/* Coincident outlines of several runs: later ones are thinner, so that all are visible. The first run's bomb keeps its
   colour; the others have the colour of their run. */
function draw_outlines(run) {
  const {bodies, bomb, fixed} = runs[run], above = lay.overlay ? runs.length - 1 - run : 0;
  const thickness = max(0.0034 * lay.side, 1.6) * (1 + above * min(0.7, 1.2 / runs.length));
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
  if (hollow) stroke_box(side, side, max(2, side / 8), outline_colour(run));
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
