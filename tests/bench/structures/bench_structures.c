/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds of the reference, and of interior, in the steps of random structures: those that tests/deep/run structures
   counts, the first 64 of each kind. The reference runs them, and interior solves the same problems. A sample is the mean
   over the steps of a structure. */
#include "random_structures.h"
#include "report.h"

#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"

#include <string.h>

enum { KINDS = sizeof structure_kinds / sizeof *structure_kinds, EACH = SAMPLES_MAX };

/* A structure that is run. */
typedef struct Run {
    Reference reference;
    void *interior;
    PairMoment space;                 /* of interior's solution */
    double by_reference, by_interior; /* s */
    int steps, converged;
} Run;

/* Of a kind. */
typedef struct Kind {
    Samples reference, interior;
    int steps, converged;
} Kind;

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Run *run = state;
    if (!pair_moment_reserve(&run->space, problem)) return error_memory(error, "structures");
    ContactSolution found = pair_moment_solution(&run->space);
    const double start = processor_seconds();
    if (!solver_interior.solve(run->interior, problem, &found, error)) return false;
    const double middle = processor_seconds();
    if (!reference_solve(&run->reference, problem, NULL, error)) return false;
    run->by_reference += processor_seconds() - middle;
    run->by_interior += middle - start;
    run->steps++;
    run->converged += reference_converged(&run->reference);
    reference_round(&run->reference, problem, solution);
    return true;
}

static void measure(const Scene *scene, Kind *kind) {
    Error error = {0};
    Settings settings;
    Run run = {.steps = 0};
    World *world = scene_world(scene, &error);
    if (world == NULL || !settings_parse(&settings, "", solver_interior.description.settings, "interior", &error) ||
        (run.interior = solver_interior.create(&settings, &error)) == NULL)
        give_up(error.message);
    for (int frame = 1; frame <= scene->frames; frame++)
        if (!world_step(world, solve, &run, scene->dt, &error)) give_up(error.message);
    samples_add(&kind->reference, 1e6 * run.by_reference / run.steps);
    samples_add(&kind->interior, 1e6 * run.by_interior / run.steps);
    kind->steps += run.steps;
    kind->converged += run.converged;
    solver_interior.destroy(run.interior);
    reference_free(&run.reference);
    pair_moment_free(&run.space);
    world_destroy(world);
}

static int kind_of(const Scene *scene) {
    int kind = 0;
    while (strncmp(scene->name, structure_kinds[kind].name, strlen(structure_kinds[kind].name)) != 0) kind++;
    return kind;
}

int main(void) {
    static Kind kinds[KINDS];
    for (int seed = 0; seed < STRUCTURES; seed++) {
        Scene *scene = random_structure(seed);
        Kind *kind = &kinds[kind_of(scene)];
        if (kind->reference.count < EACH) measure(scene, kind);
        scene_destroy(scene);
    }
    report_header();
    for (int i = 0; i < KINDS; i++) {
        const char *name = structure_kinds[i].name;
        report_line("structures", "reference", name, "us/step", &kinds[i].reference);
        report_line("structures", "interior", name, "us/step", &kinds[i].interior);
        Samples share = {0};
        samples_add(&share, (double)kinds[i].converged / kinds[i].steps);
        report_line("structures", "reference", name, "converged/steps", &share);
    }
    return 0;
}
