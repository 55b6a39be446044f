// SPDX-License-Identifier: GPL-3.0-or-later
// A client of the module (src/live/live.h), for tests.
import {readFileSync} from 'node:fs';

export async function load(path) {
  const module = await WebAssembly.compile(readFileSync(path));
  const imports = WebAssembly.Module.imports(module);
  if (imports.length > 0) throw new Error(`the module imports ${imports.map(i => i.name).join(', ')}`);
  const {exports} = await WebAssembly.instantiate(module);
  exports._initialize();
  return new Live(exports);
}

class Live {
  constructor(exports) { this.c = exports; }

  put(bytes) {
    const at = this.c.live_reserve(bytes.length);
    if (at === 0) throw new Error('out of memory');
    new Uint8Array(this.c.memory.buffer, at, bytes.length).set(bytes);
    return at;
  }

  // Calls a function with texts among its arguments.
  call(name, ...values) {
    const texts = [];
    const numbers = values.map(value => {
      if (typeof value !== 'string') return value;
      texts.push(this.put(new TextEncoder().encode(value + '\0')));
      return texts.at(-1);
    });
    const result = this.c[name](...numbers);
    texts.forEach(at => this.c.live_release(at));
    return result;
  }

  text(at) {
    const bytes = new Uint8Array(this.c.memory.buffer);
    return new TextDecoder().decode(bytes.subarray(at, bytes.indexOf(0, at)));
  }

  // The result of a function; throws the module's error where it is 0.
  must(name, ...values) {
    const result = this.call(name, ...values);
    if (result === 0) throw new Error(this.text(this.c.live_error()));
    return result;
  }

  open(bytes) { return this.must('live_open', this.put(bytes), bytes.length); }
  json(name, ...values) { return JSON.parse(this.text(this.must(name, ...values))); }

  // The run of a scene to its end.
  run(scene, settings, method, contacts = 0) {
    const run = this.must('live_begin', scene, settings, method, contacts);
    const frame = this.c.live_step(run, 1 << 30), failure = this.text(this.c.live_failure(run));
    const at = this.c.live_verdict(run), verdict = at === 0 ? null : JSON.parse(this.text(at));
    return {run, frame, failure, verdict, hash: this.hash(run, frame)};
  }

  hash(run, frame) { return BigInt.asUintN(64, this.c.live_hash(run, frame)).toString(16).padStart(16, '0'); }
}
