/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Momentum that cannot diverge: a box that slides, the residual of more sweeps, islands by themselves. */
#include "kernels.h"
#include "made.h"
#include "random_problem.h"
#include "random_structures.h"
#include "worlds.h"

#include "methods/islands.h"
#include "methods/residual.h"
#include "runs/runs.h"

#include <float.h>

/* A cube slides on flat ground: with friction below 1 it stays upright. m: of `steps` with 10 m/s at first. */
static double slides(double friction, int steps) {
    double way = 0;
    for (int k = 1; k <= steps; k++) way += fmax(0, 10 - friction * 10 * k * (double)world_dt) * (double)world_dt;
    return way;
}

TEST(a_box_that_slides_stays_upright_and_stops) {
    static const char *const settings[] = {"k=1",
                                           "k=2",
                                           "k=3",
                                           "k=5",
                                           "k=8",
                                           "k=10",
                                           "k=15",
                                           "k=16",
                                           "k=20",
                                           "k=24",
                                           "k=50",
                                           "k=100",
                                           "k=200",
                                           "k=1000",
                                           "k=5000",
                                           "k=2,near=0.005,more=400",
                                           "k=20,near=0.02",
                                           "k=5,near=0.02,more=10000",
                                           "k=1,near=0.0002,more=10000"};
    for (int i = 0; i < 5; i++) {
        const float friction = 0.5f + 0.1f * (float)i;
        for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
            OWN(World) *world = make_world();
            add_ground(world, friction);
            add_body(
                world,
                &(BodyDef){
                    .size = {1, 1}, .mass = 1, .friction = friction, .position = {-40, 0.5f}, .velocity = {10, 0}});
            OWN(ContactSolver) solver = make_solver(&solver_momentum, settings[k]);
            double turned = 0;
            for (int step = 0; step < 150; step++) {
                run(world, &solver, 1);
                turned = fmax(turned, fabs((double)world_bodies(world)[1].angle));
            }
            const double slid = (double)world_bodies(world)[1].position.x + 40;
            /* The slop of 10 mm lets a box of 1 m turn by 0.01. */
            if (turned > (k == 0 ? 0.05 : 0.015) || fabs(slid - slides((double)friction, 150)) > 0.1)
                fail_msg("friction %g, %s: slid %.3f m, not %.3f, turned by %.3f", (double)friction, settings[k], slid,
                         slides((double)friction, 150), turned);
        }
    }
}

enum { PROBLEMS = 200, LONGEST = 1600 };

/* Residuals of the islands: the largest of a pair. Returns their number. */
static int residuals_of(const Momentum *momentum, Islands *islands, const ContactProblem *problem, double *left) {
    assert_true(islands_find(islands, problem));
    for (int k = 0; k < islands->count; k++) left[k] = 0;
    for (int i = 0; i < momentum->sweeps.pair_count; i++) {
        const int32_t k = islands->island[momentum->sweeps.first[i]];
        if (k >= 0) left[k] = fmax(left[k], (double)residual_of_pair(&momentum->sweeps, i));
    }
    return islands->count;
}

typedef struct Course {
    Momentum momentum;
    Islands islands;
    float factors[LONGEST];
    double least[STRUCTURE_BODIES], left[STRUCTURE_BODIES];
    int problems, grew; /* grew: with momentum that never begins anew */
    double gain;        /* sum of the logarithms of residuals after 400 sweeps over the least of such momentum */
    const char *name;
} Course;

/* From the warm start, `count` sweeps: no island's residual is above that of fewer sweeps. */
static void sweep_on(Course *course, const ContactProblem *problem, int count, int more) {
    Momentum *momentum = &course->momentum;
    const StoppingRule rule = {.near = 0, .more = more};
    assert_true(sweeps_begin_coloured(&momentum->sweeps, sweeps_best_kernel(), problem));
    assert_true(momentum_begin(momentum, problem) && momentum_run(momentum, course->factors, count));
    assert_true(momentum_run_more(momentum, &rule, course->factors));
    sweeps_refresh(&momentum->sweeps, problem, NULL);
    const int islands = residuals_of(momentum, &course->islands, problem, course->left);
    for (int k = 0; k < islands; k++) {
        if (!(course->left[k] <= course->least[k] * (1 + 1e-5)))
            fail_msg("%s: residual %g after %d and %d sweeps, %g after fewer", course->name, sqrt(course->left[k]),
                     count, more, sqrt(course->least[k]));
        course->least[k] = fmin(course->left[k], course->least[k]);
    }
}

/* The residual of momentum that never begins anew. */
static double plain_momentum(Course *course, const ContactProblem *problem, int count) {
    Sweeps *sweeps = &course->momentum.sweeps;
    double sum = 0;
    assert_true(sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem));
    assert_true(sweeps_run_momentum(sweeps, course->factors, count));
    sweeps_refresh(sweeps, problem, NULL);
    for (int i = 0; i < sweeps->pair_count; i++) sum = fmax(sum, (double)residual_of_pair(sweeps, i));
    return sum;
}

/* (m/s)^2: of the islands together, after the most sweeps so far. */
static double residual_now(const Course *course) {
    double sum = 0;
    for (int k = 0; k < course->islands.count; k++) sum = fmax(sum, course->left[k]);
    return sum;
}

static void forget(Course *course) {
    for (int k = 0; k < STRUCTURE_BODIES; k++) course->least[k] = DBL_MAX;
}

static bool check_step(void *context, int frame, const World *world, Error *error) {
    static const int counts[] = {48, 64, 96, 208, 400, 800, LONGEST}, more[] = {8, 16, 40, 96, 200, 800};
    Course *course = context;
    const ContactProblem *problem = world_problem(world);
    (void)error;
    if (problem->contact_count == 0 || frame % 20 != 17 || course->problems == PROBLEMS) return true;
    course->problems++;
    forget(course);
    double least = DBL_MAX, at_400 = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        sweep_on(course, problem, counts[i], 0);
        if (counts[i] > 400) continue;
        at_400 = residual_now(course);
        const double plain = plain_momentum(course, problem, counts[i]);
        least = fmin(least, plain);
        course->grew += counts[i] == 400 && !(plain <= 4 * least);
    }
    course->gain += 0.5 * log((at_400 + 1e-14) / (least + 1e-14));
    forget(course);
    for (size_t i = 0; i < sizeof more / sizeof *more; i++) sweep_on(course, problem, 20, more[i]);
    return true;
}

/* Random structures, at rest and struck, with friction 0 to 3. */
TEST(more_sweeps_never_have_a_larger_residual_than_the_best_so_far) {
    static Course course;
    const Method engine = method_named("engine");
    for (int s = 0; s < LONGEST; s++) course.factors[s] = momentum_factor(s);
    for (int seed = 0; course.problems < PROBLEMS; seed++) {
        OWN(Scene) *scene = random_structure(seed);
        const float friction = 0.1f * (float)(seed % 31);
        for (int i = 0; i < scene->body_count; i++) scene->bodies[i].friction = friction;
        scene->bomb.friction = friction;
        course.name = scene->name;
        assert_ok(simulate_observed(scene, &engine, &(StepObserver){check_step, &course}, &error), error);
    }
    assert_in_range(course.grew, PROBLEMS / 10, PROBLEMS);
    assert_true(exp(course.gain / PROBLEMS) < 0.5);
    momentum_free(&course.momentum);
    islands_free(&course.islands);
}

/* A stack that a heavy box strikes; beside: and a box that slides, 60 m away. */
static World *make_struck_stack(bool beside) {
    World *world = make_world();
    add_ground(world, 0.8f);
    for (int i = 0; i < 6; i++) add_box(world, 1, 0.8f, vec2(0.05f * (float)i, 0.5f + (float)i));
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = 30, .friction = 0.8f, .position = {0.4f, 7}, .velocity = {-3, -8}});
    if (beside)
        add_body(world,
                 &(BodyDef){.size = {1, 1}, .mass = 7, .friction = 0.8f, .position = {-40, 0.5f}, .velocity = {9, 0}});
    return world;
}

static void assert_islands_independent(const ContactSolverKind *kind, const char *settings) {
    OWN(World) *alone = make_struck_stack(false), *beside = make_struck_stack(true);
    OWN(ContactSolver) solver = make_solver(kind, settings), other = make_solver(kind, settings);
    for (int step = 0; step < 60; step++) {
        run(alone, &solver, 1);
        run(beside, &other, 1);
        for (int i = 1; i <= 7; i++) {
            const Body *a = &world_bodies(alone)[i], *b = &world_bodies(beside)[i];
            if (memcmp(&a->position, &b->position, sizeof a->position) != 0 ||
                memcmp(&a->velocity, &b->velocity, sizeof a->velocity) != 0)
                fail_msg("%s:%s, step %d: body %d moves otherwise beside another", kind->description.name, settings,
                         step, i);
        }
    }
}

TEST(islands_do_not_change_each_other) {
    static const char *const settings[] = {"k=5", "k=10", "k=20", "k=50", "k=200"};
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        assert_islands_independent(&solver_momentum, settings[i]);
        assert_islands_independent(&solver_nncg, settings[i]);
    }
}

/* Velocities that are computed anew between blocks are those that momentum goes on with: the rest of the run is the
   same but for rounding errors. Alone, momentum would go on along what they changed by. */
TEST(refreshed_velocities_keep_the_course) {
    enum { SWEEPS = 200, EVERY = 8 };
    OWN(World) *world = make_struck_stack(false);
    OWN(ContactSolver) engine = make_engine("");
    float factors[SWEEPS];
    OWN(Sweeps) whole = {0}, parts = {0};
    for (int s = 0; s < SWEEPS; s++) factors[s] = momentum_factor(s);
    for (int step = 0; step < 40; step++) {
        run(world, &engine, 1);
        const ContactProblem *problem = world_problem(world);
        if (problem->contact_count == 0) continue;
        assert_true(sweeps_begin_coloured(&whole, sweeps_best_kernel(), problem));
        assert_true(sweeps_begin_coloured(&parts, sweeps_best_kernel(), problem));
        assert_true(sweeps_run_momentum(&whole, factors, SWEEPS));
        sweeps_refresh(&whole, problem, NULL);
        for (int done = 0; done < SWEEPS; done += EVERY) {
            assert_true(done == 0 ? sweeps_run_momentum(&parts, factors, EVERY)
                                  : sweeps_continue_momentum(&parts, factors + done, EVERY));
            sweeps_refresh(&parts, problem, NULL);
        }
        for (int i = 0; i < problem->body_count; i++) {
            assert_near(parts.bodies[i].x, whole.bodies[i].x, 0.02);
            assert_near(parts.bodies[i].y, whole.bodies[i].y, 0.02);
        }
    }
}

/* Lanes have the bits of the pairs one by one: factors of groups, also below 0, what is measured, what is returned
   to. */
TEST(watched_sweeps_have_the_same_bits_in_lanes) {
    enum { SWEEPS = 8 };
    static RandomProblem random;
    static float factors[SWEEPS * CONTACTS_MAX], squared[2][CONTACTS_MAX], overshoot[2][CONTACTS_MAX];
    static bool chosen[CONTACTS_MAX];
    Sweeps sweeps[2] = {{0}};
    uint32_t seed = 77;
    int several = 0, over = 0;
    if (!sweeps_can(SWEEP_LANES)) skip();
    for (int run = 0; run < 300; run++) {
        make_random(&random, &seed, 2 + run % (BODIES_MAX - 1), run % 2 == 0 ? 0.3f : 1.2f / (float)(2 + run % 79), 1);
        if (run % 5 == 0) calm_down(&random, &seed);
        for (int i = 0; i < SWEEPS * CONTACTS_MAX; i++) factors[i] = any_number(&seed, 0.7f);
        for (int i = 0; i < CONTACTS_MAX; i++) chosen[i] = uniform(&seed, 0, 1) < 0.5f;
        ContactSolution found[2] = {make_solution(&random.problem), make_solution(&random.problem)};
        for (int kernel = 0; kernel < 2; kernel++) {
            Sweeps *s = &sweeps[kernel];
            assert_true(sweeps_begin_coloured(s, (SweepKernel)kernel, &random.problem));
            sweeps_group(s);
            sweeps_keep(s, chosen);
            assert_true(sweeps_run_momentum(s, factors, SWEEPS));
            overshoot_of_pairs(s, overshoot[kernel]);
            sweeps_return(s, chosen);
            assert_true(sweeps_continue_momentum(s, factors, SWEEPS));
            residual_of_pairs(s, squared[kernel]);
            assert_true(sweeps_end(s, &found[kernel]));
        }
        assert_same_bits(&random.problem, &found[1], &found[0], "in groups");
        for (int i = 0; i < sweeps[0].pair_count; i++) {
            assert_true(squared[0][i] == squared[1][i] && overshoot[0][i] == overshoot[1][i]);
            over += overshoot[0][i] > 0;
        }
        several += sweeps[0].groups > 2;
        for (int k = 0; k < 2; k++) free_solution(&found[k]);
    }
    assert_true(several > 50 && over > 500);
    for (int k = 0; k < 2; k++) sweeps_free(&sweeps[k]);
}

/* Where sweeps overflow the solution is the warm start, or the best so far. */
TEST(what_overflows_is_given_up) {
    static RandomProblem random;
    uint32_t seed = 11;
    make_random(&random, &seed, 60, 0.1f, 1);
    random.contacts[40].mass_normal = 1e38f;
    static const char *const settings[] = {"k=10", "k=40", "k=5,near=0,more=40"};
    for (int i = 0; i < 3; i++) {
        OWN(ContactSolution) found = make_solution(&random.problem);
        solve_with(&solver_momentum, settings[i], &random.problem, &found);
        for (int k = 0; k < random.problem.body_count; k++)
            assert_true(isfinite(found.velocities[k].linear.x) && isfinite(found.velocities[k].angular));
    }
}

RUN_TESTS(NULL, NULL)
