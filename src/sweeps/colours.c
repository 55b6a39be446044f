/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweeps/colours.h"

#include "common/array.h"
#include "sweeps/contact_velocity.h"

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
