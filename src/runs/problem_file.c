/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads and writes contact problems. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "runs/problem_file.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PROBLEM_KIND "contact problem"

/* An array of `count` floats per body or contact, and their offset in its struct. */
typedef struct ProblemField {
    const char *name;
    size_t offset;
    int count;
} ProblemField;

enum { BODY_FIELDS = 7, CONTACT_FIELDS = 9 };

static const ProblemField body_fields[BODY_FIELDS] = {
    {"position", offsetof(ProblemBody, position), 2},
    {"angle", offsetof(ProblemBody, angle), 1},
    {"size", offsetof(ProblemBody, size), 2},
    {"inv_mass", offsetof(ProblemBody, inv_mass), 1},
    {"inv_inertia", offsetof(ProblemBody, inv_inertia), 1},
    {"velocity", offsetof(ProblemBody, velocity), 2},
    {"angular_velocity", offsetof(ProblemBody, angular_velocity), 1},
};

static const ProblemField contact_fields[CONTACT_FIELDS] = {
    {"contact_position", offsetof(ContactPoint, position), 2},
    {"contact_normal", offsetof(ContactPoint, normal), 2},
    {"contact_arm_a", offsetof(ContactPoint, arm_a), 2},
    {"contact_arm_b", offsetof(ContactPoint, arm_b), 2},
    {"contact_separation", offsetof(ContactPoint, separation), 1},
    {"contact_mass", offsetof(ContactPoint, mass_normal), 2},
    {"contact_friction", offsetof(ContactPoint, friction), 1},
    {"contact_bias", offsetof(ContactPoint, bias), 1},
    {"contact_warm", offsetof(ContactPoint, warm_normal), 2},
};

/* Reads contact problems from untrusted files. */

static bool read_file_head(StoredProblem *stored, NpzFile *file, const char *path, Error *error) {
    int32_t frame, bomb;
    float dt, fall = 0;
    if (!npz_check_kind(file, PROBLEM_KIND, PROBLEM_VERSION, error) ||
        !npz_read_name(file, "scene", stored->scene, sizeof stored->scene, error) ||
        !npz_read_scalar(file, "frame", NPZ_INT32, &frame, sizeof frame, error) ||
        !npz_read_scalar(file, "dt", NPZ_FLOAT32, &dt, sizeof dt, error) ||
        !npz_read_scalar(file, "bomb", NPZ_INT32, &bomb, sizeof bomb, error) ||
        (npz_has(file, "fall") && !npz_read_scalar(file, "fall", NPZ_FLOAT32, &fall, sizeof fall, error)))
        return false;
    if (frame < 1) return error_input(error, path, "frame must be at least 1 (got %d)", (int)frame);
    if (!isfinite(dt) || !(dt > 0))
        return error_input(error, path, "dt must be finite and greater than 0 (got %g)", (double)dt);
    if (!isfinite(fall) || fall < 0)
        return error_input(error, path, "fall must be finite and not negative (got %g)", (double)fall);
    stored->frame = frame;
    stored->problem.dt = dt;
    stored->problem.fall = fall;
    stored->problem.bomb = bomb;
    return true;
}

static bool expect_fields(const NpzFile *file, const ProblemField *fields, int field_count, int64_t count,
                          Error *error) {
    for (int f = 0; f < field_count; f++) {
        const NpzArray array = {
            fields[f].name, NPZ_FLOAT32, fields[f].count > 1 ? 2 : 1, {count, fields[f].count}, NULL};
        if (!npz_expect(file, &array, 1, error)) return false;
    }
    return true;
}

static bool read_counts(StoredProblem *stored, NpzFile *file, const char *path, Error *error) {
    int64_t bodies, contacts[2];
    if (!npz_shape(file, "angle", NPZ_FLOAT32, 1, &bodies, error) ||
        !npz_shape(file, "contact_bodies", NPZ_INT32, 2, contacts, error))
        return false;
    if (bodies < 1 || bodies > PROBLEM_MAX_BODIES)
        return error_input(error, path, "%lld bodies; expected 1 to %d", (long long)bodies, PROBLEM_MAX_BODIES);
    if (contacts[0] > PROBLEM_MAX_CONTACTS)
        return error_input(error, path, "%lld contacts; expected at most %d", (long long)contacts[0],
                           PROBLEM_MAX_CONTACTS);
    ContactProblem *problem = &stored->problem;
    problem->body_count = (int)bodies;
    problem->contact_count = (int)contacts[0];
    if (problem->bomb < -1 || problem->bomb >= problem->body_count)
        return error_input(error, path, "the bomb is body %d of %d", problem->bomb, problem->body_count);
    const NpzArray heads[] = {{"contact_bodies", NPZ_INT32, 2, {contacts[0], 2}, NULL},
                              {"contact_feature", NPZ_UINT32, 1, {contacts[0]}, NULL}};
    if (!expect_fields(file, body_fields, BODY_FIELDS, bodies, error) ||
        !expect_fields(file, contact_fields, CONTACT_FIELDS, contacts[0], error) || !npz_expect(file, heads, 2, error))
        return false;
    problem->bodies = stored->bodies = calloc((size_t)bodies, sizeof *stored->bodies);
    problem->contacts = stored->contacts = calloc((size_t)contacts[0] + 1, sizeof *stored->contacts);
    return (stored->bodies != NULL && stored->contacts != NULL) || error_memory(error, path);
}

/* Reads one array of floats into the structs. */
static bool read_field(NpzFile *file, const char *path, const ProblemField *field, void *records, size_t record_size,
                       int count, Error *error) {
    const int64_t shape[] = {count, field->count};
    float *numbers = npz_read(file, field->name, NPZ_FLOAT32, field->count > 1 ? 2 : 1, shape, error);
    if (numbers == NULL) return false;
    int bad = -1;
    for (int i = count - 1; i >= 0; i--) {
        const float *from = numbers + (size_t)i * (size_t)field->count;
        for (int k = 0; k < field->count; k++)
            if (!isfinite(from[k])) bad = i;
        memcpy((char *)records + (size_t)i * record_size + field->offset, from, (size_t)field->count * sizeof *from);
    }
    free(numbers);
    return bad < 0 || error_input(error, path, "%s[%d] is not finite", field->name, bad);
}

static bool read_arrays(StoredProblem *stored, NpzFile *file, const char *path, Error *error) {
    for (int f = 0; f < BODY_FIELDS; f++)
        if (!read_field(file, path, &body_fields[f], stored->bodies, sizeof *stored->bodies, stored->problem.body_count,
                        error))
            return false;
    for (int f = 0; f < CONTACT_FIELDS; f++)
        if (!read_field(file, path, &contact_fields[f], stored->contacts, sizeof *stored->contacts,
                        stored->problem.contact_count, error))
            return false;
    const int64_t shape[] = {stored->problem.contact_count, 2};
    int32_t(*pairs)[2] = npz_read(file, "contact_bodies", NPZ_INT32, 2, shape, error);
    uint32_t *features = pairs != NULL ? npz_read(file, "contact_feature", NPZ_UINT32, 1, shape, error) : NULL;
    for (int i = 0; features != NULL && i < stored->problem.contact_count; i++) {
        stored->contacts[i].a = pairs[i][0];
        stored->contacts[i].b = pairs[i][1];
        stored->contacts[i].feature = features[i];
    }
    free(pairs);
    bool done = features != NULL;
    free(features);
    return done;
}

static bool check(const StoredProblem *stored, const char *path, Error *error) {
    const float unit_tolerance = 1e-3f; /* far above the rounding error of a rotation's column */
    for (int i = 0; i < stored->problem.body_count; i++) {
        const ProblemBody *body = &stored->bodies[i];
        if (!(body->size.x > 0) || !(body->size.y > 0))
            return error_input(error, path, "body %d: its size must be greater than 0 (got %g x %g)", i,
                               (double)body->size.x, (double)body->size.y);
        if (body->inv_mass < 0 || body->inv_inertia < 0 || (body->inv_mass > 0) != (body->inv_inertia > 0))
            return error_input(error, path, "body %d: inverse mass and inertia must both be greater than 0, or both 0",
                               i);
    }
    for (int i = 0; i < stored->problem.contact_count; i++) {
        const ContactPoint *contact = &stored->contacts[i], *last = contact - 1;
        if (contact->a < 0 || contact->a >= contact->b || contact->b >= stored->problem.body_count)
            return error_input(error, path, "contact %d: bodies %d and %d are not a valid pair", i, contact->a,
                               contact->b);
        if (stored->bodies[contact->a].inv_mass + stored->bodies[contact->b].inv_mass == 0.0f)
            return error_input(error, path, "contact %d: bodies %d and %d are both static", i, contact->a, contact->b);
        if (i > 0 && (contact->a < last->a || (contact->a == last->a && contact->b < last->b)))
            return error_input(error, path, "contact %d: pairs are not sorted", i);
        if (!(fabsf(vec2_dot(contact->normal, contact->normal) - 1.0f) <= unit_tolerance))
            return error_input(error, path, "contact %d: its normal is not of unit length", i);
        if (!(contact->mass_normal > 0) || !(contact->mass_tangent > 0))
            return error_input(error, path, "contact %d: its effective masses must be greater than 0", i);
        if (contact->friction < 0) return error_input(error, path, "contact %d: friction must not be negative", i);
    }
    return true;
}

void problem_destroy(StoredProblem *stored) {
    if (stored == NULL) return;
    free(stored->bodies);
    free(stored->contacts);
    free(stored);
}

StoredProblem *problem_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    StoredProblem *stored = calloc(1, sizeof *stored);
    bool done = stored != NULL || error_memory(error, path);
    done = done && read_file_head(stored, file, path, error) && read_counts(stored, file, path, error) &&
           read_arrays(stored, file, path, error) && check(stored, path, error);
    npz_close(file);
    if (done) return stored;
    problem_destroy(stored);
    return NULL;
}

enum { HEAD_ARRAYS = 9, ARRAYS = HEAD_ARRAYS + BODY_FIELDS + CONTACT_FIELDS };

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

bool problem_write(const ContactProblem *problem, const char *scene, int frame, const char *path, Error *error) {
    int32_t version = PROBLEM_VERSION, frame_number = frame, bomb = problem->bomb;
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
            {"fall", NPZ_FLOAT32, 0, {0}, &problem->fall},
            {"bomb", NPZ_INT32, 0, {0}, &bomb},
            {"contact_bodies", NPZ_INT32, 2, {problem->contact_count, 2}, pairs},
            {"contact_feature", NPZ_UINT32, 1, {problem->contact_count}, features},
        };
        for (int i = 0; i < problem->contact_count; i++) {
            pairs[i][0] = problem->contacts[i].a;
            pairs[i][1] = problem->contacts[i].b;
            features[i] = problem->contacts[i].feature;
        }
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
