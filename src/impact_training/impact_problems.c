/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/impact_problems.h"

#include "common/array.h"

#include <stdlib.h>
#include <string.h>

static void free_item(ImpactProblem *item) {
    free((void *)item->problem.bodies);
    free((void *)item->problem.contacts);
    free(item->reference);
}

void impact_problems_free(ImpactProblems *problems) {
    for (size_t i = 0; i < problems->count; i++) free_item(&problems->items[i]);
    free(problems->items);
    *problems = (ImpactProblems){0};
}

bool impact_problems_add(ImpactProblems *problems, const ContactProblem *problem, const ReferenceVelocity *reference,
                         bool impact) {
    if (!array_reserve((void **)&problems->items, &problems->capacity, problems->count + 1, sizeof *problems->items))
        return false;
    size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    ProblemBody *body_copy = malloc((bodies + 1) * sizeof *body_copy);
    ContactPoint *contact_copy = malloc((contacts + 1) * sizeof *contact_copy);
    ImpactProblem item = {*problem, malloc((bodies + 1) * sizeof *item.reference), impact};
    item.problem.bodies = body_copy;
    item.problem.contacts = contact_copy;
    problems->items[problems->count++] = item;
    if (body_copy == NULL || contact_copy == NULL || item.reference == NULL) return false;
    memcpy(body_copy, problem->bodies, bodies * sizeof *body_copy);
    memcpy(contact_copy, problem->contacts, contacts * sizeof *contact_copy);
    memcpy(item.reference, reference, bodies * sizeof *reference);
    return true;
}

bool impact_problems_move(ImpactProblems *problems, ImpactProblems *from) {
    const bool ok = array_reserve((void **)&problems->items, &problems->capacity, problems->count + from->count,
                                  sizeof *problems->items);
    if (ok && from->count > 0)
        memcpy(problems->items + problems->count, from->items, from->count * sizeof *from->items);
    if (ok) {
        problems->count += from->count;
        from->count = 0;
    }
    impact_problems_free(from);
    return ok;
}
