/* Trails below the bodies, contacts and arrows above: src/pictures/marks.c and src/pixels/drawing.c. */

/* The largest 1, 2 or 5 times a power of ten that is at most `most`. */
function round_number(most) {
  const power = 10 ** floor(log10(most) + 1e-9), digit = [5, 2, 1].find(each => each * power <= most) ?? 1;
  return Number((digit * power).toPrecision(1));
}

/* Of the scale of distances, from 1 mm to 1 m or, if some are larger, on. */
function decades_to(largest) {
  let end = 0;
  while (10 ** end < largest && end < SCALE_LAST_DECADE) end++;
  return end - SCALE_FIRST_DECADE;
}

/* Pixels of marks, and per unit of arrows. They are in proportion to the panel, but to its boxes where these are small, or they
   would cover them. */
function mark_sizes(scale) {
  const {impulse, speed, largest} = data.scales, box = scale * data.scales.box, decades = decades_to(largest);
  const size = (share, least, boxes) => max(min(max(share * lay.side, least), boxes * box), FINEST);
  const arrow = (share, boxes) => min(share * lay.side, boxes * box);
  const unit = (value, pixels) => {
    const per = value > 1e-9 ? pixels / value : pixels;
    return {per, legend: round_number(arrow(LEGEND_ARROW, LEGEND_ARROW_BOXES) / per)};
  };
  return {
    impulse: unit(impulse, arrow(COMMON_ARROW, COMMON_ARROW_BOXES)),
    velocity: unit(speed, arrow(FASTEST_ARROW, FASTEST_ARROW_BOXES)), longest: arrow(MAX_ARROW, MAX_ARROW_BOXES),
    dot: size(MARK_DOT, MIN_DOT, DOT_BOX), line: size(MARK_LINE, MIN_LINE, LINE_BOX), decades,
    exceeded: largest > 10 ** (decades + SCALE_FIRST_DECADE),
  };
}

/* Position of a distance on the colour scale, from 1 mm. */
const distance_share = metres => max(0, min(1, (log10(metres) - SCALE_FIRST_DECADE) / sizes.decades));

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
function draw_dots(radius, points, rim = max(1, radius / 3)) {
  draw_discs(radius, look.impulse, points);
  draw_discs(max(0, radius - rim), look.panel, points);
}

/* What a contact does, its tangent turned by `turn`: a ring is open (0), a square sticks (1), a bar along the surface slips (2);
   around what the reference's contact does not do, a circle. */
function draw_mode({x, y}, mode, wrong, radius, turn = 0) {
  const long = mode === 2 ? MODE_BAR : 1, [w, h] = [long * MODE_SIDE * radius, MODE_SIDE * radius / long];
  if (wrong) draw_dots(MODE_WRONG * radius, [{x, y}], max(1, radius / 3));
  if (mode === 0) return draw_dots(radius, [{x, y}]);
  pen.save();
  pen.translate(x, y);
  pen.rotate(turn);
  for (const [halo, colour] of [[MODE_HALO, look.panel], [0, mode === 2 ? look.slips : look.impulse]]) {
    pen.fillStyle = colour;
    pen.fillRect(-w - halo, -h - halo, 2 * (w + halo), 2 * (h + halo));
  }
  pen.restore();
}

/* The run whose modes others are compared with, if all are of its world; -1: none. */
function mode_base() {
  const compared = runs.length > 1 && others.length === runs.length - 1;
  return compared && shows("modes") ? runs.findIndex(({method}) => method.split(":")[0] === "reference") : -1;
}

/* By what contacts are known by; one that is not there is open. */
const contact_key = ({a, b, feature}) => [a, b, feature].join();
const modes_of = run => new Map((run < 0 ? [] : contacts_at(run, floor(now))).map(each => [contact_key(each), each.mode]));
const same_mode = (key, own, base) => (own.get(key) ?? 0) === (base.get(key) ?? 0);

function mode_count(run) {
  const own = modes_of(run), base = modes_of(mode_base()), all = [...new Set([...own.keys(), ...base.keys()])];
  return `${all.filter(key => same_mode(key, own, base)).length} of ${all.length} contacts as the reference`;
}

function draw_modes(run) {
  const own = modes_of(run), compared = mode_base(), base = modes_of(compared);
  for (const each of contacts_at(run, floor(now)))
    draw_mode(place(each), each.mode, compared >= 0 && !same_mode(contact_key(each), own, base), sizes.dot,
      Math.atan2(each.nx, each.ny));
}

/* Where a segment of a trail that begins at a frame ends: `at` tells where the body is. Fewer segments are faster to draw. */
function segment_end(at, first, last) {
  let end = first + TRAIL_EVERY;
  for (; end < last && end + TRAIL_EVERY <= first + SEGMENT_FRAMES; end += TRAIL_EVERY) {
    const a = at(first), b = at(end + TRAIL_EVERY), length = hypot(b.x - a.x, b.y - a.y);
    for (let frame = first + TRAIL_EVERY; frame < end + TRAIL_EVERY; frame += TRAIL_EVERY) {
      const p = at(frame), off = abs((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
      if (!((length > 0 ? off / length : hypot(a.x - p.x, a.y - p.y)) < TRAIL_TOLERANCE / eye.scale)) return end;
    }
  }
  return end;
}

/* Segments of equal age have one colour, so they are drawn at once. */
function draw_trails(run) {
  const {frames, bomb, bodies, fixed, x, y} = runs[run], here_now = min(now, frames - 1), last = floor(here_now), groups = {};
  const length = min(rint(TRAIL_DURATION / data.dt), TRAIL_FRAMES_MAX), oldest = max(0, last - length);
  for (let body = 0; body < bodies; body++) {
    if (fixed[body] || !exists(run, last, body)) continue;
    const end = pose(run, here_now, body), colour = body === bomb ? look.bomb.fill : run_colours(run).fill;
    const at = frame => frame >= last ? end : {x: x[frame * bodies + body], y: y[frame * bodies + body]};
    let first = oldest + oldest % TRAIL_EVERY, far = false;
    while (first < last && isNaN(at(first).x)) first += TRAIL_EVERY;
    for (let frame = first; frame < last && !far; frame += TRAIL_EVERY)
      far = hypot(at(frame).x - end.x, at(frame).y - end.y) > MIN_TRAIL;
    for (let frame = first, next; far && frame <= last; frame = next) {
      next = segment_end(at, frame, last);
      const age = min(1, (here_now - frame) / length);
      (groups[mix(look.panel, colour, 1 - (1 - OLDEST_OPACITY) * age)] ??= []).push([at(frame), at(next)].map(place));
    }
  }
  for (const shade in groups) draw_lines(sizes.line, shade, groups[shade]);
}

/* With an open head, two if it is cut; the halo separates it from what is below. */
function draw_arrow(from, to, cut, t, colour, halo) {
  const length = hypot(to.x - from.x, to.y - from.y), head = min(HEAD * t, max(MIN_HEAD * t, HEAD_SHARE * length)) / length;
  if (!(length >= MIN_LENGTH * t && length < MAX_COORDINATE)) return;
  const c = (to.x - from.x) * head, s = (to.y - from.y) * head, lines = [[from, to]];
  const side = (back, turn) => ({x: to.x - back * c - turn * s, y: to.y - back * s + turn * c});
  for (const back of cut ? [0, HEAD_SPACING] : [0])
    lines.push([side(back + HEAD_COSINE, HEAD_SINE), side(back, 0), side(back + HEAD_COSINE, -HEAD_SINE)]);
  const width = max(min(HALO, HALO_RISE * (t - NO_HALO)), t > 3 * HALO ? t / 3 : 0);
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
  const line = max(POINTER_LINE * lay.side, MIN_POINTER_LINE), inset = POINTER_INSET * line, inside = (at, low, side) =>
    min(max(at, low + inset), low + side - inset);
  const edge = {x: inside(at.x, left, width), y: inside(at.y, top, height)};
  const x = at.x - edge.x, y = at.y - edge.y, away = hypot(x, y), tail = max(POINTER * lay.side, MIN_POINTER) / away;
  if (!(away > eye.scale * min(...size[bomb]) / 2 + inset)) return;
  draw_arrow({x: edge.x - tail * x, y: edge.y - tail * y}, edge, false, line, look.bomb.fill, look.panel);
  runs[run].arrow = edge;
}

/* Before a prediction: where the bomb appears, as outline, and a dashed line to where it strikes. */
function draw_approach(run) {
  const {bomb, live, contacts} = runs[run], impact = live ? impact_of(runs[run]) : data.impact, last = known(runs[run]);
  const line = max(GHOST_OUTLINE * lay.side, MIN_GHOST_OUTLINE), way = [];
  let frame = 0;
  while (bomb >= 0 && frame <= last && !exists(run, frame, bomb)) frame++;
  if (bomb < 0 || frame > last) return;
  with_body(run, bomb, (w, h) => stroke_box(w, h, line, look.bomb.fill), frame);
  for (const end = impact >= 0 ? min(impact, last) : contacts ? last : frame; frame <= end; frame++)
    way.push(place(pose(run, frame, bomb)));
  pen.setLineDash([4 * line, 3 * line]);
  draw_lines(line, look.bomb.fill, [way]);
  pen.setLineDash([]);
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
  if (shows("modes")) draw_modes(run);
}
