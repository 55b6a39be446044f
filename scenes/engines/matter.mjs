// SPDX-License-Identifier: GPL-3.0-or-later
// Matter.js. Its limits of rest and overlap are in pixels, so the scale matters: px=100 pixels are a metre. y points down, and
// velocities are per step of 1/60 s.
import M from 'matter-js';
import {serve, version} from './serve.mjs';

serve({name: 'Matter.js', version: version('matter-js'), create(scene, settings) {
    const px = Number(settings.px ?? 100), second = 60, bodies = [];
    const engine = M.Engine.create({enableSleeping: false,
                                    gravity: {x: scene.gravity.x * px / 1e3, y: -scene.gravity.y * px / 1e3, scale: 1e-3}});
    if (settings.k) engine.velocityIterations = engine.positionIterations = Number(settings.k);
    return {
        add(b) {
            const body = M.Bodies.rectangle(b.x * px, -b.y * px, b.width * px, b.height * px, {
                isStatic: b.fixed, friction: b.friction, frictionAir: 0, restitution: 0,
                density: (b.mass || 1) / (b.width * b.height * px * px)});
            if (b.angle !== 0) M.Body.setAngle(body, -b.angle);
            if (!b.fixed) {
                M.Body.setVelocity(body, {x: b.vx * px / second, y: -b.vy * px / second});
                M.Body.setAngularVelocity(body, -b.omega / second);
            }
            M.Composite.add(engine.world, body);
            bodies.push(body);
        },
        remove: () => M.Composite.remove(engine.world, bodies.pop()),
        step: () => M.Engine.update(engine, scene.dt * 1000),
        state(i) {
            const b = bodies[i], v = M.Body.getVelocity(b);
            return [b.position.x / px, -b.position.y / px, -b.angle, v.x * second / px, -v.y * second / px,
                    -M.Body.getAngularVelocity(b) * second];
        },
    };
}});
