/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of visits by colours. */
#include "methods/kernels.h"
#include "methods/random_problem.h"

#include "methods/sweeps.h"

OWNED_VALUE(Colours, colours_free)

static bool moves(const ContactProblem *problem, int body) {
    return problem->bodies[body].inv_mass != 0 || problem->bodies[body].inv_inertia != 0;
}

static bool meet(const ContactProblem *problem, const ContactPoint *one, const ContactPoint *other) {
    return (moves(problem, one->a) && (one->a == other->a || one->a == other->b)) ||
           (moves(problem, one->b) && (one->b == other->a || one->b == other->b));
}

/* From where on a run of visits of one surface begins whose bodies have been met in the run before: one more colour. */
static int count_runs(const ContactProblem *problem, const int32_t *visits) {
    int runs = problem->contact_count > 0, begin = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[visits[i]];
        for (int k = begin; k < i; k++) {
            const bool own = visits[k] == visits[i] - 1 && contact_shares_surface(contact - 1, contact);
            if (own || !meet(problem, contact, &problem->contacts[visits[k]])) continue;
            runs++;
            begin = i;
            break;
        }
    }
    return runs;
}

static int most_met(const ContactProblem *problem) {
    int met[BODIES_MAX] = {0}, most = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        met[contact->a]++;
        met[contact->b]++;
    }
    for (int i = 0; i < problem->body_count; i++)
        if (moves(problem, i) && met[i] > most) most = met[i];
    return most;
}

static void every_contact_is_visited_once(const ContactProblem *problem, const int32_t *visits) {
    bool seen[CONTACTS_MAX] = {false};
    for (int i = 0; i < problem->contact_count; i++) {
        assert_in_range(visits[i], 0, problem->contact_count - 1);
        assert_false(seen[visits[i]]);
        seen[visits[i]] = true;
    }
}

/* Two points of a surface are one behind the other, where they are not the second and third of three. */
static void surfaces_stay_together(const ContactProblem *problem, const int32_t *visits) {
    int place[CONTACTS_MAX];
    for (int i = 0; i < problem->contact_count; i++) place[visits[i]] = i;
    for (int i = 0; i + 1 < problem->contact_count;) {
        const bool two = contact_shares_surface(&problem->contacts[i], &problem->contacts[i + 1]);
        if (two) assert_int_equal(place[i + 1], place[i] + 1);
        i += two ? 2 : 1;
    }
}

TEST(an_order_has_few_colours) {
    static RandomProblem random;
    OWN(Colours) colours = {0};
    uint32_t seed = 12;
    for (int i = 0; i < 200; i++) {
        make_random(&random, &seed, 2 + i % (BODIES_MAX - 1), i % 2 == 0 ? 0.4f : 0.05f, 2);
        assert_true(colours_order(&colours, &random.problem));
        every_contact_is_visited_once(&random.problem, colours.visits);
        surfaces_stay_together(&random.problem, colours.visits);
        /* A pair shares its bodies with no more others than those have contacts. */
        assert_in_range(count_runs(&random.problem, colours.visits), 0, 2 * most_met(&random.problem) + 1);
    }
}

/* Ten boxes, one on the other: every second pair, then the others. */
TEST(a_chain_has_two_colours) {
    enum { LINKS = 10 };
    static RandomProblem random;
    OWN(Colours) colours = {0};
    uint32_t seed = 2;
    make_random(&random, &seed, LINKS + 1, 0, 1);
    for (int i = 0; i < LINKS; i++) {
        random.bodies[i] = (ProblemBody){.inv_mass = i > 0, .inv_inertia = i > 0};
        random.contacts[i] = random_point(&seed, i, i + 1, vec2(0, 1), 0.2f);
    }
    random.bodies[LINKS] = (ProblemBody){.inv_mass = 1, .inv_inertia = 1};
    random.problem.contact_count = LINKS;
    assert_true(colours_order(&colours, &random.problem));
    static const int32_t expected[LINKS] = {1, 3, 5, 7, 9, 0, 2, 4, 6, 8};
    assert_memory_equal(colours.visits, expected, sizeof expected);
}

/* On the ground, which no impulse moves, all lie at once; on a body that moves one after the other, and there are more
   of them than colours. */
TEST(a_star_has_one_colour_or_more_than_there_are) {
    static RandomProblem random;
    OWN(Colours) colours = {0};
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 3;
    float factors[10];
    for (int s = 0; s < 10; s++) factors[s] = momentum_factor(s);
    for (int moving = 0; moving < 2; moving++) {
        make_random(&random, &seed, BODIES_MAX, 0, 1);
        for (int i = 0; i < BODIES_MAX; i++)
            random.bodies[i].inv_mass = random.bodies[i].inv_inertia = i > 0 || moving ? 0.1f : 0;
        for (int i = 1; i < BODIES_MAX; i++) random.contacts[i - 1] = random_point(&seed, 0, i, vec2(0, 1), 0.2f);
        random.problem.contact_count = BODIES_MAX - 1;
        assert_true(colours_order(&colours, &random.problem));
        every_contact_is_visited_once(&random.problem, colours.visits);
        assert_int_equal(count_runs(&random.problem, colours.visits), moving ? BODIES_MAX - 1 : 1);
        for (int i = 0; i < BODIES_MAX - 1 && !moving; i++) assert_int_equal(colours.visits[i], i);
        assert_momentum_kernels_agree(sweeps, &random.problem, true, factors, 10);
    }
    free_kernels(sweeps);
}

RUN_TESTS(NULL, NULL)
