/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A manifest.json of megabytes of members before its view costs no more than those that may precede it. */
#include "testing.h"

#include "base/file.h"
#include "regression/naming.h"

static bool read_after(int members, FrameView *view, Error *error) {
    char text[4096];
    size_t used = (size_t)snprintf(text, sizeof text, "{\"size\": [80, 64]");
    for (int i = 1; i < members; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, ",\n\"member %d\": [{}]", i);
    used += (size_t)snprintf(text + used, sizeof text - used,
                             ",\n\"view\": {\"panels\": [{\"rectangle\": [4, 4, 72, 56], \"runs\": [\"a.npz\"],"
                             " \"scale\": 3, \"left\": 36, \"top\": 55}], \"parts\": []}}");
    const char *path = temporary_path("manifest.json");
    assert_true(used < sizeof text && file_write_soon(path, text, used, error));
    return view_read(view, path, error);
}

TEST(members_before_the_view_are_limited) {
    FrameView view;
    Error error = {0};
    assert_ok(read_after(31, &view, &error), error);
    assert_int_equal(view.width, 80);
    assert_refused(read_after(32, &view, &error), "manifest.json:32:18: error: 'view' expected");
}

int main(void) { return run_all_tests(NULL, NULL); }
