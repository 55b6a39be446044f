/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Another program solves the contact problem of each step: a solver or a network of others behind an adapter of some
   lines (scenes/engines/README.md).

   The program gets bodies and contacts of the step, and answers with impulses. They are taken as they are, also where
   they pull or leave the friction cone: scores tell. The velocities that follow conserve momentum whatever it answers.
   A step without contacts asks nothing.

   Fails where the program does: it ends, is silent for too long, or answers what cannot be. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/adapter.h"
#include "methods/methods.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct ExecSolver {
    float step_limit; /* s */
    Settings settings;
    char where[METHOD_TEXT_SIZE + sizeof "exec-solver:"]; /* of errors */
    Adapter *adapter;                                     /* NULL: none yet, or it has failed */
    int64_t ns;                                           /* that the last solve took, as the program says */
} ExecSolver;

static const SettingSpec settings[] = {{"name", "what pictures call it (default: the program)", SETTING_OWN},
                                       {"step_limit", "seconds that its start or a step may take (default: 10)",
                                        SETTING_FLOAT(ExecSolver, step_limit, 0.01f, 86400)},
                                       {"*", "all other settings are passed to the program", SETTING_OWN},
                                       {0}};

static void *exec_solver_create(const Settings *chosen, Error *error) {
    static const ExecSolver standard = {.step_limit = 10};
    ExecSolver *solver = settings_make(chosen, settings, &standard, sizeof standard, "exec-solver", error);
    if (solver == NULL) return NULL;
    solver->settings = *chosen;
    snprintf(solver->where, sizeof solver->where, "exec-solver:%s", settings_get(chosen, "program"));
    return solver;
}

static void exec_solver_destroy(void *state) {
    ExecSolver *solver = state;
    adapter_give(solver->adapter);
    free(solver);
}

static bool exec_solver_fail(ExecSolver *solver, Error *error, const char *why) {
    error_failure(error, FAILURE_ADAPTER, solver->where, "adapter failed: %s", why);
    program_failed(error->message);
    adapter_end(solver->adapter);
    solver->adapter = NULL;
    return false;
}

/* A program that has failed is started again: its failure ended another run. */
static bool exec_solver_ask(ExecSolver *solver, const ContactProblem *problem, ContactImpulse *impulses, Error *error) {
    char why[TALK_WHY_SIZE];
    const double limit = (double)solver->step_limit;
    if (solver->adapter == NULL)
        solver->adapter = adapter_take(&solver_exec_solver.description, &solver->settings, limit, why, sizeof why);
    if (solver->adapter == NULL) return exec_solver_fail(solver, error, why);
    return adapter_solve(solver->adapter, problem, impulses, &solver->ns, clock_seconds() + limit) ||
           exec_solver_fail(solver, error, adapter_why(solver->adapter));
}

static bool is_finite(const BodyVelocity *velocity) {
    return isfinite(velocity->linear.x) && isfinite(velocity->linear.y) && isfinite(velocity->angular);
}

static bool exec_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    ExecSolver *solver = state;
    solver->ns = 0;
    contact_solution_begin(problem, solution);
    if (problem->contact_count == 0) return true;
    if (!exec_solver_ask(solver, problem, solution->impulses, error)) return false;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ContactImpulse *impulse = &solution->impulses[i];
        contact_push(solution->velocities, contact, problem->bodies, *impulse);
        if (is_finite(&solution->velocities[contact->a]) && is_finite(&solution->velocities[contact->b])) continue;
        char why[TALK_WHY_SIZE];
        snprintf(why, sizeof why, "contact %d: its impulse (%g, %g) N s makes a velocity infinite", i,
                 (double)impulse->normal, (double)impulse->tangent);
        return exec_solver_fail(solver, error, why);
    }
    return true;
}

static int64_t reported(const void *state) { return ((const ExecSolver *)state)->ns; }

const ContactSolverKind solver_exec_solver = {
    .description = {.name = "exec-solver",
                    .summary = "another program solves each step's contacts: exec-solver:PROGRAM WORD...,KEY=VALUE,...",
                    .caption = "external solver",
                    .settings = settings,
                    .own_settings = "",
                    .external = true,
                    .chart = METHOD_NO_RUNS,
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = exec_solver_create,
    .solve = exec_solver_solve,
    .destroy = exec_solver_destroy,
    .reported = reported};
