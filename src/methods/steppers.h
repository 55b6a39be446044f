/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What steppers share: the contacts of the last step, and the momentum of free flight. */
#pragma once
#include "engine/engine.h"
#include "methods/methods.h"

#include <stdbool.h>
#include <stddef.h>

/* The momentum_error of methods without impulses: where no contact is, only gravity may change a momentum. */

/* N s: the sum over bodies without a contact of the momentum that they gained besides gravity's. touched[body_count] is
   work space. */
float free_flight_momentum(const ContactProblem *problem, const ContactSolution *solution, bool *touched);

/* Which contacts and bodies of a step are those of the stepper's last step, for steppers that carry more from step to
   step than the impulses that the world keeps. A body is known only if its state is, bit for bit, the one that the last
   step ended with: in another world, a copy of an earlier state or a new launch it is not. */

typedef struct TouchingPair {
    int a, b;
} TouchingPair;

/* Zero-initialise but for the sizes, which a stepper sets once; free with step_memory_free. */
struct StepMemory {
    size_t each_body, each_contact; /* bytes that the stepper carries for each */
    int body_count, contact_count;  /* of the last step */
    Body *bodies;                   /* [body_count] after it */
    TouchingPair *pairs;            /* [contact_count] */
    void *of_bodies, *of_contacts;  /* [body_count], [contact_count] what it carries, filled in `keep` */
    bool *known;                    /* [bodies of this step] */
    int *before;                    /* [contacts of this step] index of the same point in the last step, or -1 */
    size_t body_capacity, pair_capacity, of_body_capacity, of_contact_capacity, known_capacity, before_capacity;
};

void step_memory_free(StepMemory *memory);

/* Fills `known` and `before` for a step that has begun, and makes room for what is carried on from it; nothing is known
   in the first step of a run, and no contact without warm starting. False when memory is short. */
bool step_memory_match(StepMemory *memory, const World *world, const Step *step);

/* Afterwards a stepper with *to knows what one with *from knows. False when memory is short: it then knows nothing. */
bool step_memory_copy(StepMemory *to, const StepMemory *from);
