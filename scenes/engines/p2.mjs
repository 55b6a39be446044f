// SPDX-License-Identifier: GPL-3.0-or-later
// p2-es, p2.js as a module. Friction belongs to pairs of materials: here a material for each friction of the scene.
import * as P from 'p2-es';
import {serve, version} from './serve.mjs';

serve({name: 'p2-es', version: version('p2-es'), create(scene, settings) {
    const world = new P.World({gravity: [scene.gravity.x, scene.gravity.y]}), bodies = [], materials = new Map();
    if (settings.k) world.solver.iterations = Number(settings.k);
    const materialOf = (friction) => {
        if (materials.has(friction)) return materials.get(friction);
        const material = new P.Material();
        materials.set(friction, material);
        for (const [other, b] of materials)
            world.addContactMaterial(new P.ContactMaterial(material, b, {friction: Math.sqrt(friction * other)}));
        return material;
    };
    return {
        add(b) {
            const body = new P.Body({mass: b.mass, position: [b.x, b.y], angle: b.angle, velocity: [b.vx, b.vy],
                                     angularVelocity: b.omega, damping: 0, angularDamping: 0});
            const shape = new P.Box({width: b.width, height: b.height});
            shape.material = materialOf(b.friction);
            body.addShape(shape);
            world.addBody(body);
            bodies.push(body);
        },
        remove: () => world.removeBody(bodies.pop()),
        step: () => world.step(scene.dt),
        state(i) {
            const b = bodies[i];
            return [...b.position, b.angle, ...b.velocity, b.angularVelocity];
        },
    };
}});
