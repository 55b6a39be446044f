/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior-point steps with a sparse direct solve over the bodies; equations and sources in
   methods/interior_point_internal.h. Each island is solved by itself, with no more than it needs in that step (Look):

   1. Two sweeps if it is calm. In most steps at rest they are the solution.
   2. From 34 bodies on, iterations until the residual is at most what the step asks for; from 129 on, a few sweeps with
      momentum first, where they save more than they cost.
   3. The reference's solver (methods/reference.h), which follows the central path, also where it turns back. Up to 33
      bodies it comes first: it takes 0.82 of the time of 2, with a fortieth of the error. Beyond, its iterations take
      1.7 times as long, and it needs more of them; from 129 on, sweeps get farther in that time.
   4. If nothing gets there, sweeps with momentum from the best answer; the solution counts this as a fallback.

   The work of all this is counted in sweeps, and is at most 30 times that of the engine's ten. Each attempt gets two
   thirds of what is left. The analysis of the matrix tells what an iteration costs: 5 to 10 sweeps up to a hundred
   boxes, 13 in a pile or a pyramid of 500 to 1,000, 40 in a pyramid of 820 that touch on all sides. The difficulty, for
   all methods, is to find which contacts open, stick and slide. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior_point_internal.h"
#include "methods/impulses.h"
#include "methods/islands.h"
#include "methods/methods.h"
#include "methods/momentum.h"
#include "methods/reference.h"
#include "methods/residual.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    FIRST_SWEEPS = 2,    /* with 1 a wall of 85 boxes at rest takes 2.2 times as long, with 4 some impacts 1.7 times */
    START_SWEEPS = 6,    /* with momentum. Without them a wall of 314 boxes takes 2.2 times as long, struck 2.8 times */
    MOST_ITERATIONS = 40 /* what takes more rarely converges; with 10 struck pyramids take up to twice the work */
};

/* Work is counted, not timed, in coloured sweeps over the island's contacts. Its bound is 300 of the engine's own
   sweeps: each takes as long as 2.6 of these over 9 bodies, and as 4.9 to 6.8 over more (INTERIOR_MOST_WORK). */
static const double few_most_work = 780;
static const double begin_work = 3, load_work = 5.5;
/* Of the work that is left, for an attempt. With 1/2, an impact on a pyramid of 21 boxes ends in sweeps; with 1, sweeps
   get nothing after iterations on 7,260 boxes. */
static const double attempt_share = 2.0 / 3;

/* What a step is for each island, as the method interior sees it: calm or struck, few bodies or many, and the residuals
   that it has to reach.

   An island is calm if none of its bodies move fast relative to each other where they touch, whatever the bias: boxes
   that overlap and are pushed apart are calm, too. There errors add up from step to step: boxes creep at the speed of
   the error, until a card slides out of a house of cards or a stack leans. So the tolerance is smaller than that of
   impacts, `near`.

   No limit depends on units: masses count as ratios, speeds at impacts by the fastest motion at a contact, and at rest
   by gravity and the engine's slop. */

/* Many: an iteration takes as long as 10 sweeps or more; with the limit at 33 rest takes 1.4 to 3 times as long. Few:
   the reference's own solver. */
enum { FEW_BODIES = 33, MANY_BODIES = 128 };
/* A tower has more bodies than this times its loops plus one: 9 without a loop, 17 with one, as in a gate. With 4 a
   gate of 11 boxes at rest takes up to 1.8 times as long; with 16 nine boxes drift by 0.9 mm in 10,000 steps. */
enum { TOWER_BODIES = 8 };
/* Friction below this holds nothing. Without this limit three bridges and two towers without friction fall. */
static const float slippery_below = 0.01f;
/* Of the tolerance, a mean over contacts; the reference's is the largest. With 1 impacts have 1.5 times the error. */
static const double few_share = 0.25;
/* A factorization of the reference with all that goes with it: for few bodies, in sweeps; for others, in iterations. */
static const double few_work = 7.5, path_work = 1.7;

typedef struct Look {
    int bodies;    /* that move */
    float fastest; /* (m/s)^2, relative to each other where they touch */
    float before;  /* (m/s)^2, the sum of that over contacts of two bodies that move */
    float pace;    /* m/s, the unit of speeds at rest */
    bool calm, many, slippery;
    float unlike; /* the largest multiple of the other's mass, of two bodies that touch */
    bool slender; /* towers: few loops */
    float near;   /* m/s, the largest residual of a solution */
    float enough; /* m/s, the same for equal masses: an answer of the reference up to it is taken; above it, a jam */
    float left;   /* (m/s)^2, residual after sweeps: sum over its contacts */
} Look;

/* Speeds at rest are multiples of the island's pace, which a body has after a fall through five slops: 1 m/s on Earth.
   With a third of it impacts have 1.2 times the error, with three times a wall of 314 boxes takes twice as long at
   rest. An island is calm if bodies that touch move there, relative to each other, by less than that and what gravity
   adds in a step. Each contact counts, not the mean, which is small if a bomb strikes one of many boxes. The tolerance
   of calm islands is at most `calm_near`: with four times that, a pyramid of 990 boxes moves 8 times as far. Where
   nothing holds what an error moves, without friction, and in towers, where the top moves by all errors below, it is
   `fine_near` over the number of bodies: with 1e-5 a tower falls. */
static const float calm_near = 1e-4f, fine_near = 3e-6f;
/* Sweeps may add this share of the tolerance to the speeds from before the step (is_solved). With all of it a pile of
   70 boxes moves 30 times as far. */
static const float most_added = 0.5f;
/* The tolerance of a calm island is divided by the largest multiple over this of the other's mass, of two bodies that
   touch: what is a rounding error to the heavy one throws the light one. With 3 a pile of 70 boxes takes 1.2 times as
   long. */
static const float uneven_from = 10;

typedef struct State {
    float near; /* m/s */
    Interior interior;
    Islands islands;
    Look *looks; /* [islands.count] */
    ArrayBlock look_block;
    Momentum momentum;
    double left;            /* of the island's work, in sweeps */
    double work;            /* the most of an island in the last step */
    double best;            /* m/s, residual of the solution that is stored */
    ContactPoint *contacts; /* [contact_count] with the best answer as warm start */
    size_t contact_capacity;
    Reference reference; /* solves small islands */
    ContactSolution other;
    ArrayBlock other_block; /* of `other` */
    float start_factors[START_SWEEPS], fallback_factors[INTERIOR_MOST_WORK];
} State;

static float smaller(float x, float y) { return x < y ? x : y; }

static float larger(float x, float y) { return x > y ? x : y; }

/* Before the step. */
static void look_at_islands(State *solver, const ContactProblem *problem) {
    const Islands *islands = &solver->islands;
    const float pace = sqrtf(10 * CONTACT_SLOP * problem->fall / problem->dt);
    for (int k = 0; k < islands->count; k++)
        solver->looks[k] =
            (Look){.bodies = islands->islands[k].bodies,
                   .pace = pace,
                   .near = solver->near,
                   .enough = solver->near,
                   .slender = islands->islands[k].bodies > TOWER_BODIES * (islands->islands[k].loops + 1),
                   .many = islands->islands[k].bodies > MANY_BODIES};
    for (int i = 0; i < problem->contact_count; i++) {
        if (islands->island[i] < 0) continue;
        Look *look = &solver->looks[islands->island[i]];
        const ContactPoint *contact = &problem->contacts[i];
        const float inv_mass_a = problem->bodies[contact->a].inv_mass,
                    inv_mass_b = problem->bodies[contact->b].inv_mass, motion = residual_of_motion(problem, i);
        if (!(motion <= look->fastest)) look->fastest = motion; /* NaN, too */
        look->slippery |= contact->friction < slippery_below;
        if (inv_mass_a > 0 && inv_mass_b > 0) {
            look->before += motion;
            look->unlike = larger(look->unlike, larger(inv_mass_a / inv_mass_b, inv_mass_b / inv_mass_a));
        }
    }
    for (int k = 0; k < islands->count; k++) {
        Look *look = &solver->looks[k];
        const float limit = problem->fall + pace;
        look->calm = look->fastest < limit * limit;
        if (!look->calm) continue;
        const bool fine = look->slippery || look->slender;
        const float most = (fine ? fine_near : calm_near) * look->pace, shares = fine ? (float)look->bodies : 1;
        look->near = smaller(solver->near, most / (shares * larger(look->unlike / uneven_from, 1)));
        look->enough = larger(look->near, smaller(solver->near, most));
    }
}

/* Adds up what sweeps left in each island. `island`: as Islands has it, or NULL if there is a single one. */
static void look_at_residuals(Look *looks, const Sweeps *sweeps, const int32_t *island) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        const int32_t k = island != NULL ? island[sweeps->first[i]] : 0;
        if (k >= 0) looks[k].left += residual_of_pair(sweeps, i);
    }
}

/* Whether sweeps have solved the step: their residual, root mean square over so many contacts, is within the tolerance,
   and exceeds the speeds from before by no more than a share of it. At rest an error e of the impulses adds e to the
   speeds in each step while sweeps leave it there. After m steps m e is out of tolerance; iterations then stop the
   bodies by impulses whose error is -(m - 1) e. If sweeps left that there, too, this would go on for ever. As m is 2 or
   more, it is more than half of the tolerance, so the next step takes iterations again, and ends it. */
static bool is_solved(const Look *look, int contacts) {
    const float left = sqrtf(look->left / (float)contacts), before = sqrtf(look->before / (float)contacts);
    return left < look->near && left < before + most_added * look->near;
}

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
    free(solver->other_block.memory);
    momentum_free(&solver->momentum);
    reference_free(&solver->reference);
    free(solver->contacts);
    free(solver);
}

static void set_factors(float *factors, int count) {
    for (int s = 0; s < count; s++) factors[s] = momentum_factor(s);
}

static void *create(const Settings *chosen, Error *error) {
    static const State standard = {.near = 0.002f};
    State *solver = settings_make(chosen, settings, &standard, sizeof standard, "interior", error);
    if (solver == NULL) return NULL;
    set_factors(solver->start_factors, START_SWEEPS);
    set_factors(solver->fallback_factors, INTERIOR_MOST_WORK);
    return solver;
}

/* Begins with the warm start, and with the first sweeps if the problem is calm. False when memory is short. */
static bool start(State *solver, const ContactProblem *problem, bool calm) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    solver->left -= begin_work + (calm ? FIRST_SWEEPS : 0);
    return sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) && (!calm || sweeps_run(sweeps, FIRST_SWEEPS));
}

/* Sweeps with momentum after the first ones, for islands of many bodies: many impacts are over with them, in a fraction
   of an iteration's time. In calm islands of many bodies some nearly always slide for long after an impact: there
   iterations towards the small tolerance cycle, and sweeps reach it. Without friction sweeps carry little. What these
   sweeps do not solve is hard: iterations then converge sooner from the plain start. Sets *done if the sweeps are
   enough: the solution is stored. False when memory is short. */
static bool try_sweeps(State *solver, const ContactProblem *problem, Look *step, ContactSolution *solution,
                       bool *done) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    *done = false;
    if (!step->many || step->slippery) return true;
    solver->left -= START_SWEEPS;
    if (!sweeps_run_momentum(sweeps, solver->start_factors, START_SWEEPS)) return false;
    step->left = 0;
    look_at_residuals(step, sweeps, NULL);
    *done = is_solved(step, problem->contact_count) && sweeps_end(sweeps, solution);
    return *done || start(solver, problem, step->calm);
}

/* False when memory is short. */
static bool load_interior(State *solver, const ContactProblem *problem, const Look *step) {
    const double analysis = fmin(2 + step->bodies / 16.0, 14); /* of the matrix */
    solver->left -= analysis + load_work;
    return interior_load(&solver->interior, interior_best(), &solver->momentum.sweeps, problem);
}

/* How many steps, each of that work, there is room for. */
static int room(double work, double each) { return (int)fmax(work / each, 0); }

/* Until the residual is at most `near`, or the work is done. */
static void iterate(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution) {
    Interior *interior = &solver->interior;
    const int most = room(attempt_share * solver->left, interior->iteration_work);
    const double speed = fmax(sqrt((double)step->fastest), (double)step->pace);
    interior_iterate(interior, interior_best(), speed, (double)step->near,
                     most < MOST_ITERATIONS ? most : MOST_ITERATIONS);
    solver->left -= interior->iterations * interior->iteration_work;
    if (interior_end(interior, &solver->momentum.sweeps, problem, solution)) solver->best = interior->residual;
}

/* After start(): as momentum:k=1,near=NEAR (residual: methods/residual.h), until the work is done.
   False when memory is short. */
static bool sweep(State *solver, const ContactProblem *problem, float near) {
    const int more = (int)fmax(solver->left - 1, 0) / STOPPING_BLOCK * STOPPING_BLOCK;
    const StoppingRule rule = {.near = near, .more = more};
    solver->left -= 1 + more;
    return momentum_begin(&solver->momentum, problem) && momentum_run(&solver->momentum, solver->fallback_factors, 1) &&
           momentum_run_more(&solver->momentum, &rule, solver->fallback_factors);
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

/* Sweeps from the best answer of the iterations, which is stored as the solution, if there is one. Replaces it if their
   residual is smaller. */
static bool fall_back(State *solver, const ContactProblem *problem, float near, ContactSolution *solution,
                      Error *error) {
    const bool finite = solver->best < INFINITY;
    ContactProblem from = *problem;
    if ((finite && !begin_from(solver, problem, solution, &from)) || !start(solver, &from, false) ||
        !sweep(solver, &from, near))
        return error_memory(error, "interior");
    Look all = {0}; /* as the residual of the iterations, m/s: */
    look_at_residuals(&all, &solver->momentum.sweeps, NULL);
    const double after = sqrt((double)all.left / problem->contact_count);
    solution->fallbacks.by_sweeps = 1;
    return (finite && !(after < solver->best)) || momentum_end(&solver->momentum, solution) ||
           error_memory(error, "interior");
}

/* What the reference is asked for: a share of the tolerance, and no less than its own. Struck islands converge sooner
   without its patience. */
static ReferenceAim aim_at(const Look *step, double share, int most) {
    return (ReferenceAim){.tolerance = fmax(share * (double)step->near, REFERENCE_TOLERANCE),
                          .most = most,
                          .push_out = true,
                          .by_heaviest = step->calm};
}

/* Sets `best`: INFINITY if the answer is not taken. The tolerance for unlike masses may be below what rounding lets the
   reference reach; a jam has no answer within that for equal ones. work: of a factorization. Rounded impulses are put
   back into their cones. False when memory is short. */
static bool ask_reference(State *solver, const ContactProblem *problem, const Look *step, const ReferenceAim *aim,
                          double work, ContactSolution *solution, Error *error) {
    Reference *reference = &solver->reference;
    if (!reference_solve_to(reference, problem, aim, error)) return false;
    solver->left -= load_work + work * reference->factorizations;
    reference_round(reference, problem, solution);
    bool finite = true;
    for (int i = 0; i < problem->body_count; i++) {
        const BodyVelocity *v = &solution->velocities[i];
        finite &= isfinite(v->linear.x) && isfinite(v->linear.y) && isfinite(v->angular);
    }
    for (int i = 0; i < problem->contact_count; i++) {
        ContactImpulse *impulse = &solution->impulses[i];
        const float limit = problem->contacts[i].friction * impulse->normal;
        impulse->tangent = contact_clamp(impulse->tangent, -limit, limit);
        finite &= isfinite(limit) && isfinite(impulse->tangent);
    }
    solver->best = finite && reference->residual <= (double)step->enough ? reference->residual : INFINITY;
    return true;
}

static bool reserve_other(State *solver, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    return ARRAY_BLOCK_RESERVE(&solver->other_block, ARRAY_PART(solver->other.velocities, bodies),
                               ARRAY_PART(solver->other.impulses, contacts));
}

static void take_other(const State *solver, const ContactProblem *problem, ContactSolution *solution) {
    const ContactSolution *other = &solver->other;
    memcpy(solution->velocities, other->velocities, (size_t)problem->body_count * sizeof *other->velocities);
    memcpy(solution->impulses, other->impulses, (size_t)problem->contact_count * sizeof *other->impulses);
}

/* After iterations that did not get there: the reference's path, then sweeps. With many bodies the path is long, so
   sweeps follow at once. */
static bool follow_path(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                        Error *error) {
    if (!step->many) {
        const double best = solver->best, work = path_work * solver->interior.iteration_work;
        const ReferenceAim aim = aim_at(step, 1, room(attempt_share * solver->left - load_work, work));
        if (!reserve_other(solver, problem)) return error_memory(error, "interior");
        if (!ask_reference(solver, problem, step, &aim, work, &solver->other, error)) return false;
        if (solver->best < INFINITY) {
            take_other(solver, problem, solution);
            return true;
        }
        solver->best = best;
    }
    return fall_back(solver, problem, step->near, solution, error);
}

/* After sweeps: the answer without position correction instead, if its residual is smaller. In a jam no answer has what
   correction asks for. False when memory is short. */
static bool answer_jam(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                       Error *error) {
    ContactSolution *other = &solver->other;
    double swept, freed;
    if (!reference_residual(&solver->reference, problem, solution->impulses, &swept, error)) return false;
    if (swept <= (double)step->near) return true;
    if (!reserve_other(solver, problem)) return error_memory(error, "interior");
    ReferenceAim aim = aim_at(step, few_share, room(solver->left - load_work, few_work));
    aim.push_out = false;
    if (!ask_reference(solver, problem, step, &aim, few_work, other, error)) return false;
    if (solver->best == INFINITY) return true;
    if (!reference_residual(&solver->reference, problem, other->impulses, &freed, error)) return false;
    if (freed < swept) take_other(solver, problem, solution);
    return true;
}

/* All by the reference. What it does not solve may hold jammed bodies with impulses that grow for ever: sweeps begin
   from the warm start, with half of what is left. False when memory is short. */
static bool follow_whole_path(State *solver, const ContactProblem *problem, const Look *step, ContactSolution *solution,
                              Error *error) {
    const ReferenceAim aim = aim_at(step, few_share, room(attempt_share * solver->left - load_work, few_work));
    if (!ask_reference(solver, problem, step, &aim, few_work, solution, error)) return false;
    if (solver->best < INFINITY) return true;
    const double half = solver->left / 2;
    solver->left = half;
    if (!fall_back(solver, problem, step->near, solution, error)) return false;
    solver->left += half;
    return answer_jam(solver, problem, step, solution, error);
}

static double most_work(const Look *look) { return look->bodies <= FEW_BODIES ? few_most_work : INTERIOR_MOST_WORK; }

/* A problem that is a single island. */
static bool solve_island(State *solver, const ContactProblem *problem, const Look *seen, ContactSolution *solution,
                         Error *error) {
    Look look = *seen, *step = &look;
    bool done = false;
    step->left = 0;
    solver->left = most_work(step);
    if (!start(solver, problem, step->calm)) return error_memory(error, "interior");
    if (step->calm) {
        look_at_residuals(step, &solver->momentum.sweeps, NULL);
        if (is_solved(step, problem->contact_count) && sweeps_end(&solver->momentum.sweeps, solution)) return true;
    }
    if (step->bodies <= FEW_BODIES) return follow_whole_path(solver, problem, step, solution, error);
    if (!try_sweeps(solver, problem, step, solution, &done)) return error_memory(error, "interior");
    if (done) return true;
    solver->best = INFINITY;
    if (!load_interior(solver, problem, step)) return error_memory(error, "interior");
    iterate(solver, problem, step, solution);
    return solver->best <= (double)step->near || follow_path(solver, problem, step, solution, error);
}

static bool solve_islands(State *solver, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Islands *islands = &solver->islands;
    Sweeps *sweeps = &solver->momentum.sweeps;
    int calm = 0;
    for (int k = 0; k < islands->count; k++) calm += solver->looks[k].calm ? islands->islands[k].contacts : 0;
    bool swept = 2 * calm > problem->contact_count;
    if (swept) { /* the first sweeps of all islands at once: the same bits in less time */
        if (!start(solver, problem, true)) return error_memory(error, "interior");
        look_at_residuals(solver->looks, sweeps, islands->island);
        swept = sweeps_end(sweeps, solution);
    }
    if (!swept) contact_solution_begin(problem, solution);
    for (int k = 0; k < islands->count; k++) {
        const Look *step = &solver->looks[k];
        if (swept && step->calm && is_solved(step, islands->islands[k].contacts)) continue;
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
    if (!islands_find(&solver->islands, problem) ||
        !ARRAY_BLOCK_RESERVE(&solver->look_block, ARRAY_PART(solver->looks, islands->count)))
        return error_memory(error, "interior");
    look_at_islands(solver, problem);
    /* A body alone in the air would change the order of elimination. */
    const bool single = islands->count == 1 && islands->islands[0].bodies == islands->moving &&
                        islands->islands[0].contacts == problem->contact_count;
    solver->work = 0;
    if (!(single ? solve_island(solver, problem, &solver->looks[0], solution, error)
                 : solve_islands(solver, problem, solution, error)))
        return false;
    if (single) solver->work = most_work(&solver->looks[0]) - solver->left;
    return islands_take_gain(&solver->islands, problem, solution) || error_memory(error, "interior");
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
    .create = create,
    .solve = solve,
    .destroy = destroy};
