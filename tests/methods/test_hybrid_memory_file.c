/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory files: what is written is read again, and hostile files are refused with their reason. */
#include "memories.h"
#include "owned.h"

/* Two sets, three entries; the last has a neighbour. */
static HybridMemory *make_three(void) {
    HybridMemory *memory = make_memory();
    const float keys[3][KEY] = {{1, 2}, {3, 4}, {1, 2.5f}};
    const int32_t near[HYBRID_NEAR] = {0, -1, -1};
    const float weights[HYBRID_NEAR * KEY] = {0, 2};
    add_entry(memory, 2, keys[0], 3, 0.5f, NULL, NULL);
    add_entry(memory, 4, keys[1], 4, 0.5f, NULL, NULL);
    add_entry(memory, 2, keys[2], 5, 0.5f, near, weights);
    memory->launches = 9;
    memory->rows[3] = 0.25f;
    return memory;
}

TEST(what_is_written_is_read_again) {
    OWN(HybridMemory) *memory = make_three();
    const char *path = temporary_path("memory.npz");
    assert_ok(hybrid_memory_write(memory, path, &error), error);
    OWN(HybridMemory) *read = hybrid_memory_read(path, &error);
    assert_ok(read != NULL, error);
    assert_int_equal(read->entry_count, 3);
    assert_int_equal(read->set_count, 2);
    assert_int_equal(read->launches, 9);
    assert_int_equal(read->bomb, 2);
    assert_string_equal(read->scene, "hand");
    assert_memory_equal(read->rows, memory->rows, sizeof(float) * COMPONENTS * (size_t)memory->numbers);
    assert_memory_equal(read->metrics, memory->metrics, sizeof(float) * 3 * METRIC);
    const float key[KEY] = {1, 2.4f};
    const HybridQuery query = {7 + 2, 2, key};
    assert_int_equal(hybrid_memory_find(read, &query), 2);
    ContactImpulse one[2], two[2];
    hybrid_memory_answer(memory, 2, key, one);
    hybrid_memory_answer(read, 2, key, two);
    assert_memory_equal(one, two, sizeof one);
}

static void refuse(HybridMemory *memory, const char *text) {
    Error error = {0};
    const char *path = temporary_path("hostile.npz");
    assert_ok(hybrid_memory_write(memory, path, &error), error);
    assert_refused(hybrid_memory_read(path, &error), text, "hostile.npz");
    hybrid_memory_destroy(memory);
}

TEST(hostile_files_are_refused) {
    HybridMemory *memory;
#define REFUSED(change, text) \
    memory = make_three();    \
    change;                   \
    refuse(memory, text)
    REFUSED(memory->metrics[7] = NAN, "metrics: number 7 is nan");
    REFUSED(memory->keys[2] = INFINITY, "keys: number 2 is inf");
    REFUSED(memory->impulses[1].tangent = NAN, "impulses: number 3 is nan");
    REFUSED(memory->tolerance = 0, "tolerance");
    REFUSED(memory->gate = -1, "gate");
    REFUSED(memory->launches = -1, "launches is -1; expected at least 0");
    REFUSED(memory->reach[1] = -1, "reach: number 1 is -1");
    REFUSED(memory->entry_set[1] = 2, "entry_set: number 1 is 2; expected 0 to 1");
    REFUSED(memory->entry_set[1] = 0, "8 impulses; the entries have 6 contacts");
    REFUSED(memory->near[6] = 1, "near: number 6 is 1, which is no entry of the same contacts");
    REFUSED(memory->near[6] = 3, "near: number 6 is 3");
    REFUSED(memory->near[6] = -2, "near: number 6 is -2");
    REFUSED(memory->set_contacts[1] = -4, "set_contacts: number 1 is -4");
    REFUSED(memory->bomb = 3, "bomb is 3; expected 0 to 2");
    REFUSED(memory->body_count = 4, "body_count is 4");
    REFUSED((memory->set_hash[1] = memory->set_hash[0], memory->set_contacts[1] = 2, memory->set_contacts[0] = 2,
             memory->impulse_count = 6),
            "set_hash: number 1 is there twice");
#undef REFUSED
}

TEST(an_empty_memory_is_not_written) {
    OWN(HybridMemory) *memory = make_memory();
    assert_refused(hybrid_memory_write(memory, temporary_path("empty.npz"), &error), "is empty");
}

RUN_TESTS(NULL, NULL)
