/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chipmunk2D 7, the engine inside pymunk (Debian: libchipmunk-dev). Build: cc -O2 -o chipmunk chipmunk.c -lchipmunk -lm */
#include "serve.h"

#include <chipmunk/chipmunk.h>
#include <math.h>

static cpSpace *space;
static cpBody **bodies;
static cpShape **shapes;
static uint32_t count;
static float dt;

static void world_remove(void) {
    count--;
    cpSpaceRemoveShape(space, shapes[count]);
    cpSpaceRemoveBody(space, bodies[count]);
    cpShapeFree(shapes[count]);
    cpBodyFree(bodies[count]);
}

static void world_begin(const ServeScene *scene) {
    while (count > 0) world_remove();
    if (space != NULL) cpSpaceFree(space);
    space = cpSpaceNew();
    cpSpaceSetGravity(space, cpv(scene->gravity_x, scene->gravity_y));
    cpSpaceSetIterations(space, (int)serve_setting("k", scene->iterations));
    cpSpaceSetCollisionSlop(space, 0.01); /* m, as in twinbox */
    dt = scene->dt;
}

static void world_add(const ServeBody *b) {
    bodies = realloc(bodies, (count + 1) * sizeof *bodies);
    shapes = realloc(shapes, (count + 1) * sizeof *shapes);
    if (bodies == NULL || shapes == NULL) abort();
    cpBody *body = b->fixed != 0 ? cpBodyNewStatic() : cpBodyNew(b->mass, cpMomentForBox(b->mass, b->width, b->height));
    cpShape *shape = cpBoxShapeNew(body, b->width, b->height, 0);
    cpShapeSetFriction(shape, sqrt(b->friction)); /* of a pair multiplied */
    cpBodySetPosition(body, cpv(b->x, b->y));
    cpBodySetAngle(body, b->angle);
    if (b->fixed == 0) cpBodySetVelocity(body, cpv(b->vx, b->vy));
    if (b->fixed == 0) cpBodySetAngularVelocity(body, b->omega);
    cpSpaceAddBody(space, body);
    cpSpaceAddShape(space, shape);
    bodies[count] = body;
    shapes[count++] = shape;
}

static void world_step(void) { cpSpaceStep(space, dt); }

static ServeState world_state(uint32_t i) {
    const cpVect p = cpBodyGetPosition(bodies[i]), v = cpBodyGetVelocity(bodies[i]);
    return (ServeState){(float)p.x, (float)p.y, (float)cpBodyGetAngle(bodies[i]),
                        (float)v.x, (float)v.y, (float)cpBodyGetAngularVelocity(bodies[i])};
}

int main(void) { return serve("Chipmunk2D", cpVersionString); }
