/* Keys, and the buttons that do the same. */
const next_of = (list, now) => list[(list.indexOf(now) + 1) % list.length];
const sign = (key, more, less) => (key === more) - (key === less);

/* Keys as in events, words of the help, what they do, button. */
const ACTIONS = [
  ["Space", "play, pause", toggle_play, "play"],
  ["ArrowLeft ArrowRight", "one frame; with Shift, ten",
    (key, event) => step(sign(key, "ArrowRight", "ArrowLeft") * (event.shiftKey ? 10 : 1))],
  ["Home End", "first, last frame", key => seek(key === "Home" ? 0 : last)],
  ["1 2 3 4 5 6 7 8 9", "moment of this number",
    key => asked ? answer(key - 1) : moments[key - 1] && seek(moments[key - 1].frame)],
  ["[ ]", "slower, faster",
    key => change({speed: SPEEDS[SPEEDS.indexOf(view.speed) + sign(key, "]", "[")] ?? view.speed})],
  ["m", "slow motion at impact", () => change({slow: !view.slow}), "slow"],
  ["c", "split, overlay, difference", () => change({compare: next_of(COMPARES, view.compare)})],
  ["n p", "pin the next, previous body",
    key => pin((max(view.body + sign(key, "n", "p"), key === "n" ? 0 : -1) + most_bodies) % most_bodies)],
  ["r", "measure in the next run", () => change({run: (view.run + 1) % runs.length})],
  ["Escape", "unpin", () => pin(-1), "unpin"],
  ["b", "follow the pinned body", toggle_follow, "follow"],
  ["w a s d", "move the view", key => nudge(1, sign(key, "d", "a"), sign(key, "w", "s"))],
  ["+ -", "zoom in, out", key => nudge(key === "+" ? 1.25 : 0.8, 0, 0)],
  ["f", "fit the view", fit_view, "fit"],
  ["t", "colours: auto, light, dark", () => change({theme: next_of(THEMES, view.theme)}), "theme"],
  ["h", "the stage and the time line alone, or all", () => change({stage: !view.stage}), "bare"],
  ["?", "this list", () => ui.help.showModal(), "keys"],
];
if (data.live)
  ACTIONS.splice(-1, 0,
    ["j l", "launch the bomb from 0.1 m further left, right; with Shift, 1 m",
      (key, event) => nudge_bomb("bomb_x", sign(key, "l", "j") * (event.shiftKey ? 1 : 0.1))],
    ["i k", "from 0.1 m higher, lower", (key, event) => nudge_bomb("bomb_y", sign(key, "i", "k") * (event.shiftKey ? 1 : 0.1))],
    ["o u", "faster, slower by 0.5 m/s", key => nudge_bomb("bomb_speed", sign(key, "o", "u") * 0.5)]);
ui["live-help"].hidden = !data.live;
const LABELS = {ArrowLeft: "\u2190", ArrowRight: "\u2192", Escape: "Esc"};

/* In the scrubber, whose own steps would be a hundredth of the run. */
const SCRUBBER = {ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10};

for (const [keys, words, act, id] of ACTIONS) {
  ui.list.append(make("dt", keys.split(" ").map(key => make("kbd", LABELS[key] ?? key))), make("dd", words));
  if (id) ui[id].onclick = () => act();
}

onkeydown = event => {
  const {target} = event, own = selector => target.closest(selector);
  const locked = /^[A-Z]$/.test(event.key) && (!event.shiftKey || /[JLIK]/.test(event.key)); /* CapsLock; 1 m */
  const key = event.key === " " ? "Space" : locked ? event.key.toLowerCase() : event.key;
  const typed = event.getModifierState("AltGraph"); /* brackets, on some keyboards, with Ctrl and Alt */
  if ((!typed && (event.ctrlKey || event.altKey)) || event.metaKey || ui.help.open) return;
  if (key !== "Escape" && own("select, #copied, [type=number], [type=text]")) return;
  if (/^(Arrow|Home|End|Page)/.test(key) && own("[type=range]:not(#scrubber)")) return;
  if (key === "Space" && own("button, summary, [type=checkbox], [type=radio]")) return;
  if (/^(Arrow|Home|End)/.test(key) && own("[type=radio], #provenance")) return;
  const found = ACTIONS.find(([keys]) => keys.split(" ").includes(key)), by = target === ui.scrubber && SCRUBBER[key];
  if (!found && !by) return;
  event.preventDefault();
  if (by) step(by); else found[2](key, event);
};
