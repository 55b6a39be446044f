/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Violations of the laws in collisions of known outcome, and their slopes. */
#include "datasets.h"

#include "learning/pair_training.h"

/* A bomb of 2 kg flies at 3 m/s to the right, at a box of 4 kg at rest; the points are 0.5 m above the centres. */
static LawPair collision(void) {
    static const float context[PAIR_CONTEXT] = {
        [CONTEXT_INV_MASS_A] = 0.5f, [CONTEXT_INV_INERTIA_A] = 2, [CONTEXT_INV_MASS_B] = 0.25f,
        [CONTEXT_INV_INERTIA_B] = 1, [CONTEXT_NORMAL] = 1,        [CONTEXT_FRICTION] = 0.5f,
        [CONTEXT_ARM_A] = 1,         [CONTEXT_ARM_A + 1] = 0.5f,  [CONTEXT_ARM_B] = -1,
        [CONTEXT_ARM_B + 1] = 0.5f,  [CONTEXT_VELOCITIES] = 3};
    return law_pair(context);
}

static void check(const LawPair *pair, const double change[PAIR_CHANGES], const double expected[LAWS]) {
    double slope[PAIR_CHANGES];
    for (int law = 0; law < LAWS; law++) {
        const double found = laws_known[law].violation(pair, change, slope);
        if (!(fabs(found - expected[law]) < 1e-6))
            fail_msg("%s: %g, not %g", laws_known[law].name, found, expected[law]);
    }
}

TEST(violations_of_known_collisions) {
    const LawPair pair = collision();
    /* No change: still approaching at 3 m/s. */
    check(&pair, (const double[]){0, 0, 0, 0, 0, 0}, (const double[]){0, 0, 3, 0});
    /* Both continue at 1 m/s; elastic, separating at 3 m/s. Neither violates a law. */
    check(&pair, (const double[]){-2, 0, 0, 1, 0, 0}, (const double[]){0, 0, 0, 0});
    check(&pair, (const double[]){-4, 0, 0, 2, 0, 0}, (const double[]){0, 0, 0, 0});
    /* Three times the impulse: 9 J of the bomb become 9 J of the bomb and 18 J of the box. */
    check(&pair, (const double[]){-6, 0, 0, 3, 0, 0}, (const double[]){0, 18, 0, 0});
    /* Only the box changes: 4 N s too much; the bomb keeps its 9 J and the box gains 2 J; still approaching at 2
       m/s. */
    check(&pair, (const double[]){0, 0, 0, 1, 0, 0}, (const double[]){4, 2, 2, 0});
    /* Pulled by 4 N s: 25 J of the bomb and 2 J of the box; 4 N s of pulling, nothing across. */
    check(&pair, (const double[]){2, 0, 0, -1, 0, 0}, (const double[]){0, 18, 6, 4});
    /* 4 N s normal and 6 N s tangential, where friction allows 2; energy: the bomb 1 + 9 J, the box 2 + 4.5 J. */
    check(&pair, (const double[]){-2, -3, 0, 1, 1.5, 0}, (const double[]){0, 7.5, 0, 4});
    /* Reversed: 4 N s of pull, and 6 N s tangential where friction allows 0. */
    check(&pair, (const double[]){2, 3, 0, -1, -1.5, 0}, (const double[]){0, 31.5, 6, 10});
    /* Spins of -1 and 1 rad/s: each point gains 0.5 m/s towards the other; 1/4 J and 1/2 J. */
    check(&pair, (const double[]){0, 0, -1, 0, 0, 1}, (const double[]){0, 0.75, 4, 0});
}

/* The box is a wall: it gains no momentum or energy, and its change is ignored. */
TEST(static_bodies_are_ignored) {
    const float context[PAIR_CONTEXT] = {[CONTEXT_INV_MASS_A] = 0.5f,
                                         [CONTEXT_INV_INERTIA_A] = 2,
                                         [CONTEXT_NORMAL] = 1,
                                         [CONTEXT_FRICTION] = 0.5f,
                                         [CONTEXT_VELOCITIES] = 3};
    const LawPair wall = law_pair(context);
    check(&wall, (const double[]){-3, 0, 0, 7, 8, 9}, (const double[]){0, 0, 0, 0});
    check(&wall, (const double[]){1, 0, 0, 7, 8, 9}, (const double[]){0, 7, 4, 2});
    check(&wall, (const double[]){-1, 2, 0, 7, 8, 9}, (const double[]){0, 0, 2, 3});
    /* The same with the bodies exchanged: b flies to the left at a wall. */
    const float mirrored[PAIR_CONTEXT] = {[CONTEXT_INV_MASS_B] = 0.5f,
                                          [CONTEXT_INV_INERTIA_B] = 2,
                                          [CONTEXT_NORMAL] = 1,
                                          [CONTEXT_FRICTION] = 0.5f,
                                          [CONTEXT_VELOCITIES + 3] = -3};
    const LawPair thrown = law_pair(mirrored);
    check(&thrown, (const double[]){7, 8, 9, 3, 0, 0}, (const double[]){0, 0, 0, 0});
    check(&thrown, (const double[]){7, 8, 9, -1, 0, 0}, (const double[]){0, 7, 4, 2});
    check(&thrown, (const double[]){7, 8, 9, 1, 2, 0}, (const double[]){0, 0, 2, 3});
}

/* 4 N s; -6 J; 3 m/s less approach. */
TEST(sizes_are_those_of_the_change) {
    const LawPair pair = collision();
    const double change[] = {-2, 0, 0, 1, 0, 0}, expected[LAWS] = {4, -6, 3, 4};
    for (int law = 0; law < LAWS; law++) assert_near(laws_known[law].size(&pair, change), expected[law], 1e-6);
}

/* Away from kinks, which random numbers do not hit, a central difference is exact to the curvature times 1e-12. */
TEST(slopes_are_finite_differences) {
    const double step = 1e-6;
    uint32_t sequence = 29;
    int violated[LAWS] = {0};
    for (int i = 0; i < 300; i++) {
        float context[PAIR_CONTEXT];
        double change[PAIR_CHANGES], slope[PAIR_CHANGES], ignored[PAIR_CHANGES];
        draw_context(&sequence, i, context);
        const LawPair pair = law_pair(context);
        for (int k = 0; k < PAIR_CHANGES; k++) change[k] = 3 * (double)next_number(&sequence);
        for (int law = 0; law < LAWS; law++) {
            if (laws_known[law].violation(&pair, change, slope) == 0) continue;
            violated[law]++;
            for (int k = 0; k < PAIR_CHANGES; k++) {
                const double kept = change[k];
                change[k] = kept + step;
                const double above = laws_known[law].violation(&pair, change, ignored);
                change[k] = kept - step;
                const double below = laws_known[law].violation(&pair, change, ignored);
                change[k] = kept;
                assert_near(slope[k], (above - below) / (2 * step), 1e-6 * (1 + fabs(slope[k])));
            }
        }
    }
    for (int law = 0; law < LAWS; law++) assert_true(violated[law] > 50);
}

static void assert_no_weights(const char *text, const char *message) {
    Error error = {0};
    LawNumbers weights;
    assert_refused(law_weights_parse(text, &weights, &error), message);
}

TEST(weights_are_parsed) {
    LawNumbers weights;
    assert_true(law_weights_parse("cone=1,momentum=0.1", &weights, &error));
    assert_true(weights.of[LAW_MOMENTUM] == 0.1 && weights.of[LAW_CONE] == 1);
    assert_true(weights.of[LAW_ENERGY] == 0 && weights.of[LAW_APPROACH] == 0);
    assert_true(law_weights_any(&weights));
    assert_true(law_weights_named("approach", 3, &weights, &error));
    assert_true(weights.of[LAW_APPROACH] == 3 && weights.of[LAW_CONE] == 0);
    assert_true(law_weights_named("all", 2, &weights, &error));
    for (int law = 0; law < LAWS; law++) assert_true(weights.of[law] == 2);
    assert_true(law_weights_named("none", 2, &weights, &error));
    assert_false(law_weights_any(&weights));
    assert_refused(law_weights_named("gravity", 2, &weights, &error),
                   "'gravity' is not a law; known: none, momentum, energy, approach, cone, all");
    assert_no_weights("gravity=1", "gravity");
    assert_no_weights("cone=1,cone=2", "cone");
    assert_no_weights("energy", "energy");
    assert_no_weights("energy=-1", "energy: '-1' is not a number of 0 or more");
    assert_no_weights("energy=nan", "energy: 'nan' is not a number of 0 or more");
    assert_no_weights("energy=1e39", "energy: '1e39' is not a number of 0 or more");
}

RUN_TESTS(NULL, NULL)
