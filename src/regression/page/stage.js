/* The state of the page, and what the stage shows: pictures in their mode, the split, the marks. All scripts are one
   scope, in the order stage.js, list.js, page.js. */
const data = JSON.parse(document.getElementById("data").textContent);
const get = id => document.getElementById(id);
const MODES = ["expected", "actual", "difference", "swipe", "blink", "onion", "side"];
const KINDS = {expected: "e", actual: "a", difference: "d"};
const MOST_ROWS = 2000, BLINK = 600, GAP = 8, NUMBER = 24; /* pixels: between two pictures; for a number above a mark */
const reduced = matchMedia("(prefers-reduced-motion: reduce)");

let all = false, listed = [], at = -1, mode = "swipe", wanted = "swipe", zoom = "fit", blend = 50, order = data.film ? "name" : "severity";
let ring = true, running = !reduced.matches, second = false, timer = 0, turns = 0;

const frame = () => data.frames[listed[at]];
const stored = (index, kind) => get("p" + index + kind);
const usable = name => {
  const index = listed[at], has = kind => stored(index, kind) !== null;
  return KINDS[name] ? has(KINDS[name]) : has("e") && has("a");
};

function look(f) { return f.failed ? "bad" : f.verdict === "equal" && !f.metadata ? "good" : "odd"; }

function picture(kind) {
  const image = new Image();
  image.alt = {e: "expected", a: "actual", d: "difference"}[kind] + " picture of " + frame().name;
  image.draggable = false;
  image.decoding = "sync"; /* prevents an empty flash before a new picture */
  image.loaded = new Promise(done => { image.onload = image.onerror = done; });
  image.src = "data:image/png;base64," + stored(listed[at], kind).textContent;
  return image;
}

/* Text instead of pictures; "" for the pictures. */
function say(text) {
  get("nothing").textContent = text;
  get("nothing").hidden = text === "";
  get("sheet").hidden = text !== "";
}

async function show() {
  const sheet = get("sheet"), turn = ++turns, ready = usable(mode);
  const images = !ready ? [] : (KINDS[mode] ? [KINDS[mode]] : ["e", "a"]).map(picture);
  get("stage").setAttribute("aria-busy", "true");
  await Promise.all(images.map(image => image.loaded));
  if (turn !== turns) return; /* another picture was requested meanwhile */
  const split = document.createElement("div"), marks = document.createElement("div");
  split.id = "split";
  marks.id = "marks";
  sheet.replaceChildren(...(ready ? [...images, split, marks] : []));
  lay_out(true);
  get("stage").setAttribute("aria-busy", "false");
}

function scale_for(width, height, gap_x, gap_y) {
  if (zoom !== "fit") return Number(zoom);
  const stage = get("stage");
  const most = Math.min((stage.clientWidth - 2 - gap_x) / width, (stage.clientHeight - 2 - gap_y) / height);
  return most > 1 ? Math.floor(most) : most;
}

/* The scale, and where the second picture is. Side by side: beside or below the first one, whichever is larger. */
function arrange(width, height) {
  if (mode !== "side") return {scale: scale_for(width, height, 0, 0), right: 0, down: 0};
  const across = scale_for(2 * width, height, GAP, 0), below = scale_for(width, 2 * height, 0, GAP);
  return across >= below ? {scale: across, right: width * across + GAP, down: 0}
                         : {scale: below, right: 0, down: height * below + GAP};
}

/* Of the differences: regions, largest first, or all of them in one. */
function regions() {
  const {regions: found, box} = frame();
  return found && found.length > 0 ? found : box ? [{box}] : [];
}

/* Outlines a region in each picture that is beside another one. */
function mark({box}, i, width, height, {scale, right, down}) {
  /* A mark around most of the picture would be useless. */
  if (!ring || (box[2] - box[0]) * (box[3] - box[1]) > 0.5 * width * height) return;
  const margin = 6, places = right + down > 0 ? [[0, 0], [right, down]] : [[0, 0]];
  for (const [x, y] of places) {
    const outline = document.createElement("div");
    outline.className = box[1] * scale < NUMBER ? "ring low" : "ring";
    if (regions().length > 1) outline.dataset.number = i + 1;
    outline.style.left = box[0] * scale - margin + x + "px";
    outline.style.top = box[1] * scale - margin + y + "px";
    outline.style.width = (box[2] - box[0]) * scale + 2 * margin + "px";
    outline.style.height = (box[3] - box[1]) * scale + 2 * margin + "px";
    get("marks").append(outline);
  }
}

/* What the marks are, by number. */
function list_regions() {
  const known = frame().regions || [], more = (frame().region_count || 0) - known.length;
  get("regions").replaceChildren(...known.map(region => {
    const item = document.createElement("li"), [left, top, right, bottom] = region.box;
    const where = `${right - left} x ${bottom - top} pixels at (${left}, ${top}), ${region.pixels} of them differ by at most ${region.largest}`;
    item.textContent = region.name ? `${region.name}: ${where}` : where;
    return item;
  }));
  get("more-regions").textContent = more > 0 ? `and ${more} more` : "";
  get("regions-part").hidden = known.length === 0;
}

function lay_out_image(image, scale, x, y) {
  image.style.left = x + "px";
  image.style.top = y + "px";
  image.style.width = image.naturalWidth * scale + "px";
  image.style.height = image.naturalHeight * scale + "px";
  image.style.clipPath = "none";
  image.style.opacity = 1;
}

/* Sets sizes and styles of the elements on the stage; centre: scrolls to the difference. */
function lay_out(centre) {
  const sheet = get("sheet"), stage = get("stage"), images = [...sheet.querySelectorAll("img")];
  if (images.length === 0) return;
  const width = Math.max(...images.map(i => i.naturalWidth)), height = Math.max(...images.map(i => i.naturalHeight));
  const place = arrange(width, height), scale = place.scale, found = regions();
  sheet.style.width = width * scale + place.right + "px";
  sheet.style.height = height * scale + place.down + "px";
  sheet.classList.toggle("smooth", scale < 1);
  images.forEach((image, i) => lay_out_image(image, scale, i * place.right, i * place.down));
  const [bottom, top] = images;
  if (mode === "swipe") {
    top.style.clipPath = `inset(0 0 0 ${top.naturalWidth ? blend * width / top.naturalWidth : 0}%)`;
    bottom.style.clipPath = `inset(0 ${Math.max(0, 100 - blend * width / bottom.naturalWidth)}% 0 0)`;
  }
  if (mode === "onion") top.style.opacity = blend / 100;
  if (mode === "blink") (second ? bottom : top).style.opacity = 0;
  get("split").hidden = mode !== "swipe";
  get("split").style.left = blend + "%";
  get("side-row").textContent = place.down > 0 ? "Above: expected. Below: actual." : "Left: expected. Right: actual.";
  get("marks").replaceChildren();
  found.forEach((region, i) => mark(region, i, width, height, place));
  if (centre && found.length > 0) {
    const box = found[0].box;
    stage.scrollLeft = (box[0] + box[2]) / 2 * scale - stage.clientWidth / 2;
    stage.scrollTop = (box[1] + box[3]) / 2 * scale - stage.clientHeight / 2;
  }
}
