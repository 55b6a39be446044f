/* From metres to pixels, the same for all panels: src/pictures/camera.c. A point (x, y) is at pixel (left + scale x,
   top - scale y) of a panel. */

/* Whole pixels a metre keep grid lines crisp. */
function look_at(x, y, w, h, {width, height}) {
  const most = min(width / w, height / h), parts = most >= WHOLE_SCALE ? 1 : SCALE_PARTS;
  const scale = most >= 1 ? floor(most * parts) / parts : most;
  return {scale, left: rint(width / 2 - scale * x), top: rint(height / 2 + scale * y)};
}

/* Spare width goes to both sides of what stands, then to where it falls; spare height above: sky distracts less than
   ground. */
function fit_camera(grid) {
  const {set, left, right, bottom, top, action_left, action_right, room_left, room_right, middle} = data.framing;
  const h = top - bottom, largest = min(grid.width / (right - left), grid.height / h);
  const w = max(right - left, min(action_right - action_left, grid.width / (LEAST_SCALE * largest)));
  const centred = look_at((left + right) / 2, bottom + h / 2, w, h, grid), {scale} = centred;
  const half = grid.width / scale / 2, reach = max(half, (room_right - room_left) / 2);
  const falls = min(max(middle, room_right - reach), room_left + reach), x = min(max(falls, right - half), left + half);
  const whole = grid.height / scale, below = min((whole - h) / 2, data.ground * whole);
  return set ? centred : look_at(x, bottom - below + whole / 2, w, h, grid);
}

/* At a body that does not exist, or is too far, the fixed one. */
function camera({grid, fit}, frame) {
  const {kind, x, y, w, h} = view.camera, run = runs.findIndex((_, each) => exists(each, frame, view.body));
  const at = kind === "free" ? {x, y} : kind === "body" && view.body >= 0 && run >= 0 && pose(run, frame, view.body);
  return hypot(at.x, at.y) < FARTHEST ? look_at(at.x, at.y, w, h, grid) : fit;
}

function to_pixel(plan, camera, panel, x, y) {
  const {left, top} = plan.panels[panel];
  return {x: left + camera.left + camera.scale * x, y: top + camera.top - camera.scale * y};
}

const is_inside = ({left, top, width, height}, {x, y}) =>
  x >= left && x < left + width && y >= top && y < top + height;

function to_world(plan, camera, px, py) {
  const panel = plan.panels.findIndex(each => is_inside(each, {x: px, y: py}));
  if (panel < 0) return null;
  const origin = to_pixel(plan, camera, panel, 0, 0);
  return {panel, x: (px - origin.x) / camera.scale, y: (origin.y - py) / camera.scale};
}
