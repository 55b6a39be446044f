/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/colours.h"

#include "common/array.h"
#include "solvers/contact_velocity.h"

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
           array_reserve((void **)&colours->pairs, &colours->pair_capacity, contacts, sizeof *colours->pairs) &&
           array_reserve((void **)&colours->colour, &colours->colour_capacity, contacts, sizeof *colours->colour) &&
           array_reserve((void **)&colours->taken, &colours->taken_capacity, bodies, sizeof *colours->taken);
}

/* Returns how many there are. */
static int find_pairs(Colours *colours, const ContactProblem *problem) {
    int count = 0;
    for (int i = 0; i < problem->contact_count; i += contact_surface_points(problem, i)) colours->pairs[count++] = i;
    return count;
}

int colours_take(uint64_t *taken, const ContactProblem *problem, const ContactPoint *contact) {
    uint64_t *a = &taken[contact->a], *b = &taken[contact->b];
    const uint64_t open = ~(*a | *b);
    const int colour = open != 0 ? __builtin_ctzll(open) : COLOURS - 1;
    *a |= (uint64_t)problem_body_moves(&problem->bodies[contact->a]) << colour;
    *b |= (uint64_t)problem_body_moves(&problem->bodies[contact->b]) << colour;
    return colour;
}

/* points[colour + 1]: how many contacts have it. Returns how many colours there are. */
static int paint(Colours *colours, const ContactProblem *problem, int pairs, int points[COLOURS + 1]) {
    memset(colours->taken, 0, (size_t)problem->body_count * sizeof *colours->taken);
    int most = 0;
    for (int i = pairs - 1; i >= 0; i--) {
        const int colour = colours_take(colours->taken, problem, &problem->contacts[colours->pairs[i]]);
        colours->colour[i] = (uint8_t)colour;
        points[colour + 1] += contact_surface_points(problem, colours->pairs[i]);
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
        const int first = colours->pairs[i], points = contact_surface_points(problem, first);
        for (int k = 0; k < points; k++) colours->visits[begin[colours->colour[i]]++] = first + k;
    }
    return true;
}
