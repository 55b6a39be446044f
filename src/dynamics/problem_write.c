/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/problem_fields.h"
#include "npz/npz.h"

#include <stdlib.h>
#include <string.h>

enum { HEAD_ARRAYS = 8, ARRAYS = HEAD_ARRAYS + BODY_FIELDS + CONTACT_FIELDS };

/* Fills the arrays of these fields, in sequence in `numbers`; returns the end. */
static float *split_records(NpzArray *arrays, const ProblemField *fields, int field_count, const void *records,
                            size_t record_size, int count, float *numbers) {
    for (int f = 0; f < field_count; f++) {
        const ProblemField *field = &fields[f];
        arrays[f] = (NpzArray){field->name, NPZ_FLOAT32, field->count > 1 ? 2 : 1, {count, field->count}, numbers};
        for (int i = 0; i < count; i++) {
            memcpy(numbers, (const char *)records + (size_t)i * record_size + field->offset,
                   (size_t)field->count * sizeof *numbers);
            numbers += field->count;
        }
    }
    return numbers;
}

static void split_contact_heads(const ContactProblem *problem, int32_t (*pairs)[2], uint32_t *features) {
    for (int i = 0; i < problem->contact_count; i++) {
        pairs[i][0] = problem->contacts[i].a;
        pairs[i][1] = problem->contacts[i].b;
        features[i] = problem->contacts[i].feature;
    }
}

bool problem_write(const ContactProblem *problem, const char *scene, int frame, const char *path, Error *error) {
    int32_t version = PROBLEM_VERSION, frame_number = frame, bomb = problem->marked;
    size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    int32_t(*pairs)[2] = calloc(contacts + 1, sizeof *pairs);
    uint32_t *features = calloc(contacts + 1, sizeof *features);
    /* The size of the structs bounds the number of floats in them. */
    float *numbers = malloc(bodies * sizeof *problem->bodies + (contacts + 1) * sizeof *problem->contacts);
    bool done = pairs != NULL && features != NULL && numbers != NULL;
    if (done) {
        NpzArray arrays[ARRAYS] = {
            {"kind", NPZ_TEXT, 0, {0}, PROBLEM_KIND},
            {"version", NPZ_INT32, 0, {0}, &version},
            {"scene", NPZ_TEXT, 0, {0}, scene},
            {"frame", NPZ_INT32, 0, {0}, &frame_number},
            {"dt", NPZ_FLOAT32, 0, {0}, &problem->dt},
            {"bomb", NPZ_INT32, 0, {0}, &bomb},
            {"contact_bodies", NPZ_INT32, 2, {problem->contact_count, 2}, pairs},
            {"contact_feature", NPZ_UINT32, 1, {problem->contact_count}, features},
        };
        split_contact_heads(problem, pairs, features);
        float *rest = split_records(arrays + HEAD_ARRAYS, body_fields, BODY_FIELDS, problem->bodies,
                                    sizeof *problem->bodies, problem->body_count, numbers);
        split_records(arrays + HEAD_ARRAYS + BODY_FIELDS, contact_fields, CONTACT_FIELDS, problem->contacts,
                      sizeof *problem->contacts, problem->contact_count, rest);
        done = npz_write(path, arrays, ARRAYS, error);
    } else {
        error_memory(error, path);
    }
    free(pairs);
    free(features);
    free(numbers);
    return done;
}
