/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/json.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX_METHODS = 64 };

typedef struct Options {
    const char *path;
    const char *methods[MAX_METHODS];
    int method_count;
    bool json;
} Options;

static const Option option_table[] = {{"--method", 'm', "NAME[:KEY=VALUE,...]", "Method to score (may be repeated)",
                                       OPTION_TEXTS(Options, methods, method_count),
                                       .needed = "--method NAME is needed"},
                                      {OPTION_JSON(Options, json)},
                                      {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "P.npz", .needed = "a contact problem (.npz) is needed", OPTION_PATH(Options, path)},
    .inputs = {1, 1, "problem"},
    .help =
        "Solve one contact problem with each method and score it against the converged solution: RMS error of the "
        "bodies' velocities (m/s, spin weighted by 1/sqrt 6), bodies whose velocity is right (within 0.05 m/s or 5% of "
        "the change made by the contacts), and the residual of the method's impulses: the largest change of a "
        "contact's velocity by one more sweep (m/s; a method without impulses counts as impulses of 0).\v"
        "Example: twinbox solve impact.npz --method engine:k=10 --method engine:k=100"};

typedef struct Score {
    SolutionError error;
    double residual; /* m/s */
} Score;

typedef struct Result {
    const StoredProblem *stored;
    const Method *methods;
    int method_count;
    Reference truth;
    Score scores[MAX_METHODS];
} Result;

static bool score(const Result *result, const Method *method, ContactSolution *solution, Score *score, Error *error) {
    const Scene scene = {.iterations = 10, .accumulate_impulses = true};
    const ContactProblem *problem = &result->stored->problem;
    ContactSolver solver;
    Reference work = {0};
    if (!method_create_solver(method, &scene, &solver, error)) return false;
    bool ok = solver.kind->solve(solver.state, problem, solution, error) &&
              reference_residual(&work, problem, solution->impulses, &score->residual, error);
    if (ok) score->error = solution_error(problem, solution->velocities, result->truth.velocities);
    reference_free(&work);
    solver.kind->destroy(solver.state);
    return ok;
}

static bool score_all(Result *result, Error *error) {
    const ContactProblem *problem = &result->stored->problem;
    ContactSolution solution = {calloc((size_t)problem->body_count, sizeof *solution.velocities),
                                calloc((size_t)problem->contact_count + 1, sizeof *solution.impulses),
                                0,
                                {0}};
    bool ok = solution.velocities != NULL && solution.impulses != NULL;
    if (!ok) error_memory(error, "solve");
    ok = ok && reference_solve(&result->truth, problem, NULL, error);
    for (int i = 0; ok && i < result->method_count; i++)
        ok = score(result, &result->methods[i], &solution, &result->scores[i], error);
    free(solution.velocities);
    free(solution.impulses);
    return ok;
}

static void print(const Result *result) {
    const StoredProblem *stored = result->stored;
    printf("%s, step %d: %d bodies, %d contacts; reference: residual %.2g m/s after %d factorizations\n", stored->scene,
           stored->frame, stored->problem.body_count, stored->problem.contact_count, result->truth.residual,
           result->truth.factorizations);
    printf("%-40s %12s %12s %12s\n", "method", "error m/s", "right  ", "residual m/s");
    for (int i = 0; i < result->method_count; i++) {
        const Score *row = &result->scores[i];
        printf("%-40s %12.4g %7d/%-4d %12.4g\n", result->methods[i].text, row->error.rms, row->error.right,
               row->error.counted, row->residual);
    }
}

static void write_result(JsonWriter *json, const void *context) {
    const Result *result = context;
    json_put_text(json, "scene", result->stored->scene);
    json_put_int(json, "step", result->stored->frame);
    json_put_int(json, "bodies", result->stored->problem.body_count);
    json_put_int(json, "contacts", result->stored->problem.contact_count);
    json_begin_object(json, "reference", JSON_ONE_LINE);
    json_put_number(json, "residual", result->truth.residual);
    json_put_int(json, "factorizations", result->truth.factorizations);
    json_end(json);
    json_begin_array(json, "methods", JSON_LINES);
    for (int i = 0; i < result->method_count; i++) {
        const Score *row = &result->scores[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "method", result->methods[i].text);
        json_put_number(json, "error", row->error.rms);
        json_put_int(json, "right", row->error.right);
        json_put_int(json, "counted", row->error.counted);
        json_put_number(json, "residual", row->residual);
        json_end(json);
    }
    json_end(json);
}

bool command_solve(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    static Method methods[MAX_METHODS];
    for (int i = 0; i < options.method_count; i++)
        if (!method_parse(&methods[i], options.methods[i], error)) return false;
    StoredProblem *stored = problem_read(options.path, error);
    Result result = {.stored = stored, .methods = methods, .method_count = options.method_count};
    bool ok = stored != NULL && score_all(&result, error);
    if (ok && options.json)
        ok = json_output("twinbox solve 1", write_result, &result, error);
    else if (ok)
        print(&result);
    reference_free(&result.truth);
    problem_destroy(stored);
    return ok;
}
