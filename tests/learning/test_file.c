/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "learning/dataset.h"
#include "base/npz.h"

#include <math.h>

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

static void files_keep_every_bit(void **state) {
    (void)state;
    Error error = {0};
    Dataset dataset = example();
    dataset.target = TARGET_IMPULSE;
    dataset.labels = DATASET_BY_REFERENCE;
    dataset.view = PAIR_RAW_UNTURNED;
    const char *path = temporary_path("data.npz");
    assert_ok(dataset_write(&dataset, path, &error), error);
    Dataset *read = dataset_read(path, &error);
    assert_ok(read != NULL, error);
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
    assert_true(read->target == TARGET_IMPULSE && read->labels == DATASET_BY_REFERENCE &&
                read->view == PAIR_RAW_UNTURNED);
    assert_int_equal(read->scene_count, 2);
    assert_string_equal(read->scenes[0], "single");
    assert_string_equal(read->scenes[1], "stack of ten");
    dataset_destroy(read);
}

/* View and target define the width of rows. */
static void widths_are_those_of_view_and_target(void **state) {
    (void)state;
    Error error = {0};
    static float wide[ROWS * PAIR_INPUTS_MAX], points[ROWS * PAIR_POINT_CHANGES];
    for (int i = 0; i < ROWS * PAIR_INPUTS_MAX; i++) wide[i] = 0.5f * (float)i;
    for (int i = 0; i < ROWS * PAIR_POINT_CHANGES; i++) points[i] = -(float)i;
    for (PairView view = PAIR_CONTACT; view <= PAIR_NEIGHBOURS; view++) {
        Dataset dataset = example();
        dataset.view = view;
        dataset.target = TARGET_POINTS;
        dataset.inputs = wide;
        dataset.changes = points;
        const char *path = temporary_path("wide.npz");
        assert_ok(dataset_write(&dataset, path, &error), error);
        Dataset *read = dataset_read(path, &error);
        assert_ok(read != NULL, error);
        assert_true(read->view == view && read->target == TARGET_POINTS);
        assert_memory_equal(read->inputs, wide, ROWS * (size_t)dataset_inputs(read) * sizeof(float));
        assert_memory_equal(read->changes, points, sizeof points);
        dataset_destroy(read);
    }
}

static void the_most_and_longest_scene_names_are_kept(void **state) {
    (void)state;
    Error error = {0};
    Dataset dataset = example();
    const char *path = temporary_path("names.npz");
    dataset.scene_count = DATASET_MAX_SCENES;
    for (int s = 0; s < DATASET_MAX_SCENES; s++) {
        memset(dataset.scenes[s], 'a' + s, DATASET_NAME_SIZE - 1);
        dataset.scenes[s][DATASET_NAME_SIZE - 1] = '\0';
    }
    assert_ok(dataset_write(&dataset, path, &error), error);
    Dataset *read = dataset_read(path, &error);
    assert_ok(read != NULL, error);
    assert_int_equal(read->scene_count, DATASET_MAX_SCENES);
    assert_string_equal(read->scenes[DATASET_MAX_SCENES - 1], dataset.scenes[DATASET_MAX_SCENES - 1]);
    dataset_destroy(read);
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

static void a_context_is_kept_where_there_is_one(void **state) {
    (void)state;
    Error error = {0};
    Dataset with = example_with_context();
    const char *path = temporary_path("context.npz");
    assert_ok(dataset_write(&with, path, &error), error);
    Dataset *read = dataset_read(path, &error);
    assert_ok(read != NULL && read->context != NULL, error);
    assert_memory_equal(read->context, numbers.context, sizeof numbers.context);
    dataset_destroy(read);
    const Dataset without = example();
    assert_ok(dataset_write(&without, path, &error), error);
    read = dataset_read(path, &error);
    assert_ok(read != NULL, error);
    assert_null(read->context);
    dataset_destroy(read);
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    assert_refused(dataset_read(path, &error), text, path);
}

static void assert_written_is_refused(const Dataset *dataset, const char *text) {
    Error error = {0};
    const char *path = temporary_path("bad.npz");
    assert_ok(dataset_write(dataset, path, &error), error);
    refuse(path, text);
}

static void numbers_that_are_not_finite_are_refused(void **state) {
    (void)state;
    Dataset dataset = example();
    numbers.inputs[13] = NAN;
    assert_written_is_refused(&dataset, "inputs: number 13 is nan");
    dataset = example();
    numbers.changes[23] = INFINITY;
    assert_written_is_refused(&dataset, "changes: number 23 is inf");
    dataset = example();
    numbers.launch_x[2] = -INFINITY;
    assert_written_is_refused(&dataset, "launch_x: number 2");
    dataset = example();
    numbers.launch_spin[1] = NAN;
    assert_written_is_refused(&dataset, "launch_spin: number 1");
}

static void contexts_that_no_pair_has_are_refused(void **state) {
    (void)state;
    Dataset dataset = example_with_context();
    numbers.context[PAIR_CONTEXT + 3] = NAN;
    assert_written_is_refused(&dataset, "context: number 20 is nan");
    dataset = example_with_context();
    numbers.context[2 * PAIR_CONTEXT + CONTEXT_INV_MASS_B] = -1;
    assert_written_is_refused(&dataset, "context: row 2 has an inverse mass or inertia below 0");
    dataset = example_with_context();
    numbers.context[3 * PAIR_CONTEXT + CONTEXT_NORMAL] = 1;
    assert_written_is_refused(&dataset, "context: row 3 has a normal whose length is not 1");
}

static void indices_out_of_range_are_refused(void **state) {
    (void)state;
    Dataset dataset = example();
    numbers.launch[3] = LAUNCHES;
    assert_written_is_refused(&dataset, "launch: number 3 is 3; expected 0 to 2");
    numbers.launch[3] = -1;
    assert_written_is_refused(&dataset, "launch: number 3 is -1");
    dataset = example();
    numbers.launch_scene[1] = 2;
    assert_written_is_refused(&dataset, "launch_scene: number 1 is 2; expected 0 to 1");
    dataset = example();
    numbers.frame[0] = -1;
    assert_written_is_refused(&dataset, "frame: number 0");
    dataset = example();
    numbers.bodies[7] = -1;
    assert_written_is_refused(&dataset, "bodies: number 7");
    dataset = example();
    numbers.launch_test[0] = 2;
    assert_written_is_refused(&dataset, "launch_test: number 0 is 2");
}

static void both_sides_of_the_split_need_rows(void **state) {
    (void)state;
    Dataset dataset = example();
    numbers.launch_test[1] = 0;
    assert_written_is_refused(&dataset, "4 rows to train on and 0 to test on");
    memset(numbers.launch_test, 1, sizeof numbers.launch_test);
    assert_written_is_refused(&dataset, "0 rows to train on and 4 to test on");
    dataset = example();
    dataset.rows = 0;
    assert_written_is_refused(&dataset, "0 rows");
    dataset = example();
    dataset.launches = 0;
    assert_written_is_refused(&dataset, "0 launches");
}

static void scene_names_out_of_range_are_refused(void **state) {
    (void)state;
    Dataset dataset = example();
    dataset.scenes[1][0] = '\0';
    assert_written_is_refused(&dataset, "scenes: a name of 0 bytes");
    dataset = example();
    memset(dataset.scenes[0], '\n', DATASET_MAX_SCENES);
    memset(dataset.scenes[0], 'x', 1);
    assert_written_is_refused(&dataset, "scenes: a name of 0 bytes");
}

/* Replaces one array of the example's file, adds a context, or leaves it out where its data is NULL. */
static const char *write_with(NpzArray changed) {
    const Dataset dataset = example();
    const int32_t version = DATASET_VERSION;
    const NpzArray valid[] = {{"version", NPZ_INT32, 0, {0}, &version},
                              {"kind", NPZ_TEXT, 0, {0}, "dataset"},
                              {"view", NPZ_TEXT, 0, {0}, "relative"},
                              {"target", NPZ_TEXT, 0, {0}, "net"},
                              {"labels", NPZ_TEXT, 0, {0}, "engine"},
                              {"scenes", NPZ_TEXT, 0, {0}, "single\nstack"},
                              {"launch_scene", NPZ_INT32, 1, {LAUNCHES}, dataset.launch_scene},
                              {"launch_x", NPZ_FLOAT32, 1, {LAUNCHES}, dataset.launch_x},
                              {"launch_rotation", NPZ_FLOAT32, 1, {LAUNCHES}, dataset.launch_rotation},
                              {"launch_spin", NPZ_FLOAT32, 1, {LAUNCHES}, dataset.launch_spin},
                              {"launch_test", NPZ_UINT8, 1, {LAUNCHES}, dataset.launch_test},
                              {"inputs", NPZ_FLOAT32, 2, {ROWS, PAIR_INPUTS}, dataset.inputs},
                              {"changes", NPZ_FLOAT32, 2, {ROWS, PAIR_CHANGES}, dataset.changes},
                              {"launch", NPZ_INT32, 1, {ROWS}, dataset.launch},
                              {"frame", NPZ_INT32, 1, {ROWS}, dataset.frame},
                              {"bodies", NPZ_INT32, 2, {ROWS, 2}, dataset.bodies}};
    enum { COUNT = sizeof valid / sizeof valid[0] };
    NpzArray arrays[COUNT + 1];
    size_t count = 0;
    for (size_t i = 0; i < COUNT; i++) {
        bool same = strcmp(valid[i].name, changed.name) == 0;
        if (!same || changed.data != NULL) arrays[count++] = same ? changed : valid[i];
    }
    if (strcmp(changed.name, "context") == 0) arrays[count++] = changed;
    Error error = {0};
    const char *path = temporary_path("changed.npz");
    assert_ok(npz_write(path, arrays, count, &error), error);
    return path;
}

static void shapes_that_do_not_fit_are_refused(void **state) {
    (void)state;
    static const float floats[128];
    static const int32_t integers[16];
    static const uint8_t bytes[4];
    refuse(write_with((NpzArray){"inputs", NPZ_FLOAT32, 2, {ROWS, 9}, floats}), "inputs");
    refuse(write_with((NpzArray){"inputs", NPZ_FLOAT32, 2, {ROWS - 1, 10}, floats}), "changes");
    refuse(write_with((NpzArray){"changes", NPZ_FLOAT32, 2, {ROWS, 5}, floats}), "changes");
    refuse(write_with((NpzArray){"context", NPZ_FLOAT32, 2, {ROWS, PAIR_CONTEXT - 1}, floats}), "context");
    refuse(write_with((NpzArray){"context", NPZ_FLOAT32, 2, {ROWS + 1, PAIR_CONTEXT}, floats}), "context");
    refuse(write_with((NpzArray){"context", NPZ_INT32, 2, {ROWS, 3}, integers}), "context");
    refuse(write_with((NpzArray){"launch", NPZ_INT32, 1, {ROWS + 1}, integers}), "launch");
    refuse(write_with((NpzArray){"frame", NPZ_INT32, 2, {ROWS, 1}, integers}), "frame");
    refuse(write_with((NpzArray){"bodies", NPZ_INT32, 2, {ROWS, 3}, integers}), "bodies");
    refuse(write_with((NpzArray){"launch_test", NPZ_UINT8, 1, {LAUNCHES - 1}, bytes}), "launch_test");
    refuse(write_with((NpzArray){"launch_scene", NPZ_INT32, 1, {LAUNCHES + 1}, integers}), "launch_scene");
    refuse(write_with((NpzArray){"launch_x", NPZ_INT32, 1, {LAUNCHES}, integers}), "launch_x");
}

static void other_files_are_refused(void **state) {
    (void)state;
    const int32_t future = DATASET_VERSION + 1, past = 2;
    refuse(write_with((NpzArray){"version", NPZ_INT32, 0, {0}, &past}), "version 2; expected version 3");
    refuse(write_with((NpzArray){"version", NPZ_INT32, 0, {0}, &future}), "version 3");
    refuse(write_with((NpzArray){"view", NPZ_TEXT, 0, {0}, "sideways"}), "view: a word that is not known");
    refuse(write_with((NpzArray){"target", NPZ_TEXT, 0, {0}, ""}), "target: a word");
    refuse(write_with((NpzArray){"labels", NPZ_TEXT, 0, {0}, "me"}), "labels: a word");
    refuse(write_with((NpzArray){"view", NPZ_TEXT, 0, {0}, "raw"}), "inputs");
    refuse(write_with((NpzArray){"view", NPZ_TEXT, 0, {0}, "contact"}), "inputs");
    refuse(write_with((NpzArray){"target", NPZ_TEXT, 0, {0}, "points"}), "changes");
    refuse(write_with((NpzArray){"kind", NPZ_TEXT, 0, {0}, "network"}), "not a file of kind 'dataset'");
    refuse(write_with((NpzArray){.name = "kind"}), "not a file of kind 'dataset'");
    refuse(write_with((NpzArray){.name = "changes"}), "changes");
    refuse(temporary_path("missing.npz"), "error:");
    const char *path = write_with((NpzArray){.name = "none"});
    assert_int_equal(truncate(path, 900), 0);
    refuse(path, "error:");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_keep_every_bit),
        cmocka_unit_test(widths_are_those_of_view_and_target),
        cmocka_unit_test(a_context_is_kept_where_there_is_one),
        cmocka_unit_test(the_most_and_longest_scene_names_are_kept),
        cmocka_unit_test(numbers_that_are_not_finite_are_refused),
        cmocka_unit_test(contexts_that_no_pair_has_are_refused),
        cmocka_unit_test(indices_out_of_range_are_refused),
        cmocka_unit_test(both_sides_of_the_split_need_rows),
        cmocka_unit_test(scene_names_out_of_range_are_refused),
        cmocka_unit_test(shapes_that_do_not_fit_are_refused),
        cmocka_unit_test(other_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
