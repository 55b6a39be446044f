/* SPDX-License-Identifier: GPL-3.0-or-later */
/* compare prints names of a foreign manifest.json: they must be names, not commands to a terminal or a log. */
#include "testing.h"

#include "base/file.h"
#include "regression/naming.h"

/* Reads a manifest with this text, JSON without its quotes, as the name of a run. */
static bool read_named(const char *name, FrameView *view, Error *error) {
    char text[1024];
    const char *path = temporary_path("manifest.json");
    const int length =
        snprintf(text, sizeof text,
                 "{\"size\": [80, 64], \"look\": {\"compare\": \"split\", \"camera\": \"fit\", \"show\": []},"
                 " \"view\": {\"panels\": [{\"rectangle\": [4, 4, 72, 56], \"runs\": [\"%s\"],"
                 " \"scale\": 3, \"left\": 36, \"top\": 55}], \"parts\": []}}",
                 name);
    assert_true(length < (int)sizeof text && file_write_soon(path, text, (size_t)length, error));
    return view_read(view, path, error);
}

TEST(names_of_runs_are_read) {
    FrameView view;
    Error error = {0};
    assert_ok(read_named("sk\xc3\xa4l-engine.npz", &view, &error), error);
    assert_string_equal(view.panels[0].run, "sk\xc3\xa4l-engine.npz");
}

TEST(names_that_command_are_refused) {
    static const char *const names[] = {"a\\u001b[31m.npz", "a\\n::error::b.npz", "a\\u009b.npz",
                                        "a\x7f.npz",        "../a.npz",           ".a.npz"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        FrameView view;
        Error error = {0};
        assert_refused(read_named(names[i], &view, &error), "'runs' with file names");
    }
}

int main(void) { return run_all_tests(NULL, NULL); }
