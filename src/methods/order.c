/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of visits by colours (methods/sweeps.h). */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <stdlib.h>
#include <string.h>

void colours_free(Colours *colours) {
    free(colours->arrays.memory);
    *colours = (Colours){0};
}

static bool order_reserve(Colours *colours, size_t contacts, size_t bodies) {
    return ARRAY_BLOCK_RESERVE(&colours->arrays, ARRAY_PART(colours->visits, contacts),
                               ARRAY_PART(colours->pairs, contacts + 1), ARRAY_PART(colours->colour, contacts),
                               ARRAY_PART(colours->taken, bodies));
}

/* Returns their number. */
static int find_pairs(Colours *colours, const ContactProblem *problem) {
    int count = 0;
    for (int i = 0; i < problem->contact_count; i += contact_surface_points(problem, i)) colours->pairs[count++] = i;
    colours->pairs[count] = problem->contact_count;
    return count;
}

/* points[colour + 1]: the number of contacts of that colour. Returns the number of colours. */
static int order_paint(Colours *colours, const ContactProblem *problem, int pairs, int points[COLOURS + 1]) {
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
    if (!order_reserve(colours, (size_t)problem->contact_count, (size_t)problem->body_count)) return false;
    const int pairs = find_pairs(colours, problem);
    const int count = order_paint(colours, problem, pairs, begin);
    for (int i = 0; i < count; i++) begin[i + 1] += begin[i];
    for (int i = 0; i < pairs; i++) {
        int32_t *visit = &colours->visits[begin[colours->colour[i]]];
        begin[colours->colour[i]] += colours->pairs[i + 1] - colours->pairs[i];
        for (int first = colours->pairs[i]; first < colours->pairs[i + 1]; first++) *visit++ = first;
    }
    return true;
}
