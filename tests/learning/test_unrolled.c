/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps in double against the engine's, and their derivatives against finite differences. */
#include "made.h"

#include "methods/kernels.h"
#include "methods/random_problem.h"
#include "learning/unrolled.h"

static const double factors[20] = {9,   0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.8, 0.8, 0.9,
                                   0.9, 0.9, 0.9, 0,   0.9, 0.9, 0.9, 0.9, 0.9, 0.9};
enum { SWEEPS = 20, NUMBERS_MAX = 2 * CONTACTS_MAX };

/* Runs a scene with the engine; calls observe after each step. */
static void observe_scene(const char *name, bool (*observe)(void *, int, const World *, Error *), void *context) {
    Error error = {0};
    OWN(Scene) *scene = scene_named(name);
    const Method engine = method_named("engine");
    assert_ok(simulate_observed(scene, &engine, &(StepObserver){observe, context}, &error), error);
}

static void warm_start(const ContactProblem *problem, double *start) {
    assert_in_range(problem->contact_count, 0, CONTACTS_MAX);
    for (int i = 0; i < problem->contact_count; i++) {
        start[2 * i] = (double)problem->contacts[i].warm_normal;
        start[2 * i + 1] = (double)problem->contacts[i].warm_tangent;
    }
}

static void assert_same_solution(const ContactProblem *problem, const Unrolled *unrolled,
                                 const ContactSolution *expected, double tolerance) {
    for (int i = 0; i < problem->body_count; i++) {
        assert_near(unrolled->velocities[3 * i], expected->velocities[i].linear.x, tolerance);
        assert_near(unrolled->velocities[3 * i + 1], expected->velocities[i].linear.y, tolerance);
        assert_near(unrolled->velocities[3 * i + 2], expected->velocities[i].angular, tolerance);
    }
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const double mass = (double)fmaxf(contact->mass_normal, contact->mass_tangent);
        assert_near(unrolled->impulses[2 * i], expected->impulses[i].normal, mass * tolerance);
        assert_near(unrolled->impulses[2 * i + 1], expected->impulses[i].tangent, mass * tolerance);
    }
}

static void assert_equals_scalar(Unrolled *unrolled, const ContactProblem *problem, int sweeps, double roundings) {
    double start[NUMBERS_MAX];
    float in_float[SWEEPS];
    UnrolledProblem rows;
    OWN(ContactSolution) expected = make_solution(problem), before = make_solution(problem);
    for (int s = 0; s < sweeps; s++) in_float[s] = (float)factors[s];
    warm_start(problem, start);
    assert_true(unrolled_problem_make(&rows, problem));
    assert_true(unrolled_run(unrolled, &rows, start, factors, sweeps));
    momentum_solve_scalar(problem, rows.visits, in_float, sweeps, &before, &expected);
    assert_same_solution(problem, unrolled, &expected, roundings * rounding_of(problem));
    unrolled_problem_free(&rows);
}

static bool frame_equals_scalar(void *context, int frame, const World *world, Error *error) {
    (void)frame, (void)error;
    assert_equals_scalar(context, world_problem(world), 10, 200);
    assert_equals_scalar(context, world_problem(world), 0, 100);
    return true;
}

TEST(sweeps_match_the_scalar_reference_implementation) {
    Unrolled unrolled = {0};
    observe_scene("single", frame_equals_scalar, &unrolled);
    observe_scene("stack", frame_equals_scalar, &unrolled);
    observe_scene("pyramid", frame_equals_scalar, &unrolled);
    unrolled_free(&unrolled);
}

/* Random problems have warm impulses outside the cone; the scalar reference implementation needs them projected. */
TEST(the_start_is_projected_into_the_cone) {
    uint32_t seed = 1;
    int outside = 0;
    Unrolled unrolled = {0};
    for (int run = 0; run < 20; run++) {
        RandomProblem random;
        double start[NUMBERS_MAX];
        make_random(&random, &seed, 12, 0.15f, 1);
        warm_start(&random.problem, start);
        for (int i = 0; i < random.problem.contact_count; i++) {
            ContactPoint *contact = &random.contacts[i];
            if (i % 3 == 0) start[2 * i] -= 0.5;
            contact->warm_normal = fmaxf((float)start[2 * i], 0);
            const float limit = contact->friction * contact->warm_normal;
            contact->warm_tangent = fminf(fmaxf(contact->warm_tangent, -limit), limit);
            outside += (double)contact->warm_tangent != start[2 * i + 1];
        }
        UnrolledProblem rows;
        OWN(ContactSolution) expected = make_solution(&random.problem);
        assert_true(unrolled_problem_make(&rows, &random.problem));
        assert_true(unrolled_run(&unrolled, &rows, start, NULL, 0));
        sequential_impulses_begin(&random.problem, &engine_options, &expected);
        assert_same_solution(&random.problem, &unrolled, &expected, 1e-4);
        unrolled_problem_free(&rows);
    }
    assert_true(outside > 100);
    unrolled_free(&unrolled);
}

/* A problem, start impulses, and a loss of the final velocities: sum of c v + v^2 / 2. */
typedef struct Case {
    UnrolledProblem rows;
    Unrolled unrolled;
    double start[NUMBERS_MAX], weights[3 * BODIES_MAX], factors[SWEEPS];
    int sweeps;
} Case;

static double run_case(Case *given) {
    double loss = 0;
    assert_true(unrolled_run(&given->unrolled, &given->rows, given->start, given->factors, given->sweeps));
    for (int i = 0; i < 3 * given->rows.body_count; i++) {
        const double v = given->unrolled.velocities[i];
        loss += v * (given->weights[i] + v / 2);
    }
    return loss;
}

/* Starts on all sides of the cone, none on its edge. */
static Case make_case(const ContactProblem *problem, int sweeps, uint32_t *seed) {
    Case made = {.sweeps = sweeps};
    assert_in_range(problem->body_count, 1, BODIES_MAX);
    assert_true(unrolled_problem_make(&made.rows, problem));
    warm_start(problem, made.start);
    for (int i = 0; i < problem->contact_count; i++) {
        made.start[2 * i] += (double)uniform(seed, -0.3f, 1);
        const double reach = 1.5 * (double)problem->contacts[i].friction * fabs(made.start[2 * i]);
        made.start[2 * i + 1] = reach * (double)uniform(seed, -1, 1);
    }
    for (int i = 0; i < 3 * problem->body_count; i++) made.weights[i] = (double)uniform(seed, -1, 1);
    memcpy(made.factors, factors, sizeof factors);
    return made;
}

static void free_case(Case *given) {
    unrolled_problem_free(&given->rows);
    unrolled_free(&given->unrolled);
}

OWNED_VALUE(Case, free_case)

/* Between kinks the loss is quadratic in each number, so central differences are exact up to rounding. Returns false if
   there is a kink within the step. */
static bool difference(Case *given, double *number, double step, double *slope) {
    const size_t pieces = (size_t)(given->sweeps + 1) * (size_t)given->rows.contact_count;
    const double kept = *number;
    FREED uint8_t *taken = malloc(pieces + 1);
    assert_non_null(taken);
    *number = kept + step;
    *slope = run_case(given);
    memcpy(taken, given->unrolled.pieces, pieces);
    *number = kept - step;
    *slope = (*slope - run_case(given)) / (2 * step);
    *number = kept;
    bool same = memcmp(taken, given->unrolled.pieces, pieces) == 0;
    return same;
}

typedef struct Tally {
    int checked, kinks, moved;
} Tally;

static void check(Case *given, double *number, double derivative, Tally *tally) {
    double slope;
    if (!difference(given, number, 1e-4, &slope)) {
        tally->kinks++;
        return;
    }
    assert_near(derivative, slope, 1e-7 * (1 + fabs(slope)));
    tally->checked++;
    tally->moved += fabs(slope) > 1e-3;
}

/* Kinks and numbers without effect must be few, or errors would go unnoticed. */
static void assert_derivatives(const ContactProblem *problem, int sweeps, uint32_t *seed) {
    OWN(Case) given = make_case(problem, sweeps, seed);
    double by_velocity[3 * BODIES_MAX], by_start[NUMBERS_MAX], by_factors[SWEEPS];
    for (int s = 0; s < sweeps; s++) by_factors[s] = 7;
    run_case(&given);
    for (int i = 0; i < 3 * problem->body_count; i++) by_velocity[i] = given.weights[i] + given.unrolled.velocities[i];
    unrolled_back(&given.unrolled, &given.rows, by_velocity, by_start, by_factors);
    Tally of_start = {0}, of_factors = {0};
    for (int i = 0; i < 2 * problem->contact_count; i++) check(&given, &given.start[i], by_start[i], &of_start);
    for (int s = 0; s < sweeps; s++) check(&given, &given.factors[s], by_factors[s] - 7, &of_factors);
    assert_true(of_start.kinks * 4 < of_start.checked);
    assert_true(of_start.moved * 4 > of_start.checked);
    /* The first factor has no effect: no sweep precedes it. */
    assert_int_equal(of_factors.moved, sweeps > 0 ? sweeps - 1 : 0);
}

TEST(derivatives_match_differences_on_random_problems) {
    uint32_t seed = 5;
    for (int run = 0; run < 8; run++) {
        RandomProblem random;
        make_random(&random, &seed, 10, 0.2f, 0.5f);
        assert_derivatives(&random.problem, 2 * run, &seed);
    }
}

/* Impulses are equal and opposite: without static bodies, no start and no factor changes the sum of m v. */
TEST(total_momentum_is_conserved) {
    uint32_t seed = 11;
    RandomProblem random;
    double by_start[NUMBERS_MAX], by_factors[SWEEPS] = {0}, mass[3 * BODIES_MAX] = {0};
    make_random(&random, &seed, 12, 0.2f, 1);
    for (int i = 0; i < random.problem.body_count; i++) {
        if (random.bodies[i].inv_mass <= 0) random.bodies[i].inv_mass = random.bodies[i].inv_inertia = 0.5f;
        mass[3 * i] = 1 / (double)random.bodies[i].inv_mass;
    }
    OWN(Case) given = make_case(&random.problem, SWEEPS, &seed);
    run_case(&given);
    unrolled_back(&given.unrolled, &given.rows, mass, by_start, by_factors);
    for (int i = 0; i < 2 * random.problem.contact_count; i++) assert_near(by_start[i], 0, 1e-9);
    for (int s = 0; s < SWEEPS; s++) assert_near(by_factors[s], 0, 1e-9);
}

RUN_TESTS(NULL, NULL)
