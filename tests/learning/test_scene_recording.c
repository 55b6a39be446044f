/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Launches that shards have recorded: the samples are those that the training records itself, and damaged ones are refused. */
#include "impacts.h"
#include "equal_problems.h"
#include "in_shards.h"

#include "base/file.h"
#include "learning/scene_training.h"

/* More than a piece of the first round has. */
static const SceneTraining training = {.launches = 230, .rounds = 1, .seed = 5};

static void assert_equal_samples(const SlotSamples *samples, const SlotSamples *others) {
    assert_int_equal(samples->count, others->count);
    assert_int_equal(samples->unconverged, others->unconverged);
    for (int i = 0; i < samples->count; i++) {
        const SlotSample *one = &samples->items[i], *two = &others->items[i];
        const size_t bodies = (size_t)one->problem.body_count, contacts = (size_t)one->problem.contact_count;
        assert_int_equal(one->launch, two->launch);
        assert_int_equal(one->since, two->since);
        assert_equal_problems(&one->problem, &two->problem);
        assert_memory_equal(one->reference, two->reference, bodies * sizeof *one->reference);
        assert_memory_equal(one->goal, two->goal, contacts * sizeof *one->goal);
        assert_memory_equal(one->unrolled.free, two->unrolled.free, 3 * bodies * sizeof *one->unrolled.free);
        assert_memory_equal(one->unrolled.visits, two->unrolled.visits, contacts * sizeof *one->unrolled.visits);
    }
}

TEST(shards_record_what_the_training_runs) {
    Scene *scene = scene_named("stack");
    SceneRecording recording;
    Pieces pieces;
    SceneTraining reading = training;
    reading.recorded = &pieces;
    assert_ok(scene_recording_begin(&recording, scene, &training, &error), error);
    assert_int_equal(recording.plan.count, 5); /* 60, 115 and 115 launches */
    in_shards(&pieces, &recording.plan, temporary_path("net.npz"), 3);
    for (int set = 0; set < SCENE_SETS; set++) {
        SlotSamples run = {0}, read = {0};
        assert_ok(scene_recording_take(&recording, (SceneSet)set, &run, NULL, &error), error);
        recording.training = &reading;
        assert_ok(scene_recording_take(&recording, (SceneSet)set, &read, NULL, &error), error);
        recording.training = &training;
        assert_in_range(run.count, 60, 10000);
        assert_equal_samples(&read, &run);
        slot_samples_free(&run);
        slot_samples_free(&read);
    }
    pieces_close(&pieces);
    scene_recording_end(&recording);
    scene_destroy(scene);
}

/* Whether the bytes, with nothing behind them, are refused. */
static bool is_refused(const char *bytes, size_t size, int bodies) {
    Error error = {0};
    SlotSamples samples = {0};
    char *copy = malloc(size + 1 - (size > 0));
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    const bool read = slot_samples_read(&samples, copy, size, bodies, "piece", &error);
    free(copy);
    slot_samples_free(&samples);
    if (!read) assert_error(error, ERROR_INPUT, "piece: error: has damaged results; delete it, and its shard");
    return !read;
}

static void write_samples(const SlotSamples *samples, char **bytes, size_t *size) {
    FILE *out = memory_stream(bytes, size);
    assert_non_null(out);
    slot_samples_write(samples, out);
    assert_int_equal(fclose(out), 0);
}

TEST(damaged_samples_are_refused) {
    const size_t head = sizeof(int32_t);
    SlotSamples samples = labelled_impacts(2), read = {0};
    char *bytes = NULL, *bytes_of_one = NULL;
    size_t size, size_of_one;
    assert_in_range(samples.count, 2, 100);
    const int bodies = samples.items[0].problem.body_count;
    const SlotSamples one = {.items = samples.items, .count = 1}, two = {.items = samples.items, .count = 2, 5};
    write_samples(&one, &bytes_of_one, &size_of_one);
    write_samples(&two, &bytes, &size);
    assert_ok(slot_samples_read(&read, bytes, size, bodies, "piece", &error), error);
    assert_equal_samples(&read, &two);
    for (size_t cut = 0; cut < size; cut++)
        assert_int_equal(is_refused(bytes, cut, bodies), cut != head && cut != size_of_one);
    assert_true(is_refused(bytes, size, bodies + 1));
    bytes[head + 3] = (char)0x80; /* a negative launch */
    assert_true(is_refused(bytes, size, bodies));
    bytes[head + 3] = 0;
    assert_false(is_refused(bytes, size, bodies));
    bytes[head - 1] = (char)0x80; /* a negative number of samples that were left out */
    assert_true(is_refused(bytes, size, bodies));
    free(bytes_of_one);
    free(bytes);
    slot_samples_free(&samples);
    slot_samples_free(&read);
}

RUN_TESTS(NULL, NULL)
