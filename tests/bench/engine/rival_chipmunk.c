/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chipmunk2D 7 (Debian's libchipmunk, built with its assertions enabled), one thread. */
#include "rival.h"

#include <chipmunk/chipmunk.h>

#include <math.h>

static void *create(void) {
    cpSpace *space = cpSpaceNew();
    cpSpaceSetGravity(space, cpv(0, -10));
    cpSpaceSetIterations(space, 10);
    cpSpaceSetCollisionSlop(space, 0.01);
    cpSpaceSetSleepTimeThreshold(space, (cpFloat)INFINITY);
    return space;
}

static void add(void *world, const RivalBox *box) {
    cpSpace *space = world;
    cpFloat mass = (cpFloat)box->mass, width = (cpFloat)box->width, height = (cpFloat)box->height;
    cpBody *body = box->fixed ? cpBodyNewStatic() : cpBodyNew(mass, cpMomentForBox(mass, width, height));
    cpSpaceAddBody(space, body);
    cpBodySetPosition(body, cpv((cpFloat)box->x, (cpFloat)box->y));
    if (!box->fixed) cpBodySetVelocity(body, cpv((cpFloat)box->vx, (cpFloat)box->vy));
    cpShape *shape = cpSpaceAddShape(space, cpBoxShapeNew(body, width, height, 0));
    /* Chipmunk multiplies the two coefficients; the others take the square root of their product. */
    cpShapeSetFriction(shape, sqrt((cpFloat)box->friction));
}

static void step(void *world) { cpSpaceStep(world, 1.0 / 60.0); }

static void free_shape(cpBody *body, cpShape *shape, void *space) {
    (void)body;
    cpSpaceRemoveShape(space, shape);
    cpShapeFree(shape);
}

static void free_body(cpBody *body, void *space) {
    cpBodyEachShape(body, free_shape, space);
    cpSpaceRemoveBody(space, body);
    cpBodyFree(body);
}

static void after_step(cpSpace *space, void *body, void *data) {
    (void)data;
    free_body(body, space);
}

static void later(cpBody *body, void *space) { cpSpaceAddPostStepCallback(space, after_step, body, NULL); }

static void destroy(void *world) {
    /* Bodies can only be removed after a step: the space is locked while it iterates over them. */
    cpSpaceEachBody(world, later, world);
    cpSpaceFree(world);
}

const Rival rival_chipmunk = {"chipmunk", create, add, step, destroy};
