/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of the memory: who answers, with what, and how ellipsoids grow and shrink. */
#include "memories.h"
#include "owned.h"

TEST(entries_answer_inside_their_ball_and_for_their_contacts_only) {
    OWN(HybridMemory) *memory = make_memory();
    float key[KEY] = {1, 2, 3};
    HybridQuery query = {7 + 4, 4, key};
    assert_int_equal(hybrid_memory_find(memory, &query), -1);
    assert_int_equal(add_entry(memory, 4, key, 5, 0.5f, NULL, NULL), 0);
    assert_int_equal(hybrid_memory_find(memory, &query), 0);
    key[8] = 0.4f;
    assert_int_equal(hybrid_memory_find(memory, &query), 0);
    key[0] += 0.4f;
    assert_int_equal(hybrid_memory_find(memory, &query), -1);
    assert_int_equal(hybrid_memory_nearest(memory, &query, 3), 0);
    key[0] -= 0.4f;
    query.contacts = 3; /* the same hash, by accident */
    assert_int_equal(hybrid_memory_find(memory, &query), -1);
    query = (HybridQuery){7 + 3, 3, key};
    assert_int_equal(hybrid_memory_nearest(memory, &query, 3), -1);
}

TEST(the_most_central_entry_answers) {
    OWN(HybridMemory) *memory = make_memory();
    for (int i = 0; i < 200; i++) { /* the table of sets grows, too */
        const float key[KEY] = {(float)(i / 4)};
        add_entry(memory, i % 4, key, (float)i, 3, NULL, NULL);
    }
    for (int i = 0; i < 200; i++) {
        const float key[KEY] = {(float)(i / 4) + 0.2f};
        const HybridQuery query = {7 + (uint64_t)(i % 4), i % 4, key};
        assert_int_equal(hybrid_memory_find(memory, &query), i);
        assert_int_equal(hybrid_memory_nearest(memory, &query, 3), i);
    }
    assert_int_equal(memory->set_count, 4);
}

/* Three entries of a linear map; the third interpolates between them. */
TEST(a_linear_map_is_answered_exactly) {
    OWN(HybridMemory) *memory = make_memory();
    const float along_x[KEY] = {1}, along_y[KEY] = {0, 1}, origin[KEY] = {0}, at[KEY] = {0.5f, -2};
    add_entry(memory, 2, along_x, 3, 1, NULL, NULL);
    add_entry(memory, 2, along_y, 5, 1, NULL, NULL);
    const int32_t near[HYBRID_NEAR] = {0, 1, -1};
    float weights[HYBRID_NEAR * KEY] = {0};
    weights[0] = weights[KEY + 1] = 1;
    weights[2 * KEY] = 1e9f; /* of nobody */
    const int entry = add_entry(memory, 2, origin, 1, 1, near, weights);
    ContactImpulse impulses[2];
    hybrid_memory_answer(memory, entry, at, impulses);
    for (int i = 0; i < 2; i++) { /* 1 + 2 x + 4 y */
        assert_near(impulses[i].normal, 1 + 2 * 0.5 + 4 * -2 + i, 1e-5);
        assert_near(impulses[i].tangent, 0.1 * (1 + 2 * 0.5 + 4 * -2 + i), 1e-5);
    }
}

/* The new point is on the border. Growth keeps all that was inside, a cut all that was outside; `reach` bounds all
   points. */
TEST(ellipsoids_grow_and_shrink_to_a_point) {
    uint32_t seed = 3;
    for (int run = 0; run < 50; run++) {
        OWN(HybridMemory) *memory = make_memory();
        const float origin[KEY] = {0};
        add_entry(memory, 1, origin, 1, 1, NULL, NULL);
        for (int turn = 0; turn < 6; turn++) {
            float points[100][KEY], before[100], key[KEY];
            for (int i = 0; i < KEY; i++) key[i] = (turn % 3 == 2 ? 0.2f : 1.5f) * any_number(&seed);
            for (int p = 0; p < 100; p++) {
                for (int i = 0; i < KEY; i++) points[p][i] = any_number(&seed);
                before[p] = hybrid_memory_distance(memory, 0, points[p]);
            }
            const bool grows = hybrid_memory_distance(memory, 0, key) > 1;
            hybrid_memory_stretch(memory, 0, key);
            assert_near(hybrid_memory_distance(memory, 0, key), 1, 1e-3);
            for (int p = 0; p < 100; p++) {
                const float now = hybrid_memory_distance(memory, 0, points[p]);
                float square = 0;
                for (int i = 0; i < KEY; i++) square += points[p][i] * points[p][i];
                assert_true(grows ? now <= before[p] * 1.001f : now >= before[p] * 0.999f);
                assert_true(square <= now * memory->reach[0] * 1.001f);
            }
        }
        hybrid_memory_stretch(memory, 0, origin); /* nothing */
        assert_near(hybrid_memory_distance(memory, 0, origin), 0, 0);
    }
}

/* With rows of unit vectors: numbers along them are components, all others make the distance. */
TEST(a_key_has_components_and_the_distance_from_their_space) {
    OWN(HybridMemory) *memory = make_memory();
    float key[KEY], bomb[HYBRID_NUMBERS] = {1, 2, 3, 4, 5, 6}, others[2 * HYBRID_NUMBERS] = {0};
    memory->rows[3 * COMPONENTS] = memory->rows[8 * COMPONENTS + 1] = 1;
    memory->centre[8] = 10;
    others[3] = 2;
    others[8] = 13;
    others[1] = 3;
    others[11] = -4;
    hybrid_memory_key(memory, bomb, others, key);
    assert_memory_equal(key, bomb, sizeof bomb);
    assert_near(key[6], 2, 0);
    assert_near(key[7], 3, 0);
    assert_near(key[8], 5, 1e-5);
}

/* A box of 2 m by 1 m at 60 Hz: an overlap of 1 m is pushed apart at 12 m/s. */
TEST(numbers_are_in_metres_per_second) {
    float numbers[HYBRID_NUMBERS];
    const ProblemBody body = {
        .position = {1, -2}, .angle = 9, .size = {2, 1}, .velocity = {3, 4}, .angular_velocity = 2};
    const float expected[] = {12, -24, 12 * 0.75f * 0.5f, 3, 4, 1.5f};
    hybrid_memory_numbers(&body, 0.5f, 1.0f / 60, numbers);
    for (int i = 0; i < HYBRID_NUMBERS; i++) assert_near(numbers[i], expected[i], 1e-5);
}

RUN_TESTS(NULL, NULL)
