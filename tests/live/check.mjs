// SPDX-License-Identifier: GPL-3.0-or-later
// node check.mjs MODULE TWINBOX PACK LAUNCHES: random launches of scenes by all methods of the module, each also by
// `twinbox simulate`. Hashes, verdicts and refusals must be the same. Runs in the folder of the sources.
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {load} from './live.mjs';

const [path, twinbox, pack, launches] = process.argv.slice(2);
const solvers = ['engine', 'engine:k=4,warm=off', 'momentum', 'interior', 'interior:near=0.02', 'soft-step', 'soft-step:keep=0.05', 'engine:keep=0.02',
  'avbd', 'nncg', 'reference', 'closed-form', 'admm'];
const networks = ['pair-net', 'contact-net', 'pair-net:net=off', 'sain', 'hybrid', 'gns', 'subspace'];
const scenes = [
  {file: 'scenes/single.yaml', methods: [...solvers, ...networks]},
  {file: 'scenes/stack.yaml', methods: [...solvers, ...networks, 'scene-net:network=scenes/networks/scene-stack.npz']},
  {file: 'scenes/pyramid.yaml', methods: [...solvers, ...networks]},
  {file: 'scenes/pyramid_settled.yaml', methods: ['engine', 'scene-net', 'hybrid', 'subspace']},
  {file: 'scenes/families/gate.yaml', methods: solvers},
  {file: 'scenes/families/wall_85.yaml', methods: solvers},
  {file: 'scenes/stability/stack_height.yaml', methods: solvers, parameter: ['height', 2, 30]},
];

// The same launches each time: SplitMix of 32 bits.
let seed = 1;
const random = () => {
  seed = seed + 0x9e3779b9 | 0;
  let z = Math.imul(seed ^ seed >>> 16, 0x85ebca6b);
  z = Math.imul(z ^ z >>> 13, 0xc2b2ae35);
  return ((z ^ z >>> 16) >>> 0) / 2 ** 32;
};
const between = (from, to) => from + random() * (to - from);
const one_of = list => list[Math.floor(random() * list.length)];

// Most launches are where the bomb is free, and some are refused.
function settings_of({parameter, bomb}) {
  const settings = [];
  if (parameter) settings.push(`${parameter[0]}=${Math.round(between(parameter[1], parameter[2]))}`);
  if (bomb) settings.push(`bomb_x=${between(...bomb.reach)}`);
  if (bomb && random() < 0.3) settings.push(`bomb_y=${bomb.y + between(-0.5, 3)}`);
  if (bomb && random() < 0.2) settings.push(`bomb_mass=${between(1, 200).toPrecision(3)}`);
  if (bomb && bomb.speed > 0 && random() < 0.2) settings.push(`bomb_speed=${between(0.1, 40)}`);
  if (random() < 0.2) settings.push(`friction=${random().toFixed(2)}`);
  if (random() < 0.2) settings.push(`iterations=${Math.ceil(between(0, 30))}`);
  if (random() < 0.1) settings.push(`dt=${one_of([1 / 60, 0.01, 1 / 120])}`);
  return settings;
}

const live = await load(path);
const folder = mkdtempSync(join(tmpdir(), 'live-'));
const counts = {equal: 0, frames: 0, refused: 0, different: 0};
const by_method = {};

function fail(what, found, expected) {
  counts.different++;
  console.error(`${what}\n    module:  ${found}\n    program: ${expected}`);
}

// A file's name has a folder in the program's messages only.
const reason = text => text.replace(/^.*?error: /s, '').replace(/^ .*/gms, '').trim();

// "stack by engine: 300 steps of 0.0166667 s, 12 bodies, state 0123..." and the verdict
function by_program(file, settings, method, hashes) {
  const set = settings.flatMap(setting => ['--set', setting]);
  const {stdout, stderr} = spawnSync(twinbox, ['simulate', file, '-m', method, ...set, ...hashes, '-q'], {encoding: 'utf8'});
  return {state: /, state ([0-9a-f]{16})/.exec(stdout)?.[1], verdict: /verdict: (.*)/.exec(stdout)?.[1], failure: stderr};
}

// All frames of a run.
function check_frames(what, run, frames, file) {
  const expected = readFileSync(file, 'utf8').trim().split('\n').slice(1);
  if (expected.length !== frames + 1) fail(what, `${frames + 1} frames`, `${expected.length} frames`);
  expected.forEach((line, frame) => {
    const found = `${frame},${live.hash(run, frame)}`;
    counts.frames++;
    if (found !== line) fail(what, found, line);
  });
}

function check(scene, number) {
  const method = one_of(scene.methods), settings = settings_of(scene), whole = number % 4 === 0;
  const what = `${scene.file} ${method} ${settings.join(' ')}`, file = join(folder, 'hashes.csv');
  const program = by_program(scene.file, settings, method, whole ? ['--hash', file] : []);
  let result;
  try {
    result = live.run(scene.at, settings.join(','), method, number % 2);
  } catch (error) {
    if (!(error instanceof WebAssembly.RuntimeError) && reason(error.message) === reason(program.failure)) counts.refused++;
    else fail(what, error.message, program.failure);
    return;
  }
  if (result.failure !== '') {
    if (reason(result.failure) !== reason(program.failure)) fail(what, result.failure, program.failure);
    else counts.refused++;
  } else if (result.hash !== program.state || result.verdict.words !== program.verdict) {
    fail(what, `${result.hash} ${result.verdict.words}`, `${program.state} ${program.verdict} ${program.failure}`);
  } else {
    counts.equal++;
    by_method[method.replace(/:.*/, '')] = (by_method[method.replace(/:.*/, '')] ?? 0) + 1;
    if (whole) check_frames(what, result.run, result.frame, file);
  }
  live.c.live_end(result.run);
}

for (const scene of scenes) {
  const bundle = join(folder, 'bundle');
  execFileSync(pack, [bundle, scene.file, ...scene.methods]);
  scene.at = live.open(readFileSync(bundle));
  scene.bomb = live.json('live_describe', scene.at, '').bomb;
}
for (let i = 0; i < launches; i++) check(scenes[i % scenes.length], Math.floor(i / scenes.length));
rmSync(folder, {recursive: true});
console.log(`${counts.equal} runs equal, with ${counts.frames} frames compared one by one; ${counts.refused} refused alike; ` +
  `${counts.different} different`);
console.log(Object.entries(by_method).map(([name, count]) => `${name} ${count}`).join(', '));
process.exitCode = counts.different > 0 || counts.equal < launches / 2 ? 1 : 0;
