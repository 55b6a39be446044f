// SPDX-License-Identifier: GPL-3.0-or-later
// The binary form of twinbox's protocol for engines (README.md) in Node.js. An adapter calls
//     serve({name, version, create})
// where create(scene, settings) returns a world: {add(body), remove(), step(), state(i), end()}. The scene has gravity (x, y),
// dt and iterations; a body has fixed, width, height, x, y, angle, vx, vy, omega, mass (0 if fixed) and friction; settings are texts.
import fs from 'node:fs';

console.log = console.error; // standard output is for answers

// The version of an installed package.
export const version = (name) =>
    JSON.parse(fs.readFileSync(new URL(`./node_modules/${name}/package.json`, import.meta.url))).version;

let unread = Buffer.alloc(0);

const more = () => {
    const block = Buffer.alloc(1 << 16), size = fs.readSync(0, block);
    if (size === 0) process.exit(0); // twinbox has ended
    unread = Buffer.concat([unread, block.subarray(0, size)]);
};

const read = (size) => {
    while (unread.length < size) more();
    const bytes = Buffer.from(unread.subarray(0, size));
    unread = unread.subarray(size);
    return bytes;
};

const readLine = () => {
    while (!unread.includes(10)) more();
    return read(unread.indexOf(10) + 1).toString();
};

const write = (bytes) => {
    for (let at = 0; at < bytes.length;) at += fs.writeSync(1, bytes, at);
};

const readBody = () => {
    const b = read(44), at = (i) => b.readFloatLE(4 * i);
    return {fixed: at(0) !== 0, width: at(1), height: at(2), x: at(3), y: at(4), angle: at(5), vx: at(6), vy: at(7),
            omega: at(8), mass: at(9), friction: at(10)};
};

const step = (world, scene, frame, count) => {
    const begun = process.hrtime.bigint();
    world.step();
    const ns = process.hrtime.bigint() - begun, out = Buffer.alloc(24 + 24 * count);
    [scene, frame, count, 0].forEach((n, i) => out.writeUInt32LE(n, 4 * i));
    out.writeBigUInt64LE(ns, 16);
    for (let i = 0; i < count; i++) world.state(i).forEach((n, k) => out.writeFloatLE(n, 24 + 24 * i + 4 * k));
    write(out);
};

export const serve = ({name, version, create}) => {
    const {twinbox, settings} = JSON.parse(readLine());
    if (twinbox !== 1) throw Error(`protocol ${twinbox} is not known`);
    write(Buffer.from(JSON.stringify({twinbox, name, version, form: 'binary'}) + '\n'));
    let world = null, count = 0;
    for (;;) {
        const head = read(36), [scene, frame, steps, added, removed, iterations] =
            [0, 1, 2, 3, 4, 5].map((i) => head.readUInt32LE(4 * i));
        if (frame === 0) {
            world?.end?.();
            const gravity = {x: head.readFloatLE(24), y: head.readFloatLE(28)};
            world = create({gravity, dt: head.readFloatLE(32), iterations}, settings);
            count = 0;
        }
        for (let i = 0; i < removed; i++) world.remove();
        for (let i = 0; i < added; i++) world.add(readBody());
        count += added - removed;
        for (let k = 1; k <= steps; k++) step(world, scene, frame + k, count);
    }
};
