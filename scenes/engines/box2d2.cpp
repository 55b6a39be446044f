// SPDX-License-Identifier: GPL-3.0-or-later
// Box2D 2.4 (Debian: libbox2d-dev). Build: c++ -O2 -o box2d2 box2d2.cpp -lbox2d
#include "serve.h"

#include <box2d/box2d.h>
#include <string>
#include <vector>

static b2World *world;
static std::vector<b2Body *> bodies;
static float dt;
static int iterations;

static void world_begin(const ServeScene *scene) {
    delete world;
    world = new b2World(b2Vec2(scene->gravity_x, scene->gravity_y));
    world->SetAllowSleeping(false);
    bodies.clear();
    dt = scene->dt;
    iterations = static_cast<int>(serve_setting("k", scene->iterations));
}

static void world_add(const ServeBody *body) {
    b2BodyDef def;
    def.type = body->fixed != 0 ? b2_staticBody : b2_dynamicBody;
    def.position.Set(body->x, body->y);
    def.angle = body->angle;
    def.linearVelocity.Set(body->vx, body->vy);
    def.angularVelocity = body->omega;
    b2PolygonShape shape;
    shape.SetAsBox(body->width / 2, body->height / 2);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = body->mass / (body->width * body->height);
    fixture.friction = body->friction; // of a pair the root of the product, as in twinbox
    bodies.push_back(world->CreateBody(&def));
    bodies.back()->CreateFixture(&fixture);
}

static void world_remove() {
    world->DestroyBody(bodies.back());
    bodies.pop_back();
}

static void world_step() { world->Step(dt, iterations, 3); }

static ServeState world_state(uint32_t i) {
    const b2Vec2 p = bodies[i]->GetPosition(), v = bodies[i]->GetLinearVelocity();
    return {p.x, p.y, bodies[i]->GetAngle(), v.x, v.y, bodies[i]->GetAngularVelocity()};
}

int main() {
    const std::string version = std::to_string(b2_version.major) + "." + std::to_string(b2_version.minor) + "." +
                                std::to_string(b2_version.revision);
    return serve("Box2D", version.c_str());
}
