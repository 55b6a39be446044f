/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems as bytes: they come back bit by bit, and damaged ones are refused without reading past their end. */
#include "testing.h"

#include "runs/runs.h"

#include <math.h>

enum { BODIES = 3, CONTACTS = 3, ROOM = 1024 };

typedef struct Written {
    ProblemBody bodies[BODIES];
    ContactPoint contacts[CONTACTS];
    char bytes[ROOM];
    size_t size;
} Written;

static void write_problem(Written *written, int body_count, int contact_count, int bomb, float dt) {
    const ContactProblem problem = {body_count, contact_count, bomb, dt, written->bodies, written->contacts};
    FILE *out = fmemopen(written->bytes, ROOM, "wb");
    assert_non_null(out);
    problem_bytes_write(&problem, out);
    written->size = (size_t)ftell(out);
    assert_int_equal(fclose(out), 0);
}

static void make_problem(Written *written) {
    *written = (Written){.size = 0};
    for (int i = 0; i < BODIES; i++)
        written->bodies[i] = (ProblemBody){.position = {(float)i, 2}, .angle = 0.5f, .size = {1, 1}, .inv_mass = 3};
    const int pairs[CONTACTS][2] = {{0, 1}, {0, 1}, {1, 2}};
    for (int i = 0; i < CONTACTS; i++)
        written->contacts[i] =
            (ContactPoint){.a = pairs[i][0], .b = pairs[i][1], .bias = 0.25f, .feature = 0xfedcba98u, .warm_normal = 7};
    write_problem(written, BODIES, CONTACTS, 2, 0.01f);
}

/* Reads a copy that ends where its memory ends. */
static bool read_copy(const Written *written, size_t size, ContactProblem *problem, ProblemBytes *bytes, Error *error) {
    char *copy = malloc(size + (size == 0));
    assert_non_null(copy);
    memcpy(copy, written->bytes, size);
    *bytes = (ProblemBytes){copy, size, "piece"};
    *error = (Error){0};
    const bool ok = problem_bytes_read(problem, bytes, error);
    free(copy);
    return ok;
}

TEST(written_is_read) {
    Written written;
    ContactProblem problem;
    ProblemBytes bytes;
    make_problem(&written);
    assert_ok(read_copy(&written, written.size, &problem, &bytes, &error), error);
    assert_int_equal(bytes.left, 0);
    assert_int_equal(problem.body_count, BODIES);
    assert_int_equal(problem.contact_count, CONTACTS);
    assert_int_equal(problem.marked, 2);
    assert_true(problem.dt == 0.01f);
    assert_memory_equal(problem.bodies, written.bodies, sizeof written.bodies);
    assert_memory_equal(problem.contacts, written.contacts, sizeof written.contacts);
    problem_bytes_free(&problem);
}

TEST(cut_off_is_refused) {
    Written written;
    ContactProblem problem;
    ProblemBytes bytes;
    make_problem(&written);
    for (size_t size = 0; size < written.size; size++) {
        assert_refused(read_copy(&written, size, &problem, &bytes, &error), "piece: error: has damaged results");
        problem_bytes_free(&problem);
    }
}

static void refused(const Written *written) {
    Error error;
    ContactProblem problem;
    ProblemBytes bytes;
    assert_refused(read_copy(written, written->size, &problem, &bytes, &error), "piece: error: has damaged results");
    problem_bytes_free(&problem);
}

TEST(impossible_numbers_are_refused) {
    Written written;
    const struct {
        int bodies, contacts, bomb;
        float dt;
    } heads[] = {{0, 0, -1, 1},
                 {BODIES, CONTACTS, BODIES, 1},
                 {BODIES, CONTACTS, -2, 1},
                 {BODIES, CONTACTS, 0, 0},
                 {BODIES, CONTACTS, 0, NAN},
                 {2, CONTACTS, 0, 1}};
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        make_problem(&written);
        write_problem(&written, heads[i].bodies, heads[i].contacts, heads[i].bomb, heads[i].dt);
        refused(&written);
    }
    const int pairs[][2] = {{-1, 1}, {1, 1}, {2, 1}, {0, BODIES}, {0, 0}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        make_problem(&written);
        written.contacts[0].a = pairs[i][0];
        written.contacts[0].b = pairs[i][1];
        write_problem(&written, BODIES, CONTACTS, 2, 1);
        refused(&written);
    }
    make_problem(&written);
    written.contacts[2] = (ContactPoint){.a = 0, .b = 1};
    written.contacts[1] = (ContactPoint){.a = 1, .b = 2};
    write_problem(&written, BODIES, CONTACTS, 2, 1);
    refused(&written); /* pairs not sorted */
    make_problem(&written);
    written.bodies[1].velocity.y = INFINITY;
    write_problem(&written, BODIES, CONTACTS, 2, 1);
    refused(&written);
    make_problem(&written);
    written.contacts[1].warm_tangent = NAN;
    write_problem(&written, BODIES, CONTACTS, 2, 1);
    refused(&written);
}

RUN_TESTS(NULL, NULL)
