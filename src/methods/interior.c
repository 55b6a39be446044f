/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior-point steps with a sparse direct solve over the bodies; equations and sources in
   methods/interior_point_internal.h. Each island is solved by itself, with no more than it needs in that step
   (methods/interior_look.h):

   1. Two sweeps if it is calm. If they leave little more than rounding errors, they are the solution: in most steps at
      rest.
   2. A few sweeps with momentum, where they save more than they cost.
   3. Iterations until the residual is at most `near`: from near the bounds, and if these break down, from further
      inside.
   4. If nothing gets there, sweeps with momentum from the best answer; the solution counts this as a fallback.

   The work of all this is counted in sweeps, and is at most 30 times that of the engine's ten. Iterations end when it
   is reached; the best answer so far is the solution. The analysis of the matrix tells what an iteration costs: 5 to 10
   sweeps up to a hundred boxes, 13 in a pile or a pyramid of 500 to 1,000, 40 in a pyramid of 820 that touch on all
   sides. Where too few fit in, all is left to sweeps.

   Fails at impacts whose central path turns back, as the bound leaves no room to follow it. The difficulty there, for
   all methods, is to find which contacts open, stick and slide. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior.h"
#include "methods/interior_look.h"
#include "methods/interior_point_internal.h"
#include "methods/islands.h"
#include "methods/methods.h"
#include "methods/momentum.h"
#include "methods/residual.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    FIRST_SWEEPS = 2,
    START_SWEEPS = 6,      /* with momentum */
    FALLBACK_SWEEPS = 128, /* at most, with momentum, after a plain one, where iterations are too dear or fail */
    LEAST_OF_MANY = 11     /* iterations: fewer are rarely as good as sweeps; with 12 a pyramid of 20 rows creeps */
};

/* Work is counted, not timed, in sweeps over the island's contacts; its bound is in methods/interior.h. */
static const double begin_work = 3, load_work = 5.5;
/* Products of blocks in a factorization, as a multiple of the number of loops to the power 1.5: 2 in pyramids and
   walls, 1.4 in piles. */
static const double usual_products = 2;
/* Kept for sweeps where iterations do not converge. */
static const double last_work = 20;

/* Sweeps end an impact if their residual is below this share of the tolerance. Their errors are long waves, which
   exceed the residual more than those of iterations. */
static const float trusted = 0.3f;

/* Iterations from the start of the sweeps. If these break down or cycle, it is better to start from there again,
   further inside, than from where they are. */
enum { ATTEMPTS = 4 /* the last is empty */ };
static const double patient = 1e6, hasty = 10; /* for `lost` */
static const InteriorAttempt at_rest[ATTEMPTS] = {{&interior_gentle, 1e-7, hasty, 10},
                                                  {&interior_gentle, 0.01, patient, 40},
                                                  {&interior_far, 0.01, patient, 40}},
                             at_rest_uneven[ATTEMPTS] = {{&interior_gentle, 1e-7, hasty, 10},
                                                         {&interior_far, 0.01, patient, 40}};
/* Among many bodies iterations that do not converge at once rarely do. */
static const InteriorAttempt at_rest_of_many[ATTEMPTS] = {{&interior_gentle, 1e-7, hasty, 10}};
/* Struck stacks, and restless islands, converge from near the bounds, some after many jumps. Other struck islands do so
   at once or not at all. If not, they begin again further inside. Those with many bodies, or with a heavy one, begin
   there. */
static const InteriorAttempt near_bounds[ATTEMPTS] = {{&interior_quick, 1e-3, patient, 30}},
                             at_impact[ATTEMPTS] = {{&interior_quick, 1e-3, hasty, 20},
                                                    {&interior_far, 0.3, patient, 40}};

typedef struct State {
    float near; /* m/s */
    Interior interior;
    Islands islands;
    InteriorLook *looks; /* [islands.count] */
    ArrayBlock look_block;
    Momentum momentum;
    double left;            /* of the island's work, in sweeps */
    double work;            /* the most of an island in the last step */
    bool analysed;          /* the island's matrix is, */
    bool loaded;            /* and iterations may begin */
    double best;            /* m/s, residual of the solution that is stored */
    ContactPoint *contacts; /* [contact_count] with the best answer as warm start */
    size_t contact_capacity;
    float start_factors[START_SWEEPS], fallback_factors[FALLBACK_SWEEPS];
} State;

static const SettingSpec settings[] = {
    {"near", "residual at which iterations stop, m/s (default: 0.002)", SETTING_FLOAT(State, near, 1e-9f, 1e6f)},
    KEEP_SETTING(SETTING_OWN),
    {0}};

static void interior_destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    interior_free(&solver->interior);
    islands_free(&solver->islands);
    free(solver->look_block.memory);
    momentum_free(&solver->momentum);
    free(solver->contacts);
    free(solver);
}

static void set_factors(float *factors, int count) {
    for (int s = 0; s < count; s++) factors[s] = momentum_factor_tuned(s, count);
}

static void *interior_create(const Settings *chosen, Error *error) {
    static const State standard = {.near = 0.002f};
    State *solver = settings_make(chosen, settings, &standard, sizeof standard, "interior", error);
    if (solver == NULL) return NULL;
    set_factors(solver->start_factors, START_SWEEPS);
    set_factors(solver->fallback_factors, FALLBACK_SWEEPS);
    return solver;
}

/* Begins with the warm start, and with the first sweeps if the problem is calm. False when memory is short. */
static bool interior_start(State *solver, const ContactProblem *problem, bool calm) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    solver->left -= begin_work + (calm ? FIRST_SWEEPS : 0);
    return sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) && (!calm || sweeps_run(sweeps, FIRST_SWEEPS));
}

/* Sweeps with momentum after the first ones, where they save as much of an iteration as they cost. At rest iterations
   converge at once from the first sweeps, or not at all; but in calm islands of many bodies some nearly always slide
   for long after an impact, iterations towards the small tolerance cycle, and sweeps reach it in less time. Sweeps
   carry little where light bodies hold heavy ones, or where there is no friction. Impacts of many bodies that are not
   solved by these sweeps are hard: iterations then converge sooner from the plain start. Sets *done if the sweeps are
   enough: the solution is stored. False when memory is short. */
static bool try_sweeps(State *solver, const ContactProblem *problem, const InteriorLook *step,
                       ContactSolution *solution, bool *done) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    const float enough = step->calm ? step->near : trusted * solver->near;
    *done = false;
    if (step->calm && (!step->many || interior_look_jams(step))) return true;
    solver->left -= START_SWEEPS;
    if (!sweeps_run_momentum(sweeps, solver->start_factors, START_SWEEPS)) return false;
    *done = !residual_of_visits_reaches(sweeps, problem->contact_count, enough) && sweeps_end(sweeps, solution);
    return *done || !step->many || interior_start(solver, problem, step->calm);
}

/* Of the matrix of an island. */
static double analysis_work(const InteriorLook *step) { return fmin(2 + step->bodies / 16.0, 14); }

/* False when memory is short. */
static bool load_interior(State *solver, const ContactProblem *problem, const InteriorLook *step) {
    solver->left -= load_work + (solver->analysed ? 0 : analysis_work(step));
    solver->analysed = solver->loaded = true;
    return interior_load(&solver->interior, interior_best(), &solver->momentum.sweeps, problem);
}

/* Iterations of that work that the island's has room for, after a step that takes `before` of it. */
static int affordable(const State *solver, double before, double iteration_work) {
    return (int)fmax((solver->left - before - last_work) / iteration_work, 0);
}

/* Whether there is room for enough iterations by what the island's loops tell, so that its matrix is not analysed in
   vain. */
static bool seems_cheap(const State *solver, const InteriorLook *step) {
    const double usual =
        interior_work(usual_products * step->loops * sqrt(step->loops), solver->momentum.sweeps.pair_count);
    return affordable(solver, load_work + analysis_work(step), usual) >= (step->many ? LEAST_OF_MANY : 0);
}

/* Loads the island, unless its iterations are too dear. Sets *cheap. False when memory is short. */
static bool load_if_cheap(State *solver, const ContactProblem *problem, const InteriorLook *step, bool *cheap) {
    *cheap = seems_cheap(solver, step);
    if (!*cheap) return true;
    if (!load_interior(solver, problem, step)) return false;
    *cheap = affordable(solver, 0, solver->interior.iteration_work) >= (step->many ? LEAST_OF_MANY : 0);
    return true;
}

/* Stores the answer of the iterations if it is the best so far. */
static void interior_offer(State *solver, const ContactProblem *problem, ContactSolution *solution) {
    const Interior *interior = &solver->interior;
    if (interior->residual < solver->best && interior_end(interior, &solver->momentum.sweeps, problem, solution))
        solver->best = interior->residual;
}

/* Contacts that cycle at rest mostly converge to a larger tolerance as impacts do. Among many bodies that must not let
   them open: a wall that creeps once goes on. */
static const InteriorAttempt *attempts_of(const InteriorLook *step) {
    if (!step->calm && step->bodies <= INTERIOR_FEW_BODIES) return near_bounds;
    if (!step->calm) return step->many || step->heavy ? at_impact + 1 : at_impact;
    const bool many = step->many && !interior_look_jams(step);
    if (step->restless && !many) return near_bounds;
    return many ? at_rest_of_many : step->uneven ? at_rest_uneven : at_rest;
}

/* The attempts, until the residual is at most `near` or the work is done. False when memory is short. */
static bool iterate_interior(State *solver, const ContactProblem *problem, const InteriorLook *step,
                             ContactSolution *solution) {
    Interior *interior = &solver->interior;
    const double near = (double)step->near;
    for (const InteriorAttempt *attempt = attempts_of(step); attempt->rule != NULL && solver->best > near; attempt++) {
        const double again = solver->loaded ? 0 : begin_work + FIRST_SWEEPS + load_work;
        const int most = affordable(solver, again, interior->iteration_work);
        if (most == 0) return true;
        if (!solver->loaded && !(interior_start(solver, problem, step->calm) && load_interior(solver, problem, step)))
            return false;
        solver->loaded = false;
        /* What opens is not found in the next step, falls, and lands on what lies below. */
        if (step->calm) interior_close(interior, interior_look_closing(step, solver->near), (double)problem->dt);
        interior_iterate(interior, interior_best(), attempt, interior_look_speed(step), near, most);
        solver->left -= interior->iterations * interior->iteration_work;
        interior_offer(solver, problem, solution);
    }
    return true;
}

/* After interior_start(): as momentum:k=1,near=NEAR,more=128 (residual: methods/residual.h), or until the work is done.
   False when memory is short. */
static bool interior_sweep(State *solver, const ContactProblem *problem, float near) {
    const int more = (int)fmin(fmax(solver->left - 1, 0), FALLBACK_SWEEPS) / STOPPING_BLOCK * STOPPING_BLOCK;
    const StoppingRule rule = {.near = near, .more = more};
    solver->left -= 1 + more;
    return momentum_begin(&solver->momentum, problem) && momentum_run(&solver->momentum, solver->fallback_factors, 1) &&
           momentum_run_more(&solver->momentum, &rule, solver->fallback_factors);
}

/* After interior_start(): all by sweeps with momentum. */
static bool solve_by_sweeps(State *solver, const ContactProblem *problem, float near, ContactSolution *solution,
                            Error *error) {
    solution->fallbacks.by_sweeps = 1;
    return (interior_sweep(solver, problem, near) && momentum_end(&solver->momentum, solution)) ||
           error_memory(error, "interior");
}

/* m/s, as that of the iterations. */
static double residual_of(const Sweeps *sweeps, int contacts) {
    InteriorLook all = {0};
    interior_look_at_residuals(&all, sweeps, NULL);
    return interior_look_residual(&all, contacts);
}

/* The problem with that solution as its warm start, valid until the next call. False when memory is short. */
static bool begin_from(State *solver, const ContactProblem *problem, const ContactSolution *solution,
                       ContactProblem *from) {
    const size_t contacts = (size_t)problem->contact_count;
    if (!array_reserve((void **)&solver->contacts, &solver->contact_capacity, contacts, sizeof *solver->contacts))
        return false;
    memcpy(solver->contacts, problem->contacts, contacts * sizeof *solver->contacts);
    for (size_t i = 0; i < contacts; i++) {
        solver->contacts[i].warm_normal = solution->impulses[i].normal;
        solver->contacts[i].warm_tangent = solution->impulses[i].tangent;
    }
    *from = *problem;
    from->contacts = solver->contacts;
    return true;
}

/* Sweeps from the best answer of the iterations, which is stored as the solution. Replaces it if their residual is
   smaller. */
static bool fall_back(State *solver, const ContactProblem *problem, float near, ContactSolution *solution,
                      Error *error) {
    const bool finite = solver->best < INFINITY;
    ContactProblem from = *problem;
    if ((finite && !begin_from(solver, problem, solution, &from)) || !interior_start(solver, &from, false) ||
        !interior_sweep(solver, &from, near))
        return error_memory(error, "interior");
    const double after = residual_of(&solver->momentum.sweeps, problem->contact_count);
    solution->fallbacks.by_sweeps = 1;
    return (finite && !(after < solver->best)) || momentum_end(&solver->momentum, solution) ||
           error_memory(error, "interior");
}

/* Iterations, then sweeps. */
static bool solve_further(State *solver, const ContactProblem *problem, const InteriorLook *step,
                          ContactSolution *solution, Error *error) {
    solver->best = INFINITY;
    bool cheap;
    if (!load_if_cheap(solver, problem, step, &cheap)) return error_memory(error, "interior");
    if (!cheap)
        return interior_start(solver, problem, false) ? solve_by_sweeps(solver, problem, step->enough, solution, error)
                                                      : error_memory(error, "interior");
    if (!iterate_interior(solver, problem, step, solution)) return error_memory(error, "interior");
    return solver->best <= (double)step->enough || fall_back(solver, problem, step->enough, solution, error);
}

/* A problem that is a single island. */
static bool solve_island(State *solver, const ContactProblem *problem, const InteriorLook *seen,
                         ContactSolution *solution, Error *error) {
    InteriorLook look = *seen, *step = &look;
    bool done = false;
    step->left = (PairResidual){0};
    solver->left = INTERIOR_MOST_WORK;
    solver->analysed = solver->loaded = false;
    if (!interior_start(solver, problem, step->calm)) return error_memory(error, "interior");
    if (step->calm) {
        interior_look_at_residuals(step, &solver->momentum.sweeps, NULL);
        if (interior_look_is_still(step, problem->contact_count) && sweeps_end(&solver->momentum.sweeps, solution))
            return true;
        interior_look_again(step, solver->near, problem->contact_count);
    }
    if (step->many && !step->calm && !seems_cheap(solver, step))
        return solve_by_sweeps(solver, problem, solver->near, solution, error);
    if (!try_sweeps(solver, problem, step, solution, &done)) return error_memory(error, "interior");
    return done || solve_further(solver, problem, step, solution, error);
}

static bool are_mostly_calm(const State *solver, int contacts) {
    const Islands *islands = &solver->islands;
    int calm = 0;
    for (int k = 0; k < islands->count; k++) calm += solver->looks[k].calm ? islands->islands[k].contacts : 0;
    return 2 * calm > contacts;
}

/* The first sweeps of all islands at once, where most are calm: the same bits in less time. Sets *done to whether they
   are stored. False when memory is short. */
static bool sweep_all(State *solver, const ContactProblem *problem, ContactSolution *solution, bool *done) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    *done = false;
    if (!are_mostly_calm(solver, problem->contact_count)) return true;
    if (!interior_start(solver, problem, true)) return false;
    interior_look_at_residuals(solver->looks, sweeps, solver->islands.island);
    *done = sweeps_end(sweeps, solution);
    return true;
}

static bool solve_islands(State *solver, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Islands *islands = &solver->islands;
    bool swept;
    if (!sweep_all(solver, problem, solution, &swept)) return error_memory(error, "interior");
    if (!swept) contact_solution_begin(problem, solution);
    for (int k = 0; k < islands->count; k++) {
        const InteriorLook *step = &solver->looks[k];
        if (swept && interior_look_is_still(step, islands->islands[k].contacts)) continue;
        ContactSolution of_part;
        const ContactProblem part = islands_take(islands, problem, k, &of_part);
        if (!solve_island(solver, &part, step, &of_part, error)) return false;
        solver->work = fmax(solver->work, INTERIOR_MOST_WORK - solver->left);
        islands_put(islands, k, &part, &of_part, solution);
    }
    solution->fallbacks.by_sweeps = solution->fallbacks.by_sweeps > 0;
    return true;
}

static bool interior_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    const Islands *islands = &solver->islands;
    if (!islands_find(&solver->islands, problem) ||
        !ARRAY_BLOCK_RESERVE(&solver->look_block, ARRAY_PART(solver->looks, islands->count)))
        return error_memory(error, "interior");
    interior_look(solver->looks, islands, problem, solver->near);
    /* A body alone in the air would change the order of elimination. */
    const bool single = islands->count == 1 && islands->islands[0].bodies == islands->moving &&
                        islands->islands[0].contacts == problem->contact_count;
    solver->work = 0;
    if (!single) return solve_islands(solver, problem, solution, error);
    const bool done = solve_island(solver, problem, &solver->looks[0], solution, error);
    solver->work = INTERIOR_MOST_WORK - solver->left;
    return done;
}

double interior_work_done(const void *state) { return ((const State *)state)->work; }

const ContactSolverKind solver_interior = {
    .description = {.name = "interior",
                    .summary = "interior-point steps with a sparse direct solve over the bodies",
                    .caption = "interior-point steps",
                    .settings = settings,
                    .converges = "near=1e-6",
                    .falls_back = true,
                    .chart = METHOD_RUNS("near=1", "near=0.1", "near=0.02", "near=0.002", "near=0.0005", "near=0.0001"),
                    .chart_quick = METHOD_RUNS("near=0.002"),
                    .stability_place = 2},
    .create = interior_create,
    .solve = interior_solve,
    .destroy = interior_destroy};
