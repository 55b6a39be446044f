// SPDX-License-Identifier: GPL-3.0-or-later
// Box2D 3, in WebAssembly.
import load from 'box2d3-wasm';
import {serve, version} from './serve.mjs';

const B = await load({pthreadCount: 0});
const use = (object, read) => { // objects of WebAssembly are not collected
    const result = read(object);
    object.delete();
    return result;
};
serve({name: 'Box2D (box2d3-wasm)', version: version('box2d3-wasm'), create(scene, settings) {
    const def = B.b2DefaultWorldDef(), bodies = [];
    def.gravity = new B.b2Vec2(scene.gravity.x, scene.gravity.y);
    def.enableSleep = false;
    const world = B.b2CreateWorld(def), substeps = Number(settings.k ?? 4);
    return {
        add(b) {
            const d = B.b2DefaultBodyDef(), s = B.b2DefaultShapeDef(), material = s.material;
            d.type = b.fixed ? B.b2BodyType.b2_staticBody : B.b2BodyType.b2_dynamicBody;
            d.position = new B.b2Vec2(b.x, b.y);
            d.rotation = B.b2MakeRot(b.angle);
            d.linearVelocity = new B.b2Vec2(b.vx, b.vy);
            d.angularVelocity = b.omega;
            s.density = b.mass / (b.width * b.height);
            material.friction = b.friction;
            s.material = material;
            bodies.push(B.b2CreateBody(world, d));
            B.b2CreatePolygonShape(bodies.at(-1), s, B.b2MakeBox(b.width / 2, b.height / 2));
        },
        remove: () => B.b2DestroyBody(bodies.pop()),
        step: () => B.b2World_Step(world, scene.dt, substeps),
        state(i) {
            const b = bodies[i];
            return [...use(B.b2Body_GetPosition(b), (p) => [p.x, p.y]),
                    use(B.b2Body_GetRotation(b), (q) => B.b2Rot_GetAngle(q)),
                    ...use(B.b2Body_GetLinearVelocity(b), (v) => [v.x, v.y]), B.b2Body_GetAngularVelocity(b)];
        },
        end: () => B.b2DestroyWorld(world),
    };
}});
