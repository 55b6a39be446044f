/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stacks as a whole, by two passes over what stands on the ground without loops (forest.h); where that solves all
   contacts there is nothing left to sweep. Otherwise the engine's sweeps. They begin where

       E(P) = sum of m v^2 / 2 + I w^2 / 2 - sum of bias P_n,   v and w: after the impulses P

   is least between the impulses of the step before and those of the passes, where there are some: its minimum is the
   solution without friction, and after a blow the passes are far better, or far worse. And where sweeps end with a higher
   E than no impulse has, they begin again from none: what has held a blow is no start for the step after it, in which all
   flies apart. Source: forest.h; E: Baraff, "Fast Contact Force Computation for Nonpenetrating Rigid Bodies" (1994). Fails
   as the engine does where it falls back to it: in walls, bridges and arches, on corners, and while boxes tip or slide; a
   stack that a blow has shaken may so be lost. */
#include "solvers/forest.h"
#include "solvers/solvers.h"
#include "sweeps/sequential_impulses.h"
#include "sweeps/sweeps.h"

#include <stdlib.h>

typedef struct Robust {
    int sweep_count;
    Forest forest;
    Sweeps sweeps;
} Robust;

static const SettingSpec settings[] = {{"k", "sweeps a step where the passes do not solve it (the scene's own: 10)"},
                                       {NULL, NULL}};

static void destroy(void *state) {
    Robust *solver = state;
    if (solver == NULL) return;
    forest_free(&solver->forest);
    sweeps_free(&solver->sweeps);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    int sweep_count = 10;
    if (!settings_int(chosen, "k", 1, SWEEPS_MAX, &sweep_count, error)) return NULL;
    Robust *solver = calloc(1, sizeof *solver);
    if (solver == NULL)
        error_memory(error, "robust");
    else
        solver->sweep_count = sweep_count;
    return solver;
}

/* sum of bias P_n, J */
static double pushed(const Sweeps *sweeps) {
    double sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++)
        for (int k = 0; k < 2; k++)
            sum += (double)sweeps->pairs[i].points[k].bias * (double)sweeps->pairs[i].sums[k].normal;
    return sum;
}

/* E along a change of impulses: E(t) = E(0) + slope t + curve t^2 / 2 after t of it. */
typedef struct Line {
    double slope, curve; /* J */
} Line;

/* Of the change that led from the velocities `before`, and pushed() then, to where the sweeps are. */
static Line look_back(const ContactProblem *problem, const Sweeps *sweeps, const BodyVelocity *before,
                      double pushed_before) {
    Line line = {pushed_before - pushed(sweeps), 0};
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const SweepBody *now = &sweeps->bodies[i];
        if (body->inv_mass == 0.0f || body->inv_inertia == 0.0f) continue;
        const double mass = 1 / (double)body->inv_mass, inertia = 1 / (double)body->inv_inertia;
        const double x = (double)before[i].linear.x, y = (double)before[i].linear.y, spin = (double)before[i].angular;
        const double by_x = (double)now->x - x, by_y = (double)now->y - y, by_spin = (double)now->spin - spin;
        line.slope += mass * (by_x * x + by_y * y) + inertia * by_spin * spin;
        line.curve += mass * (by_x * by_x + by_y * by_y) + inertia * by_spin * by_spin;
    }
    return line;
}

/* Where E is least between both ends, 0 and 1; 0 where numbers are none. */
static float lowest(Line line) {
    const double part = -line.slope / line.curve;
    return part >= 1 ? 1.0f : part > 0 ? (float)part : 0.0f;
}

/* From the warm start towards the impulses of the passes, which are in the solution, as far as that lowers E. Both are
   overwritten. */
static void go_towards_passes(Sweeps *sweeps, const ContactProblem *problem, ContactSolution *solution) {
    ContactImpulse *change = solution->impulses;
    for (int i = 0; i < problem->body_count; i++) {
        const SweepBody *body = &sweeps->bodies[i];
        solution->velocities[i] = (BodyVelocity){vec2(body->x, body->y), body->spin};
    }
    for (int i = 0; i < problem->contact_count; i++) {
        change[i].normal -= problem->contacts[i].warm_normal;
        change[i].tangent -= problem->contacts[i].warm_tangent;
    }
    const double pushed_before = pushed(sweeps);
    sweeps_push(sweeps, change);
    const float back = lowest(look_back(problem, sweeps, solution->velocities, pushed_before)) - 1;
    if (back == 0.0f) return;
    for (int i = 0; i < problem->contact_count; i++) {
        change[i].normal *= back;
        change[i].tangent *= back;
    }
    sweeps_push(sweeps, change);
}

/* Whether the sweeps have ended no better than with no impulse at all, by more than what moves all bodies through the slop
   in a step: so much is the price of what warm starts do for loops, which settle over many steps. */
static bool has_risen(const ContactProblem *problem, const Sweeps *sweeps, BodyVelocity *room) {
    const double speed = (double)CONTACT_SLOP / (double)problem->dt;
    double allowed = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        room[i] = (BodyVelocity){body->velocity, body->angular_velocity};
        if (body->inv_mass != 0.0f) allowed += 0.5 * speed * speed / (double)body->inv_mass;
    }
    const Line line = look_back(problem, sweeps, room, 0);
    return line.slope + 0.5 * line.curve > allowed;
}

static bool sweep(Robust *solver, const ContactProblem *problem, bool passes, ContactSolution *solution) {
    Sweeps *sweeps = &solver->sweeps;
    if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, true, 1.0f)) return false;
    if (passes) go_towards_passes(sweeps, problem, solution);
    if (!sweeps_run(sweeps, solver->sweep_count)) return false;
    if (!has_risen(problem, sweeps, solution->velocities)) return true;
    return sweeps_begin(sweeps, sweeps->kernel, problem, false, 1.0f) && sweeps_run(sweeps, solver->sweep_count);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true, .relaxation = 1.0f};
    Robust *solver = state;
    ForestAnswer answer;
    if (!forest_solve(&solver->forest, problem, solution->impulses, &answer)) return error_memory(error, "robust");
    if (answer == FOREST_WHOLE) {
        for (int i = 0; i < problem->body_count; i++) solution->velocities[i] = solver->forest.bodies[i].after;
        return true;
    }
    if (!sweep(solver, problem, answer == FOREST_PART, solution)) return error_memory(error, "robust");
    if (!sweeps_end(&solver->sweeps, solution))
        sequential_impulses_solve(problem, &options, solver->sweep_count, solution);
    return true;
}

const ContactSolverKind solver_robust = {
    .description = {.name = "robust",
                    .summary = "stacks solved as a whole from the ground up and back, else the engine",
                    .settings = settings,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50", "k=100"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability_place = 2},
    .create = create,
    .solve = solve,
    .destroy = destroy};
