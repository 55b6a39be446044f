/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Microseconds per step of 20 sweeps with momentum, in the order of colours and in the given order of contacts, and the
   velocity error of both: faster must not mean less accurate. Measured on the impact steps of the engine's runs, in the
   order of the steps, so that schedules are rebuilt as often as in a run. A sample is the mean over several passes over
   all steps; the orders take turns. */
#include "report.h"

#include "base/base.h"
#include "learning/scene_training.h"
#include "methods/momentum.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <stdlib.h>

enum { SCENES = 2, ORDERS = 2, SAMPLES = 31, SWEEPS = 20 };
enum { PASSES = 20 }; /* per sample: one pass takes less than a millisecond */

static const char *const scenes[SCENES] = {"stack", "pyramid_settled"};
static const char *const orders[ORDERS] = {"order of colours", "order given"};
static const double converged = 1e-3;            /* m/s: far below the residuals after the sweeps */
static const FloatRange bomb_x = {-4.5, 1.6, 6}; /* m: never 0, where a bomb on a stack is an exact tie */

typedef struct Ratios {
    double time, error; /* order of colours / order given */
} Ratios;

/* One order and its buffers. */
typedef struct Solver {
    int order;
    float factors[SWEEPS];
    Sweeps sweeps;
    ContactSolution solution;
} Solver;

typedef struct Recording {
    ImpactProblems problems;
    Reference reference;
    PhaseTracker tracker;
} Recording;

/* Leaves out the few problems whose reference does not converge. */
static bool observe(void *context, int frame, const World *world, Error *error) {
    Recording *recording = context;
    const ContactProblem *problem = world_problem(world);
    if (phase_next(&recording->tracker, problem, frame) != PHASE_IMPACT) return true;
    if (!reference_solve(&recording->reference, problem, NULL, error)) return false;
    return recording->reference.residual > converged ||
           impact_problems_add(&recording->problems, problem, recording->reference.velocities, true) ||
           error_memory(error, "recording");
}

/* The impact problems of the engine's runs, in the order of the steps. */
static ImpactProblems record(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s.yaml", SOURCE_DIR, name);
    Error error = {0};
    Method engine;
    Scene *scene = scene_read(path, &error);
    if (scene == NULL || !method_parse(&engine, "engine", &error)) give_up(error.message);
    Recording recording = {0};
    for (int i = 0; i < bomb_x.count; i++) {
        Scene launch = *scene;
        launch.bomb.x.value = range_value(&bomb_x, i);
        recording.tracker = (PhaseTracker){.impact_frames = scene->bomb.impact_frames};
        if (!simulate_observed(&launch, &engine, &(StepObserver){observe, &recording}, &error)) give_up(error.message);
    }
    scene_destroy(scene);
    reference_free(&recording.reference);
    return recording.problems;
}

static void solver_begin(Solver *solver, int order, const ImpactProblem *items, size_t count) {
    size_t bodies = 0, contacts = 0;
    for (size_t i = 0; i < count; i++) {
        const ContactProblem *problem = &items[i].problem;
        if ((size_t)problem->body_count > bodies) bodies = (size_t)problem->body_count;
        if ((size_t)problem->contact_count > contacts) contacts = (size_t)problem->contact_count;
    }
    *solver = (Solver){.order = order};
    for (int s = 0; s < SWEEPS; s++) solver->factors[s] = momentum_factor_tuned(s, SWEEPS);
    solver->solution.velocities = malloc(bodies * sizeof *solver->solution.velocities);
    solver->solution.impulses = malloc(contacts * sizeof *solver->solution.impulses);
    if (solver->solution.velocities == NULL || solver->solution.impulses == NULL) give_up("out of memory");
}

static void solver_end(Solver *solver) {
    sweeps_free(&solver->sweeps);
    free(solver->solution.velocities);
    free(solver->solution.impulses);
}

static void solve(Solver *solver, const ContactProblem *problem) {
    Sweeps *sweeps = &solver->sweeps;
    const SweepKernel kernel = sweeps_best_kernel();
    bool ok = solver->order == 0 ? sweeps_begin_coloured(sweeps, kernel, problem)
                                 : sweeps_begin(sweeps, kernel, problem, true);
    if (!ok || !sweeps_run_momentum(sweeps, solver->factors, SWEEPS)) give_up("out of memory");
    if (!sweeps_end(sweeps, &solver->solution)) give_up("a velocity is not finite");
}

static double microseconds_a_step(Solver *solver, const ImpactProblem *items, size_t count) {
    double start = processor_seconds();
    for (int pass = 0; pass < PASSES; pass++)
        for (size_t i = 0; i < count; i++) solve(solver, &items[i].problem);
    return 1e6 * (processor_seconds() - start) / (double)count / PASSES;
}

static double mean_error(Solver *solver, const ImpactProblem *items, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        solve(solver, &items[i].problem);
        sum += solution_error(&items[i].problem, solver->solution.velocities, items[i].reference).rms;
    }
    return sum / (double)count;
}

static Ratios measure(const char *name) {
    ImpactProblems problems = record(name);
    Solver solvers[ORDERS];
    Samples errors[ORDERS] = {0}, times[ORDERS] = {0}, ratios = {0};
    for (int k = 0; k < ORDERS; k++) {
        solver_begin(&solvers[k], k, problems.items, problems.count);
        samples_add(&errors[k], mean_error(&solvers[k], problems.items, problems.count));
    }
    for (int i = 0; i < SAMPLES; i++) {
        for (int k = 0; k < ORDERS; k++)
            samples_add(&times[k], microseconds_a_step(&solvers[k], problems.items, problems.count));
        samples_add(&ratios, times[0].values[i] / times[1].values[i]);
    }
    char figure[64];
    for (int k = 0; k < ORDERS; k++) report_line("colours", orders[k], name, "us/step", &times[k]);
    snprintf(figure, sizeof figure, "%s mean velocity error", name);
    for (int k = 0; k < ORDERS; k++) report_line("colours", orders[k], figure, "m/s", &errors[k]);
    for (int k = 0; k < ORDERS; k++) solver_end(&solvers[k]);
    impact_problems_free(&problems);
    return (Ratios){samples_median(&ratios), errors[0].values[0] / errors[1].values[0]};
}

int main(void) {
    Ratios ratios[SCENES];
    report_header();
    for (int i = 0; i < SCENES; i++) ratios[i] = measure(scenes[i]);
    for (int i = 0; i < SCENES; i++) {
        char name[64];
        snprintf(name, sizeof name, "colours %s, time / order given", scenes[i]);
        report_target(name, ratios[i].time, "at most", 0.8);
        snprintf(name, sizeof name, "colours %s, error / order given", scenes[i]);
        report_target(name, ratios[i].error, "at most", 1.05);
    }
    return 0;
}
