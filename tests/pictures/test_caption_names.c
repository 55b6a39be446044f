/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method's name stands in every picture, whatever else has to go, and no caption is cut. */
#include "testing.h"
#include "owned_drawings.h"

#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/pictures_internal.h"
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
    OWN(Drawing) sample = {0};
    bool found = false;
    font_add(&sample, font, text, 0, 0, 0);
    const size_t count = sample.glyph_count;
    for (size_t at = 0; at + count <= drawing->glyph_count && !found && count > 0; at++) {
        found = true;
        for (size_t i = 0; i < count && found; i++) found = drawing->glyphs[at + i].bitmap == sample.glyphs[i].bitmap;
    }
    return found;
}

static bool has_name(const Drawing *drawing, const Layout *layout, const char *name) {
    return has_text(drawing, &layout->title, name) || has_text(drawing, &layout->axis, name);
}

/* The number of runs whose name, whole or without its settings, is in the picture. */
static int count_names(int count, int width, int height, const RenderLook *look, bool whole) {
    Error error = {0};
    OWN(Picture) picture;
    OWN(Drawing) drawing = {0};
    const RenderOptions options = {.width = width, .height = height, .look = *look, .describe = describe};
    assert_ok(picture_plan(&picture, panels, count, width, height, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    picture_draw(&picture, moment_stored(11), &drawing);
    int found = 0;
    for (int run = 0; run < count; run++) {
        char name[CAPTION_TEXT_SIZE];
        method_name_among(name, sizeof name, methods, count, run);
        if (!whole) name[method_name_head(name)] = '\0';
        const bool there = has_name(&drawing, &picture.layout, name);
        if (!there) print_error("%d runs, %d x %d: no %s\n", count, width, height, name);
        found += there;
    }
    return found;
}

TEST_WITH(every_name_is_in_every_picture, make, destroy) {
    static const int sizes[][2] = {{480, 320}, {640, 360}, {960, 540}, {1280, 720}, {1920, 1080}, {540, 960}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int count = 1; count <= RENDER_PANELS_MAX; count++)
            assert_int_equal(count_names(count, sizes[i][0], sizes[i][1], &(RenderLook){0}, false), count);
}

TEST_WITH(names_are_whole_where_there_is_room, make, destroy) {
    for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
        assert_int_equal(count_names(count, 1280, 720, &(RenderLook){0}, true), count);
        if (count > 1)
            assert_int_equal(count_names(count, 960, 540, &(RenderLook){.compare = LOOK_OVERLAY}, true), count);
    }
}

/* Whether all words stand in the drawing, in one of the fonts of captions. */
static bool has_words(const Drawing *drawing, const Layout *layout, const char *text) {
    char words[CAPTION_TEXT_SIZE], *rest = NULL;
    snprintf(words, sizeof words, "%s", text);
    for (char *word = strtok_r(words, " ", &rest); word != NULL; word = strtok_r(NULL, " ", &rest))
        if (!has_text(drawing, &layout->method, word) && !has_text(drawing, &layout->axis, word)) return false;
    return true;
}

/* Draws the captions of `count` methods from this one on; the number of descriptions that are left out. */
static int check_captions(int first, int count, const int size[2], LookCompare compare) {
    Error error = {0};
    OWN(Picture) picture;
    OWN(Drawing) drawing = {0};
    int kinds = 0, left_out = 0;
    const RenderOptions options = {
        .width = size[0], .height = size[1], .look.compare = compare, .describe = method_describe};
    while (method_kinds[kinds].description != NULL) kinds++;
    for (int i = 0; i < count; i++) strcpy(runs[i]->method, method_kinds[(first + i) % kinds].description->name);
    assert_ok(picture_plan(&picture, panels, count, size[0], size[1], &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    const Layout *layout = &picture.layout;
    for (int panel = 0; panel < picture.panel_count; panel++)
        caption_panel(&picture, panel, moment_stored(8), &drawing);
    for (int i = compare == LOOK_DIFFERENCE; i < count; i++) {
        const MethodDescription *method = picture.methods[i];
        if (!has_name(&drawing, layout, method->name)) fail_msg("%d x %d: no %s", size[0], size[1], method->name);
        left_out += method->caption != NULL && !has_words(&drawing, layout, method->caption);
    }
    if (has_text(&drawing, &layout->title, "\xE2\x80\xA6") || has_text(&drawing, &layout->method, "\xE2\x80\xA6") ||
        has_text(&drawing, &layout->axis, "\xE2\x80\xA6"))
        fail_msg("%d x %d, runs %s to %s: a caption is cut", size[0], size[1], runs[0]->method,
                 runs[count - 1]->method);
    Part parts[PARTS_MAX];
    const int part_count = parts_find(&picture, parts);
    for (size_t i = 0; i < drawing.glyph_count; i++) {
        const int32_t *box = drawing.glyphs[i].box;
        bool inside = false;
        for (int k = 0; k < part_count; k++)
            inside |= parts[k].kind == PART_CAPTION && box[0] >= parts[k].rect.left && box[1] >= parts[k].rect.top &&
                      box[0] + box[2] <= parts[k].rect.right + 1 && box[1] + box[3] <= parts[k].rect.bottom;
        if (!inside)
            fail_msg("%d x %d, runs %s to %s (LookCompare %d): letter %zu is in no caption: x %d to %d, y %d to %d",
                     size[0], size[1], runs[0]->method, runs[count - 1]->method, (int)compare, i, box[0],
                     box[0] + box[2], box[1], box[1] + box[3]);
    }
    return left_out;
}

/* In the smallest pictures that have text, descriptions may go. */
TEST_WITH(no_caption_of_a_method_is_cut, make, destroy) {
    static const int sizes[][2] = {{1280, 720}, {1080, 1080}, {720, 1280}, {640, 360}, {480, 320}};
    for (int i = 0; i < RENDER_PANELS_MAX; i++) /* all bodies are in view: only captions are drawn */
        for (int frame = 6; frame < runs[i]->frames && i > 0; frame++)
            for (int body = FIRST_BOX; body <= BOMB_BODY; body++) run_position(runs[i], frame, body)->x -= 700;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int count = 1; count <= RENDER_PANELS_MAX; count++)
            for (int first = 0; method_kinds[first].description != NULL; first++)
                for (int compare = LOOK_SPLIT; compare <= (count > 1 ? LOOK_DIFFERENCE : LOOK_SPLIT); compare++) {
                    const int left_out = check_captions(first, count, sizes[i], (LookCompare)compare);
                    if (left_out > 0 && sizes[i][0] > 640)
                        fail_msg("%d x %d, %d runs: %d descriptions left out", sizes[i][0], sizes[i][1], count,
                                 left_out);
                }
}

TEST_WITH(a_caption_of_the_options_is_whole_or_refused, make, destroy) {
    static const char words[] =
        "Sequential impulses with a warm start, ten sweeps per step, and the friction of Coulomb";
    static const char longer[] =
        "Sequential impulses with a warm start, ten sweeps per step, and the friction of Coulomb, as in Box2D-Lite, "
        "but "
        "with all contacts of a pair solved at once and with the impulses of the step before it, where there are any";
    RenderOptions options = {.width = 1280, .height = 720, .captions = {NULL, words}};
    Picture picture;
    Drawing drawing = {0};
    assert_ok(picture_plan(&picture, panels, 6, 1280, 720, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    caption_panel(&picture, 1, moment_stored(0), &drawing);
    assert_true(has_words(&drawing, &picture.layout, words));
    drawing_free(&drawing);
    options.width = 480, options.height = 320, options.captions[1] = longer;
    assert_refused(picture_check(panels, 6, &options, &error), "--caption", "lines in panels of this size");
}

/* What happened, without figures behind it: counts of boxes stay. */
TEST_WITH(the_end_card_has_the_verdicts, make, destroy) {
    static const char *const verdicts[][2] = {
        {"collapses; 8 of 10 fell; 2 moved by up to 2 m; rests", "collapses; 8 of 10 fell; 2 moved by up to 2 m"},
        {"settles at 3 s; slides by 5 m", "settles at 3 s"}};
    const RenderOptions options = {.width = 1280, .height = 720, .end_card = true};
    Picture picture;
    OWN(Drawing) drawing = {0};
    for (int i = 0; i < 2; i++) trajectory_judge(runs[i], verdicts[i][0], 3, -1);
    assert_ok(picture_plan(&picture, panels, 2, 1280, 720, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    card_draw(&picture, (Moment){MOMENT_END, 11, 0, 1, 1}, &drawing);
    for (int i = 0; i < 2; i++) {
        assert_true(has_text(&drawing, &picture.layout.axis, verdicts[i][1]));
        assert_false(has_text(&drawing, &picture.layout.axis, verdicts[i][0]));
    }
    picture_free(&picture);
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
