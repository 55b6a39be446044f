/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/problem_bytes.h"

#include "common/memory_stream.h"
#include "dynamics/problem_fields.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The same problem has the same bytes. */
static_assert(sizeof(ProblemBody) == 10 * sizeof(float), "no padding");
static_assert(sizeof(ContactPoint) == 18 * sizeof(float), "no padding");

typedef struct Head {
    int32_t bodies, contacts, bomb;
    float dt; /* s */
} Head;

bool problem_bytes_refuse(const ProblemBytes *bytes, Error *error) {
    return error_input(error, bytes->path, "has damaged results; delete it, and its shard does it again");
}

bool problem_bytes_take(ProblemBytes *bytes, void *items, size_t count, size_t size, Error *error) {
    if (count > bytes->left / size) return problem_bytes_refuse(bytes, error);
    if (count == 0) return true;
    memcpy(items, bytes->at, count * size);
    bytes->at += count * size;
    bytes->left -= count * size;
    return true;
}

void problem_bytes_write(const ContactProblem *problem, FILE *out) {
    const Head head = {problem->body_count, problem->contact_count, problem->marked, problem->dt};
    fwrite(&head, sizeof head, 1, out);
    stream_put(out, problem->bodies, sizeof *problem->bodies, (size_t)problem->body_count);
    stream_put(out, problem->contacts, sizeof *problem->contacts, (size_t)problem->contact_count);
}

static bool read_head(ContactProblem *problem, ProblemBytes *bytes, Error *error) {
    Head head;
    *problem = (ContactProblem){0};
    if (!problem_bytes_take(bytes, &head, 1, sizeof head, error)) return false;
    *problem = (ContactProblem){head.bodies, head.contacts, head.bomb, head.dt, NULL, NULL};
    return (head.bodies > 0 && head.bodies <= PROBLEM_MAX_BODIES && head.contacts >= 0 &&
            head.contacts <= PROBLEM_MAX_CONTACTS && head.bomb >= -1 && head.bomb < head.bodies && isfinite(head.dt) &&
            head.dt > 0) ||
           problem_bytes_refuse(bytes, error);
}

static bool is_finite(const ProblemField *fields, int field_count, const void *record) {
    bool finite = true;
    for (int f = 0; f < field_count; f++) {
        float numbers[2];
        memcpy(numbers, (const char *)record + fields[f].offset, (size_t)fields[f].count * sizeof *numbers);
        for (int k = 0; k < fields[f].count; k++) finite = finite && isfinite(numbers[k]);
    }
    return finite;
}

static bool is_possible(const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++)
        if (!is_finite(body_fields, BODY_FIELDS, &problem->bodies[i])) return false;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i], *last = contact - (i > 0);
        if (!is_finite(contact_fields, CONTACT_FIELDS, contact) || contact->a < 0 || contact->a >= contact->b ||
            contact->b >= problem->body_count || contact->a < last->a ||
            (contact->a == last->a && contact->b < last->b))
            return false;
    }
    return true;
}

/* Memory is taken only for what is there. */
bool problem_bytes_read(ContactProblem *problem, ProblemBytes *bytes, Error *error) {
    if (!read_head(problem, bytes, error)) return false;
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (bytes->left < bodies * sizeof(ProblemBody) + contacts * sizeof(ContactPoint))
        return problem_bytes_refuse(bytes, error);
    ProblemBody *body_items = malloc(bodies * sizeof *body_items);
    ContactPoint *contact_items = malloc((contacts + 1) * sizeof *contact_items);
    problem->bodies = body_items;
    problem->contacts = contact_items;
    if (body_items == NULL || contact_items == NULL) return error_memory(error, bytes->path);
    return problem_bytes_take(bytes, body_items, bodies, sizeof *body_items, error) &&
           problem_bytes_take(bytes, contact_items, contacts, sizeof *contact_items, error) &&
           (is_possible(problem) || problem_bytes_refuse(bytes, error));
}

void problem_bytes_free(ContactProblem *problem) {
    free((void *)problem->bodies);
    free((void *)problem->contacts);
    *problem = (ContactProblem){0};
}
