/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method's name stands in every picture, whatever else has to go. */
#include "testing.h"

#include "methods/methods.h"
#include "pictures/internal.h"
#include "pictures/runs.h"

static const char *const methods[RENDER_PANELS_MAX] = {
    "engine", "momentum:k=20", "pair-net:network=nets/small.npz", "interior", "longest-of-names:k=20", "contact-net"};
static const MethodDescription description = {.name = "any", .caption = "some words on what the method does"};
static const MethodDescription *describe(const char *method) { return (void)method, &description; }

static Trajectory *runs[RENDER_PANELS_MAX];
static const Trajectory *panels[RENDER_PANELS_MAX];

/* Bodies have left the picture in all runs but the first, and one run has ended. */
FIXTURE(make) {
    for (int i = 0; i < RENDER_PANELS_MAX; i++) {
        panels[i] = runs[i] = run_make(methods[i], i == 3 ? 9 : 12);
        for (int frame = 6; frame < runs[i]->frames && i > 0; frame++)
            for (int body = FIRST_BOX; body <= BOMB_BODY; body++) run_position(runs[i], frame, body)->x += 700;
    }
}

FIXTURE(destroy) {
    for (int i = 0; i < RENDER_PANELS_MAX; i++) trajectory_destroy(runs[i]);
}

/* Whether these characters of a font stand beside each other in the drawing. */
static bool has_text(const Drawing *drawing, const Font *font, const char *text) {
    Drawing sample = {0};
    bool found = false;
    font_add(&sample, font, text, 0, 0, 0);
    const size_t count = sample.glyph_count;
    for (size_t at = 0; at + count <= drawing->glyph_count && !found && count > 0; at++) {
        found = true;
        for (size_t i = 0; i < count && found; i++) found = drawing->glyphs[at + i].bitmap == sample.glyphs[i].bitmap;
    }
    drawing_free(&sample);
    return found;
}

static bool has_name(const Drawing *drawing, const Layout *layout, const char *name) {
    return has_text(drawing, &layout->title, name) || has_text(drawing, &layout->axis, name);
}

/* The number of runs whose name, whole or without its settings, is in the picture. */
static int count_names(int count, int width, int height, const RenderLook *look, bool whole) {
    Error error = {0};
    Picture picture;
    Drawing drawing = {0};
    const RenderOptions options = {.width = width, .height = height, .look = *look, .describe = describe};
    assert_ok(picture_plan(&picture, panels, count, width, height, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    picture_draw(&picture, moment_stored(11), &drawing);
    int found = 0;
    for (int run = 0; run < count; run++) {
        char name[CAPTION_TEXT_SIZE];
        method_name(name, sizeof name, methods[run]);
        if (!whole) name[method_name_head(name)] = '\0';
        const bool there = has_name(&drawing, &picture.layout, name);
        if (!there) print_error("%d runs, %d x %d: no %s\n", count, width, height, name);
        found += there;
    }
    drawing_free(&drawing);
    picture_free(&picture);
    return found;
}

TEST_WITH(every_name_is_in_every_picture, make, destroy) {
    static const int sizes[][2] = {{480, 320}, {640, 360}, {960, 540}, {1280, 720}, {1920, 1080}, {540, 960}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int count = 1; count <= RENDER_PANELS_MAX; count++)
            assert_int_equal(count_names(count, sizes[i][0], sizes[i][1], &(RenderLook){0}, false), count);
}

/* Short ones next to long ones give their room to these. */
TEST_WITH(names_are_whole_where_there_is_room, make, destroy) {
    for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
        assert_int_equal(count_names(count, 1280, 720, &(RenderLook){0}, true), count);
        if (count > 1)
            assert_int_equal(count_names(count, 960, 540, &(RenderLook){.compare = LOOK_OVERLAY}, true), count);
    }
}

TEST(room_is_shared_fairly) {
    const int widths[] = {10, 50, 20, 90};
    assert_true(caption_fair_width(widths, 4, 170) >= 90);
    assert_true(caption_fair_width(widths, 4, 1000) >= 90);
    assert_int_equal(caption_fair_width(widths, 4, 120), 45); /* 10 + 45 + 20 + 45 */
    assert_int_equal(caption_fair_width(widths, 4, 121), 45);
    assert_int_equal(caption_fair_width(widths, 4, 4), 1);
    assert_int_equal(caption_fair_width(widths, 4, -5), -5);
}

RUN_TESTS(NULL, NULL)
