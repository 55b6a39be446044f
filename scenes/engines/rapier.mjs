// SPDX-License-Identifier: GPL-3.0-or-later
// Rapier 2D, in WebAssembly.
import R from '@dimforge/rapier2d-compat';
import {serve, version} from './serve.mjs';

await R.init();
serve({name: 'Rapier', version: version('@dimforge/rapier2d-compat'), create(scene, settings) {
    const world = new R.World(scene.gravity), bodies = [];
    world.timestep = scene.dt;
    if (settings.k) world.numSolverIterations = Number(settings.k);
    return {
        add(b) {
            const kind = b.fixed ? R.RigidBodyDesc.fixed() : R.RigidBodyDesc.dynamic();
            const body = world.createRigidBody(kind.setTranslation(b.x, b.y).setRotation(b.angle).setLinvel(b.vx, b.vy)
                .setAngvel(b.omega).setCanSleep(false));
            const shape = R.ColliderDesc.cuboid(b.width / 2, b.height / 2).setDensity(b.mass / (b.width * b.height));
            world.createCollider(shape.setFriction(Math.sqrt(b.friction)) // of a pair the root of the product
                .setFrictionCombineRule(R.CoefficientCombineRule.Multiply), body);
            bodies.push(body);
        },
        remove: () => world.removeRigidBody(bodies.pop()),
        step: () => world.step(),
        state(i) {
            const b = bodies[i], p = b.translation(), v = b.linvel();
            return [p.x, p.y, b.rotation(), v.x, v.y, b.angvel()];
        },
        end: () => world.free(),
    };
}});
