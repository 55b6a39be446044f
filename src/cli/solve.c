/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "dynamics/problem_file.h"
#include "reference/solution_error.h"
#include "simulate/method.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX_METHODS = 64 };

typedef struct Options {
    const char *path;
    const char *methods[MAX_METHODS];
    int method_count;
} Options;

static const Option option_table[] = {{"--method", 'm', "NAME[:KEY=VALUE,...]", "Method to score (may be repeated)",
                                       OPTION_TEXTS(Options, methods, method_count),
                                       .needed = "--method NAME is needed"},
                                      {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "P.npz", .needed = "a contact problem (.npz) is needed", OPTION_TEXT(Options, path)},
    .inputs = {1, 1, "problem"},
    .help =
        "Solve one contact problem with each method and score it against the converged solution: RMS error of the "
        "bodies' velocities (m/s, spin weighted by 1/sqrt 6), bodies whose velocity is right (within 0.05 m/s or 5% of "
        "the change made by the contacts), and the residual of the method's impulses: the largest change of a "
        "contact's velocity by one more sweep (m/s; a method without impulses counts as impulses of 0).\v"
        "Example: twinbox solve impact.npz --method engine:k=10 --method engine:k=100"};

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
    const ContactProblem *problem = &stored->problem;
    const Scene scene = {.iterations = 10, .accumulate_impulses = true};
    Reference truth = {0};
    ContactSolution solution = {calloc((size_t)problem->body_count, sizeof *solution.velocities),
                                calloc((size_t)problem->contact_count + 1, sizeof *solution.impulses),
                                0,
                                {0}};
    bool ok = solution.velocities != NULL && solution.impulses != NULL;
    if (!ok) error_memory(error, "solve");
    ok = ok && reference_solve(&truth, problem, NULL, error);
    if (ok) {
        printf("%s, step %d: %d bodies, %d contacts; reference: residual %.2g m/s after %d factorizations\n",
               stored->scene, stored->frame, problem->body_count, problem->contact_count, truth.residual,
               truth.factorizations);
        printf("%-40s %12s %12s %12s\n", "method", "error m/s", "right  ", "residual m/s");
    }
    for (int i = 0; ok && i < method_count; i++) ok = score(&methods[i], &scene, problem, &truth, &solution, error);
    free(solution.velocities);
    free(solution.impulses);
    reference_free(&truth);
    return ok;
}

bool command_solve(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    static Method methods[MAX_METHODS];
    for (int i = 0; i < options.method_count; i++)
        if (!method_parse(&methods[i], options.methods[i], error)) return false;
    StoredProblem *stored = problem_read(options.path, error);
    bool ok = stored != NULL && score_all(stored, methods, options.method_count, error);
    problem_destroy(stored);
    return ok;
}
