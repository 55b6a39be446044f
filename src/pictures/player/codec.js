/* The states and contacts of the runs, as src/pictures/player_pack.c describes them. All scripts are one scope, in the order
   of src/CMakeLists.txt. */
const COMPONENTS = ["vx", "vy", "omega", "x", "y", "angle"], POSES = 3;
const CONTACT_KEYS = 3, CONTACT_VALUES = 7, SEARCH = 16, SHARE = 64;
const stored_dt = data.dt; /* that of live runs may change */
const HASH_START = [0x14650FB0, 0x739D0383]; /* FNV-1a 64: high and low half; the prime is 2^40 + 0x1B3 */

/* The arrays of a run: components by name and their bits. */
function make_states(run, frames, bodies) {
  const bits = {};
  for (const name of COMPONENTS) {
    run[name] = new Float32Array(frames * bodies);
    bits[name] = new Uint32Array(run[name].buffer); /* a float that is copied as a number may lose the bits of a NaN */
  }
  run.x.fill(NaN); /* a body that is not decoded yet is not there */
  return Object.assign(run, {bits, frames, bodies, lists: [], modes: [], loads: [], list_loads: [], done: []});
}

const pairs = numbers => Array.from({length: numbers.length / 2}, (_, i) => [numbers[2 * i], numbers[2 * i + 1]]);

/* Names of 32 bytes with zeros behind them; empty: the body has none. */
const names_in = bytes => Array.from({length: bytes.length / 32}, (_, body) =>
  new TextDecoder().decode(bytes.subarray(32 * body, 32 * body + 32)).split("\0")[0]);

/* A live run (live.js) has a method, and its states are computed. `stored`: the run's number in the page's elements, whatever its
   panel; checked, wrong: of its frames. */
const runs = data.runs.map((run, index) => Object.assign(make_states(run, run.frames, run.bodies), {
  index, stored: index, checked: 0, wrong: 0, size: pairs(new Float32Array(packed("size" + index).buffer)),
  fixed: Array.from(packed("fixed" + index), Boolean), reached: -1,
  named: run.names && names_in(packed("name" + index)),
  mass: run.masses && new Float32Array(packed("mass" + index).buffer),
  distances: run.live ? new Float32Array(run.frames) : new Float32Array(packed("distances" + index).buffer),
  hashes: run.live ? null : new DataView(packed("hashes" + index).buffer),
}));

/* The first frame of live runs, so that the first picture waits for no worker. */
for (const run of runs.filter(each => each.live)) {
  pairs(new Float32Array(packed("places").buffer)).forEach(([x, y], body) => { [run.x[body], run.y[body]] = [x, y]; });
  run.angle.set(new Float32Array(packed("angles").buffer));
  run.reached = 0;
}

/* Number i of a column of `count` numbers in four planes of bytes; the same as a difference. */
const number_at = (bytes, begin, count, i) => {
  const at = begin + i;
  return bytes[at] | bytes[at + count] << 8 | bytes[at + 2 * count] << 16 | bytes[at + 3 * count] << 24;
};
const difference_at = (bytes, begin, count, i) => {
  const number = number_at(bytes, begin, count, i);
  return number >>> 1 ^ -(number & 1);
};

const as_float = new Float32Array(1), as_bits = new Uint32Array(as_float.buffer);

/* Each body of one component; floats round as in the engine. */
function decode_component(run, bytes, which, begin, length) {
  const {bodies} = run, count = bodies * length, bits = run.bits[COMPONENTS[which]], values = run[COMPONENTS[which]];
  const speeds = run[COMPONENTS[which - POSES]];
  for (let body = 0; body < bodies; body++)
    for (let k = 0, at = begin * bodies + body; k < length; k++, at += bodies) {
      let predicted = k > 0 ? bits[at - bodies] : 0;
      if (k > 0 && speeds) {
        as_float[0] = values[at - bodies] + Math.fround(stored_dt * speeds[at]);
        if (!Number.isNaN(as_float[0])) predicted = as_bits[0];
      }
      bits[at] = predicted + difference_at(bytes, 4 * which * count, count, body * length + k);
    }
}

/* A normal impulse from its rounded logarithm: the upper bits of the float 1 + |impulse| / unit. */
function impulse_of(steps) {
  as_bits[0] = Math.abs(steps) + (127 << 5) << 18;
  return Math.sign(steps) * (as_float[0] - 1) * data.units.impulse;
}

/* The same contact in the frame before, among the next ones there: its place; -1: none. */
function find_before(before, from, row) {
  for (let i = from; i < before.length && i < from + SEARCH; i++)
    if (before[i][0] === row[0] && before[i][1] === row[1] && before[i][2] === row[2]) return i;
  return -1;
}

function decode_contacts(run, bytes, begin, length) {
  const total = (bytes.length / 4 - length) / (CONTACT_KEYS + CONTACT_VALUES), column = i => 4 * (length + i * total);
  let before = [], at = 0;
  for (let k = 0; k < length; k++) {
    const rows = [], count = number_at(bytes, 0, length, k), center = (begin + k) * run.bodies;
    let from = 0;
    for (let i = 0; i < count; i++, at++) {
      const row = [];
      for (let key = 0; key < CONTACT_KEYS; key++) row.push(number_at(bytes, column(key), total, at));
      const same = find_before(before, from, row);
      for (let value = 0; value < CONTACT_VALUES; value++) {
        const old = same >= 0 ? before[same][CONTACT_KEYS + value] : 0;
        row.push(old + difference_at(bytes, column(CONTACT_KEYS + value), total, at) | 0);
      }
      if (same >= 0) from = same + 1;
      rows.push(row);
    }
    run.lists[begin + k] = rows.map(row => contact_of(run, row, center));
    before = rows;
  }
}

function contact_of(run, [a, b, feature, x, y, nx, ny, steps, share, mode], center) {
  const normal = impulse_of(steps), tangent = share / SHARE * (Math.abs(normal) + data.units.impulse);
  const unit = data.units.length, cx = run.x[center + b], cy = run.y[center + b], length = Math.hypot(nx, ny) || 1;
  return {a, b, feature, mode, x: x * unit + (Number.isFinite(cx) ? cx : 0), y: y * unit + (Number.isFinite(cy) ? cy : 0),
    nx: nx / length, ny: ny / length, normal, tangent};
}

/* Calls decode(run, bytes, first frame, number of frames) for a chunk, once. */
const load_once = (kind, loads, decode) => (run, chunk) => run[loads][chunk] ??= inflated(`${kind}${run.stored}-${chunk}`)
  .then(bytes => decode(run, bytes, chunk * data.chunk, Math.min(data.chunk, run.frames - chunk * data.chunk)));
const load_states = load_once("s", "loads", (run, bytes, begin, length) => {
  COMPONENTS.forEach((_, which) => decode_component(run, bytes, which, begin, length));
  run.done[begin / data.chunk] = true;
});
const load_lists = load_once("c", "list_loads", decode_contacts);

/* The chunks with a stored frame of a run and the next, between which poses are interpolated. */
function chunks_of(run, frame) {
  const own = own_frame(run, frame), of = at => Math.floor(Math.min(Math.max(Math.floor(at), 0), run.frames - 1) / data.chunk);
  return [of(own), of(own + 1)];
}

/* Contacts are several times as large as states: those of all runs are decoded where they are drawn or measured only. */
const draws_contacts = () => [...view.show].some(name => data.shows[name].includes("contacts"));
const lists_wanted = run => run.contacts && !run.live && (view.body >= 0 || draws_contacts());
const list_place = (run, frame) => Math.min(Math.floor(own_frame(run, frame)), run.frames - 1);

/* Whether a run has what is shown of a frame; one that has failed shows what it has. */
const has = (run, frame) => run.live ? has_failed(run) || run.reached >= min(ceil(frame), run.frames - 1)
  : chunks_of(run, frame).every(chunk => run.done[chunk]) &&
    (!lists_wanted(run) || list_place(run, frame) in run.lists);
const ready = frame => runs.every(run => has(run, frame));

/* Contacts lie relative to bodies: after the states. */
const load = frame => Promise.all(runs.filter(run => !has(run, frame)).map(async run => {
  if (run.live) return arrival();
  const chunks = chunks_of(run, frame);
  await Promise.all(chunks.map(chunk => load_states(run, chunk)));
  if (lists_wanted(run)) await load_lists(run, chunks[0]);
}));

/* FNV-1a 64 over the bytes of the dynamic bodies that exist, in two halves of 32 bits. */
function hash_of(run, frame) {
  const words = ["x", "y", "angle", "vx", "vy", "omega"].map(name => run.bits[name]);
  let [high, low] = HASH_START;
  for (let body = 0, at = frame * run.bodies; body < run.bodies; body++, at++) {
    if (run.fixed[body] || Number.isNaN(run.x[at])) continue;
    for (const word of words)
      for (let shift = 0; shift < 32; shift += 8) {
        low = (low ^ (word[at] >>> shift & 255)) >>> 0;
        /* times 0x1B3, and low shifted by 40 bits into high */
        const product = low * 0x1B3, carry = Math.floor(product / 4294967296);
        high = Math.imul(high, 0x1B3) + carry + (low << 8) >>> 0;
        low = product >>> 0;
      }
  }
  return high.toString(16).padStart(8, "0") + low.toString(16).padStart(8, "0");
}

const stored_hash = (run, frame) => run.hashes.getBigUint64(8 * frame, true).toString(16).padStart(16, "0");

/* The check of all states against the hashes of the runs' files, a slice of time after the other. */
const SLICE = 8; /* ms of script at once */
const on_checked = [];
const recorded = runs.filter(run => !run.live); /* also those whose panel was removed */
function checked() {
  const sum = key => recorded.reduce((sum, run) => sum + run[key], 0);
  return {frames: sum("checked"), of: sum("frames"), wrong: sum("wrong")};
}

async function check_all() {
  for (const run of recorded)
    for (let chunk = 0; chunk < run.chunks; chunk++) {
      await load_states(run, chunk);
      for (let since = performance.now(); run.checked < Math.min((chunk + 1) * data.chunk, run.frames); run.checked++) {
        if (hash_of(run, run.checked) !== stored_hash(run, run.checked)) run.wrong++;
        if (performance.now() - since < SLICE) continue;
        await new Promise(done => setTimeout(done));
        since = performance.now();
      }
      on_checked.forEach(call => call());
    }
}

/* Of the step that follows from the poses of a frame; of the last frame, of its own step. */
const contacts_at = (index, frame) => runs[index].live ? live_contacts(runs[index], list_place(runs[index], frame))
  : runs[index].lists[list_place(runs[index], frame)] ?? [];
