/* The pointer on the picture: hover measures, click pins, drag moves, wheel and pinch zoom all panels. */
const CLICK = 4, SMALLEST = 1e-3, FARTHEST = data.farthest; /* pixels; m, as for render --camera */
const {stage} = ui, pressed = new Map();
let planned = null, hover = null, grip = null, travelled = 0;

const eye_now = () => camera(planned, view.frame);
/* Rounded up, it could lead to the next smaller scale, which is a whole number. */
const side = metres => six_digits(metres * (1 - 5e-6));

/* What a panel shows: as set, which is finer than the picture's whole pixels. */
function shown_view() {
  const {scale, left, top} = eye_now(), {width, height} = planned.panels[0], set = view.camera;
  const x = (width / 2 - left) / scale, y = (top - height / 2) / scale;
  if (set.kind === "fit") return {x, y, w: side(width / scale), h: side(height / scale)};
  return set.kind === "body" ? {...set, x, y} : set;
}

const is_view = ({x, y, w, h}) => max(abs(x), abs(y), w, h) < FARTHEST && min(w, h) >= SMALLEST;

/* Zooms by `factor` about a pixel, then moves what is shown by (dx, dy) pixels. */
function move_view(px, py, factor, dx, dy) {
  const now = eye_now(), from = shown_view(), kind = view.camera.kind === "body" && factor !== 1 ? "body" : "free";
  const {left, top, width, height} = planned.panels[to_world(planned, now, px, py)?.panel ?? 0];
  const [w, h] = [from.w, from.h].map(metres => factor === 1 ? metres : side(metres / factor));
  const {scale} = look_at(0, 0, w, h, {width, height}), away = 1 / now.scale - 1 / scale;
  const x = from.x + (px - left - width / 2) * away - dx / scale;
  const y = from.y - (py - top - height / 2) * away + dy / scale;
  if (is_view({x, y, w, h})) change({camera: {kind, x, y, w, h}});
}

/* For keys and buttons. */
function nudge(factor, right, up) {
  const {left, top, width, height} = planned.panels[0], part = 0.1 * min(width, height);
  move_view(left + width / 2, top + height / 2, factor, -right * part, up * part);
}

const fit_view = () => change({camera: FIT});

function toggle_follow() {
  if (view.body >= 0) change({camera: {...shown_view(), kind: view.camera.kind === "body" ? "free" : "body"}});
}

function pin(body, run = view.run) {
  if (body < 0 && view.camera.kind === "body") toggle_follow();
  change({body, run});
}

const under = () => hover && body_at(planned, eye_now(), view.frame, hover.x, hover.y);

/* Middle and spread of the fingers, or the place of the only pointer. */
function gather() {
  const [a, b = a] = pressed.values();
  return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, spread: hypot(a.x - b.x, a.y - b.y) || 1};
}

stage.onpointermove = event => {
  hover = {x: event.offsetX, y: event.offsetY};
  if (drag_bomb(event)) return;
  if (!pressed.has(event.pointerId)) return measure();
  pressed.set(event.pointerId, hover);
  const {x, y, spread} = grip;
  grip = gather();
  travelled += hypot(grip.x - x, grip.y - y) + abs(grip.spread - spread);
  if (travelled > CLICK) move_view(x, y, grip.spread / spread, grip.x - x, grip.y - y);
};
stage.onpointerdown = event => {
  if (event.button !== 0 || (pressed.size === 0 && grab_bomb(event))) return;
  stage.setPointerCapture(event.pointerId);
  if (pressed.size === 0) travelled = 0;
  hover = {x: event.offsetX, y: event.offsetY};
  pressed.set(event.pointerId, hover);
  grip = gather();
};
stage.onpointerup = stage.onpointercancel = event => {
  if (drop_bomb()) return;
  const world = asked && travelled <= CLICK && to_world(planned, eye_now(), event.offsetX, event.offsetY);
  if (world) answer(world.panel);
  const hit = event.type === "pointerup" && pressed.size === 1 && travelled <= CLICK && under();
  pressed.delete(event.pointerId);
  if (pressed.size > 0) grip = gather();
  if (hit) pin(hit.body === view.body && hit.run === view.run ? -1 : hit.body, hit.run);
};
stage.onpointerleave = () => { hover = null; measure(); };
stage.ondblclick = fit_view;
/* onwheel would be passive in some browsers. A page that shows this stage scrolls by the wheel alone. */
stage.addEventListener("wheel", event => {
  if (view.stage && parent !== window && !event.ctrlKey) return;
  event.preventDefault();
  move_view(event.offsetX, event.offsetY, 2 ** (-event.deltaY / (event.deltaMode ? 15 : 500)), 0, 0);
}, {passive: false});
