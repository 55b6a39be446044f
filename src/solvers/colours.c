/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/colours.h"

#include "common/array.h"
#include "solvers/contact_velocity.h"

#include <stdlib.h>
#include <string.h>

enum { COLOURS = 64 }; /* what finds none of them free takes the last: it commutes no more, but has its place */

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

static int points_of(const ContactProblem *problem, int first) {
    const ContactPoint *contact = &problem->contacts[first];
    return first + 1 < problem->contact_count && contact_shares_surface(contact, contact + 1) ? 2 : 1;
}

/* Returns how many there are. */
static int find_pairs(Colours *colours, const ContactProblem *problem) {
    int count = 0;
    for (int i = 0; i < problem->contact_count; i += points_of(problem, i)) colours->pairs[count++] = i;
    return count;
}

static uint64_t all_if(bool yes) { return yes ? UINT64_MAX : 0; }

static bool moves(const ProblemBody *body) { return body->inv_mass != 0 || body->inv_inertia != 0; }

/* points[colour + 1]: how many contacts have it. Returns how many colours there are. */
static int paint(Colours *colours, const ContactProblem *problem, int pairs, int points[COLOURS + 1]) {
    memset(colours->taken, 0, (size_t)problem->body_count * sizeof *colours->taken);
    int most = 0;
    for (int i = pairs - 1; i >= 0; i--) {
        const ContactPoint *contact = &problem->contacts[colours->pairs[i]];
        uint64_t *a = &colours->taken[contact->a], *b = &colours->taken[contact->b];
        const uint64_t open = ~(*a | *b);
        const int colour = open != 0 ? __builtin_ctzll(open) : COLOURS - 1;
        *a |= 1ULL << colour & all_if(moves(&problem->bodies[contact->a]));
        *b |= 1ULL << colour & all_if(moves(&problem->bodies[contact->b]));
        colours->colour[i] = (uint8_t)colour;
        points[colour + 1] += points_of(problem, colours->pairs[i]);
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
        const int first = colours->pairs[i], points = points_of(problem, first);
        for (int k = 0; k < points; k++) colours->visits[begin[colours->colour[i]]++] = first + k;
    }
    return true;
}
