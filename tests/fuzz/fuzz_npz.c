/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers of .npz: runs (of twinbox and of others), datasets, contact problems; and the archive itself. */
#include "fuzz.h"

#include "learning/dataset.h"
#include "runs/problem_file.h"
#include "runs/trajectory.h"
#include "fuzz_archive.h"
#include "base/npz.h"
#include "methods/methods.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The archive as it is; every array by every type. */
void fuzz_zip(const uint8_t *data, size_t size) {
    Error error = {0};
    const char *path = fuzz_file("input.npz", data, size);
    NpzFile *file = FUZZ_READ(npz_open(path, &error), path);
    if (file == NULL) return;
    if (npz_name(file, 0) == NULL) fuzz_fail("no array, and no error");
    for (size_t i = 0; npz_name(file, i) != NULL; i++) {
        char text[64];
        const NpzType type = (NpzType)(i % NPZ_INT8);
        const char *name = npz_name(file, i);
        for (int rank = 0; rank <= NPZ_MAX_RANK; rank++) {
            int64_t shape[NPZ_MAX_RANK];
            error = (Error){0};
            const bool fits = npz_shape(file, name, type, rank, shape, &error);
            void *values = fits ? npz_read(file, name, type, rank, shape, &error) : NULL;
            if (error.kind == ERROR_SYSTEM) fuzz_fail("%s", error.message);
            free(values);
        }
        error = (Error){0};
        const bool read = npz_read_text(file, name, text, sizeof text, &error);
        if (read ? memchr(text, '\0', sizeof text) == NULL : error.kind != ERROR_INPUT) fuzz_fail("%s", error.message);
        npz_convert(file);
    }
    npz_close(file);
}

/* States of a run must be finite where its body exists: everything draws them. */
static void check_states(const Trajectory *run) {
    for (int frame = 0; frame < run->frames; frame++)
        for (int body = 0; body < run->bodies; body++) {
            const size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
            if (trajectory_has(run, frame, body) &&
                !(isfinite(run->position[i].x) && isfinite(run->position[i].y) && isfinite(run->angle[i])))
                fuzz_fail("frame %d: body %d is at no place", frame, body);
        }
    for (int64_t i = 0; i < run->contact_start[run->frames]; i++)
        if (run->contacts[i].a < 0 || run->contacts[i].a >= run->contacts[i].b || run->contacts[i].b >= run->bodies)
            fuzz_fail("contact %lld of bodies %d and %d", (long long)i, run->contacts[i].a, run->contacts[i].b);
}

/* What was read can be written, and gives the same states and verdict. */
static void check_run(const Trajectory *run) {
    Error error = {0};
    const char *path = fuzz_file("again.npz", "", 0);
    check_states(run);
    if (!trajectory_write(run, path, &error)) fuzz_fail("a run cannot be written: %s", error.message);
    Trajectory *again = trajectory_read(path, &error);
    if (again == NULL) fuzz_fail("a run that was read is lost: %s", error.message);
    if (again->frames != run->frames || again->bodies != run->bodies) fuzz_fail("the size of a run changes");
    for (int frame = 0; frame < run->frames; frame++)
        if (trajectory_frame_hash(again, frame) != trajectory_frame_hash(run, frame))
            fuzz_fail("frame %d changes", frame);
    if (strcmp(again->verdict, run->verdict) != 0 || again->verdict_frame >= run->frames ||
        again->verdict_body >= run->bodies)
        fuzz_fail("the verdict '%s' is lost", run->verdict);
    trajectory_destroy(again);
}

void fuzz_run(const uint8_t *data, size_t size) {
    Error error = {0};
    const char *path = fuzz_archive(data, size);
    Trajectory *run = FUZZ_READ(trajectory_read(path, &error), path);
    if (run != NULL) check_run(run);
    trajectory_destroy(run);
}

void fuzz_dataset(const uint8_t *data, size_t size) {
    Error error = {0};
    const char *path = fuzz_archive(data, size);
    Dataset *dataset = FUZZ_READ(dataset_read(path, &error), path);
    for (int64_t row = 0; dataset != NULL && row < dataset->rows; row++) {
        const int launch = dataset->launch[row];
        if (launch < 0 || launch >= dataset->launches || dataset->launch_scene[launch] < 0 ||
            dataset->launch_scene[launch] >= dataset->scene_count)
            fuzz_fail("row %lld is of no launch or scene", (long long)row);
        dataset_is_test(dataset, row);
    }
    dataset_destroy(dataset);
}

/* Solves it: whatever is accepted must be safe to compute with. */
static void solve(const ContactProblem *problem, const char *text) {
    const Scene scene = {.name = "fuzz", .iterations = 2, .accumulate_impulses = true};
    Error error = {0};
    Method method;
    ContactSolver solver;
    ContactSolution solution = {.velocities = calloc((size_t)problem->body_count + 1, sizeof *solution.velocities),
                                .impulses = calloc((size_t)problem->contact_count + 1, sizeof *solution.impulses)};
    if (!method_parse(&method, text, &error) || !method_create_solver(&method, &scene, &solver, &error))
        fuzz_fail("%s", error.message);
    if (!solver.kind->solve(solver.state, problem, &solution, &error) && error.kind == ERROR_SYSTEM)
        fuzz_fail("%s", error.message);
    solver.kind->destroy(solver.state);
    free(solution.velocities);
    free(solution.impulses);
}

void fuzz_problem(const uint8_t *data, size_t size) {
    Error error = {0};
    const char *path = fuzz_archive(data, size);
    StoredProblem *stored = FUZZ_READ(problem_read(path, &error), path);
    if (stored != NULL) {
        solve(&stored->problem, "engine:k=2");
        solve(&stored->problem, "interior");
    }
    problem_destroy(stored);
}
