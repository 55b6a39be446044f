/* Trails below the bodies, contacts and arrows above: src/pictures/parts.c, panel.c and src/pixels/drawing.c. */

const TRAIL = 2.0, MIN_TRAIL = 0.5; /* s; m: a body that moved less has none */
const TRAIL_EVERY = 2, TRAIL_POINTS = 4, MOST_TRAIL = 600; /* frames between points; points of a segment; frames */
const OLDEST = 0.15;    /* opacity of a trail's oldest end */
const MIN_SPEED = 0.05; /* m/s: slower bodies have no arrow */

/* The largest 1, 2 or 5 times a power of ten that is at most `most`. */
function round_number(most) {
  const power = 10 ** floor(log10(most) + 1e-9), digit = [5, 2, 1].find(each => each * power <= most) ?? 1;
  return Number((digit * power).toPrecision(1));
}

/* Pixels of marks, and per unit of arrows. They are in proportion to the panel, but to its boxes where these are small, or they
   would cover them. */
function mark_sizes(scale) {
  const {impulse, speed, largest} = data.scales, box = scale * data.scales.box, decades = largest > 1 ? 4 : 3;
  const size = (share, least, boxes) => max(min(max(share * lay.side, least), boxes * box), 0.6);
  const arrow = (share, boxes) => min(share * lay.side, boxes * box);
  const unit = (value, pixels) => {
    const per = value > 1e-9 ? pixels / value : pixels;
    return {per, legend: round_number(arrow(0.07, 3.5) / per)};
  };
  return {
    impulse: unit(impulse, arrow(0.1, 1.2)), velocity: unit(speed, arrow(0.2, 3)), longest: arrow(0.28, 4),
    dot: size(0.0052, 2.2, 0.13), line: size(0.0034, 1.4, 0.085), decades, exceeded: largest > 10 ** (decades - 3),
  };
}

/* Position of a distance on the colour scale, from 1 mm. */
const distance_share = metres => max(0, min(1, (log10(metres) + 3) / sizes.decades));

function draw_lines(thickness, colour, all) {
  pen.lineWidth = thickness;
  pen.strokeStyle = colour;
  pen.beginPath();
  for (const line of all) line.forEach(({x, y}, i) => { if (i > 0) pen.lineTo(x, y); else pen.moveTo(x, y); });
  pen.stroke();
}

function draw_discs(radius, colour, points) {
  pen.fillStyle = colour;
  pen.beginPath();
  for (const {x, y} of points) {
    pen.moveTo(x + radius, y);
    pen.arc(x, y, radius, 0, 7);
  }
  pen.fill();
}

/* With a rim. */
function draw_dots(radius, points) {
  draw_discs(radius, look.impulse, points);
  draw_discs(max(0, radius - max(1, radius / 3)), look.panel, points);
}

/* Segments of equal age have one colour, so they are drawn at once. */
function draw_trails(run) {
  const {frames, bomb, bodies, fixed, x, y} = runs[run], last = min(now, frames - 1), groups = {};
  const length = min(rint(TRAIL / data.dt), MOST_TRAIL), start = max(0, floor(last) - length);
  for (let body = 0; body < bodies; body++) {
    const end = pose(run, last, body), path = [], colour = body === bomb ? look.bomb.fill : run_colours(run).fill;
    for (let frame = start + start % TRAIL_EVERY; frame < last && !fixed[body]; frame += TRAIL_EVERY)
      path.push({x: x[frame * bodies + body], y: y[frame * bodies + body], age: min(1, (last - frame) / length)});
    if (!path.some(point => hypot(point.x - end.x, point.y - end.y) > MIN_TRAIL)) continue;
    const points = [...path, end].map(place);
    for (let i = 0; i < path.length; i += TRAIL_POINTS) {
      const shade = mix(look.panel, colour, 1 - (1 - OLDEST) * path[i].age);
      (groups[shade] ??= []).push(points.slice(i, i + TRAIL_POINTS + 1));
    }
  }
  for (const shade in groups) draw_lines(sizes.line, shade, groups[shade]);
}

/* With an open head, two if it is cut; the halo separates it from what is below. */
function draw_arrow(from, to, cut, t, colour, halo) {
  const length = hypot(to.x - from.x, to.y - from.y), head = min(4.2 * t, max(3 * t, 0.6 * length)) / length;
  if (!(length >= 2 * t && length < 1e9)) return;
  const c = (to.x - from.x) * head, s = (to.y - from.y) * head, lines = [[from, to]];
  const side = (back, turn) => ({x: to.x - back * c - turn * s, y: to.y - back * s + turn * c}), along = 0.75 ** 0.5;
  for (const back of cut ? [0, 0.85] : [0])
    lines.push([side(back + along, 0.5), side(back, 0), side(back + along, -0.5)]);
  const width = max(min(1, 2.5 * (t - 1)), t > 3 ? t / 3 : 0);
  if (width > 0) draw_lines(t + 2 * width, halo, lines);
  draw_lines(t, colour, lines);
}

/* Of a vector, y up: "impulse" or "velocity". */
function draw_vector(what, at, x, y) {
  const {per} = sizes[what], fits = sizes.longest / (per * hypot(x, y)), from = place(at);
  const pixels = fits < 1 ? per * fits * (1 + min(-log10(fits) / 3, 1)) : per;
  draw_arrow(from, {x: from.x + pixels * x, y: from.y - pixels * y}, fits < 1, sizes.line, look[what], look.panel);
}

/* At the edge of the panel, an arrow to a bomb that is outside. */
function draw_pointer(run) {
  const {bomb, size} = runs[run];
  runs[run].arrow = null;
  if (bomb < 0 || !exists(run, now, bomb)) return;
  const at = place(pose(run, now, bomb)), {left, top, width, height} = here;
  const line = max(0.0075 * lay.side, 2), inset = 3 * line, inside = (at, low, side) =>
    min(max(at, low + inset), low + side - inset);
  const edge = {x: inside(at.x, left, width), y: inside(at.y, top, height)};
  const x = at.x - edge.x, y = at.y - edge.y, away = hypot(x, y), tail = max(0.055 * lay.side, 14) / away;
  if (!(away > eye.scale * min(...size[bomb]) / 2 + inset)) return;
  draw_arrow({x: edge.x - tail * x, y: edge.y - tail * y}, edge, false, line, look.bomb.fill, look.panel);
  runs[run].arrow = edge;
}

/* An impulse is that on body b; body a receives the opposite. */
function draw_marks(run) {
  const {bodies, fixed} = runs[run], stored = floor(now);
  for (let body = 0; body < bodies && shows("velocities"); body++) {
    const {x, y} = velocity(run, stored, body);
    if (!fixed[body] && hypot(x, y) > MIN_SPEED) draw_vector("velocity", pose(run, now, body), x, y);
  }
  const all = shows("contacts") || shows("impulses") ? contacts_at(run, stored) : [];
  if (shows("impulses"))
    for (const {x, y, nx, ny, normal, tangent} of all)
      draw_vector("impulse", {x, y}, normal * nx + tangent * ny, normal * ny - tangent * nx);
  if (shows("contacts")) draw_dots(sizes.dot, all.map(place));
}
