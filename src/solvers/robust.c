/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves trees of bodies on the ground, such as stacks, directly by two passes (forest.h). If that solves all contacts,
   no sweeps follow; otherwise the engine's sweeps do. They start from the impulses at which

       E(P) = sum of m v^2 / 2 + I w^2 / 2 - sum of bias P_n,   v and w: after the impulses P

   is smallest between the warm start and the impulses of the passes, if there are any: the minimum of E is the solution
   without friction, and after a blow the passes may be far better than the warm start, or far worse. If the sweeps end
   with a higher E than zero impulses have, they start again from zero: impulses that resisted a blow are a bad start
   for the next step, in which the bodies fly apart. Source: forest.h; E: Baraff, "Fast Contact Force Computation for
   Nonpenetrating Rigid Bodies" (1994). Fails as the engine does if the passes do not apply: in walls, bridges and
   arches, on corners, and while boxes tip or slide; a stack that a blow has shaken may then collapse. */
#include "solvers/forest.h"
#include "solvers/solvers.h"
#include "solvers/stopping.h"
#include "sweeps/sequential_impulses.h"
#include "sweeps/sweeps.h"

#include <stdlib.h>

typedef struct Robust {
    int sweep_count;
    StoppingRule rule;
    Forest forest;
    Sweeps sweeps;
} Robust;

static const SettingSpec settings[] = {
    {"k", "sweeps per step if the direct passes do not solve it (default: the scene's, else 10)"},
    STOPPING_SETTINGS,
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
    StoppingRule rule = {0};
    if (!settings_int(chosen, "k", 1, SWEEPS_MAX, &sweep_count, error) || !stopping_read(&rule, chosen, error))
        return NULL;
    Robust *solver = calloc(1, sizeof *solver);
    if (solver == NULL)
        error_memory(error, "robust");
    else
        *solver = (Robust){.sweep_count = sweep_count, .rule = rule};
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

/* E along a change of impulses: E(t) = E(0) + slope t + curve t^2 / 2 after the share t of it. */
typedef struct Line {
    double slope, curve; /* J */
} Line;

/* Along the change from the velocities `before`, with pushed() as it was then, to those of the sweeps. */
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

/* The t of [0, 1] with the smallest E; 0 if it is NaN. */
static float lowest(Line line) {
    const double part = -line.slope / line.curve;
    return part >= 1 ? 1.0f : part > 0 ? (float)part : 0.0f;
}

/* Moves the sweeps from the warm start towards the impulses of the passes, given in the solution, to the smallest E.
   Overwrites the solution. */
static void move_towards_passes(Sweeps *sweeps, const ContactProblem *problem, ContactSolution *solution) {
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

/* True if E after the sweeps exceeds that of zero impulses by more than the energy that moves all bodies by the slop in
   one step. The allowance keeps warm starts in loops, such as walls, which settle over many steps. */
static bool has_risen(const ContactProblem *problem, const Sweeps *sweeps, BodyVelocity *work) {
    const double speed = (double)CONTACT_SLOP / (double)problem->dt;
    double allowed = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        work[i] = (BodyVelocity){body->velocity, body->angular_velocity};
        if (body->inv_mass != 0.0f) allowed += 0.5 * speed * speed / (double)body->inv_mass;
    }
    const Line line = look_back(problem, sweeps, work, 0);
    return line.slope + 0.5 * line.curve > allowed;
}

static bool sweep(Robust *solver, const ContactProblem *problem, bool passes, ContactSolution *solution) {
    Sweeps *sweeps = &solver->sweeps;
    if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, true, 1.0f)) return false;
    if (passes) move_towards_passes(sweeps, problem, solution);
    if (!stopping_run(&solver->rule, sweeps, problem, solver->sweep_count, sweeps_run)) return false;
    if (!has_risen(problem, sweeps, solution->velocities)) return true;
    return sweeps_begin(sweeps, sweeps->kernel, problem, false, 1.0f) &&
           stopping_run(&solver->rule, sweeps, problem, solver->sweep_count, sweeps_run);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true, .relaxation = 1.0f};
    Robust *solver = state;
    ForestResult result;
    if (!forest_solve(&solver->forest, problem, solution->impulses, &result)) return error_memory(error, "robust");
    if (result == FOREST_WHOLE) {
        for (int i = 0; i < problem->body_count; i++) solution->velocities[i] = solver->forest.bodies[i].after;
        return true;
    }
    if (!sweep(solver, problem, result == FOREST_PART, solution)) return error_memory(error, "robust");
    if (!sweeps_end(&solver->sweeps, solution))
        sequential_impulses_solve(problem, &options, solver->sweep_count, solution);
    return true;
}

const ContactSolverKind solver_robust = {
    .description = {.name = "robust",
                    .summary = "stacks solved directly in two passes, all else by sequential impulses",
                    .settings = settings,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50", "k=100"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability_place = 2},
    .create = create,
    .solve = solve,
    .destroy = destroy};
