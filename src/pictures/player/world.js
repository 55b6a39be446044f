/* Where bodies are. A run is named by its index; a frame may lie between two stored ones, and beyond the end of a run it is
   the last. */
const own_frame = ({pace}, frame) => frame * (pace ?? 1); /* of a recorded run beside live ones of other steps (live.js) */
const frames_of = run => ceil((run.frames - 1) / (run.pace ?? 1)) + 1;
const stored_frame = (run, frame) => Math.min(Math.floor(own_frame(runs[run], frame)), runs[run].frames - 1);
const place_of = (run, frame, body) => stored_frame(run, frame) * runs[run].bodies + body;

const exists = (run, frame, body) =>
  body >= 0 && body < runs[run].bodies && !Number.isNaN(runs[run].x[place_of(run, frame, body)]);

/* Linear, as the engine moves bodies; angles do not wrap. A body that disappears keeps its last pose. */
function pose(run, frame, body) {
  const {x, y, angle, bodies, frames} = runs[run], at = place_of(run, frame, body), next = at + bodies;
  const own = own_frame(runs[run], frame), part = own < frames - 1 ? own - Math.floor(own) : 0;
  if (part === 0 || Number.isNaN(x[next])) return {x: x[at], y: y[at], angle: angle[at]};
  return {x: x[at] + part * (x[next] - x[at]), y: y[at] + part * (y[next] - y[at]),
    angle: angle[at] + part * (angle[next] - angle[at])};
}

function velocity(run, frame, body) {
  const {vx, vy, omega} = runs[run], at = place_of(run, frame, body);
  return {x: vx[at], y: vy[at], spin: omega[at]};
}

/* m between the same body of two runs; NaN if their worlds differ, or one has ended or does not have it. */
function distance_between(a, b, frame, body) {
  if (!runs[a].compared || !runs[b].compared || frame > runs[a].frames - 1 || frame > runs[b].frames - 1 ||
      !exists(a, frame, body) || !exists(b, frame, body)) return NaN;
  const one = pose(a, frame, body), other = pose(b, frame, body);
  return Math.hypot(one.x - other.x, one.y - other.y);
}

const distance = (run, frame, body) => distance_between(0, run, frame, body);

/* The largest distance of a body from the first run: as stored in the page, or between two frames as drawn. */
function largest(run, frame) {
  if (run === 0 || !runs[run].compared || frame > Math.min(runs[0].frames, runs[run].frames) - 1) return NaN;
  if (Number.isInteger(frame)) return runs[run].distances[frame];
  let most = NaN;
  for (let body = 0; body < runs[run].bodies; body++) {
    const metres = distance(run, frame, body);
    if (!(metres <= most)) most = Number.isNaN(metres) ? most : metres;
  }
  return most;
}
