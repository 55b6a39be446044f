/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Titles break into lines that fit, in the header and on cards; captions stand for the names of methods. */
#include "testing.h"
#include "owned_drawings.h"

#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pictures/runs.h"

static const char LONG_TITLE[] =
    "How a neural network learns to topple a stack of ten boxes, and what it takes for a law in "
    "the loss to keep them apart";

static Trajectory *runs[2];

FIXTURE(make) {
    runs[0] = run_make("engine", 12);
    runs[1] = run_make("pair-net", 12);
}

FIXTURE(destroy) {
    for (int i = 0; i < 2; i++) trajectory_destroy(runs[i]);
}

TEST(lines_fit_and_hold_every_word) {
    const Font font = font_pick(FONT_SEMIBOLD, 20);
    for (int room = 150; room < 1500; room += 37)
        for (int first = 100; first <= room; first += 50) {
            const TextLines lines = text_lines(&font, LONG_TITLE, first, room);
            char joined[2 * sizeof LONG_TITLE] = "";
            for (int i = 0; i < lines.count && i < TEXT_LINES_MAX; i++) {
                const bool rest = i == TEXT_LINES_MAX - 1 && lines.count > TEXT_LINES_MAX;
                if (!rest) assert_true(font_width(&font, lines.lines[i]) <= (i == 0 ? first : room));
                if (joined[0] != '\0') strcat(joined, " ");
                strcat(joined, lines.lines[i]);
            }
            assert_string_equal(joined, LONG_TITLE);
        }
}

TEST(a_word_longer_than_a_line_is_broken) {
    const Font font = font_pick(FONT_SEMIBOLD, 20);
    const TextLines lines = text_lines(&font, "D\xC3\xA4mpfungsgleichungssysteme", 120, 120);
    assert_int_equal(lines.count, 3);
    for (int i = 0; i < lines.count; i++) assert_true(font_width(&font, lines.lines[i]) <= 120);
    const TextLines below = text_lines(&font, "engine", 20, 500); /* no room beside the numbers */
    assert_int_equal(below.count, 2);
    assert_string_equal(below.lines[0], "");
    assert_string_equal(below.lines[1], "engine");
}

static Picture plan(const char *title, const char *caption, int width, int height) {
    Error error = {0};
    Picture picture;
    RenderOptions options = {.width = width, .height = height, .title = title, .captions = {NULL, caption}};
    assert_ok(picture_plan(&picture, (const Trajectory *const *)runs, 2, width, height, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    return picture;
}

/* The run that the table compares with: what held best; the reference, whatever it did; without verdicts the first. */
TEST_WITH(an_end_card_compares_with_what_held, make, destroy) {
    static const struct {
        const char *methods[2], *verdicts[2];
        int base;
    } cases[] = {
        {{"engine", "pair-net"}, {"", ""}, 0},
        {{"pair-net", "engine"}, {"explodes at 0.3 s (body 7)", "stands"}, 1},
        {{"engine", "pair-net"}, {"stands", "explodes at 0.3 s (body 7)"}, 0},
        {{"engine", "interior"}, {"falls; 1 of 2 fell", "falls; 2 of 2 fell"}, 0},
        {{"pair-net", "engine"}, {"explodes at 0.3 s (body 7)", ""}, 0},
        {{"engine", "reference"}, {"stands", "falls"}, 1},
    };
    const RenderOptions options = {.width = 1280, .height = 720, .end_card = true, .describe = method_describe};
    run_position(runs[1], 5, FIRST_BOX)->y += 3;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        OWN(Picture) picture;
        for (int k = 0; k < 2; k++) {
            strcpy(runs[k]->method, cases[i].methods[k]);
            strcpy(runs[k]->verdict, cases[i].verdicts[k]);
        }
        assert_ok(picture_plan(&picture, (const Trajectory *const *)runs, 2, 1280, 720, &error), error);
        assert_ok(picture_apply_options(&picture, &options, &error), error);
        assert_int_equal(picture.card_base, cases[i].base);
        const CardRow *row = &picture.card_rows[1 - cases[i].base];
        assert_near(row->largest, 3, 1e-6);
        assert_int_equal(row->frame, 5);
        assert_near(row->last, 0, 1e-9);
    }
}

/* Each line moves the panels down. */
TEST_WITH(the_header_is_as_high_as_its_title, make, destroy) {
    const Picture one = plan(NULL, NULL, 960, 540), more = plan(LONG_TITLE, NULL, 960, 540);
    assert_int_equal(one.layout.header_lines, 1);
    assert_true(more.layout.header_lines > 1);
    assert_int_equal(more.layout.area.top - one.layout.area.top,
                     (more.layout.header_lines - 1) * more.layout.header_pitch);
    assert_int_equal(more.layout.area.bottom, one.layout.area.bottom);
}

TEST_WITH(too_long_a_title_is_an_error, make, destroy) {
    char text[2 * sizeof LONG_TITLE];
    snprintf(text, sizeof text, "%.126s %.126s", LONG_TITLE, LONG_TITLE);
    const RenderOptions title = {.width = 640, .height = 360, .title = text},
                        end = {.width = 640, .height = 360, .look.end = text};
    assert_refused(picture_check((const Trajectory *const *)runs, 2, &title, &error),
                   "--title: error: the text needs 6 lines");
    assert_refused(picture_check((const Trajectory *const *)runs, 2, &end, &error),
                   "--end: error: the text needs 6 lines");
}

static bool draws(const Drawing *drawing, const Font *font, const char *text) {
    OWN(Drawing) sample = {0};
    font_add(&sample, font, text, 0, 0, 0);
    bool found = false;
    for (size_t at = 0; !found && at + sample.glyph_count <= drawing->glyph_count; at++) {
        found = true;
        for (size_t i = 0; found && i < sample.glyph_count; i++)
            found = drawing->glyphs[at + i].bitmap == sample.glyphs[i].bitmap;
    }
    return found;
}

/* In the panel and on both cards; the other run keeps its name. */
TEST_WITH(a_caption_stands_for_the_method, make, destroy) {
    const Picture picture = plan(NULL, "our own", 960, 540);
    const MomentKind kinds[] = {MOMENT_STORED, MOMENT_TITLE, MOMENT_END};
    for (int i = 0; i < 3; i++) {
        OWN(Drawing) drawing = {0};
        const Font font = kinds[i] == MOMENT_STORED ? picture.layout.title : font_pick(FONT_SEMIBOLD, 0.036 * 540);
        picture_draw(&picture, (Moment){.kind = kinds[i], .frame = 5, .slow = 1}, &drawing);
        assert_true(draws(&drawing, &font, "our own"));
        assert_false(draws(&drawing, &font, "pair-net"));
        assert_true(draws(&drawing, &font, "engine"));
    }
    const Picture kept = plan(NULL, "", 960, 540);
    OWN(Drawing) drawing = {0};
    picture_draw(&kept, moment_stored(5), &drawing);
    assert_true(draws(&drawing, &kept.layout.title, "pair-net"));
}

RUN_TESTS(NULL, NULL)
