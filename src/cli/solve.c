/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "dynamics/problem_file.h"
#include "reference/solution_error.h"
#include "simulate/method.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX_METHODS = 64 };

static const struct argp_option option_table[] = {
    {"method", 'm', "NAME[:KEY=VALUE,...]", 0, "Method to score (may be repeated)", 0}, {0}};

typedef struct Options {
    const char *path;
    const char *methods[MAX_METHODS];
    int method_count;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'm':
        if (options->method_count == MAX_METHODS) argp_error(state, "at most %d methods", MAX_METHODS);
        options->methods[options->method_count++] = value;
        break;
    case ARGP_KEY_ARG:
        if (options->path != NULL) argp_error(state, "only one problem can be given (second: '%s')", value);
        options->path = value;
        break;
    case ARGP_KEY_END:
        if (options->path == NULL) argp_error(state, "a contact problem (.npz) is needed");
        if (options->method_count == 0) argp_error(state, "--method NAME is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "P.npz",
    "Solve one contact problem with each method and score it against the converged solution: RMS error of the bodies' "
    "velocities (m/s, spin weighted by 1/sqrt 6), bodies whose velocity is right (within 0.05 m/s or 5% of the change "
    "made by the contacts), and the residual of the method's impulses: the largest change of a contact's velocity by "
    "one more sweep (m/s; a method without impulses counts as impulses of 0).\v"
    "Example: twinbox solve impact.npz --method engine:k=10 --method engine:k=100",
    NULL,
    NULL,
    NULL};

static bool score(const Method *method, const Scene *scene, const ContactProblem *problem, const Reference *truth,
                  ContactSolution *solution, Error *error) {
    ContactSolver solver;
    Reference work = {0};
    double residual;
    if (!method_create_solver(method, scene, &solver, error)) return false;
    bool ok = solver.kind->solve(solver.state, problem, solution, error) &&
              reference_residual(&work, problem, solution->impulses, &residual, error);
    if (ok) {
        SolutionError found = solution_error(problem, solution->velocities, truth->velocities);
        printf("%-40s %12.4g %7d/%-4d %12.4g\n", method->text, found.rms, found.right, found.counted, residual);
    }
    reference_free(&work);
    solver.kind->destroy(solver.state);
    return ok;
}

static bool score_all(const StoredProblem *stored, const Method *methods, int method_count, Error *error) {
    /* For one problem: far more visits than a study may spend on each. */
    const double tolerance = 1e-8;
    const int max_visits = 10 * REFERENCE_MAX_VISITS;
    const ContactProblem *problem = &stored->problem;
    const Scene scene = {.iterations = 10, .accumulate_impulses = true};
    Reference truth = {0};
    ContactSolution solution = {calloc((size_t)problem->body_count, sizeof *solution.velocities),
                                calloc((size_t)problem->contact_count + 1, sizeof *solution.impulses),
                                0,
                                {0}};
    bool ok = solution.velocities != NULL && solution.impulses != NULL;
    if (!ok) error_memory(error, "solve");
    ok = ok && reference_solve(&truth, problem, tolerance, max_visits, NULL, error);
    if (ok) {
        printf("%s, step %d: %d bodies, %d contacts; reference: residual %.2g m/s after %d sweeps\n", stored->scene,
               stored->frame, problem->body_count, problem->contact_count, truth.residual, truth.sweeps);
        printf("%-40s %12s %12s %12s\n", "method", "error m/s", "right  ", "residual m/s");
    }
    for (int i = 0; ok && i < method_count; i++) ok = score(&methods[i], &scene, problem, &truth, &solution, error);
    free(solution.velocities);
    free(solution.impulses);
    reference_free(&truth);
    return ok;
}

int command_solve(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    static Method methods[MAX_METHODS];
    for (int i = 0; i < options.method_count; i++)
        if (!method_parse(&methods[i], options.methods[i], error)) return STATUS_DIFFERENT;
    StoredProblem *stored = problem_read(options.path, error);
    bool ok = stored != NULL && score_all(stored, methods, options.method_count, error);
    problem_destroy(stored);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
