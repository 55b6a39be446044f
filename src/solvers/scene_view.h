/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contact problem as a slot network meets it (network/slot_network.h). A bomb that turned by a quarter is the same
   box with its edges renamed: it is seen turned back to within an eighth of a turn (a half and a quarter where it is
   oblong), and so are the features of its contacts. Without that, each quarter would have to be learned by itself. */
#pragma once
#include "dynamics/contact_problem.h"
#include "network/slot_network.h"

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise; arrays grow and are reused. */
typedef struct SceneView {
    SlotView slots;
    int32_t *contacts;    /* [slots.slot_count] the contact of each */
    ContactImpulse *base; /* [contact_count] the start without the network: warm impulses, those with a slot up to
                             its cap and inside the cone */
    /* What `slots` points to: */
    float bomb[SLOT_BODY_NUMBERS], *state, *ones, *warm;
    int32_t *present, *impulses;
    size_t state_capacity, ones_capacity, warm_capacity, present_capacity, impulse_capacity, contact_capacity,
        base_capacity;
} SceneView;

void scene_view_free(SceneView *view);

/* The feature of one of the problem's contacts, as seen. */
uint32_t scene_view_feature(const ContactProblem *problem, const ContactPoint *contact);

/* The problem has the network's bodies. False when memory is short. */
bool scene_view_take(SceneView *view, const SlotNetwork *network, const ContactProblem *problem);
