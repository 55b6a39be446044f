/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "nets/net_files.h"
#include "owned.h"

#include "learning/dataset.h"

enum { ROWS = 4, LAUNCHES = 3 };

/* Two scenes, three launches of which the second is held out, four rows. */
static struct {
    float inputs[ROWS * PAIR_INPUTS], changes[ROWS * PAIR_CHANGES], context[ROWS * PAIR_CONTEXT], launch_x[LAUNCHES],
        launch_rotation[LAUNCHES], launch_spin[LAUNCHES];
    int32_t launch[ROWS], frame[ROWS], bodies[ROWS * 2], launch_scene[LAUNCHES];
    uint8_t launch_test[LAUNCHES];
} numbers;

static Dataset example(void) {
    for (int i = 0; i < ROWS * PAIR_INPUTS; i++) numbers.inputs[i] = 0.1f * (float)i - 1;
    for (int i = 0; i < ROWS * PAIR_CHANGES; i++) numbers.changes[i] = -0.3f * (float)i;
    memcpy(numbers.launch, (int32_t[]){0, 0, 1, 2}, sizeof numbers.launch);
    memcpy(numbers.frame, (int32_t[]){1, 2, 5, 9}, sizeof numbers.frame);
    memcpy(numbers.bodies, (int32_t[]){0, 1, 0, 2, 1, 2, 0, 1}, sizeof numbers.bodies);
    memcpy(numbers.launch_scene, (int32_t[]){0, 0, 1}, sizeof numbers.launch_scene);
    memcpy(numbers.launch_x, (float[]){-0.1f, 0, 0.1f}, sizeof numbers.launch_x);
    memcpy(numbers.launch_rotation, (float[]){0.5f, -1.5f, 0}, sizeof numbers.launch_rotation);
    memcpy(numbers.launch_spin, (float[]){20, 0, -7}, sizeof numbers.launch_spin);
    memcpy(numbers.launch_test, (uint8_t[]){0, 1, 0}, sizeof numbers.launch_test);
    return (Dataset){.rows = ROWS,
                     .inputs = numbers.inputs,
                     .changes = numbers.changes,
                     .launch = numbers.launch,
                     .frame = numbers.frame,
                     .bodies = numbers.bodies,
                     .launches = LAUNCHES,
                     .launch_scene = numbers.launch_scene,
                     .launch_x = numbers.launch_x,
                     .launch_rotation = numbers.launch_rotation,
                     .launch_spin = numbers.launch_spin,
                     .launch_test = numbers.launch_test,
                     .scene_count = 2,
                     .scenes = {"single", "stack of ten"}};
}

/* The example with a context: one body moves, and the normal points up. */
static Dataset example_with_context(void) {
    Dataset dataset = example();
    for (int i = 0; i < ROWS * PAIR_CONTEXT; i++) numbers.context[i] = 0.01f * (float)i;
    for (int r = 0; r < ROWS; r++) {
        numbers.context[r * PAIR_CONTEXT + CONTEXT_NORMAL] = 0;
        numbers.context[r * PAIR_CONTEXT + CONTEXT_NORMAL + 1] = 1;
    }
    dataset.context = numbers.context;
    return dataset;
}

static Dataset *written_and_read(const Dataset *dataset) {
    Error error = {0};
    const char *path = temporary_path("data.npz");
    assert_ok(dataset_write(dataset, path, &error), error);
    Dataset *read = dataset_read(path, &error);
    assert_ok(read != NULL, error);
    return read;
}

TEST(files_keep_every_bit) {
    Dataset dataset = example_with_context();
    dataset.target = TARGET_IMPULSE;
    dataset.labels = DATASET_BY_REFERENCE;
    dataset.view = PAIR_RAW_UNTURNED;
    OWN(Dataset) *read = written_and_read(&dataset);
    assert_true(read->rows == ROWS && read->launches == LAUNCHES);
    assert_memory_equal(read->inputs, numbers.inputs, sizeof numbers.inputs);
    assert_memory_equal(read->changes, numbers.changes, sizeof numbers.changes);
    assert_memory_equal(read->launch, numbers.launch, sizeof numbers.launch);
    assert_memory_equal(read->frame, numbers.frame, sizeof numbers.frame);
    assert_memory_equal(read->bodies, numbers.bodies, sizeof numbers.bodies);
    assert_memory_equal(read->launch_scene, numbers.launch_scene, sizeof numbers.launch_scene);
    assert_memory_equal(read->launch_x, numbers.launch_x, sizeof numbers.launch_x);
    assert_memory_equal(read->launch_test, numbers.launch_test, sizeof numbers.launch_test);
    assert_memory_equal(read->launch_rotation, numbers.launch_rotation, sizeof numbers.launch_rotation);
    assert_memory_equal(read->launch_spin, numbers.launch_spin, sizeof numbers.launch_spin);
    assert_memory_equal(read->context, numbers.context, sizeof numbers.context);
    assert_true(read->target == TARGET_IMPULSE && read->labels == DATASET_BY_REFERENCE &&
                read->view == PAIR_RAW_UNTURNED);
    assert_int_equal(read->scene_count, 2);
    assert_string_equal(read->scenes[0], "single");
    assert_string_equal(read->scenes[1], "stack of ten");
}

static bool is_read(const char *path, Error *error) {
    Dataset *dataset = dataset_read(path, error);
    dataset_destroy(dataset);
    return dataset != NULL;
}

static const char *write_example(const Dataset *dataset) {
    Error error = {0};
    const char *path = temporary_path("example.npz");
    assert_ok(dataset_write(dataset, path, &error), error);
    return path;
}

TEST(every_array_is_needed_and_checked) {
    const Dataset dataset = example(), with = example_with_context();
    assert_file_is_checked(is_read, write_example(&dataset), "dataset", DATASET_VERSION);
    NetArrays arrays = read_arrays(write_example(&with));
    for (int wrong = 0; wrong < 3; wrong++) { /* the context may be missing, and nothing else */
        NpzArray context = arrays.items[arrays.count - 1];
        assert_string_equal(context.name, "context");
        context.shape[0] -= wrong == 0;
        context.shape[1] -= wrong == 1;
        if (wrong == 2) context.type = NPZ_INT32;
        refuse_file(is_read, write_with(&arrays, context), "context");
    }
    free_arrays(&arrays);
}

/* One number of the example with a context is bad. */
TEST(numbers_out_of_range_are_refused) {
    const struct {
        int32_t *index;
        float *number;
        double bad;
        const char *text;
    } cases[] = {
        {NULL, &numbers.changes[23], INFINITY, "changes: number 23 is inf; all must be finite"},
        {NULL, &numbers.context[2 * PAIR_CONTEXT + CONTEXT_INV_MASS_B], -1,
         "context: row 2 has an inverse mass or inertia below 0"},
        {NULL, &numbers.context[3 * PAIR_CONTEXT + CONTEXT_NORMAL], 1,
         "context: row 3 has a normal whose length is not 1"},
        {&numbers.launch[3], NULL, LAUNCHES, "launch: number 3 is 3; expected 0 to 2"},
        {&numbers.launch_scene[1], NULL, 2, "launch_scene: number 1 is 2; expected 0 to 1"},
        {&numbers.frame[0], NULL, -1, "frame: number 0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const Dataset dataset = example_with_context();
        if (cases[i].index != NULL)
            *cases[i].index = (int32_t)cases[i].bad;
        else
            *cases[i].number = (float)cases[i].bad;
        refuse_file(is_read, write_example(&dataset), cases[i].text);
    }
}

TEST(splits_and_names_out_of_range_are_refused) {
    static const struct {
        uint8_t test[LAUNCHES];
        int rows, launches;
        char first_name[4];
        const char *text;
    } cases[] = {{{2, 1, 0}, ROWS, LAUNCHES, "one", "launch_test: number 0 is 2"},
                 {{0, 0, 0}, ROWS, LAUNCHES, "one", "4 rows to train on and 0 to test on"},
                 {{0, 1, 0}, 0, LAUNCHES, "one", "0 rows"},
                 {{0, 1, 0}, ROWS, 0, "one", "0 launches"},
                 {{0, 1, 0}, ROWS, LAUNCHES, "", "scenes: a name of 0 bytes"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Dataset dataset = example();
        memcpy(numbers.launch_test, cases[i].test, sizeof numbers.launch_test);
        dataset.rows = cases[i].rows;
        dataset.launches = cases[i].launches;
        strcpy(dataset.scenes[0], cases[i].first_name);
        refuse_file(is_read, write_example(&dataset), cases[i].text);
    }
}

RUN_TESTS(NULL, NULL)
