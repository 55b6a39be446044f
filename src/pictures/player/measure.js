/* Measured values of the body that is pinned or under the pointer. */

/* "0.36 m", "12 mm", "3.2 \u00b5m" */
function metric(value, unit) {
  const [factor, prefix] = value >= 1 || value === 0 ? [1, ""] : value >= 1e-3 ? [1e3, "m"] : [1e6, "\u00b5"];
  return value >= 0 ? `${Number((value * factor).toPrecision(3))} ${prefix}${unit}` : "\u2013";
}

const swatch = run => make("span", {title: runs[run].name}, shape(SQUARE, run), " " + names[run]);

/* Four decimals; 0 has no sign. */
const decimal = value => value.toFixed(4).replace(/^-(?=[0.]+$)/, "");
const row = (kind, head, ...cells) =>
  make("tr", make("th", head), cells.map(cell => make(kind, cell.toFixed ? decimal(cell) : cell)));
const table = (heads, rows) =>
  rows.length > 0 ? make("table", make("thead", row("th", ...heads)), make("tbody", rows)) : "";

/* For each body that it touches the sum over their contact points, which the page has rounded to 2%. */
function contact_rows(run, body) {
  const sums = {}, {contacts, lists} = runs[run];
  if (contacts && !runs[run].live && !(list_place(runs[run], view.frame) in lists))
    load_lists(runs[run], chunks_of(runs[run], view.frame)[0]).then(measure);
  for (const {a, b, normal, tangent} of contacts_at(run, view.frame)) {
    if (a !== body && b !== body) continue;
    const sum = sums[a + b - body] ??= [0, 0];
    sum[0] += normal;
    sum[1] += tangent;
  }
  return Object.keys(sums).map(other => row("td", "body " + other, ...sums[other].map(sum => sum.toPrecision(3))));
}

/* Against the same body in the other runs of this world. */
function error_rows(run, body) {
  const v = velocity(run, view.frame, body);
  return [0, ...others].filter(other => other !== run && runs[run].compared).map(other => {
    const u = velocity(other, view.frame, body), metres = distance_between(run, other, view.frame, body);
    const known = metres >= 0 && runs[run].velocities && runs[other].velocities;
    return row("td", swatch(other), metric(metres, "m"), metric(known ? hypot(u.x - v.x, u.y - v.y) : NaN, "m/s"));
  });
}

function body_tables({run, body}) {
  const {size, fixed, bomb, velocities} = runs[run], v = velocity(run, view.frame, body);
  const {x, y, angle} = pose(run, view.frame, body), kind = body === bomb ? "bomb" : fixed[body] ? "static" : "box";
  const rows = [row("td", "position, m", x, y), row("td", "angle, rad, \u00b0", angle, angle * 180 / Math.PI)];
  if (velocities) rows.push(row("td", "velocity, m/s", v.x, v.y), row("td", "spin, rad/s", v.spin));
  return [table([`${kind}, ${size[body].map(six_digits).join(" x ")} m`, "x", "y"], rows),
    table(["next impulses, N s", "normal", "tangent"], contact_rows(run, body)),
    table(["away from it", "position", "velocity"], error_rows(run, body))];
}

function show_body() {
  const pinned = view.body >= 0, hit = pinned ? view : under(), name = hit && runs[hit.run].named?.[hit.body];
  tell(ui.named, hit ? `Body ${hit.body}${name ? `, ${name},` : ""} in ${names[hit.run]}${pinned ? ", pinned" : ""}` : "Body");
  ui.unpin.disabled = ui.follow.disabled = !pinned;
  ui.follow.checked = view.camera.kind === "body";
  ui.values.replaceChildren(...!hit ? ["Point at a body to measure it."]
    : exists(hit.run, view.frame, hit.body) ? body_tables(hit) : ["It is not there at this time."]);
}
