/* The picture of a moment: src/pictures/picture.c and panel.c. */

/* A rectangle at whole device pixels: crisp and never invisible. */
function bar(x, y, width, height, colour) {
  const snap = value => round(value * base.a) / base.a, size = value => max(snap(value), 1 / base.a);
  pen.fillStyle = colour;
  pen.fillRect(snap(x), snap(y), size(width), size(height));
}

/* A recorded run of another launch: grey, and what it shows. */
function draw_elsewhere({why, elsewhere}) {
  const {left, top, width, height} = here, {title, method} = lay, gap = title.em >> 1;
  pen.globalCompositeOperation = "saturation";
  bar(left, top, width, height, "#808080");
  pen.globalCompositeOperation = "source-over";
  bar(left, top, width, height, `color-mix(in srgb, ${look.panel} 60%, transparent)`);
  const texts = [why ? "Another scene" : "Another launch", ...elsewhere.split(", ")];
  texts.forEach((text, line) => {
    const font = line === 0 ? title : method, baseline = top + gap + title.em + line * lay.line;
    const short = fitting(font, text, width - 2 * gap);
    bar(left + gap - 2, baseline - title.em, text_width(font, short) + 4, lay.line, look.panel);
    write(font, short, left + gap, baseline, look.ink);
  });
}

function draw_panel(columns, rows) {
  const {run, outlines, left, top, width, height} = here, all = lay.overlay ? [run, ...outlines] : [run];
  pen.save();
  pen.beginPath();
  pen.rect(left, top, width, height);
  pen.clip();
  bar(left, top, width, height, look.panel);
  draw_grid(columns, rows);
  draw_bodies(true);
  if (shows("trails")) all.forEach(draw_trails);
  draw_bodies(false);
  outlines.forEach(draw_outlines);
  draw_pointer(run);
  if (asked) draw_approach(run);
  all.forEach(draw_marks);
  draw_labels();
  draw_pinned();
  if (runs[run].elsewhere) draw_elsewhere(runs[run]);
  pen.restore();
  draw_axes(columns, here.first ? rows : []);
  all.forEach(draw_caption);
}

/* Draws a moment. The context's transform scales CSS pixels. */
function draw_picture(context, plan, frame) {
  [pen, base, look, lay, eye, now] = [context, context.getTransform(), theme(), plan, camera(plan, frame), frame];
  sizes = mark_sizes(eye.scale);
  pen.lineCap = pen.lineJoin = "round";
  bar(0, 0, lay.width, lay.height, look.page);
  draw_header();
  const {grid, axis, panels} = lay, columns = grid_lines(eye.left, grid.width, 1);
  const rows = grid_lines(eye.top, grid.height, -1, axis.em);
  for (here of panels) draw_panel(columns, rows);
  place_entries(true);
}
