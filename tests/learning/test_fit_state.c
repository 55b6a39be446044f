/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "learning/learning.h"
#include "base/npz.h"

#include <math.h>
#include <unistd.h>

enum { COUNT = 3 };

static double written[3][COUNT] = {{1, 2, 3}, {0.5, -0.5, 0.25}, {4, 5, 6}}, read_back[3][COUNT];

static FitState state_over(double numbers[3][COUNT], const char *command) {
    return (FitState){.command = command, .adam = adam_over(numbers[0], numbers[1], numbers[2], COUNT, 0, 0.99)};
}

static const char *write_state(void) {
    const char *path = temporary_path("net.npz.part");
    FitState from = state_over(written, "train a");
    Error error = {0};
    from.stage = 1, from.epoch = 7;
    from.adam.steps = 11;
    assert_ok(fit_state_write(&from, path, &error), error);
    return path;
}

static void a_state_is_read_back(void **state) {
    (void)state;
    const char *path = write_state();
    FitState to = state_over(read_back, "train a");
    Error error = {0};
    bool found;
    assert_ok(fit_state_read(&to, path, &found, &error), error);
    assert_true(found);
    assert_int_equal(to.stage, 1);
    assert_int_equal(to.epoch, 7);
    assert_int_equal(to.adam.steps, 11);
    assert_near(to.adam.square_left, pow(0.99, 11), 1e-15);
    assert_memory_equal(read_back, written, sizeof written);
}

static void another_command_begins_again(void **state) {
    (void)state;
    const char *path = write_state();
    FitState other = state_over(read_back, "train b");
    Error error = {0};
    bool found = true;
    assert_ok(fit_state_read(&other, path, &found, &error), error);
    assert_false(found);
    assert_int_equal(unlink(path), 0);
    found = true;
    assert_ok(fit_state_read(&other, path, &found, &error), error);
    assert_false(found);
}

static void damaged_states_are_refused(void **state) {
    (void)state;
    const char *path = write_state();
    double numbers[4][1];
    FitState to = {.command = "train a", .adam = adam_over(numbers[0], numbers[1], numbers[2], 1, 0, 0.99)};
    Error error = {0};
    bool found;
    assert_refused(fit_state_read(&to, path, &found, &error), "net.npz.part: error: ");
    written[0][1] = NAN;
    path = write_state();
    written[0][1] = 2;
    FitState same = state_over(read_back, "train a");
    error = (Error){0};
    read_back[0][0] = -1;
    assert_refused(fit_state_read(&same, path, &found, &error), "weights: number 1 is NaN or infinite");
    assert_true(read_back[0][0] == -1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_state_is_read_back),
        cmocka_unit_test(another_command_begins_again),
        cmocka_unit_test(damaged_states_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
