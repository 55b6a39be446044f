/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <stdlib.h>
#include <string.h>

void colours_free(Colours *colours) {
    free(colours->visits);
    free(colours->pairs);
    free(colours->colour);
    free(colours->taken);
    *colours = (Colours){0};
}

static bool reserve(Colours *colours, size_t contacts, size_t bodies) {
    return array_reserve((void **)&colours->visits, &colours->visit_capacity, contacts, sizeof *colours->visits) &&
           array_reserve((void **)&colours->pairs, &colours->pair_capacity, contacts + 1, sizeof *colours->pairs) &&
           array_reserve((void **)&colours->colour, &colours->colour_capacity, contacts, sizeof *colours->colour) &&
           array_reserve((void **)&colours->taken, &colours->taken_capacity, bodies, sizeof *colours->taken);
}

/* Returns their number. */
static int find_pairs(Colours *colours, const ContactProblem *problem) {
    int count = 0;
    for (int i = 0; i < problem->contact_count; i += contact_surface_points(problem, i)) colours->pairs[count++] = i;
    colours->pairs[count] = problem->contact_count;
    return count;
}

/* points[colour + 1]: the number of contacts of that colour. Returns the number of colours. */
static int paint(Colours *colours, const ContactProblem *problem, int pairs, int points[COLOURS + 1]) {
    memset(colours->taken, 0, (size_t)problem->body_count * sizeof *colours->taken);
    int most = 0;
    for (int i = pairs - 1; i >= 0; i--) {
        const int colour = colours_take(colours->taken, problem, &problem->contacts[colours->pairs[i]]);
        colours->colour[i] = (uint8_t)colour;
        points[colour + 1] += colours->pairs[i + 1] - colours->pairs[i];
        if (colour >= most) most = colour + 1;
    }
    return most;
}

bool colours_order(Colours *colours, const ContactProblem *problem) {
    int begin[COLOURS + 1] = {0};
    if (!reserve(colours, (size_t)problem->contact_count, (size_t)problem->body_count)) return false;
    const int pairs = find_pairs(colours, problem);
    const int count = paint(colours, problem, pairs, begin);
    for (int i = 0; i < count; i++) begin[i + 1] += begin[i];
    for (int i = 0; i < pairs; i++) {
        int32_t *visit = &colours->visits[begin[colours->colour[i]]];
        begin[colours->colour[i]] += colours->pairs[i + 1] - colours->pairs[i];
        for (int first = colours->pairs[i]; first < colours->pairs[i + 1]; first++) *visit++ = first;
    }
    return true;
}

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
