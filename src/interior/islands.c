/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior/islands.h"

#include "common/array.h"

#include <stdlib.h>

void islands_free(Islands *islands) {
    free(islands->parent);
    free(islands->loops);
    *islands = (Islands){0};
}

/* The body that stands for the island; halves the path to it. */
static int32_t find(int32_t *parent, int32_t body) {
    while (parent[body] != body) body = parent[body] = parent[parent[body]];
    return body;
}

int islands_most_loops(Islands *islands, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count + 1, size = sizeof(int32_t);
    if (!array_reserve((void **)&islands->parent, &islands->parent_capacity, bodies, size) ||
        !array_reserve((void **)&islands->loops, &islands->loop_capacity, bodies, size))
        return -1;
    int32_t *parent = islands->parent, *loops = islands->loops;
    for (int i = 0; i < problem->body_count; i++) {
        parent[i] = problem_body_moves(&problem->bodies[i]) ? i : -1;
        loops[i] = 0;
    }
    int most = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const bool again = i > 0 && contact[-1].a == contact->a && contact[-1].b == contact->b;
        if (again || parent[contact->a] < 0 || parent[contact->b] < 0) continue;
        const int32_t a = find(parent, contact->a), b = find(parent, contact->b);
        parent[b] = a;
        loops[a] += a == b ? 1 : loops[b];
        if (loops[a] > most) most = loops[a];
    }
    return most;
}
