/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A folder that cannot be read to its end is a failure of the system, never "equal". */
#include "folder_faults.h"
#include "made.h"

#include "base/file.h"
#include "regression/regression.h"

static char expected[256], actual[256];

static void make_picture(const char *folder, const char *name) {
    Error error = {0};
    char path[512];
    Image *image = image_sized(4, 4);
    snprintf(path, sizeof path, "%s/sub", folder);
    assert_ok(file_make_directory(path, &error), error);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_ok(image_write_png(image, path, NULL, 0, &error), error);
    image_destroy(image);
}

FIXTURE(make) {
    static const char *const names[] = {"1.png", "2.png", "sub/3.png"};
    snprintf(expected, sizeof expected, "%s", temporary_path("expected"));
    snprintf(actual, sizeof actual, "%s", temporary_path("actual"));
    for (int i = 0; i < 3; i++) make_picture(expected, names[i]), make_picture(actual, names[i]);
}

/* Each call fails in turn, until none is left. Three lists are read: the pictures of both folders, and trajectories. */
static void assert_never_equal(int *countdown, int calls) {
    int call = 0;
    for (bool failed = true; failed;) {
        Error error = {0};
        Regression regression;
        const RegressionOptions options = {.max_pixels = IMAGE_MAX_PIXELS};
        *countdown = ++call;
        failed = !regression_run(&regression, expected, actual, &options, NULL, &error);
        *countdown = 0;
        if (failed) {
            assert_error(error, ERROR_SYSTEM, "cannot be read: ");
        } else {
            assert_true(regression_passed(&regression) && regression.count == 3);
            regression_free(&regression);
        }
    }
    assert_true(call > calls);
}

TEST(folders_that_cannot_be_opened) { assert_never_equal(&failing_opendir, 3 * 2); }

TEST(folders_that_end_early) {
    assert_never_equal(&failing_readdir, 3 * (3 + 1 + 2 * 3)); /* entries, with . and .., and the end of each */
}

TEST(entries_that_cannot_be_inspected) { assert_never_equal(&failing_stat, 3 * 4); }

RUN_TESTS(make, NULL)
