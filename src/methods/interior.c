/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step by the reference (methods/reference.h), which follows the central path from its beginning, also where it turns
   back, but only to a given residual: 10 to 30 factorizations where iterations of `interior` fail, rarely more than 100. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior_point_internal.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>

/* Zero-initialise. */
typedef struct CentralPath {
    Reference reference;
    int bodies, contacts; /* of the largest problems so far */
} CentralPath;

/* Problems that `interior` leaves to sweeps with momentum. The time of a factorization grows with the power 1.5 of the
   bodies in an island (methods/sweeps.h); an iteration takes as long as 20 sweeps at 496 boxes in a pyramid, 45 at
   1,275 and 120 at 4,950. Beyond about 750 boxes sweeps are as accurate in the same time. Stacks and rows of any number
   of bodies have no loops, and are not left to sweeps.

   Interior-point steps only for the bodies that sweeps leave unsolved, with the impulses of all others kept, gain nothing
   on average: on eight frozen impacts of 1,276 and 2,401 boxes the error at equal time was 1.2 to 1.4 times that of sweeps
   (geometric mean). They help where a wall is struck from the side. Under the top of a pyramid all impulses change down
   to the ground. */

enum { LARGE_SWEEPS = 20, LARGE_MORE = 96 }; /* sweeps, and those that may follow while the residual is too large */

/* Zero-initialise. */
typedef struct LargeIslands {
    Islands islands;
    float factors[LARGE_SWEEPS], more_factors[LARGE_MORE];
} LargeIslands;

enum { FACTORIZATIONS = 200 }; /* those of the reference's first attempt */

static bool central_path_is_solved(const Reference *reference, const ContactProblem *problem, double near) {
    bool solved = reference->residual <= near;
    for (int i = 0; i < problem->contact_count; i++)
        solved &= reference->impulses[i].normal <= interior_impulse_max * (double)problem->contacts[i].mass_normal;
    return solved;
}

static void central_path_free(CentralPath *path) { reference_free(&path->reference); }

/* Allocates what a solve needs if the problem is larger than those before, so that the step that does need it allocates
   nothing. False with error set when memory is short. */
static bool central_path_reserve(CentralPath *path, const ContactProblem *problem, Error *error) {
    if (problem->body_count <= path->bodies && problem->contact_count <= path->contacts) return true;
    if (problem->body_count > path->bodies) path->bodies = problem->body_count;
    if (problem->contact_count > path->contacts) path->contacts = problem->contact_count;
    return reference_reserve(&path->reference, problem) || error_memory(error, "interior");
}

/* Stores the solution and sets *solved if the residual (of Reference) is at most `near` (m/s) after 200 factorizations,
   and float can hold the impulses. Else the solution is not changed. False with error set when memory is short. */
static bool central_path_solve(CentralPath *path, const ContactProblem *problem, double near, ContactSolution *solution,
                               bool *solved, Error *error) {
    Reference *reference = &path->reference;
    if (!reference_solve_to(reference, problem, near, FACTORIZATIONS, error)) return false;
    *solved = central_path_is_solved(reference, problem, near);
    if (!*solved) return true;
    reference_round(reference, problem, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const float limit = problem->contacts[i].friction * solution->impulses[i].normal;
        solution->impulses[i].tangent = contact_clamp(solution->impulses[i].tangent, -limit, limit);
    }
    return true;
}

enum { LOOPS_MAX = 700 }; /* of an island that is factorized */

static void large_islands_init(LargeIslands *large) {
    for (int s = 0; s < LARGE_SWEEPS; s++) large->factors[s] = momentum_factor_tuned(s, LARGE_SWEEPS);
    for (int s = 0; s < LARGE_MORE; s++) large->more_factors[s] = momentum_factor_tuned(s, LARGE_MORE);
}

static void large_islands_free(LargeIslands *large) { islands_free(&large->islands); }

/* Whether the problem is to be left to sweeps. False with error set when memory is short. */
static bool large_islands_find(LargeIslands *large, const ContactProblem *problem, bool *left_to_sweeps, Error *error) {
    *left_to_sweeps = false;
    if (problem->contact_count <= LOOPS_MAX) return true; /* each pair has a contact */
    const int loops = islands_most_loops(&large->islands, problem);
    *left_to_sweeps = loops > LOOPS_MAX;
    return loops >= 0 || error_memory(error, "interior");
}

/* Sweeps until the residual (methods/solvers.h) is below `near` (m/s). */
static bool large_islands_solve(const LargeIslands *large, Momentum *momentum, float near,
                                const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Sweeps *sweeps = &momentum->sweeps;
    const StoppingRule rule = {.near = near, .more = LARGE_MORE};
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) ||
        !sweeps_run_momentum(sweeps, large->factors, LARGE_SWEEPS) ||
        !momentum_run_more(sweeps, problem, &rule, large->more_factors))
        return error_memory(error, "interior");
    solution->fallbacks.by_sweeps = 1;
    return sweeps_end(sweeps, solution) ||
           momentum_solve(momentum, problem, large->factors, LARGE_SWEEPS, solution, error);
}

/* Interior-point steps with a sparse direct solve over the bodies; equations and sources in methods/interior_point_internal.h. A few
   sweeps make the start. Ends when the residual is at most `near`. Iterations are quick as they do not stay near the
   central path. They fail where it turns back: in 1 to 10% of the impacts on walls, piles and pyramids, and in up to half
   on those of some hundred boxes. Then the reference follows the path from its beginning, also where it turns back, to a
   residual of `near` (methods/reference.h). If there is no such solution, sweeps with momentum solve the step, unless
   their residual is larger; the solution counts this as a fallback.

   At rest errors add up from step to step: boxes creep at the speed of the error, until a card slides out of a house of
   cards or a stack leans. So the tolerance is smaller there. A step counts as at rest if no bodies move fast relative to
   each other where they touch, whatever the bias: boxes that overlap and are pushed apart need the small tolerance,
   too, as an error makes them spin. If the sweeps leave no more than rounding errors, the step ends with them: so it
   does in walls and pyramids at rest, and in stacks of few boxes.

   In large islands with many loops, such as pyramids of more than 128 boxes, some bodies nearly always slide, and
   iterations towards the small tolerance of rest would cycle. Such a step counts as an impact: mostly sweeps with
   momentum are enough for it. Stacks have no loops, and stand whatever their number.

   Elsewhere sweeps with momentum make the start: each saves as much of an iteration as it costs.

   Fails by its time: an iteration costs as much as 5 sweeps on scenes/stack and as 12 on scenes/pyramid_settled, and
   more beyond some hundred bodies, so large islands are left to sweeps. An impact takes about four
   iterations to 0.02 m/s and two more to 0.001 m/s, but ten to thirty from poor impulses of the step before, or where
   friction jams a pile. */

enum {
    REST_SWEEPS = 2,
    IMPACT_SWEEPS = 6,    /* with momentum, at the start of a step that is not at rest */
    MANY_BODIES = 128,    /* more: an iteration takes as long as 15 sweeps or more, */
    MANY_SWEEPS = 12,     /* and these save more than they cost */
    MANY_LOOPS = 64,      /* of an island among many bodies: more are never at rest */
    FALLBACK_SWEEPS = 14, /* with momentum, and then more while the residual is too large */
    FALLBACK_MORE = 96,
    CHECK_EVERY = 8
};

/* m/s. A step is at rest if all bodies move by less than `rest_below` relative to each other where they touch; a step of
   gravity makes 0.17, and 1 at 10 Hz. Not their mean: it is small if a bomb strikes one of many boxes. At rest the
   tolerance is at most `rest_near`. */
static const float rest_below = 1.2f, rest_near = 1e-4f;
/* Sweeps end an impact if their residual is below this share of the tolerance. Their errors are long waves, which exceed
   the residual more than those of iterations. */
static const float trusted = 0.3f;
/* m/s: the residual of velocities near 1 m/s that are correct but for half a rounding, 2^-25. */
static const float rounding = 3e-8f;
/* An interior point leaves each contact a little open, and boxes that rest on each other would part. So contacts that
   overlap by less than `shallow` (m) aim to close by up to `closing` (m/s): both exceed the rounding of positions. Where a
   step with that aim does not converge, as many of a pyramid that settles, it is solved without. */
static const double shallow = (double)CONTACT_SLOP / 20, closing = 0.001;

/* Iterations from the start of the sweeps, near the bounds first. If these break down or cycle, it is better to start from
   there again, further inside, than from where they are. */
typedef struct Attempt {
    const InteriorRule *rule;
    double least_scale, lost; /* as for interior_iterate() */
    int iterations;
} Attempt;

enum { ATTEMPTS = 2, FEW_BODIES = 32 };
static const double patient = 1e6, hasty = 10; /* for `lost` */
#define IMPACT_SCALE 0.01                      /* m/s, `least_scale` of the first attempt */
static const Attempt at_rest[ATTEMPTS] = {{&interior_gentle, 1e-6, hasty, 10}, {&interior_gentle, 0.1, hasty, 40}},
                     at_impact[ATTEMPTS] = {{&interior_quick, IMPACT_SCALE, hasty, 20},
                                            {&interior_gentle, 10, hasty, 25}};
/* Those of stacks find back after many jumps. */
static const Attempt at_impact_of_few[ATTEMPTS] = {{&interior_quick, IMPACT_SCALE, patient, 30}, {0}};
/* Impacts of more than MANY_BODIES seldom converge from near the bounds. */
static const Attempt at_impact_of_many[ATTEMPTS] = {{&interior_gentle, 1, hasty, 25}, {0}};

typedef struct State {
    Interior interior;
    LargeIslands large;
    Momentum momentum;
    CentralPath path;
    float near; /* m/s */
    float start_factors[IMPACT_SWEEPS], many_factors[MANY_SWEEPS], factors[FALLBACK_SWEEPS],
        more_factors[FALLBACK_MORE];
} State;

static const SettingSpec settings[] = {{"near", "residual at which iterations stop, m/s (default: 0.02)"},
                                       {NULL, NULL}};

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    interior_free(&solver->interior);
    large_islands_free(&solver->large);
    momentum_free(&solver->momentum);
    central_path_free(&solver->path);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    float near = 0.02f;
    if (!settings_float(chosen, "near", 1e-9f, 1e6f, &near, error)) return NULL;
    State *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "interior");
        return NULL;
    }
    solver->near = near;
    large_islands_init(&solver->large);
    for (int s = 0; s < IMPACT_SWEEPS; s++) solver->start_factors[s] = momentum_factor_tuned(s, IMPACT_SWEEPS);
    for (int s = 0; s < MANY_SWEEPS; s++) solver->many_factors[s] = momentum_factor_tuned(s, MANY_SWEEPS);
    for (int s = 0; s < FALLBACK_SWEEPS; s++) solver->factors[s] = momentum_factor_tuned(s, FALLBACK_SWEEPS);
    for (int s = 0; s < FALLBACK_MORE; s++) solver->more_factors[s] = momentum_factor_tuned(s, FALLBACK_MORE);
    return solver;
}

static float smaller(float x, float y) { return x < y ? x : y; }

static bool start(State *solver, const ContactProblem *problem, bool rests) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem)) return false;
    if (rests) return sweeps_run(sweeps, REST_SWEEPS);
    return problem->body_count > MANY_BODIES ? sweeps_run_momentum(sweeps, solver->many_factors, MANY_SWEEPS)
                                             : sweeps_run_momentum(sweeps, solver->start_factors, IMPACT_SWEEPS);
}

/* False when memory is short. */
static bool find_rest(State *solver, const ContactProblem *problem, bool *rests) {
    const int loops = problem->body_count > MANY_BODIES ? islands_most_loops(&solver->large.islands, problem) : 0;
    *rests = loops <= MANY_LOOPS && !residual_motion_reaches(problem, rest_below);
    return loops >= 0;
}

static const Attempt *impact_attempts(int bodies) {
    return bodies > MANY_BODIES ? at_impact_of_many : bodies > FEW_BODIES ? at_impact : at_impact_of_few;
}

/* False when memory is short. */
static bool iterate(State *solver, const ContactProblem *problem, bool rests) {
    const InteriorKernels *kernels = interior_best();
    const float near = rests ? smaller(solver->near, rest_near) : solver->near;
    const Attempt *attempts = rests ? at_rest : impact_attempts(problem->body_count);
    for (int i = 0; i < ATTEMPTS && attempts[i].rule != NULL; i++) {
        if (!interior_load(&solver->interior, kernels, &solver->momentum.sweeps, problem)) return false;
        if (rests && i == 0) interior_close(&solver->interior, fmin((double)solver->near, closing), shallow);
        interior_iterate(&solver->interior, kernels, attempts[i].rule, attempts[i].least_scale, attempts[i].lost,
                         (double)near, attempts[i].iterations);
        if (solver->interior.residual <= (double)near) return true;
    }
    return true;
}

static bool is_solved(const State *solver) { return solver->interior.residual <= (double)solver->near; }

/* Contacts that cycle at rest mostly converge to the tolerance of impacts. False when memory is short. */
static bool iterate_and_again(State *solver, const ContactProblem *problem, bool rests) {
    return iterate(solver, problem, rests) && (!rests || is_solved(solver) || iterate(solver, problem, false));
}

static bool sweep(State *solver, const ContactProblem *problem) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) ||
        !sweeps_run_momentum(sweeps, solver->factors, FALLBACK_SWEEPS))
        return false;
    for (int s = 0; s < FALLBACK_MORE && residual_reaches(sweeps, problem->contact_count, solver->near);
         s += CHECK_EVERY)
        if (!(s == 0 ? sweeps_run_momentum(sweeps, solver->more_factors, CHECK_EVERY)
                     : sweeps_continue_momentum(sweeps, solver->more_factors + s, CHECK_EVERY)))
            return false;
    return true;
}

/* The solution of the iterations is stored. Replaces it if the residual of sweeps is smaller. */
static bool fall_back(State *solver, bool finite, const ContactProblem *problem, ContactSolution *solution,
                      Error *error) {
    const double before = solver->interior.residual;
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!sweep(solver, problem) || !interior_load(&solver->interior, interior_best(), sweeps, problem))
        return error_memory(error, "interior");
    if (finite && before <= solver->interior.residual) return true;
    solution->fallbacks.by_sweeps = 1;
    return sweeps_end(sweeps, solution) ||
           momentum_solve(&solver->momentum, problem, solver->factors, FALLBACK_SWEEPS, solution, error);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    const Sweeps *sweeps = &solver->momentum.sweeps;
    bool left_to_sweeps;
    if (!large_islands_find(&solver->large, problem, &left_to_sweeps, error)) return false;
    if (left_to_sweeps)
        return large_islands_solve(&solver->large, &solver->momentum, solver->near, problem, solution, error);
    bool rests;
    if (!central_path_reserve(&solver->path, problem, error)) return false;
    if (!find_rest(solver, problem, &rests)) return error_memory(error, "interior");
    if (!start(solver, problem, rests)) return error_memory(error, "interior");
    const float enough = rests ? smaller(solver->near, rounding) : trusted * solver->near;
    if (!residual_of_visits_reaches(sweeps, problem->contact_count, enough) && sweeps_end(sweeps, solution))
        return true;
    if (!iterate_and_again(solver, problem, rests)) return error_memory(error, "interior");
    const bool finite = interior_end(&solver->interior, sweeps, problem, solution);
    bool solved = finite && is_solved(solver);
    if (!solved && !central_path_solve(&solver->path, problem, (double)solver->near, solution, &solved, error))
        return false;
    return solved || fall_back(solver, finite, problem, solution, error);
}

const ContactSolverKind solver_interior = {
    .description = {.name = "interior",
                    .summary = "interior-point steps with a sparse direct solve over the bodies",
                    .caption = "interior-point steps",
                    .look = {METHOD_PURPLE, METHOD_DIAMOND},
                    .settings = settings,
                    .falls_back = true,
                    .chart = METHOD_RUNS("near=0.1", "near=0.02", "near=0.001"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability_place = 2},
    .create = create,
    .solve = solve,
    .destroy = destroy};
