/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What scene-net sees of a step, and the method with a network in memory. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "nets/kinds.h"

#include <stdbool.h>
#include <stdint.h>

/* A contact problem as the inputs of its network (nets/kinds.h). A bomb rotated by a quarter turn is the
   same box with its edges renamed. So the view rotates it back to within an eighth of a turn (a quarter if it is
   oblong), and renames the features of its contacts. Otherwise the network would have to learn each quarter turn
   separately. */

/* Zero-initialise; arrays grow and are reused. */
typedef struct SceneView {
    SceneNetView slots;
    int32_t *contacts;    /* [slots.slot_count] the contact of each slot */
    ContactImpulse *base; /* [contact_count] impulses without the network: the warm start, for contacts with a slot
                             up to its cap and inside the cone */
    /* The arrays that `slots` points to: */
    float bomb[SLOT_BODY_NUMBERS], *state, *ones, *warm;
    int32_t *present, *impulses;
    ArrayBlock arrays;
} SceneView;

void scene_view_free(SceneView *view);

/* The feature of one of the problem's contacts, with the bomb rotated back. */
uint32_t scene_view_feature(const ContactProblem *problem, const ContactPoint *contact);

/* rad: the angle of a body, turned back by quarter turns (half turns if it is oblong) to the smallest. */
float scene_view_angle(const ProblemBody *body);

/* The problem must have the network's bodies. False when memory is short. */
bool scene_view_take(SceneView *view, const SceneNet *network, const ContactProblem *problem);

/* The method scene-net with a network in memory, for training. */

/* The network remains the caller's and must outlive the solver. near: the setting, m/s. */
bool scene_net_make(ContactSolver *solver, const SceneNet *network, float near, Error *error);
