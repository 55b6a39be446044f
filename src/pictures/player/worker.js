/* What runs in the worker of a live panel: the page sends the source of this function, so nothing else of the page is there.
   It has its own instance of the module (src/live/live.h) and steps one launch after the other. */
function panel_worker() {
  const SLICE = 10, FIRST = 16, SHARE = 60; /* ms: between looks for a newer launch; to the first part of a run that is sent, and
    between the others */
  let live = null, scene = 0, wanted = null, busy = true; /* until it is open */
  const memory = () => live.memory.buffer;
  const copy = (type, at, from, count) => new type(memory(), at, from + count).slice(from);
  const text = at => {
    const bytes = new Uint8Array(memory());
    return new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
  };

  const NAME = 32; /* bytes */
  const names_of = (at, count) => at === 0 ? null : Array.from({length: count}, (_, body) => text(at + NAME * body));

  function put(bytes) {
    const at = live.live_reserve(bytes.length);
    if (at === 0) throw new Error("out of memory");
    new Uint8Array(memory(), at, bytes.length).set(bytes);
    return at;
  }

  /* Calls a function with texts among its arguments; throws the module's error where the result is 0. */
  function must(name, ...values) {
    const given = values.map(value => typeof value === "string" ? put(new TextEncoder().encode(value + "\0")) : value);
    const result = live[name](...given);
    given.forEach((at, i) => typeof values[i] === "string" && live.live_release(at));
    if (result === 0) throw new Error(text(live.live_error()));
    return result;
  }
  const json = (...call) => JSON.parse(text(must(...call)));

  async function open({module, bundle}) {
    live = (await WebAssembly.instantiate(module)).exports;
    live._initialize();
    scene = must("live_open", put(bundle), bundle.length);
    postMessage({methods: json("live_methods"), scene: json("live_describe", scene, "")});
  }

  /* Frames first ... last of a run, and what is known of the whole when it has ended. */
  function send(run, {id, contacts}, about, first, last, ended) {
    const bodies = live.live_bodies(run), at = first * bodies, count = (last - first + 1) * bodies;
    const part = {
      id, first, last, bodies, scene: about, recorded: contacts === 1, frames: live.live_frames(run), bomb: live.live_bomb(run), ended,
      sizes: copy(Float32Array, live.live_sizes(run), 0, 2 * bodies), fixed: copy(Uint8Array, live.live_fixed(run), 0, bodies),
      named: names_of(live.live_names(run), bodies),
      masses: copy(Float32Array, live.live_masses(run), 0, bodies),
      positions: copy(Float32Array, live.live_positions(run), 2 * at, 2 * count),
      angles: copy(Float32Array, live.live_angles(run), at, count),
      velocities: copy(Float32Array, live.live_velocities(run), 2 * at, 2 * count),
      spins: copy(Float32Array, live.live_spins(run), at, count),
      starts: Int32Array.from({length: last - first + 2}, (_, k) => live.live_contact_start(run, first + k)),
      failure: text(live.live_failure(run)),
    };
    const words = 9, from = part.starts[0];
    part.contacts = copy(Int32Array, live.live_contacts(run), words * from, words * (part.starts.at(-1) - from));
    part.modes = Uint8Array.from({length: part.starts.at(-1) - from}, (_, i) => live.live_contact_mode(run, from + i));
    if (ended || first === 0) part.framing = json("live_framing", run);
    if (ended) {
      const verdict = live.live_verdict(run);
      part.hash = BigInt.asUintN(64, live.live_hash(run, last)).toString(16).padStart(16, "0");
      part.verdict = verdict === 0 ? null : JSON.parse(text(verdict));
    }
    postMessage(part, Object.values(part).filter(value => value?.buffer).map(value => value.buffer));
  }

  const pause = () => new Promise(done => {
    const channel = new MessageChannel();
    channel.port1.onmessage = done;
    channel.port2.postMessage(0);
  });

  /* A newer launch has to wait until this one has been shown at the page's time, or a drag would never show anything. */
  async function simulate(launch) {
    const {set, method, until, contacts} = launch, run = must("live_begin", scene, set, method, contacts);
    try {
      const end = live.live_frames(run) - 1, {parameters, dt, steps, iterations, scene_hash} = json("live_describe", scene, set);
      const values = Object.fromEntries(parameters.map(({name, value}) => [name, value]));
      for (let next = 0, frame = 0, sent = performance.now();;) {
        for (const since = performance.now(); frame < end && performance.now() - since < SLICE;) {
          const before = frame;
          frame = live.live_step(run, 1);
          if (frame === before) break;
        }
        const ended = frame === end || text(live.live_failure(run)) !== "";
        if (ended || (frame >= until && performance.now() - sent > (next === 0 ? FIRST : SHARE))) {
          send(run, launch, {values, dt, steps, iterations, scene_hash}, next, frame, ended);
          [next, sent] = [frame + 1, performance.now()];
        }
        if (ended || (wanted && next > until)) return;
        await pause();
      }
    } finally { live.live_end(run); }
  }

  async function work() {
    busy = true;
    while (wanted) {
      const launch = wanted;
      wanted = null;
      try { await simulate(launch); } catch (error) { postMessage({id: launch.id, error: error.message}); }
    }
    busy = false;
  }

  onmessage = ({data}) => {
    if (data.module) return open(data).then(work, error => postMessage({error: error.message}));
    wanted = data;
    if (!busy) work();
  };
}
