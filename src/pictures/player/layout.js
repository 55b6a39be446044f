/* Where a picture has its panels and texts: src/pictures/picture.c, in CSS pixels. Where text would be
   smaller than 12 pixels, it and its rows keep that size; larger pictures have the layout of `render`. */
const {abs, ceil, cos, floor, hypot, log10, max, min, round, sin, trunc} = Math;

/* What is being laid out or drawn, and how: the context and its first transform, the theme, plan, camera, frame, sizes of marks
   and the panel. */
let pen, base, look, lay, eye, now, sizes, here;

const LEAST = 600;         /* pixels of a picture below which rows of text do not shrink with it */
const NUMBER_EMS = 1.7442; /* the width of "-50" in Inter: the margin must not depend on the browser's fonts */
const shows = what => view.show.has(what);
const ruler = document.createElement("canvas").getContext("2d");

/* Ties to even, as in C. */
const rint = value => round(value) - value === 0.5 ? 2 * round(value / 2) : round(value);

function text_width(font, text) {
  ruler.font = font.css;
  return ceil(ruler.measureText(text).width);
}

/* The largest that `render` has, at most so many pixels. */
function font_of(weight, most) {
  const em = data.font_sizes.findLast(size => size <= most);
  return {em, css: `${weight} ${em}px Inter, system-ui, sans-serif`};
}

/* The text, or its beginning and an ellipsis, in at most `room` pixels. */
function fitting(font, text, room) {
  let letters = [...text.slice(0, max(0, 5 * room / font.em))], cut = letters.join("");
  for (; letters.length > 0 && (text_width(font, cut) > room || cut === "\u2026"); letters.pop())
    cut = letters.join("").trimEnd() + "\u2026";
  return letters.length > 0 ? cut : "";
}

function measures(width, height, legend_rows, lines) {
  const unit = min(height, UNIT_WIDTH * width), of = share => rint(share * max(unit, LEAST));
  const font = (weight, share) => font_of(weight, max(share * unit, 12));
  const margin = rint(max(PAGE_MARGIN * unit, MIN_MARGIN)), header = margin + of(HEADER_RISE);
  const end = height - rint(PAGE_FOOT * unit);
  const title = font(600, TITLE_FONT), line = max(of(CAPTION_PITCH), rint(CAPTION_PITCH_EMS * title.em));
  const title_row = of(TITLE_ROW) + (lines - 1) * line, axis_row = of(AXIS_ROW), tick = of(AXIS_TICK), axis = font(400, AXIS_FONT);
  const pitch = of(LEGEND_PITCH), more = (legend_rows - 1) * pitch;
  return {
    width, height, margin, header, axis, tick, pitch, rise: of(TITLE_RISE), line, drop: of(AXIS_DROP),
    row_gap: title_row + axis_row,
    overlay: view.compare === "overlay", difference: view.compare === "difference",
    scene: font(600, SCENE_FONT), status: font(400, STATUS_FONT), title, method: font(400, METHOD_FONT),
    left: margin + ceil(NUMBER_EMS * axis.em) + 2 * tick, right: width - margin, top: header + of(HEADER_GAP) + title_row,
    bottom: end - axis_row - (legend_rows > 0 ? of(LEGEND_ROW) + more : 0), legend: end - of(LEGEND_DROP) - more,
  };
}

/* Panels of equal size in so many columns. */
function grid_of(count, columns) {
  const rows = ceil(count / columns);
  return {
    columns, rows, left: lay.left, top: lay.top,
    width: max(1, trunc((lay.right - lay.left - (columns - 1) * lay.margin) / columns)),
    height: max(1, trunc((lay.bottom - lay.top - (rows - 1) * lay.row_gap) / rows)),
  };
}

/* Between the scale in these panels and that at which what falls would stay in view. */
function scale_in({width, height}) {
  const {left, right, room_left, room_right, bottom, top} = data.framing, high = height / (top - bottom);
  return Math.sqrt(min(width / (right - left), high) * min(width / (room_right - room_left), high));
}

/* The grid in which the scene is largest; an unusual one only if the scene gains, more where names would be cut. Their widths
   are those of `render`'s font. */
function choose_grid(count) {
  const few = count > 3 ? 2 : 1, usual = grid_of(count, lay.height > lay.width ? few : ceil(count / few));
  const wide = max(...runs.map((_, run) => caption_width(run)));
  let best = usual, most = scale_in(usual);
  for (let columns = 1; columns <= count; columns++) {
    const grid = grid_of(count, columns), worth = scale_in(grid) / (grid.width >= wide ? GAIN : GAIN_WITH_CUT_NAMES);
    if (worth > most) [most, best] = [worth, grid];
  }
  return best;
}

/* Panels that a long or high scene would leave almost empty have its shape. The names of an overlay need all the width. */
function shrink(grid, needs) {
  const {left, top, columns, rows} = grid, {scale} = fit_camera(grid), {em} = lay.title;
  const side = (whole, needed, share, ems) =>
    needed >= share * whole ? whole : min(whole, ceil(max(needed / FULL_SHARE, ems * em)));
  const width = lay.overlay ? grid.width : side(grid.width, scale * needs.x, LEAST_SHARE_X, LEAST_PANEL_WIDTH);
  const height = side(grid.height, scale * needs.y, LEAST_SHARE_Y, LEAST_PANEL_HEIGHT);
  return {columns, rows, width, height, left: left + trunc(columns * (grid.width - width) / 2),
    top: top + trunc(rows * (grid.height - height) / 2)};
}

/* What a panel shows: the bodies of a run, and those of others as outlines. Runs that cannot be compared have their own. */
function arrange(width, height, legend_rows, lines = 1) {
  const {room_left, room_right, bottom, top} = data.framing;
  const needs = {x: Math.fround(room_right - room_left), y: Math.fround(top - bottom)};
  lay = measures(width, height, legend_rows, lines);
  const {overlay, difference} = lay, shown = runs.map((_, run) => run)
    .filter(run => overlay ? !others.includes(run) : run > 0 || !difference);
  const ghosts = difference || shows("ghosts") ? [0] : [];
  lay.pair = runs.length === 2 && others.length === 1 && shown.length === 2;
  const grid = lay.grid = shrink(choose_grid(shown.length), needs);
  lay.side = min(grid.width, grid.height);
  const {columns, rows} = grid, empty = rows * columns - shown.length, x_step = grid.width + lay.margin;
  /* A last row that is not full is in the middle. */
  const middle = i => i >= shown.length + empty - columns ? trunc(empty * x_step / 2) : 0;
  lay.panels = shown.map((run, i) => ({
    run, outlines: overlay ? (run === 0 ? others : []) : others.includes(run) ? ghosts : [], first: i % columns === 0,
    left: grid.left + middle(i) + i % columns * x_step, width: grid.width, height: grid.height,
    top: grid.top + trunc(i / columns) * (grid.height + lay.row_gap),
  }));
  lay.captions = lay_captions(grid.width);
  if (lay.captions.lines > lines) {
    arrange(width, height, legend_rows, lines + 1);
    return;
  }
  lay.fit = fit_camera(grid);
  sizes = mark_sizes(lay.fit.scale);
}

/* The plan of a picture of this size. It depends on what is compared and shown, not on the frame. The legend's entries depend
   on the room that its rows leave. */
function plan(width, height) {
  let needed = 0;
  for (let rows = 0; rows <= needed; rows++) {
    arrange(width, height, rows);
    needed = place_entries(false);
  }
  arrange(width, height, needed);
  return lay;
}
