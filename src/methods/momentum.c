/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential impulses with momentum extrapolation between sweeps: before each sweep the impulses, and the velocities,
   which are linear in them, continue along their last change. With p[s] and v[s] after sweep s,

       p = p[s] + beta[s] (p[s] - p[s-1]),   v = v[s] + beta[s] (v[s] - v[s-1])

   is where sweep s + 1 begins; the sweep projects the impulses back into their cones. Source: Nesterov, "A Method of
   Solving a Convex Programming Problem with Convergence Rate O(1/k^2)" (1983); for contacts Mazhar, Heyn, Negrut,
   Tasora, "Using Nesterov's Method to Accelerate Multibody Dynamics with Friction and Contact" (2015), with full
   gradient steps in place of sweeps. Sweeps visit contacts in the order of colours: as accurate, and faster.

   Extrapolation can carry impulses past the solution for ever. It even makes errors grow where boxes slide: there
   friction follows the normal impulse and acts on the normal velocity, too, so a visit overshoots, by a share e of the
   error, and the error grows if e (1 + 2 beta) > 1 (its factor z solves z^2 + e (1 + beta) z - e beta = 0). So the
   first sweeps have a lower beta where contacts slide.

   Sweeps are watched there, and in runs of more than 16: each island's residual, the largest change by one more visit,
   is measured after blocks of 16, or of 8 where contacts slide or a stopping rule reads it, and in the end; its
   velocities are first computed anew from the impulses. If the residual exceeds twice the least, the island goes back
   to the solution that was best, and momentum restarts (O'Donoghue, Candes, "Adaptive Restart for Accelerated Gradient
   Schemes", 2015), with a beta that rises half as long as before, or it would take the same course for ever; longer
   again with each look that finds no rise. An island whose residual is not its least in the end goes back, too. Nothing
   here depends on the number of sweeps that follow: more sweeps continue fewer.

   Fails while friction cones change from sweep to sweep: then the extrapolation is wrong, so the first sweeps of an
   impact gain little. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/momentum.h"
#include "methods/residual.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>

float momentum_factor(int sweep) { return sweep == 0 ? 0 : 1.0f - 7.0f / (15.0f + (float)sweep); }

float *momentum_factors_make(int count) {
    float *factors = malloc((size_t)count * sizeof *factors);
    for (int s = 0; factors != NULL && s < count; s++) factors[s] = momentum_factor(s);
    return factors;
}

/* The course of an island. Residuals are squared, (m/s)^2, the largest of its pairs (residual_of_pair()). */
struct MomentumIsland {
    float left, best; /* after the last block; the least, whose solution is kept */
    int sweeps;       /* since the last restart */
    int longest;      /* beta stays that of this many sweeps */
    float most;       /* beta is at most this, in the first sweeps */
};

enum {
    SLIDING_EVERY = 8, /* sweeps between two looks at an island in which contacts slide, and at others: */
    CALM_EVERY = 16    /* a look takes the time of three sweeps */
};

/* Momentum makes residuals rise and fall. It restarts at this multiple of the least square. */
static const float risen = 4;

void momentum_free(Momentum *momentum) {
    sweeps_free(&momentum->sweeps);
    free(momentum->arrays.memory);
    free(momentum->more_factors);
    islands_free(&momentum->islands);
    *momentum = (Momentum){0};
}

/* The largest beta of which errors do not grow where a visit overshoots by the share a: below 0 where sweeps alone
   would make them grow. Two contacts of a box that slides overshoot together: by 1.22 a if it is a cube of friction
   0.8; here by a (1 + a). */
static float largest_factor(float a) {
    const float both = a * (1 + a);
    return 3 * both <= 1 ? 1 : 0.5f / both - 0.5f;
}

static void choose_all(Momentum *momentum) {
    for (int k = 0; k < momentum->sweeps.groups; k++) momentum->chosen[k] = true;
}

/* Finds the islands, whose residuals are not known yet. */
static void watch(Momentum *momentum) {
    Sweeps *sweeps = &momentum->sweeps;
    if (momentum->watched) return;
    sweeps_group(sweeps);
    for (int k = 0; k < sweeps->groups; k++)
        momentum->courses[k] = (MomentumIsland){.left = HUGE_VALF, .best = HUGE_VALF, .most = 1};
    momentum->watched = true;
}

/* Where contacts slide, and overshoot, sweeps are watched from the beginning. */
static void watch_sliding(Momentum *momentum) {
    const Sweeps *sweeps = &momentum->sweeps;
    bool slides = false;
    for (int i = 0; i < sweeps->pair_count; i++) slides |= sweep_pair_may_overshoot(&sweeps->pairs[i]);
    if (!slides) return;
    slides = false;
    overshoot_of_pairs(sweeps, momentum->of_pairs);
    for (int i = 0; i < sweeps->pair_count; i++) slides |= largest_factor(momentum->of_pairs[i]) < 1;
    if (!slides) return;
    watch(momentum);
    for (int i = 0; i < sweeps->pair_count; i++) {
        MomentumIsland *course = &momentum->courses[sweeps->group[i]];
        const float most = largest_factor(momentum->of_pairs[i]);
        if (most < course->most) course->most = most;
    }
}

bool momentum_begin(Momentum *momentum, const ContactProblem *problem) {
    Sweeps *sweeps = &momentum->sweeps;
    const size_t pairs = (size_t)sweeps->pair_count;
    momentum->problem = problem;
    momentum->watched = false;
    sweeps->block = STOPPING_BLOCK;
    if (!ARRAY_BLOCK_RESERVE(&momentum->arrays, ARRAY_PART(momentum->courses, pairs), /* as many islands at most */
                             ARRAY_PART(momentum->chosen, pairs), ARRAY_PART(momentum->of_pairs, pairs),
                             ARRAY_PART(momentum->factors, CALM_EVERY * pairs)))
        return false;
    watch_sliding(momentum);
    return true;
}

static void begin_course(MomentumIsland *course) {
    course->sweeps = 0;
    course->longest = SWEEPS_MAX;
}

/* Sweeps of a run, as many as are done. total: 0 where a stopping rule ends it. */
typedef struct Run {
    const float *factors;
    int done, total;
} Run;

/* Whether the island is judged now. Its looks depend on nothing but itself and the run, so they are no matter of
   others, and of no longer run. A run with a single part has no look. */
static bool is_due(const MomentumIsland *course, const Run *run) {
    const int every = run->total == 0 || course->most < 1 ? SLIDING_EVERY : CALM_EVERY;
    return run->done % every == 0 ? run->total != every : run->done == run->total && run->total > every;
}

/* Measures the residuals of the chosen islands, and copies the solutions of those that are better than ever. */
static void measure(Momentum *momentum) {
    Sweeps *sweeps = &momentum->sweeps;
    MomentumIsland *courses = momentum->courses;
    bool *chosen = momentum->chosen;
    sweeps_refresh(sweeps, momentum->problem, chosen);
    residual_of_pairs(sweeps, momentum->of_pairs);
    for (int k = 0; k < sweeps->groups; k++)
        if (chosen[k]) courses[k].left = 0;
    for (int i = 0; i < sweeps->pair_count; i++)
        if (chosen[sweeps->group[i]] && !(momentum->of_pairs[i] <= courses[sweeps->group[i]].left))
            courses[sweeps->group[i]].left = momentum->of_pairs[i];
    for (int k = 0; k < sweeps->groups; k++) {
        chosen[k] = chosen[k] && courses[k].left <= courses[k].best;
        if (chosen[k]) courses[k].best = courses[k].left;
    }
    sweeps_keep(sweeps, chosen);
}

/* At a look. Returns true where momentum has carried the island too far, or to numbers that are NaN or infinite: it
   goes back to what was best, and takes another course from there. */
static bool judge(MomentumIsland *course) {
    if (course->left <= risen * course->best) {
        if (course->left > course->best) return false;
        const int longer = course->longest + course->longest / 4 + 1;
        course->longest = longer < SWEEPS_MAX ? longer : SWEEPS_MAX;
        return false;
    }
    course->left = course->best;
    course->longest = (course->sweeps < course->longest ? course->sweeps : course->longest) / 2;
    if (course->longest < SLIDING_EVERY) course->longest = SLIDING_EVERY;
    course->sweeps = 0;
    return true;
}

static void look(Momentum *momentum, const Run *run) {
    const int groups = momentum->sweeps.groups;
    bool any_due = false, any_lost = false;
    for (int k = 0; k < groups; k++) {
        momentum->chosen[k] = is_due(&momentum->courses[k], run);
        any_due |= momentum->chosen[k];
    }
    if (!any_due) return;
    measure(momentum);
    for (int k = 0; k < groups; k++) {
        momentum->chosen[k] = is_due(&momentum->courses[k], run) && judge(&momentum->courses[k]);
        any_lost |= momentum->chosen[k];
    }
    if (any_lost) sweeps_return(&momentum->sweeps, momentum->chosen);
}

/* False when memory is short. */
static bool run_block(Momentum *momentum, Run *run, int count) {
    Sweeps *sweeps = &momentum->sweeps;
    float *factor = momentum->factors;
    for (int s = 0; s < count; s++)
        for (int k = 0; k < sweeps->groups; k++) {
            const MomentumIsland *course = &momentum->courses[k];
            const int sweep = course->sweeps + s;
            const float wanted = sweep == 0 ? 0 : run->factors[sweep < course->longest ? sweep : course->longest];
            const bool begins = run->done + s < SLIDING_EVERY || (run->total > 0 && run->total < 2 * SLIDING_EVERY);
            const float most = begins || course->most < 0 ? course->most : 1;
            *factor++ = sweep == 0 || wanted < most ? wanted : most;
        }
    if (!(run->done == 0 ? sweeps_run_momentum(sweeps, momentum->factors, count)
                         : sweeps_continue_momentum(sweeps, momentum->factors, count)))
        return false;
    for (int k = 0; k < sweeps->groups; k++) momentum->courses[k].sweeps += count;
    run->done += count;
    look(momentum, run);
    return true;
}

/* Takes islands whose residual was smaller before back to their best solutions. */
static void settle(Momentum *momentum) {
    bool any = false;
    for (int k = 0; k < momentum->sweeps.groups; k++) {
        momentum->chosen[k] = !(momentum->courses[k].left <= momentum->courses[k].best);
        any |= momentum->chosen[k];
    }
    if (any) sweeps_return(&momentum->sweeps, momentum->chosen);
}

bool momentum_run(Momentum *momentum, const float *factors, int count) {
    if (count <= CALM_EVERY && !momentum->watched) return sweeps_run_momentum(&momentum->sweeps, factors, count);
    const int every = momentum->watched ? SLIDING_EVERY : CALM_EVERY;
    Run run = {.factors = factors, .total = count};
    watch(momentum);
    for (int k = 0; k < momentum->sweeps.groups; k++) {
        begin_course(&momentum->courses[k]);
        momentum->courses[k].best = HUGE_VALF; /* not the start: its impulses may be outside of the cones */
    }
    choose_all(momentum); /* for islands in which the first numbers are infinite */
    sweeps_keep(&momentum->sweeps, momentum->chosen);
    while (run.done < count) {
        const int left = count - run.done;
        if (!run_block(momentum, &run, left < every ? left : every)) return false;
    }
    settle(momentum);
    return true;
}

bool momentum_run_more(Momentum *momentum, const StoppingRule *rule, const float *factors) {
    const ContactProblem *problem = momentum->problem;
    const Sweeps *sweeps = &momentum->sweeps;
    if (!stopping_needs_more(rule, 0, sweeps, problem)) return true;
    Run run = {.factors = factors};
    watch(momentum);
    for (int k = 0; k < sweeps->groups; k++) momentum->courses[k].best = HUGE_VALF;
    choose_all(momentum);
    measure(momentum);
    for (int k = 0; k < sweeps->groups; k++) begin_course(&momentum->courses[k]);
    while (stopping_needs_more(rule, run.done, sweeps, problem))
        if (!run_block(momentum, &run, STOPPING_BLOCK)) return false;
    if (residual_reaches(sweeps, problem->contact_count, rule->near)) settle(momentum);
    return true;
}

bool momentum_end(Momentum *momentum, ContactSolution *solution) {
    if (!sweeps_end(&momentum->sweeps, solution)) {
        if (!sweeps_begin_coloured(&momentum->sweeps, momentum->sweeps.kernel, momentum->problem)) return false;
        sweeps_end(&momentum->sweeps, solution);
    }
    return islands_take_gain(&momentum->islands, momentum->problem, solution);
}

bool momentum_solve(Momentum *momentum, const ContactProblem *problem, const float *factors, int count,
                    ContactSolution *solution, Error *error) {
    return (sweeps_begin_coloured(&momentum->sweeps, sweeps_best_kernel(), problem) &&
            momentum_begin(momentum, problem) && momentum_run(momentum, factors, count) &&
            momentum_run_more(momentum, &momentum->rule, momentum->more_factors) && momentum_end(momentum, solution)) ||
           error_memory(error, "momentum");
}

typedef struct State {
    StoppingRule rule;
    Momentum momentum;
    float *factors; /* [rule.k] */
} State;

static const SettingSpec settings[] = {SWEEPS_SETTING, STOPPING_SETTINGS("sweeps"), KEEP_SETTING(SETTING_OWN), {0}};

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    momentum_free(&solver->momentum);
    free(solver->factors);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    static const State standard = {.rule.k = 10};
    State *solver = stopping_make(chosen, settings, &standard, sizeof standard, "momentum", error);
    if (solver == NULL) return NULL;
    solver->factors = momentum_factors_make(solver->rule.k);
    solver->momentum.rule = solver->rule;
    if (solver->rule.more > 0) solver->momentum.more_factors = momentum_factors_make(solver->rule.more);
    if (solver->factors != NULL && (solver->rule.more == 0 || solver->momentum.more_factors != NULL)) return solver;
    destroy(solver);
    error_memory(error, "momentum");
    return NULL;
}

static bool solve_momentum(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    return momentum_solve(&solver->momentum, problem, solver->factors, solver->rule.k, solution, error);
}

const ContactSolverKind solver_momentum = {
    .description = {.name = "momentum",
                    .summary = "sequential impulses with momentum extrapolation between sweeps",
                    .caption = "sequential impulses with momentum",
                    .settings = settings,
                    .converges = "k=2000",
                    .chart =
                        METHOD_RUNS("k=5", "k=20", "k=50", "k=100", "k=2,near=0.5,more=10000",
                                    "k=2,near=0.001,more=400", "k=2,near=0.0002,more=400", "k=5,near=0.1,more=10000",
                                    "k=5,near=0.02,more=10000", "k=5,near=0.001,more=10000"),
                    .chart_quick = METHOD_RUNS("k=10", "k=20", "k=5,near=0.1,more=10000"),
                    .stability = METHOD_RUNS("", "k=20"),
                    .stability_place = 3},
    .create = create,
    .solve = solve_momentum,
    .destroy = destroy};
