/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Labels stand in their boxes however these are turned, scale with them, are left out where they could not be read, and
   stand out from every colour of a box. */
#include "testing.h"
#include "owned_drawings.h"

#include "pictures/pictures_internal.h"
#include "pictures/look_runs.h"

static Picture picture_of(double metres, LookLabels labels) {
    static const float masses[RUN_BODIES] = {0, 1234, 0.25F, 150};
    Picture picture;
    Error error = {0};
    const RenderOptions options = {
        .width = 1280, .height = 720, .look = {.labels = labels, .view = {0, 1.5F, metres, metres / 2}}};
    memcpy(runs[0]->mass, masses, sizeof masses);
    if (runs[0]->name == NULL) assert_ok(trajectory_make_names(runs[0], &error), error);
    strcpy(runs[0]->name[FIRST_BOX].text, "Gewölbe");
    strcpy(runs[0]->name[BOMB_BODY].text, "WW");
    assert_ok(picture_plan(&picture, panels, 1, 1280, 720, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    return picture;
}

enum { MOMENT = 18 }; /* all bodies are near each other */

/* What is drawn of a body. */
static Drawing draw(const Picture *picture, int body) {
    Drawing drawing = {0};
    body_draw(picture, 0, 0, moment_stored(MOMENT), body, &drawing);
    return drawing;
}

/* The largest distance of a glyph's corner from the middle of the body / half the body's shorter side. */
static double reach(const Picture *picture, int body, const Drawing *drawing) {
    const Vec2 at = *run_position(runs[0], MOMENT, body), size = runs[0]->size[body];
    const Point middle = panel_point(picture, 0, (double)at.x, (double)at.y);
    double most = 0;
    for (size_t i = 0; i < drawing->glyph_count; i++)
        for (int corner = 0; corner < 4; corner++) {
            const int32_t *box = drawing->glyphs[i].box;
            const double x = box[0] + (corner & 1) * box[2] - middle.x, y = box[1] + (corner >> 1) * box[3] - middle.y;
            most = fmax(most, sqrt(x * x + y * y));
        }
    return most / (picture->camera.scale * fmin((double)size.x, (double)size.y) / 2);
}

TEST_WITH(a_label_is_in_the_circle_that_turning_boxes_share, make, destroy) {
    for (double metres = 8; metres < 60; metres *= 1.3)
        for (LookLabels labels = LOOK_NUMBERS; labels <= LOOK_NAMES; labels++) {
            const Picture picture = picture_of(metres, labels);
            for (int body = FIRST_BOX; body < RUN_BODIES; body++) {
                OWN(Drawing) drawing = draw(&picture, body);
                assert_true(reach(&picture, body, &drawing) < 1);
            }
        }
}

/* Height of the digit of a body's number; 0: none. */
static int digit_height(double metres, int body) {
    const Picture picture = picture_of(metres, LOOK_NUMBERS);
    OWN(Drawing) drawing = draw(&picture, body);
    const int height = drawing.glyph_count > 0 ? drawing.glyphs[0].box[3] : 0;
    return height;
}

TEST_WITH(labels_scale_with_their_boxes_and_small_ones_are_left_out, make, destroy) {
    const int far = digit_height(32, FIRST_BOX), near = digit_height(16, FIRST_BOX);
    assert_true(far > 0 && near > far * 3 / 2 && near < far * 5 / 2); /* letters have steps of up to 1/6 */
    assert_true(digit_height(32, BOMB_BODY) > far);
    assert_int_equal(digit_height(200, FIRST_BOX), 0);
}

TEST_WITH(masses_have_three_digits, make, destroy) {
    static const size_t glyphs[RUN_BODIES] = {0, strlen("1230"), strlen("0.25"), strlen("150")};
    const Picture picture = picture_of(8, LOOK_MASSES);
    for (int body = 0; body < RUN_BODIES; body++) {
        OWN(Drawing) drawing = draw(&picture, body);
        assert_int_equal(drawing.glyph_count, glyphs[body]);
    }
}

TEST_WITH(a_name_is_its_letters_and_a_body_without_has_no_label, make, destroy) {
    static const size_t glyphs[RUN_BODIES] = {0, strlen("Gewoelbe") - 1, 0, strlen("WW")};
    const Picture picture = picture_of(8, LOOK_NAMES);
    for (int body = 0; body < RUN_BODIES; body++) {
        OWN(Drawing) drawing = draw(&picture, body);
        assert_int_equal(drawing.glyph_count, glyphs[body]);
    }
}

/* The target is the sign of a bomb whose label has no room. */
TEST_WITH(a_bomb_has_a_label_or_a_target, make, destroy) {
    const Picture near = picture_of(10, LOOK_MASSES), far = picture_of(200, LOOK_MASSES);
    OWN(Drawing) labelled = draw(&near, BOMB_BODY), target = draw(&far, BOMB_BODY);
    assert_true(labelled.glyph_count > 0 && labelled.shape_count == 1);
    assert_true(target.glyph_count == 0 && target.shape_count > 1);
}

/* Outside of the panel a label would be drawn over what is beside it: glyphs have no clip. */
TEST_WITH(a_label_does_not_leave_the_panel, make, destroy) {
    const Picture picture = picture_of(10, LOOK_NUMBERS);
    const Rect *rect = &picture.layout.panels[0];
    bool drawn = false, left_out = false;
    for (float x = -12; x < 12; x += 0.07F) {
        *run_position(runs[0], MOMENT, FIRST_BOX) = vec2(x, 1.5F);
        OWN(Drawing) drawing = draw(&picture, FIRST_BOX);
        for (size_t i = 0; i < drawing.glyph_count; i++) {
            const int32_t *box = drawing.glyphs[i].box;
            assert_true(box[0] >= rect->left && box[0] + box[2] <= rect->right);
        }
        drawn |= drawing.glyph_count > 0, left_out |= drawing.glyph_count == 0;
    }
    assert_true(drawn && left_out);
}

/* Relative luminance: WCAG 2.1. */
static double luminance(uint32_t color) {
    double parts[3];
    for (int i = 0; i < 3; i++) {
        const double part = (color >> (16 - 8 * i) & 255) / 255.0;
        parts[i] = part <= 0.03928 ? part / 12.92 : pow((part + 0.055) / 1.055, 2.4);
    }
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2];
}

static double contrast(uint32_t a, uint32_t b) {
    const double p = luminance(a), q = luminance(b);
    return (fmax(p, q) + 0.05) / (fmin(p, q) + 0.05);
}

/* 3: what WCAG asks of large bold text. */
static void expect_contrast(LookTheme theme, const RunColours *colours) {
    for (int body = FIRST_BOX; body < RUN_BODIES; body++) {
        Picture picture = picture_of(10, LOOK_NUMBERS);
        picture.theme = theme_get(theme);
        picture.colours[0] = *colours;
        OWN(Drawing) drawing = draw(&picture, body);
        const uint32_t fill = drawing.shapes[0].paint[0], color = drawing.glyphs[0].color;
        assert_true(contrast(color, fill) >= 3);
        assert_true(contrast(color, fill) >= 0.95 * contrast(color == INK ? PANEL : INK, fill));
    }
}

TEST_WITH(labels_stand_out_from_every_colour_of_a_box, make, destroy) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        RunColours family[COLOUR_SHADES];
        if (!colours_have(kind->description->name)) continue; /* a program */
        colours_family(kind->description->name, NULL, family);
        for (int shade = 0; shade < COLOUR_SHADES; shade++)
            for (LookTheme theme = LOOK_LIGHT; theme <= LOOK_DARK; theme++) expect_contrast(theme, &family[shade]);
    }
}

TEST_WITH(unknown_masses_are_refused, make, destroy) {
    Picture picture;
    const RenderOptions options = {.width = 1280, .height = 720, .look = {.labels = LOOK_MASSES}};
    assert_ok(picture_plan(&picture, panels, 2, 1280, 720, &error), error);
    assert_false(picture_apply_options(&picture, &options, &error));
    assert_error(error, ERROR_INPUT, "masses cannot be shown: run 1 (engine) does not have them");
}

RUN_TESTS(NULL, NULL)
