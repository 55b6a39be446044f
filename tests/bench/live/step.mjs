// SPDX-License-Identifier: GPL-3.0-or-later
// node step.mjs MODULE BUNDLE METHOD RUNS: as step_native, in Node.js.
import {readFileSync} from 'node:fs';
import {load} from '../../live/live.mjs';

const STEPS = 10;
const [module, bundle, method, runs] = process.argv.slice(2);
const live = await load(module), scene = live.open(readFileSync(bundle)), best = [];
let hash = '';
for (let i = Number(runs); i > 0; i--) {
  const run = live.must('live_begin', scene, '', method, 1), last = live.c.live_frames(run) - 1;
  let frame = 0;
  for (let part = 0; frame < last; part++) {
    const began = performance.now();
    frame = live.c.live_step(run, STEPS);
    best[part] = Math.min(best[part] ?? Infinity, performance.now() - began);
  }
  hash = live.hash(run, frame);
  live.c.live_end(run);
}
console.log(best.reduce((sum, ms) => sum + ms, 0).toFixed(4), hash);
