/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "network/momentum_schedule.h"
#include "npz/npz.h"

#include <math.h>

static void what_is_written_is_read_again(void **state) {
    (void)state;
    Error error = {0};
    MomentumSchedules written = {.command = "twinbox train"}, found;
    const float three[] = {0, 0.5f, 2}, five[] = {0, 0.1f, 0.2f, 0.3f, 0.4f};
    assert_ok(momentum_schedules_add(&written, 3, three, &error), error);
    assert_ok(momentum_schedules_add(&written, 5, five, &error), error);
    const char *path = temporary_path("schedules.npz");
    assert_ok(momentum_schedules_write(&written, path, &error), error);
    assert_ok(momentum_schedules_read(&found, path, &error), error);
    assert_int_equal(found.count, 2);
    assert_string_equal(found.command, "twinbox train");
    assert_memory_equal(momentum_schedules_find(&found, 3), three, sizeof three);
    assert_memory_equal(momentum_schedules_find(&found, 5), five, sizeof five);
    assert_null(momentum_schedules_find(&found, 4));
    momentum_schedules_free(&written);
    momentum_schedules_free(&found);
}

/* A file as hostile as the caller likes. */
static const char *write_file(int version, const char *kind, int count, const int32_t *sweeps, int numbers,
                              const float *factors) {
    const NpzArray arrays[] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = kind},
        {.name = "command", .type = NPZ_TEXT, .data = ""},
        {.name = "sweeps", .type = NPZ_INT32, .rank = 1, .shape = {count}, .data = sweeps},
        {.name = "factors", .type = NPZ_FLOAT32, .rank = 1, .shape = {numbers}, .data = factors}};
    Error error = {0};
    const char *path = temporary_path("hostile.npz");
    assert_ok(npz_write(path, arrays, 5, &error), error);
    return path;
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    MomentumSchedules schedules;
    assert_refused(momentum_schedules_read(&schedules, path, &error), text);
    assert_int_equal(schedules.count, 0);
}

static void hostile_files_are_refused(void **state) {
    (void)state;
    static const char kind[] = "momentum-schedules";
    const float fine[] = {0, 0.5f, 0.6f, 0.7f, 0, 0.5f};
    const int32_t two[] = {2, 4};
    refuse(write_file(2, kind, 2, two, 6, fine), "version 2");
    refuse(write_file(1, "network", 2, two, 6, fine), "not a file of kind 'momentum-schedules'");
    refuse(write_file(1, kind, 2, two, 5, fine), "factors");
    refuse(write_file(1, kind, 0, two, 0, fine), "0 schedules");
    refuse(write_file(1, kind, 2, (const int32_t[]){4, 2}, 6, fine), "sweeps[1] is 2");
    refuse(write_file(1, kind, 2, (const int32_t[]){3, 3}, 6, fine), "sweeps[1] is 3");
    refuse(write_file(1, kind, 2, (const int32_t[]){-1, 7}, 6, fine), "sweeps[0] is -1");
    refuse(write_file(1, kind, 1, (const int32_t[]){1001}, 6, fine), "sweeps[0] is 1001");
    refuse(write_file(1, kind, 1, (const int32_t[]){2}, 2, (const float[]){0, NAN}), "factors: number 1");
    refuse(write_file(1, kind, 1, (const int32_t[]){2}, 2, (const float[]){0, -0.1f}), "factors: number 1");
    refuse(write_file(1, kind, 1, (const int32_t[]){2}, 2, (const float[]){2.1f, 0}), "factors: number 0");
    const int32_t many[17] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
    refuse(write_file(1, kind, 17, many, 6, fine), "17 schedules");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_written_is_read_again),
                                       cmocka_unit_test(hostile_files_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
