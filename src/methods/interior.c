/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior-point steps with a sparse direct solve over the bodies; equations and sources in
   methods/interior_point_internal.h. Each island is solved by itself, with no more than it needs in that step: two sweeps if it
   is calm, else a few with momentum; then iterations until the residual is at most `near`. Iterations are quick as they do
   not stay near the central path. They fail where it turns back: in 1 to 10% of the impacts on walls, piles and pyramids, and in up
   to half on those of some hundred boxes. Then the reference follows the path from its beginning, also where it turns back,
   to a residual of `near` (methods/reference.h): 10 to 30 factorizations, rarely more than 100. If there is no such solution,
   sweeps with momentum solve the step, unless their residual is larger; the solution counts this as a fallback.

   An island is calm if none of its bodies move fast relative to each other where they touch, whatever the bias: boxes that
   overlap and are pushed apart are calm, too. There errors add up from step to step: boxes creep at the speed of the error,
   until a card slides out of a house of cards or a stack leans. So the tolerance is smaller, and contacts are kept closed
   (interior_close()): what opens is not found in the next step, falls, and lands on what lies below. If two sweeps leave
   little more than rounding errors, the step ends with them: so it does in most steps at rest.

   Sweeps carry little where light bodies hold heavy ones, or where there is no friction; a calm island of such bodies is left
   to iterations. In other calm islands of more than 128 bodies, some bodies nearly always slide for long after an impact, and
   iterations towards the small tolerance cycle; sweeps with momentum then reach it in less time. After an impact an island
   is restless for some frames: calm, but the first sweeps leave much. There errors have no time to add up, and `near` will do.

   Fails by its time: an iteration costs as much as 5 sweeps on scenes/stack and as 12 on scenes/pyramid_settled, and
   more beyond some hundred bodies. An impact takes about four iterations to 0.02 m/s and two more to 0.001 m/s, but ten to
   thirty from poor impulses of the step before, or where friction jams a pile.

   Impacts on large islands are left to sweeps with momentum. The time of a factorization grows with the power 1.5 of
   the bodies in an island (methods/block_lu.h); an iteration takes as long as 20 sweeps at 496 boxes in a pyramid, 45 at
   1,275 and 120 at 4,950. Beyond about 750 boxes sweeps are as accurate in the same time. Stacks and rows of any number
   of bodies have no loops, and are not left to sweeps. Interior-point steps only for the bodies that sweeps leave
   unsolved, with the impulses of all others kept, gain nothing on average: on eight frozen impacts of 1,276 and 2,401
   boxes the error at equal time was 1.2 to 1.4 times that of sweeps (geometric mean). They help where a wall is struck
   from the side. Under the top of a pyramid all impulses change down to the ground.

   Other iterations did not help there. Frozen impacts of 498 and 992 bodies, a residual of 0.002 m/s, begun with 20 sweeps:
   with friction that dilates as it slides, so that the problem is convex, and dilatation subtracted as of the iteration before,
   primal-dual steps need 28 to more than 60 factorizations; augmented Lagrangians with Newton steps, more than 60. One
   factorization and 400 solutions (ADMM) have 3 to 6 times the error of momentum in the same time. Iterations that begin after
   400 sweeps cycle as those that begin after 20. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior_point_internal.h"
#include "methods/islands.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>

enum {
    FIRST_SWEEPS = 2,
    START_SWEEPS = 6,     /* with momentum */
    MANY_BODIES = 128,    /* more: an iteration takes as long as 15 sweeps or more, */
    MANY_SWEEPS = 12,     /* and these save more than they cost */
    MOST_LOOPS = 700,     /* of an island that is factorized */
    FALLBACK_SWEEPS = 14, /* with momentum, */
    LARGE_SWEEPS = 20,    /* or in large islands, */
    MORE_SWEEPS = 96,     /* and then more while the residual is too large */
    FACTORIZATIONS = 200  /* those of the reference's first attempt */
};

/* m/s. An island is calm if its bodies move by less than `calm_below` relative to each other where they touch; a step of
   gravity makes 0.17, and 1 at 10 Hz. Not their mean: it is small if a bomb strikes one of many boxes. There the tolerance
   is at most `calm_near`, or `many_near` among many bodies; without friction, where nothing holds what an error moves,
   `slippery_near`. */
static const float calm_below = 1.2f, calm_near = 1e-4f, many_near = 4e-4f, slippery_near = 1e-6f;
/* Sweeps end an impact if their residual is below this share of the tolerance. Their errors are long waves, which exceed the
   residual more than those of iterations. */
static const float trusted = 0.3f;
/* In calm islands plain sweeps are enough below this (m/s), or below so many roundings of what the impulses hold; without
   friction, and in towers, only below the latter. At 1e-4 m/s a house of cards falls, and a stack of 60 at 3 roundings. */
static const float still = 2e-5f, roundings = 3, slender_roundings = 0.3f;
/* A calm island of some size whose first sweeps leave more than this multiple of the tolerance of impacts is restless. */
static const float restless_from = 2;
/* Sweeps carry little between bodies that touch if one has more than this multiple of the other's mass. There, a multiple of
   the tolerance has to do among many bodies. */
static const float uneven_from = 10, jammed_near = 10;
/* m/s. An interior point leaves each contact a little open, and boxes that rest on each other would part. So in calm islands
   contacts aim to close by up to this speed, until they overlap a little (interior_close()). */
static const double closing = 0.001;

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
/* Beyond MANY_BODIES iterations that do not converge at once rarely do, and impacts' tolerance would let contacts open. */
static const Attempt at_rest_of_many[ATTEMPTS] = {{&interior_gentle, 1e-6, hasty, 10}, {0}};
/* Those of stacks find back after many jumps. */
static const Attempt at_impact_of_few[ATTEMPTS] = {{&interior_quick, IMPACT_SCALE, patient, 30}, {0}};
/* Impacts of more than MANY_BODIES seldom converge from near the bounds. */
static const Attempt at_impact_of_many[ATTEMPTS] = {{&interior_gentle, 1, hasty, 25}, {0}};

static float smaller(float x, float y) { return x < y ? x : y; }
static float larger(float x, float y) { return x > y ? x : y; }

/* What a step is for an island. */
typedef struct Look {
    int bodies; /* that move */
    bool calm, many, slippery, uneven;
    bool restless;      /* calm only now, after an impact: it slides on for some time */
    bool slender;       /* towers: errors below are larger above */
    float near, enough; /* m/s: residuals at which iterations stop, and that are taken */
    PairResidual left;  /* sum over its pairs, after the first sweeps */
} Look;

typedef struct State {
    float near; /* m/s */
    Interior interior;
    Islands islands;
    Look *looks; /* [islands.count] */
    ArrayBlock look_block;
    Momentum momentum;
    Reference reference;
    int bodies, contacts; /* of the largest problems so far that the reference has room for */
    float start_factors[START_SWEEPS], many_factors[MANY_SWEEPS], fallback_factors[FALLBACK_SWEEPS],
        large_factors[LARGE_SWEEPS], more_factors[MORE_SWEEPS];
} State;

static const SettingSpec settings[] = {
    {"near", "residual at which iterations stop, m/s (default: 0.002)", SETTING_FLOAT(State, near, 1e-9f, 1e6f)},
    KEEP_SETTING(SETTING_OWN),
    {0}};

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    interior_free(&solver->interior);
    islands_free(&solver->islands);
    free(solver->look_block.memory);
    momentum_free(&solver->momentum);
    reference_free(&solver->reference);
    free(solver);
}

static void set_factors(float *factors, int count) {
    for (int s = 0; s < count; s++) factors[s] = momentum_factor_tuned(s, count);
}

static void *create(const Settings *chosen, Error *error) {
    static const State standard = {.near = 0.002f};
    State *solver = settings_make(chosen, settings, &standard, sizeof standard, "interior", error);
    if (solver == NULL) return NULL;
    set_factors(solver->start_factors, START_SWEEPS);
    set_factors(solver->many_factors, MANY_SWEEPS);
    set_factors(solver->fallback_factors, FALLBACK_SWEEPS);
    set_factors(solver->large_factors, LARGE_SWEEPS);
    set_factors(solver->more_factors, MORE_SWEEPS);
    return solver;
}

static bool is_uneven(float inv_mass_a, float inv_mass_b) {
    return inv_mass_a > 0 && inv_mass_b > 0 &&
           (inv_mass_a > uneven_from * inv_mass_b || inv_mass_b > uneven_from * inv_mass_a);
}

static void look_at_contact(Look *step, const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    step->calm = step->calm && residual_of_motion(problem, i) < calm_below * calm_below;
    step->slippery |= contact->friction < INTERIOR_SLIPPERY;
    step->uneven |= is_uneven(problem->bodies[contact->a].inv_mass, problem->bodies[contact->b].inv_mass);
}

/* A speed that moves bodies no further in a step than this one does at 60 Hz. */
static float same_way(float speed, float dt) { return smaller(speed, speed / (60 * dt)); }

static float tolerance(const Look *step, float near, float dt) {
    if (!step->calm) return near;
    if (step->slippery) return smaller(near, slippery_near);
    return smaller(near, step->many && !step->uneven ? same_way(many_near, dt) : calm_near);
}

/* Sweeps carry little between its bodies. */
static bool jams(const Look *step) { return step->slippery || step->uneven; }

static void decide(Look *step, float near, float dt) {
    step->near = tolerance(step, near, dt);
    step->enough = !step->calm || !step->many ? near : jams(step) ? jammed_near * step->near : step->near;
}

/* Looks at each island before the step. False when memory is short. */
static bool look(State *solver, const ContactProblem *problem) {
    const Islands *islands = &solver->islands;
    if (!ARRAY_BLOCK_RESERVE(&solver->look_block, ARRAY_PART(solver->looks, islands->count))) return false;
    for (int k = 0; k < islands->count; k++)
        solver->looks[k] = (Look){.bodies = islands->islands[k].bodies,
                                  .calm = true,
                                  .slender = islands->islands[k].bodies > 4 * (islands->islands[k].loops + 1),
                                  .many = islands->islands[k].bodies > MANY_BODIES};
    for (int i = 0; i < problem->contact_count; i++)
        if (islands->island[i] >= 0) look_at_contact(&solver->looks[islands->island[i]], problem, i);
    for (int k = 0; k < islands->count; k++) decide(&solver->looks[k], solver->near, problem->dt);
    return true;
}

/* Adds up what the first sweeps left in each island. `island`: as Islands has it, or NULL if there is a single one. */
static void add_residuals(const Sweeps *sweeps, const int32_t *island, Look *looks) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        const int32_t k = island != NULL ? island[sweeps->first[i]] : 0;
        if (k < 0) continue;
        const PairResidual residual = residual_of_pair(sweeps, i);
        looks[k].left.visit += residual.visit;
        looks[k].left.held += residual.held;
    }
}

/* Whether that is little more than rounding errors. */
static bool is_still(const Look *step, const ContactProblem *problem, int contacts) {
    const float held = sqrtf(step->left.held / (float)contacts);
    const float least = step->slippery || step->slender ? 0 : same_way(still, problem->dt);
    const float limit = larger((step->slender ? slender_roundings : roundings) * 0x1p-24f * (1 + held), least);
    return step->calm && step->left.visit < limit * limit * (float)contacts;
}

/* Whether it is more than `restless_from` times what impacts may leave, in an island where such errors do no harm. */
static bool is_restless(const Look *step, float near, int contacts) {
    const float limit = restless_from * near;
    return step->calm && step->bodies > FEW_BODIES && !step->slippery && !step->slender &&
           step->left.visit > limit * limit * (float)contacts;
}

/* Makes room for a solve by the reference, so that the step that does need it allocates nothing. False when memory is
   short. */
static bool reserve_reference(State *solver, const ContactProblem *problem) {
    if (problem->body_count <= solver->bodies && problem->contact_count <= solver->contacts) return true;
    if (problem->body_count > solver->bodies) solver->bodies = problem->body_count;
    if (problem->contact_count > solver->contacts) solver->contacts = problem->contact_count;
    return reference_reserve(&solver->reference, problem);
}

static const Attempt *impact_attempts(int bodies) {
    return bodies > MANY_BODIES ? at_impact_of_many : bodies > FEW_BODIES ? at_impact : at_impact_of_few;
}

/* Some attempts, until the residual is at most `near`. False when memory is short. */
static bool attempt(State *solver, const ContactProblem *problem, const Attempt *attempts, bool close, float near) {
    const InteriorKernels *kernels = interior_best();
    for (int i = 0; i < ATTEMPTS && attempts[i].rule != NULL; i++) {
        if (!interior_load(&solver->interior, kernels, &solver->momentum.sweeps, problem)) return false;
        if (close) interior_close(&solver->interior, fmin((double)solver->near, closing), (double)problem->dt);
        interior_iterate(&solver->interior, kernels, attempts[i].rule, attempts[i].least_scale, attempts[i].lost,
                         (double)near, attempts[i].iterations);
        if (solver->interior.residual <= (double)near) return true;
    }
    return true;
}

static bool is_solved(const State *solver, const Look *step) {
    return solver->interior.residual <= (double)step->enough;
}

/* Contacts that cycle at rest mostly converge to a larger tolerance as impacts do. Among many bodies that must not let them
   open: a wall that creeps once goes on. False when memory is short. */
static bool iterate(State *solver, const ContactProblem *problem, const Look *step) {
    const Attempt *as_impact = impact_attempts(step->bodies);
    if (!step->calm) return attempt(solver, problem, as_impact, false, step->near);
    if (step->many && !jams(step)) return attempt(solver, problem, at_rest_of_many, true, step->near);
    if (step->restless) return attempt(solver, problem, as_impact, true, step->near);
    return attempt(solver, problem, at_rest, true, step->near) &&
           (is_solved(solver, step) || attempt(solver, problem, as_impact, step->many, step->enough));
}

/* Stores the reference's solution and sets *solved if its residual is at most `near`, and float can hold the impulses. Else
   the solution is not changed. False with error set when memory is short. */
static bool follow_path(State *solver, const ContactProblem *problem, ContactSolution *solution, bool *solved,
                        Error *error) {
    Reference *reference = &solver->reference;
    if (!reference_solve_to(reference, problem, (double)solver->near, FACTORIZATIONS, error)) return false;
    *solved = reference->residual <= (double)solver->near;
    for (int i = 0; i < problem->contact_count; i++)
        *solved &= reference->impulses[i].normal <= interior_impulse_max * (double)problem->contacts[i].mass_normal;
    if (!*solved) return true;
    reference_round(reference, problem, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const float limit = problem->contacts[i].friction * solution->impulses[i].normal;
        solution->impulses[i].tangent = contact_clamp(solution->impulses[i].tangent, -limit, limit);
    }
    return true;
}

/* Sweeps with momentum until the residual (methods/solvers.h) is below `near`. False when memory is short. */
static bool sweep(State *solver, const ContactProblem *problem, float near, const float *factors, int count) {
    const StoppingRule rule = {.near = near, .more = MORE_SWEEPS};
    return sweeps_begin_coloured(&solver->momentum.sweeps, sweeps_best_kernel(), problem) &&
           momentum_begin(&solver->momentum, problem) && momentum_run(&solver->momentum, factors, count) &&
           momentum_run_more(&solver->momentum, &rule, solver->more_factors);
}

/* Stores what sweep() left. */
static bool end_sweep(State *solver, ContactSolution *solution, Error *error) {
    solution->fallbacks.by_sweeps = 1;
    return momentum_end(&solver->momentum, solution) || error_memory(error, "interior");
}

/* The solution of the iterations is stored. Replaces it if the residual of sweeps is smaller. */
static bool fall_back(State *solver, bool finite, float near, const ContactProblem *problem, ContactSolution *solution,
                      Error *error) {
    const double before = solver->interior.residual;
    const float *factors = solver->fallback_factors;
    if (!sweep(solver, problem, near, factors, FALLBACK_SWEEPS) ||
        !interior_load(&solver->interior, interior_best(), &solver->momentum.sweeps, problem))
        return error_memory(error, "interior");
    if (finite && before <= solver->interior.residual) return true;
    return end_sweep(solver, solution, error);
}

/* Begins with the warm start, and with the first sweeps if the problem is calm. False when memory is short. */
static bool start(Sweeps *sweeps, const ContactProblem *problem, bool calm) {
    return sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) && (!calm || sweeps_run(sweeps, FIRST_SWEEPS));
}

/* Sweeps with momentum after the first ones. Sets *done if they are enough: the solution is stored. False when memory is
   short. */
static bool continue_sweeps(State *solver, const ContactProblem *problem, const Look *step, const float *factors,
                            int count, ContactSolution *solution, bool *done) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    const float enough = step->calm ? step->near : trusted * solver->near;
    if (!sweeps_run_momentum(sweeps, factors, count)) return false;
    *done = !residual_of_visits_reaches(sweeps, problem->contact_count, enough) && sweeps_end(sweeps, solution);
    return true;
}

/* Where sweeps with momentum save as much of an iteration as they cost. At rest iterations converge at once from the first
   sweeps, or not at all. */
static bool try_sweeps(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                       bool *done) {
    *done = false;
    if (step->calm && (!step->many || jams(step))) return true;
    if ((step->calm || !step->many) &&
        !continue_sweeps(solver, problem, step, solver->start_factors, START_SWEEPS, solution, done))
        return false;
    if (*done || !step->many) return true;
    return continue_sweeps(solver, problem, step, solver->many_factors, MANY_SWEEPS, solution, done) &&
           (*done || !step->calm || start(&solver->momentum.sweeps, problem, true));
}

/* All by sweeps with momentum. */
static bool solve_by_sweeps(State *solver, const ContactProblem *problem, float near, const float *factors, int count,
                            ContactSolution *solution, Error *error) {
    return sweep(solver, problem, near, factors, count) ? end_sweep(solver, solution, error)
                                                        : error_memory(error, "interior");
}

/* Iterations; at impacts and in small islands then the path; then sweeps. */
static bool solve_further(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                          Error *error) {
    if (!iterate(solver, problem, step)) return error_memory(error, "interior");
    const bool finite = interior_end(&solver->interior, &solver->momentum.sweeps, problem, solution);
    bool solved = finite && is_solved(solver, step);
    if (!solved && !(step->calm && step->many) && !follow_path(solver, problem, solution, &solved, error)) return false;
    return solved ||
           fall_back(solver, finite, step->calm && step->many ? step->near : solver->near, problem, solution, error);
}

/* A problem that is a single island. */
static bool solve_island(State *solver, const ContactProblem *problem, const Look *seen, int loops,
                         ContactSolution *solution, Error *error) {
    const bool large = loops > MOST_LOOPS;
    Look look = *seen, *step = &look;
    bool done = false;
    step->left = (PairResidual){0};
    if (!start(&solver->momentum.sweeps, problem, step->calm)) return error_memory(error, "interior");
    if (step->calm) {
        add_residuals(&solver->momentum.sweeps, NULL, step);
        if (is_still(step, problem, problem->contact_count) && sweeps_end(&solver->momentum.sweeps, solution))
            return true;
        step->restless = is_restless(step, solver->near, problem->contact_count);
        if (step->restless) step->near = step->enough = solver->near;
    }
    if ((!large && !reserve_reference(solver, problem)) ||
        ((!large || step->calm) && !try_sweeps(solver, problem, step, solution, &done)))
        return error_memory(error, "interior");
    if (done) return true;
    return large ? solve_by_sweeps(solver, problem, step->near, solver->large_factors, LARGE_SWEEPS, solution, error)
                 : solve_further(solver, problem, step, solution, error);
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
    if (!start(sweeps, problem, true)) return false;
    add_residuals(sweeps, solver->islands.island, solver->looks);
    *done = sweeps_end(sweeps, solution);
    return true;
}

static bool solve_islands(State *solver, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Islands *islands = &solver->islands;
    bool swept;
    if (!sweep_all(solver, problem, solution, &swept)) return error_memory(error, "interior");
    if (!swept) contact_solution_begin(problem, solution);
    for (int k = 0; k < islands->count; k++) {
        const Look *step = &solver->looks[k];
        if (swept && is_still(step, problem, islands->islands[k].contacts)) continue;
        ContactSolution of_part;
        const ContactProblem part = islands_take(islands, problem, k, &of_part);
        if (!solve_island(solver, &part, step, islands->islands[k].loops, &of_part, error)) return false;
        islands_put(islands, k, &part, &of_part, solution);
    }
    solution->fallbacks.by_sweeps = solution->fallbacks.by_sweeps > 0;
    return true;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    const Islands *islands = &solver->islands;
    if (!islands_find(&solver->islands, problem) || !look(solver, problem)) return error_memory(error, "interior");
    /* A body alone in the air would change the order of elimination. */
    const bool single = islands->count == 1 && islands->islands[0].bodies == islands->moving &&
                        islands->islands[0].contacts == problem->contact_count;
    return single ? solve_island(solver, problem, &solver->looks[0], islands->islands[0].loops, solution, error)
                  : solve_islands(solver, problem, solution, error);
}

const ContactSolverKind solver_interior = {
    .description = {.name = "interior",
                    .summary = "interior-point steps with a sparse direct solve over the bodies",
                    .caption = "interior-point steps",
                    .settings = settings,
                    .falls_back = true,
                    .chart = METHOD_RUNS("near=1", "near=0.1", "near=0.02", "near=0.002", "near=0.0005", "near=0.0001"),
                    .chart_quick = METHOD_RUNS("near=0.002"),
                    .stability_place = 2},
    .create = create,
    .solve = solve,
    .destroy = destroy};
