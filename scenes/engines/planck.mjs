// SPDX-License-Identifier: GPL-3.0-or-later
// Planck.js, a port of Box2D 2.3. Its polygons have a skin that keeps boxes 15 mm apart; shrink=on makes them smaller by it.
import {Box, Vec2, World} from 'planck';
import {serve, version} from './serve.mjs';

serve({name: 'Planck', version: version('planck'), create(scene, settings) {
    const world = new World({gravity: Vec2(scene.gravity.x, scene.gravity.y), allowSleep: false}), bodies = [];
    const skin = settings.shrink === 'on' ? 0.0075 : 0;
    return {
        add(b) {
            const body = world.createBody({type: b.fixed ? 'static' : 'dynamic', position: Vec2(b.x, b.y), angle: b.angle,
                                           linearVelocity: Vec2(b.vx, b.vy), angularVelocity: b.omega});
            const w = b.width - 2 * skin, h = b.height - 2 * skin;
            body.createFixture({shape: new Box(w / 2, h / 2), density: b.mass / (w * h), friction: b.friction});
            bodies.push(body);
        },
        remove: () => world.destroyBody(bodies.pop()),
        step: () => world.step(scene.dt, Number(settings.k ?? 8), 3),
        state(i) {
            const b = bodies[i], p = b.getPosition(), v = b.getLinearVelocity();
            return [p.x, p.y, b.getAngle(), v.x, v.y, b.getAngularVelocity()];
        },
    };
}});
