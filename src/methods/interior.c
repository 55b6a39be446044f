/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior-point steps with a sparse direct solve over the bodies; equations and sources in
   methods/interior_point_internal.h. Each island is solved by itself, with no more than it needs in that step: two sweeps if it
   is calm; else a few with momentum; then iterations until the residual is at most `near`: from near the bounds, and if these
   break down, from far inside them; at impacts the reference then follows the path from its beginning, also where it turns back
   (methods/interior_path.h). If nothing gets there, sweeps with momentum go on from the best answer, and the solution counts this
   as a fallback.

   The work of all this is counted in sweeps, and has a bound: iterations end when it is reached, and the best answer so far is the
   solution. The analysis of the matrix tells what an iteration costs: 5 to 10 sweeps up to a hundred boxes, 13 in a pile or a
   pyramid of 500 to 1,000, 40 in a pyramid of 820 that touch on all sides. Where too few fit in, all is left to sweeps.

   An island is calm if none of its bodies move fast relative to each other where they touch, whatever the bias: boxes that
   overlap and are pushed apart are calm, too. There errors add up from step to step: boxes creep at the speed of the error,
   until a card slides out of a house of cards or a stack leans. So the tolerance is smaller, and contacts are kept closed
   (interior_close()): what opens is not found in the next step, falls, and lands on what lies below. If two sweeps leave
   little more than rounding errors, the step ends with them: so it does in most steps at rest.

   Sweeps carry little where light bodies hold heavy ones, or where there is no friction; a calm island of such bodies is left
   to iterations. In other calm islands of more than 128 bodies, some bodies nearly always slide for long after an impact, and
   iterations towards the small tolerance cycle; sweeps with momentum then reach it in less time. After an impact an island
   is restless for some frames: calm, but the first sweeps leave much. There errors have no time to add up, and `near` will do.

   No limit depends on units: masses count as ratios, speeds at impacts by the fastest motion at a contact, and at rest by gravity
   and the engine's slop.

   Fails at impacts whose central path turns back, beyond 128 bodies, where the bound leaves no room to follow it: what bounds all
   methods there is which contacts open, stick and slide. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior_path.h"
#include "methods/interior_point_internal.h"
#include "methods/islands.h"
#include "methods/methods.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    FIRST_SWEEPS = 2,
    START_SWEEPS = 6,     /* with momentum */
    MANY_BODIES = 128,    /* more: an iteration takes as long as 10 sweeps or more, */
    MANY_SWEEPS = 12,     /* and these save more than they cost */
    LARGE_SWEEPS = 20,    /* with momentum, where iterations are too dear; then more while the residual is too large */
    LAST_SWEEPS = 8,      /* with momentum, from the best answer of iterations; then more */
    MORE_SWEEPS = 96,     /* at most, of those */
    LEAST_ON_PATH = 8,    /* factorizations */
    LEAST_ITERATIONS = 7, /* of a struck island of many: fewer seldom are as good as sweeps; */
    LEAST_ITERATIONS_AT_REST = 3 /* and one more for each hundred bodies */
};

/* A step takes at most the work of so many sweeps of each island (solvers.h). It is counted, not timed: as sweeps over the same
   contacts. */
static const double begin_work = 3, load_work = 5.5;
/* Products of blocks in a factorization, as a multiple of the number of loops to the power 1.5: 2 in pyramids and walls, 1.4 in
   piles. */
static const double usual_products = 2;
/* Kept for sweeps where iterations do not converge. */
/* A factorization of the path, in iterations. */
static const double path_work = 2;
static const double last_work = 20, last_work_of_struck_many = 40;

/* Speeds at rest are multiples of the island's pace: that of a fall through five slops, 1 m/s on Earth. An island is calm if its
   bodies move relative to each other, where they touch, by less than `calm_below` and what gravity adds in a step. Not their
   mean: it is small if a bomb strikes one of many boxes. There the tolerance is at most `calm_near`, or `many_near` among many
   bodies; without friction, where nothing holds what an error moves, `slippery_near`; in towers `slender_near`: at 3e-5 some
   stacks of 41 to 60 boxes sway for seconds, and at 1e-4 one of 40 falls; at 1e-5 no step ends with sweeps, and rounding errors
   of iterations move a stack of 20 by 15 um in 10 s. */
static const float calm_below = 1.03f, calm_near = 1e-4f, many_near = 4e-4f, slippery_near = 1e-6f,
                   slender_near = 2e-5f;
/* Some of them are multiples of no more than moves bodies by so many slops in a step. */
static const float longest_way = 1.67f;
/* Sweeps end an impact if their residual is below this share of the tolerance. Their errors are long waves, which exceed the
   residual more than those of iterations. */
static const float trusted = 0.3f;
/* And at rest no more of them follow if it is above this multiple: they rarely make up for it. */
static const float hopeless = 10;
/* In calm islands plain sweeps are enough below this, or below so many roundings of what the impulses hold; without friction,
   and in towers, only below the latter. At 1e-4 a house of cards falls, and a stack of 60 at 3 roundings. */
static const float still = 2e-5f, roundings = 3, slender_roundings = 0.3f;
/* A calm island of some size whose first sweeps leave more than this multiple of the tolerance of impacts is restless. */
static const float restless_from = 2;
/* Sweeps carry little between bodies that touch if one has more than this multiple of the other's mass. There, a multiple of
   the tolerance has to do among many bodies. */
static const float uneven_from = 10, jammed_near = 10;
/* An interior point leaves each contact a little open, and boxes that rest on each other would part. So in calm islands
   contacts aim to close by up to this speed, until they overlap a little (interior_close()). */
static const float closing = 1e-3f;
/* Attempts measure speeds by the fastest motion at a contact, and in calm islands by this. */
static const float calm_speed = 10;

/* Iterations from the start of the sweeps, near the bounds first. If these break down or cycle, it is better to start from
   there again, further inside, than from where they are. */
enum { ATTEMPTS = 3, FEW_BODIES = 32 };
static const double patient = 1e6, hasty = 10; /* for `lost` */
static const InteriorAttempt at_rest[ATTEMPTS] = {{&interior_gentle, 1e-7, hasty, 10},
                                                  {&interior_gentle, 0.01, hasty, 40},
                                                  {&interior_far, 0.01, patient, 40}},
                             at_rest_uneven[ATTEMPTS] = {{&interior_gentle, 1e-7, hasty, 10},
                                                         {&interior_far, 0.01, patient, 40}},
                             at_impact[ATTEMPTS] = {{&interior_quick, 1e-3, hasty, 20},
                                                    {&interior_far, 0.3, patient, 40},
                                                    {&interior_gentle, 1, patient, 25}};
/* Those of stacks find back after many jumps. */
static const InteriorAttempt at_impact_of_few[ATTEMPTS] = {{&interior_quick, 1e-3, patient, 30}};
/* Beyond MANY_BODIES iterations that do not converge at once rarely do, and impacts' tolerance would let contacts open. */
static const InteriorAttempt at_rest_of_many[ATTEMPTS] = {{&interior_gentle, 1e-7, hasty, 10}};
/* Impacts of more than MANY_BODIES seldom converge from near the bounds. */
static const InteriorAttempt at_impact_of_many[ATTEMPTS] = {{&interior_far, 0.1, patient, 40}};

static float smaller(float x, float y) { return x < y ? x : y; }
static float larger(float x, float y) { return x > y ? x : y; }

/* What a step is for an island. */
typedef struct Look {
    int bodies, loops; /* bodies: that move */
    float fastest;     /* (m/s)^2, relative to each other where they touch */
    float fall;        /* m/s, that gravity adds in a step */
    float pace, brief; /* m/s, units of speeds at rest; brief: the one that gets shorter in long steps */
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
    InteriorPath path;
    double left;            /* of the island's work, in sweeps */
    double work;            /* the most of an island in the last step */
    bool analysed;          /* the island's matrix is, */
    bool loaded;            /* and iterations may begin */
    double best;            /* m/s, residual of the solution that is stored */
    ContactPoint *contacts; /* [contact_count] with the best answer as warm start */
    size_t contact_capacity;
    float start_factors[START_SWEEPS], many_factors[MANY_SWEEPS], large_factors[LARGE_SWEEPS],
        last_factors[LAST_SWEEPS], more_factors[MORE_SWEEPS];
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
    interior_path_free(&solver->path);
    free(solver->contacts);
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
    set_factors(solver->large_factors, LARGE_SWEEPS);
    set_factors(solver->last_factors, LAST_SWEEPS);
    set_factors(solver->more_factors, MORE_SWEEPS);
    return solver;
}

static bool is_uneven(float inv_mass_a, float inv_mass_b) {
    return inv_mass_a > 0 && inv_mass_b > 0 &&
           (inv_mass_a > uneven_from * inv_mass_b || inv_mass_b > uneven_from * inv_mass_a);
}

static void look_at_contact(Look *step, const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    const float motion = residual_of_motion(problem, i);
    if (!(motion <= step->fastest)) step->fastest = motion; /* NaN, too */
    step->slippery |= contact->friction < INTERIOR_SLIPPERY;
    step->uneven |= is_uneven(problem->bodies[contact->a].inv_mass, problem->bodies[contact->b].inv_mass);
}

static float tolerance(const Look *step, float near) {
    if (!step->calm) return near;
    if (step->slippery) return smaller(near, slippery_near * step->pace);
    if (step->slender) return smaller(near, slender_near * step->pace);
    return smaller(near, step->many && !step->uneven ? many_near * step->brief : calm_near * step->pace);
}

/* Sweeps carry little between its bodies. */
static bool jams(const Look *step) { return step->slippery || step->uneven; }

static void decide(Look *step, float near) {
    const float limit = step->fall + calm_below * step->pace;
    step->calm = step->fastest < limit * limit;
    step->near = tolerance(step, near);
    step->enough = !step->calm || !step->many ? near : jams(step) ? jammed_near * step->near : step->near;
}

/* m/s: what attempts measure speeds by. */
static double speed_of(const Look *step) {
    return step->calm ? (double)(calm_speed * step->pace) : sqrt((double)step->fastest);
}

/* Looks at each island before the step. False when memory is short. */
static bool look(State *solver, const ContactProblem *problem) {
    const Islands *islands = &solver->islands;
    const float pace = sqrtf(10 * CONTACT_SLOP * problem->fall / problem->dt);
    if (!ARRAY_BLOCK_RESERVE(&solver->look_block, ARRAY_PART(solver->looks, islands->count))) return false;
    for (int k = 0; k < islands->count; k++)
        solver->looks[k] = (Look){.bodies = islands->islands[k].bodies,
                                  .loops = islands->islands[k].loops,
                                  .fall = problem->fall,
                                  .pace = pace,
                                  .brief = smaller(pace, longest_way * CONTACT_SLOP / problem->dt),
                                  .slender = islands->islands[k].bodies > 4 * (islands->islands[k].loops + 1),
                                  .many = islands->islands[k].bodies > MANY_BODIES};
    for (int i = 0; i < problem->contact_count; i++)
        if (islands->island[i] >= 0) look_at_contact(&solver->looks[islands->island[i]], problem, i);
    for (int k = 0; k < islands->count; k++) decide(&solver->looks[k], solver->near);
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
static bool is_still(const Look *step, int contacts) {
    const float held = sqrtf(step->left.held / (float)contacts);
    const float least = step->slippery || step->slender ? 0 : still * step->brief;
    const float limit = larger((step->slender ? slender_roundings : roundings) * 0x1p-24f * (step->pace + held), least);
    return step->calm && step->left.visit < limit * limit * (float)contacts;
}

/* Whether it is more than `restless_from` times what impacts may leave, in an island where such errors do no harm. */
static bool is_restless(const Look *step, float near, int contacts) {
    const float limit = restless_from * near;
    return step->calm && step->bodies > FEW_BODIES && !step->slippery && !step->slender &&
           step->left.visit > limit * limit * (float)contacts;
}

/* Begins with the warm start, and with the first sweeps if the problem is calm. False when memory is short. */
static bool start(State *solver, const ContactProblem *problem, bool calm) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    solver->left -= begin_work + (calm ? FIRST_SWEEPS : 0);
    return sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) && (!calm || sweeps_run(sweeps, FIRST_SWEEPS));
}

/* Sweeps with momentum after the first ones. Sets *done if they are enough: the solution is stored. False when memory is
   short. */
static bool continue_sweeps(State *solver, const ContactProblem *problem, const Look *step, const float *factors,
                            int count, ContactSolution *solution, bool *done) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    const float enough = step->calm ? step->near : trusted * solver->near;
    solver->left -= count;
    if (!sweeps_run_momentum(sweeps, factors, count)) return false;
    *done = !residual_of_visits_reaches(sweeps, problem->contact_count, enough) && sweeps_end(sweeps, solution);
    return true;
}

/* Where sweeps with momentum save as much of an iteration as they cost. At rest iterations converge at once from the first
   sweeps, or not at all; impacts of many bodies that are not solved by these are hard, and iterations then converge sooner from
   the plain start. */
static bool try_sweeps(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                       bool *done) {
    *done = false;
    if (step->calm && (!step->many || jams(step))) return true;
    if ((step->calm || !step->many) &&
        !continue_sweeps(solver, problem, step, solver->start_factors, START_SWEEPS, solution, done))
        return false;
    if (*done || !step->many) return true;
    if (step->calm &&
        residual_of_visits_reaches(&solver->momentum.sweeps, problem->contact_count, hopeless * step->near))
        return start(solver, problem, true);
    return continue_sweeps(solver, problem, step, solver->many_factors, MANY_SWEEPS, solution, done) &&
           (*done || start(solver, problem, step->calm));
}

/* Of the matrix of an island. */
static double analysis_work(const Look *step) { return fmin(2 + step->bodies / 16.0, 14); }

/* False when memory is short. */
static bool load(State *solver, const ContactProblem *problem, const Look *step) {
    solver->left -= load_work + (solver->analysed ? 0 : analysis_work(step));
    solver->analysed = solver->loaded = true;
    return interior_load(&solver->interior, interior_best(), &solver->momentum.sweeps, problem);
}

/* Iterations of that work that the island's has room for, after a step that takes `before` of it. */
static int affordable(const State *solver, const Look *step, double before, double iteration_work) {
    const double kept = step->many && !step->calm ? last_work_of_struck_many : last_work;
    return (int)fmax((solver->left - before - kept) / iteration_work, 0);
}

/* Loads the island, unless its iterations are too dear: by what its loops tell, so that its matrix is not analysed in vain; then
   by the analysis. Sets *cheap. False when memory is short. */
static bool load_if_cheap(State *solver, const ContactProblem *problem, const Look *step, bool *cheap) {
    const double usual =
        interior_work(usual_products * step->loops * sqrt(step->loops), solver->momentum.sweeps.pair_count);
    const int least = !step->many ? 0 : step->calm ? LEAST_ITERATIONS_AT_REST + step->bodies / 100 : LEAST_ITERATIONS;
    *cheap = affordable(solver, step, load_work + analysis_work(step), usual) >= least;
    if (!*cheap) return true;
    if (!load(solver, problem, step)) return false;
    *cheap = affordable(solver, step, 0, solver->interior.iteration_work) >= least;
    return true;
}

/* Stores the answer of the iterations if it is the best so far. */
static void offer(State *solver, const ContactProblem *problem, ContactSolution *solution) {
    const Interior *interior = &solver->interior;
    if (interior->residual < solver->best && interior_end(interior, &solver->momentum.sweeps, problem, solution))
        solver->best = interior->residual;
}

/* Some attempts, until the residual is at most `near` or the work is done. False when memory is short. */
static bool attempt(State *solver, const ContactProblem *problem, const Look *step, const InteriorAttempt *attempts,
                    bool close, float near, ContactSolution *solution) {
    Interior *interior = &solver->interior;
    for (int i = 0; i < ATTEMPTS && attempts[i].rule != NULL && solver->best > (double)near; i++) {
        const double again = solver->loaded ? 0 : begin_work + FIRST_SWEEPS + load_work;
        const int most = affordable(solver, step, again, interior->iteration_work);
        if (most == 0) return true;
        if (!solver->loaded && !(start(solver, problem, step->calm) && load(solver, problem, step))) return false;
        solver->loaded = false;
        if (close) interior_close(interior, (double)smaller(solver->near, closing * step->pace), (double)problem->dt);
        interior_iterate(interior, interior_best(), &attempts[i], speed_of(step), (double)near, most);
        solver->left -= interior->iterations * interior->iteration_work;
        offer(solver, problem, solution);
    }
    return true;
}

/* Contacts that cycle at rest mostly converge to a larger tolerance as impacts do. Among many bodies that must not let them
   open: a wall that creeps once goes on. False when memory is short. */
static bool iterate(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution) {
    const InteriorAttempt *as_impact = step->many                  ? at_impact_of_many
                                       : step->bodies > FEW_BODIES ? at_impact
                                                                   : at_impact_of_few;
    const bool close = step->calm;
    if (!step->calm || (step->restless && (!step->many || jams(step))))
        return attempt(solver, problem, step, as_impact, close, step->near, solution);
    if (step->many && !jams(step)) return attempt(solver, problem, step, at_rest_of_many, close, step->near, solution);
    return attempt(solver, problem, step, step->uneven ? at_rest_uneven : at_rest, close, step->near, solution);
}

/* Stores the path's solution if its residual is the least so far. */
static bool follow_path(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                        Error *error) {
    InteriorPath *path = &solver->path;
    const double each = path_work * solver->interior.iteration_work;
    const int most = (int)fmax((solver->left - last_work) / each, 0);
    if (most < LEAST_ON_PATH) return true;
    if (!interior_path_follow(path, problem, speed_of(step), (double)solver->near, most, error)) return false;
    solver->left -= path->reference.factorizations * each;
    if (!(path->residual < solver->best)) return true;
    solver->best = path->residual;
    interior_path_take(path, problem, solution);
    return true;
}

/* Begins, and sweeps with momentum until the residual (methods/solvers.h) is below `near`, or the work is done. False when
   memory is short. */
static bool sweep(State *solver, const ContactProblem *problem, float near, const float *factors, int count) {
    if (!start(solver, problem, false)) return false;
    const int more = (int)fmin(fmax(solver->left - count, 0), MORE_SWEEPS) / STOPPING_BLOCK * STOPPING_BLOCK;
    const StoppingRule rule = {.near = near, .more = more};
    solver->left -= count + more;
    return momentum_begin(&solver->momentum, problem) && momentum_run(&solver->momentum, factors, count) &&
           momentum_run_more(&solver->momentum, &rule, solver->more_factors);
}

/* All by sweeps with momentum. */
static bool solve_by_sweeps(State *solver, const ContactProblem *problem, float near, ContactSolution *solution,
                            Error *error) {
    solution->fallbacks.by_sweeps = 1;
    return (sweep(solver, problem, near, solver->large_factors, LARGE_SWEEPS) &&
            momentum_end(&solver->momentum, solution)) ||
           error_memory(error, "interior");
}

/* m/s, as that of the iterations. */
static double residual_of(const Sweeps *sweeps, int contacts) {
    Look all = {0};
    add_residuals(sweeps, NULL, &all);
    return sqrt((double)all.left.visit / contacts);
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
    if ((finite && !begin_from(solver, problem, solution, &from)) ||
        !sweep(solver, &from, near, solver->last_factors, LAST_SWEEPS))
        return error_memory(error, "interior");
    const double after = residual_of(&solver->momentum.sweeps, problem->contact_count);
    solution->fallbacks.by_sweeps = 1;
    return (finite && !(after < solver->best)) || momentum_end(&solver->momentum, solution) ||
           error_memory(error, "interior");
}

/* Iterations, then sweeps. */
static bool solve_further(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                          Error *error) {
    const float near = step->calm && step->many ? step->near : solver->near;
    solver->best = INFINITY;
    bool cheap;
    if (!load_if_cheap(solver, problem, step, &cheap)) return error_memory(error, "interior");
    if (!cheap) return solve_by_sweeps(solver, problem, near, solution, error);
    if (!interior_path_reserve(&solver->path, problem) || !iterate(solver, problem, step, solution))
        return error_memory(error, "interior");
    if (solver->best > (double)step->enough && !(step->calm && step->many) &&
        !follow_path(solver, problem, step, solution, error))
        return false;
    return solver->best <= (double)step->enough || fall_back(solver, problem, near, solution, error);
}

static double most_work(const Look *step) { return step->many ? INTERIOR_MOST_WORK_OF_MANY : INTERIOR_MOST_WORK; }

/* A problem that is a single island. */
static bool solve_island(State *solver, const ContactProblem *problem, const Look *seen, ContactSolution *solution,
                         Error *error) {
    Look look = *seen, *step = &look;
    bool done = false;
    step->left = (PairResidual){0};
    solver->left = most_work(step);
    solver->analysed = solver->loaded = false;
    if (!start(solver, problem, step->calm)) return error_memory(error, "interior");
    if (step->calm) {
        add_residuals(&solver->momentum.sweeps, NULL, step);
        if (is_still(step, problem->contact_count) && sweeps_end(&solver->momentum.sweeps, solution)) return true;
        step->restless = is_restless(step, solver->near, problem->contact_count);
        if (step->restless) step->near = step->enough = solver->near;
    }
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
    if (!start(solver, problem, true)) return false;
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
        if (swept && is_still(step, islands->islands[k].contacts)) continue;
        ContactSolution of_part;
        const ContactProblem part = islands_take(islands, problem, k, &of_part);
        if (!solve_island(solver, &part, step, &of_part, error)) return false;
        solver->work = fmax(solver->work, most_work(step) - solver->left);
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
    solver->work = 0;
    if (!single) return solve_islands(solver, problem, solution, error);
    const bool done = solve_island(solver, problem, &solver->looks[0], solution, error);
    solver->work = most_work(&solver->looks[0]) - solver->left;
    return done;
}

double interior_work_done(const void *state) { return ((const State *)state)->work; }

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
