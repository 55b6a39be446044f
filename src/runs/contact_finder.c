/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contacts between boxes in given poses, for runs that do not state theirs: the collision detection of the engine's
   step. */
#include "base/base.h"
#include "engine/engine.h"
#include "runs/contact_finder.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"

#include <stdlib.h>

void contact_finder_free(ContactFinder *finder) {
    sort_and_sweep_free(&finder->broad_phase);
    free(finder->pairs.pairs);
    contact_set_free(&finder->set);
    free(finder->boxes);
    free(finder->bounds);
    free(finder->fixed);
    *finder = (ContactFinder){0};
}

bool contact_finder_reserve(ContactFinder *finder, int count, Error *error) {
    const size_t room = (size_t)count + 1;
    return (array_reserve((void **)&finder->boxes, &finder->box_capacity, room, sizeof *finder->boxes) &&
            array_reserve((void **)&finder->bounds, &finder->bound_capacity, room, sizeof *finder->bounds) &&
            array_reserve((void **)&finder->fixed, &finder->fixed_capacity, room, sizeof *finder->fixed)) ||
           error_memory(error, "contacts");
}

bool contact_finder_pairs(ContactFinder *finder, int count, Error *error) {
    if (sort_and_sweep_find(&finder->broad_phase, &finder->pairs, finder->bounds, finder->fixed, count)) return true;
    return finder->broad_phase.too_many
               ? error_input(error, "contacts", "more than %d pairs of boxes overlap, or nearly", BROAD_PHASE_MAX_PAIRS)
               : error_memory(error, "contacts");
}

bool contact_finder_find(ContactFinder *finder, const Body *bodies, int count, float skin, Error *error) {
    if (!contact_finder_reserve(finder, count, error)) return false;
    for (int i = 0; i < count; i++) {
        const Vec2 size = vec2_add(bodies[i].size, vec2(2 * skin, 2 * skin));
        finder->boxes[i] = box_make(bodies[i].position, size, bodies[i].angle);
        finder->bounds[i] = contact_bounds(&finder->boxes[i], finder->rules);
        finder->fixed[i] = bodies[i].inv_mass == 0;
    }
    if (!contact_finder_pairs(finder, count, error)) return false;
    if (!contact_set_collide(&finder->set, &finder->pairs, finder->boxes, &(ContactSet){0}, finder->rules))
        return error_memory(error, "contacts");
    for (int i = 0; i < finder->set.contact_count; i++) finder->set.contacts[i].separation += 2 * skin;
    return true;
}

/* The contacts of a step follow from the poses before it. */
static bool find_step(Trajectory *run, int step, ContactFinder *finder, Body *bodies, int *numbers, Error *error) {
    int count = 0;
    for (int i = 0; i < run->bodies; i++) {
        const size_t at = trajectory_at(run, step - 1, i);
        if (!trajectory_has(run, step - 1, i)) continue;
        const float mass = run->fixed[i] ? 0 : 1;
        bodies[count] = (Body){.position = run->position[at],
                               .angle = run->angle[at],
                               .size = run->size[i],
                               .inv_mass = mass,
                               .inv_inertia = mass};
        numbers[count++] = i;
    }
    if (!contact_finder_find(finder, bodies, count, 0, error)) return false;
    const ContactSet *set = &finder->set;
    TrajectoryContact *found = trajectory_add_contacts(run, step, set->contact_count, error);
    for (int i = 0; found != NULL && i < set->contact_count; i++) {
        const ContactPoint *point = &set->contacts[i];
        found[i] = (TrajectoryContact){.a = numbers[point->a],
                                       .b = numbers[point->b],
                                       .feature = point->feature,
                                       .point = point->position,
                                       .normal = point->normal};
    }
    return found != NULL;
}

bool trajectory_find_contacts(Trajectory *run, Error *error) {
    ContactFinder finder = {.rules.mend = true}; /* those of all methods: others have less */
    Body *bodies = malloc(((size_t)run->bodies + 1) * sizeof *bodies);
    int *numbers = malloc(((size_t)run->bodies + 1) * sizeof *numbers);
    bool ok = (bodies != NULL && numbers != NULL) || error_memory(error, run->scene);
    run->last_step = 0;
    run->contact_start[1] = 0;
    for (int step = 1; ok && step < run->frames; step++) ok = find_step(run, step, &finder, bodies, numbers, error);
    trajectory_end_contacts(run);
    run->no_contacts = !ok;
    run->no_impulses = ok;
    contact_finder_free(&finder);
    free(bodies);
    free(numbers);
    return ok;
}
