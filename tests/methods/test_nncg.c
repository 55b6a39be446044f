/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NNCG: its bits against a plain text contact by contact, and a law. test_rivals.c has what all rivals must keep. */
#include "kernels.h"

#include "random_problem.h"
#include "worlds.h"

#include "methods/islands.h"

/* Velocities and impulses as one row of numbers. */
enum { NUMBERS_MAX = 3 * BODIES_MAX + 2 * CONTACTS_MAX };

static int to_numbers(const ContactProblem *problem, const ContactSolution *solution, float numbers[NUMBERS_MAX]) {
    size_t bodies = (size_t)problem->body_count * 3, contacts = (size_t)problem->contact_count * 2;
    memcpy(numbers, solution->velocities, bodies * sizeof *numbers);
    memcpy(numbers + bodies, solution->impulses, contacts * sizeof *numbers);
    return (int)(bodies + contacts);
}

static void from_numbers(const ContactProblem *problem, const float *numbers, ContactSolution *solution) {
    size_t bodies = (size_t)problem->body_count * 3, contacts = (size_t)problem->contact_count * 2;
    memcpy(solution->velocities, numbers, bodies * sizeof *numbers);
    memcpy(solution->impulses, numbers + bodies, contacts * sizeof *numbers);
}

/* Sum of x * y over the impulses of an island in the order that nncg.c promises: that of the visits. */
static float multiply(const ContactProblem *problem, const int32_t *visits, const int *islands, int island,
                      const float *x, const float *y) {
    float partial[8] = {0};
    for (int v = 0, pair = -1, point = 1; v < problem->contact_count; v++) {
        const int i = visits[v];
        const ContactPoint *contact = &problem->contacts[i];
        bool second =
            point == 0 && i == visits[v - 1] + 1 && contact->a == contact[-1].a && contact->b == contact[-1].b;
        point = second ? 1 : 0;
        if (islands[i] != island) continue;
        pair += second ? 0 : 1;
        float *part = &partial[4 * (pair % 2) + 2 * point];
        part[0] += x[2 * i] * y[2 * i];
        part[1] += x[2 * i + 1] * y[2 * i + 1];
    }
    for (int k = 0; k < 4; k++) partial[k] += partial[k + 4];
    return (partial[0] + partial[2]) + (partial[1] + partial[3]);
}

/* A sweep's conclusion for each island. */
typedef struct Plain {
    float before[CONTACTS_MAX + BODIES_MAX], beta[CONTACTS_MAX + BODIES_MAX];
    bool anew[CONTACTS_MAX + BODIES_MAX];
} Plain;

/* islands[contact_count]. Contacts of two bodies that do not move are islands, too: those of the same first body.
   Returns a limit of the numbers. */
static int find_islands(const ContactProblem *problem, int *islands) {
    Islands found = {0};
    assert_true(islands_find(&found, problem));
    for (int i = 0; i < problem->contact_count; i++)
        islands[i] = found.island[i] >= 0 ? found.island[i] : found.count + problem->contacts[i].a;
    const int count = found.count + problem->body_count;
    islands_free(&found);
    return count;
}

/* The island that a number belongs to: of its contact, or of a contact of its body; -1: none. */
static int island_of(const ContactProblem *problem, const int *islands, int number) {
    const int impulses = 3 * problem->body_count, body = number / 3;
    if (number >= impulses) return islands[(number - impulses) / 2];
    for (int i = 0; i < problem->contact_count && problem_body_moves(&problem->bodies[body]); i++)
        if (problem->contacts[i].a == body || problem->contacts[i].b == body) return islands[i];
    return -1;
}

/* Returns how often an island began anew. */
static int solve_plainly(const ContactProblem *problem, const int32_t *visits, int count, ContactSolution *solution) {
    static float p[NUMBERS_MAX], after[NUMBERS_MAX], d[NUMBERS_MAX], step[NUMBERS_MAX];
    static int island[NUMBERS_MAX];
    static Plain plain;
    static int islands[CONTACTS_MAX];
    const int count_of_islands = find_islands(problem, islands);
    begin_scalar(problem, visits, solution);
    int numbers = to_numbers(problem, solution, p), impulses = 3 * problem->body_count, begun_anew = 0;
    for (int i = 0; i < numbers; i++) island[i] = island_of(problem, islands, i);
    memset(d, 0, sizeof d);
    memset(&plain, 0, sizeof plain);
    for (int sweep = 0; sweep < count; sweep++) {
        for (int i = 0; i < problem->contact_count; i++)
            sequential_impulses_visit(problem, &engine_options, visits[i], 1, solution);
        if (sweep == count - 1) break;
        to_numbers(problem, solution, after);
        for (int i = 0; i < numbers; i++) step[i] = after[i] - p[i];
        for (int k = 0; k < count_of_islands; k++) {
            const float squared = multiply(problem, visits, islands, k, step + impulses, step + impulses);
            plain.beta[k] = squared < plain.before[k] ? squared / plain.before[k] : 1;
            plain.anew[k] = multiply(problem, visits, islands, k, step + impulses, d + impulses) < 0;
            plain.before[k] = squared;
            begun_anew += plain.anew[k];
        }
        for (int i = 0; i < numbers; i++) {
            const bool anew = island[i] < 0 || plain.anew[island[i]];
            p[i] = anew ? after[i] : after[i] - (0.0f - plain.beta[island[i]] * d[i]);
            d[i] = anew ? 0 : plain.beta[island[i]] * d[i] + step[i];
        }
        from_numbers(problem, p, solution);
    }
    return begun_anew;
}

TEST(random_problems_have_the_bits_of_the_plain_text) {
    static RandomProblem random;
    uint32_t seed = 17;
    const int counts[] = {1, 2, 3, 10, 25};
    int begun_anew = 0;
    Islands islands = {0};
    Colours colours = {0};
    for (int c = 0; c < 5; c++) {
        const char *text = printed("k=%d", counts[c]);
        OWN(ContactSolver) nncg = make_solver(&solver_nncg, text);
        for (int i = 0; i < 60; i++) {
            int bodies = 2 + (7 * i) % (BODIES_MAX - 1);
            make_random(&random, &seed, bodies, i % 2 == 0 ? 0.5f : 4.0f / (float)bodies, 2);
            if (i % 5 == 0) calm_down(&random, &seed);
            OWN(ContactSolution) plain = make_solution(&random.problem), found = make_solution(&random.problem);
            assert_true(colours_order(&colours, &random.problem));
            begun_anew += solve_plainly(&random.problem, colours.visits, counts[c], &plain);
            assert_true(islands_take_gain(&islands, &random.problem, &plain));
            assert_ok(solver_nncg.solve(nncg.state, &random.problem, &found, &error), error);
            assert_same_bits(&random.problem, &found, &plain, text);
        }
    }
    assert_true(begun_anew > 10);
    islands_free(&islands);
    colours_free(&colours);
}

/* A stack put down without a warm start: the impulses under box i must carry m g dt (n - i). Plain sweeps pass the
   weight on from box to box. */
static float missing_weight(const ContactSolverKind *kind) {
    enum { BOXES = 10 };
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < BOXES; i++) add_box(world, 2, 0.2f, vec2(0, 0.5f + (float)i));
    OWN(ContactSolver) solver = make_solver(kind, "k=60");
    run(world, &solver, 1);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->contact_count, 2 * BOXES);
    float missing = 0;
    for (int i = 0; i < problem->contact_count; i += 2) {
        const ContactImpulse *impulses = &world_solution(world)->impulses[i];
        float weight = 2 * 10 * world_dt * (float)(BOXES - problem->contacts[i].a);
        missing = fmaxf(missing, fabsf(impulses[0].normal + impulses[1].normal - weight) / weight);
    }
    return missing;
}

TEST(a_stack_carries_its_weight_at_once) {
    assert_true(missing_weight(&solver_nncg) < 0.01f);
    assert_true(missing_weight(&solver_engine) > 0.1f);
}

RUN_TESTS(NULL, NULL)
