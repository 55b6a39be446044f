/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What compare takes from a foreign manifest.json: names that are names, not commands to a terminal or a log, and a
   view that does not come after megabytes of other members. */
#include "testing.h"

#include "regression/view.h"

#define VIEW                                                                      \
    "\"view\": {\"panels\": [{\"rectangle\": [4, 4, 72, 56], \"runs\": [\"%s\"]," \
    " \"scale\": 3, \"left\": 36, \"top\": 55}], \"parts\": []}}"

static bool read_view(const char *text, FrameView *view, Error *error) {
    return view_read(view, write_bytes(temporary_path("manifest.json"), text, strlen(text)), error);
}

/* With this name of a run: JSON without its quotes. */
static bool read_named(const char *name, FrameView *view, Error *error) {
    char text[1024];
    snprintf(text, sizeof text,
             "{\"size\": [80, 64], \"look\": {\"compare\": \"split\", \"camera\": \"fit\", \"show\": []}, " VIEW, name);
    return read_view(text, view, error);
}

static bool read_after(int members, FrameView *view, Error *error) {
    char text[4096] = "{\"size\": [80, 64]";
    for (int i = 1; i < members; i++) text_add(text, sizeof text, ",\n\"member %d\": [{}]", i);
    text_add(text, sizeof text, ",\n" VIEW, "a.npz");
    return read_view(text, view, error);
}

TEST(names_of_runs_are_read) {
    FrameView view;
    assert_ok(read_named("sk\xc3\xa4l-engine.npz", &view, &error), error);
    assert_string_equal(view.panels[0].run, "sk\xc3\xa4l-engine.npz");
}

TEST(names_that_command_are_refused) {
    static const char *const names[] = {"a\\u001b[31m.npz", "a\\n::error::b.npz", "a\\u009b.npz",
                                        "a\x7f.npz",        "../a.npz",           ".a.npz"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        FrameView view;
        assert_refused(read_named(names[i], &view, &error), "'runs' with file names");
    }
}

TEST(members_before_the_view_are_limited) {
    FrameView view;
    assert_ok(read_after(31, &view, &error), error);
    assert_int_equal(view.width, 80);
    assert_refused(read_after(32, &view, &error), "manifest.json:32:18: error: 'view' expected");
}

RUN_TESTS(NULL, NULL)
