/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Box2D 2.4 (Debian's libbox2d), one thread: 10 velocity iterations and 3 position iterations, as its manual recommends.
   No continuous collision, because no other engine here has it. */
#include "rival.h"

#include <box2d/box2d.h>

namespace {

void *create() {
    b2World *world = new b2World(b2Vec2(0.0f, -10.0f));
    world->SetAllowSleeping(false);
    world->SetContinuousPhysics(false);
    return world;
}

void add(void *world, const RivalBox *box) {
    b2BodyDef def;
    def.type = box->fixed ? b2_staticBody : b2_dynamicBody;
    def.position.Set(box->x, box->y);
    def.linearVelocity.Set(box->vx, box->vy);
    b2Body *body = static_cast<b2World *>(world)->CreateBody(&def);
    b2PolygonShape shape;
    shape.SetAsBox(0.5f * box->width, 0.5f * box->height);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = box->mass / (box->width * box->height);
    fixture.friction = box->friction;
    body->CreateFixture(&fixture);
}

void step(void *world) { static_cast<b2World *>(world)->Step(1.0f / 60.0f, 10, 3); }

void destroy(void *world) { delete static_cast<b2World *>(world); }

} // namespace

extern "C" {
const Rival rival_box2d = {"box2d24", create, add, step, destroy};
}
