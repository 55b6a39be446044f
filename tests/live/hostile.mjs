// SPDX-License-Identifier: GPL-3.0-or-later
// node hostile.mjs MODULE PLAIN PACK: what a page may get wrong ends in an error with a reason, and the module works afterwards. A trap
// (WebAssembly.RuntimeError) fails the test.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {load} from './live.mjs';

const [path, plain_path, pack] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'live-'));
// The methods of the list METHODS: those of the plain module, and those of the one with networks.
const [PLAIN, ALL] = ['LIVE', 'LIVE|LIVE_NETWORK'].map(where => [...readFileSync('src/methods/methods.h', 'utf8')
  .matchAll(RegExp(`(?:SOLVER|STEPPING)\\((\\w+), (?:${where})\\)`, 'g'))].map(entry => entry[1].replaceAll('_', '-')).join());
const live = await load(path);
let failures = 0;

function expect(condition, what) {
  if (condition) return;
  failures++;
  console.error(`failed: ${what}`);
}

function refused(call, words) {
  try {
    call();
    expect(false, `${words}: it is accepted`);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    expect(error.message.includes(words), `"${error.message}" lacks "${words}"`);
  }
}

function bundle_of(...scene_and_methods) {
  execFileSync(pack, [join(folder, 'bundle'), ...scene_and_methods]);
  return new Uint8Array(readFileSync(join(folder, 'bundle')));
}

const stack = live.open(bundle_of('scenes/stack.yaml', 'engine'));
const settled = live.open(bundle_of('scenes/pyramid_settled.yaml', 'engine'));
const height = live.open(bundle_of('scenes/stability/stack_height.yaml', 'engine'));
const begin = (scene, settings, method = 'engine') => live.must('live_begin', scene, settings, method, 0);

refused(() => begin(stack, 'bomb_x=NaN'), "'bomb_x=NaN' is not NAME=VALUE with a number after '='");
refused(() => begin(stack, 'bomb_x=1e999'), "'bomb_x=1e999' is not NAME=VALUE");
refused(() => begin(stack, 'bomb_x'), "'bomb_x' is not NAME=VALUE");
refused(() => begin(stack, ','), "'' is not NAME=VALUE");
refused(() => begin(stack, 'x'.repeat(100000) + '=1'), 'is not NAME=VALUE');
refused(() => begin(stack, 'bomb_x=1,bomb_x=2'), "the parameter 'bomb_x' is set twice");
refused(() => begin(stack, Array.from({length: 100}, (_, i) => `a${i}=1`).join()), "'a0' is not a parameter");
refused(() => begin(stack, '<b>=1'), "'<b>' is not a parameter");
refused(() => begin(stack, 'bomb_speed=-1'), 'bomb_speed must be a number from 0 to 10000 m/s (set to -1)');
refused(() => begin(height, 'height=1e9'), 'height must be from');
refused(() => begin(height, 'height=2.5'), 'height must be a whole number');
refused(() => begin(stack, '', 'egnine'), "'egnine' is not a method; did you mean 'engine'?");
refused(() => begin(stack, '', 'playback'), "'playback' is not a method; known: engine, momentum, nncg, pair-net, contact-net, scene-net, reference");
refused(() => begin(stack, '', 'engine:k=0'), "k: error: must be a whole number from 1 to 1000000 (got '0')");
refused(() => begin(stack, '', 'interior:near=nan'), 'near');
refused(() => begin(stack, '', 'x'.repeat(100000)), "a method's text has at most 127 characters");
refused(() => begin(stack, '', 'pair-net'), 'networks/pair-net.npz: error: the page does not have this network');
refused(() => begin(stack, '', 'pair-net:network=/etc/passwd'), 'the page does not have this network');
refused(() => begin(settled, 'dt=1e-5'), 'out of memory');
refused(() => live.json('live_describe', stack, 'iterations=0.5'), 'iterations must be a whole number');

const method_names = live.json('live_methods').map(method => method.name);
expect(method_names.join() === ALL, method_names.join());
const {parameters, bomb} = live.json('live_describe', height, 'height=7');
expect(parameters.find(each => each.name === 'height').value === 7, 'a setting is described');
expect(bomb === null, 'a scene without a bomb is described');


// Damage anywhere: refused, or a scene that can be described and run.
const whole = bundle_of('scenes/stack.yaml', 'pair-net');
let random = 1, opened = 0, ran = 0;
const next = limit => (random = Math.imul(random, 1103515245) + 12345 >>> 0) % limit;
for (let i = 0; i < 3000; i++) {
  let bytes = whole.slice(0, i % 3 === 0 ? next(whole.length) : whole.length);
  for (let k = next(3); k >= 0 && i % 3 !== 0; k--) bytes[next(4) === 0 ? next(200) : next(bytes.length)] = next(256);
  try {
    const scene = live.open(bytes);
    opened++;
    try {
      live.json('live_describe', scene, '');
      const run = begin(scene, '', 'pair-net');
      live.c.live_step(run, 2);
      live.c.live_end(run);
      ran++;
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) throw error;
    }
    live.c.live_close(scene);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
  }
}
expect(opened > 500 && opened < 2900 && ran > 100, `of 3000 damaged bundles ${opened} were opened and ${ran} ran`);

// After all that: the bits of before, and no memory lost.
const {hash, run} = live.run(stack, '', 'engine');
live.c.live_end(run);
const size = live.c.memory.buffer.byteLength;
for (let i = 0; i < 100; i++) {
  const again = live.run(stack, '', 'engine', 1);
  expect(again.hash === hash, 'another hash');
  live.c.live_end(again.run);
}
expect(live.c.memory.buffer.byteLength === size, 'memory grows from run to run');

// The module without networks: the same runs, and its methods.
const plain = await load(plain_path);
const stack_there = plain.open(bundle_of('scenes/stack.yaml', 'engine'));
expect(plain.run(stack_there, '', 'engine').hash === hash, 'another hash by the plain module');
expect(plain.json('live_methods').map(method => method.name).join() === PLAIN, 'plain methods');
expect(plain.call('live_begin', stack_there, '', 'pair-net', 0) === 0, 'a network in the plain module');
rmSync(folder, {recursive: true});
process.exitCode = failures > 0 ? 1 : 0;
