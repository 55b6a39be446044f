/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Only what a change touches is drawn again. (Frames that follow each other equal whole ones, whatever the
   look: test_look_frames.c. So do bytes of files whose rows are kept: tests/pixels/test_encoder.c.) */
#include "made.h"
#include "owned_drawings.h"

#include "mesa.h"
#include "pixels/gl.h"
#include "pictures/render_internal.h"
#include "runs.h"

enum { WIDTH = 320, HEIGHT = 180, FRAMES = 6 };

/* A single frame drawn in between invalidates the canvas; a frame that does not exist does not. */
TEST(other_calls_may_come_between) {
    OWN(Trajectory) *run = run_make("engine", FRAMES);
    const Trajectory *const panels[] = {run};
    const RenderOptions options = {.width = WIDTH, .height = HEIGHT};
    const bool *changed;
    for (int frame = 0; frame < FRAMES; frame++) run_position(run, frame, FIRST_BOX)->y += 1.6F * (float)frame;
    Renderer *next = renderer_create(panels, 1, &options, &error),
             *whole = renderer_create(panels, 1, &options, &error);
    OWN(Image) *a = image_sized(WIDTH, HEIGHT), *b = image_sized(WIDTH, HEIGHT);
    for (int frame = 0; frame < FRAMES; frame++) {
        assert_ok(renderer_draw_next(next, moment_stored(frame), a, &changed, &error), error);
        assert_ok(renderer_draw(whole, frame, b, &error), error);
        assert_true(image_hash(a) == image_hash(b));
        if (frame % 2 == 0)
            assert_ok(renderer_draw(next, FRAMES - 1 - frame, b, &error), error);
        else
            assert_false(renderer_draw_next(next, moment_stored(FRAMES), a, &changed, &(Error){0}));
    }
    renderer_destroy(next);
    renderer_destroy(whole);
}

/* In pixels, of all parts; none of them may be outside the picture, or cover a pixel again. */
static int painted(const Damage *damage) {
    int pixels = 0;
    bool seen[100][150] = {{false}};
    for (Rect part = {0}; damage_next(damage, &part);)
        for (int y = part.top; y < part.bottom; y++)
            for (int x = part.left; x < part.right; x++, pixels++) {
                assert_true(x < 150 && y < 100 && !seen[y][x]);
                seen[y][x] = true;
            }
    return pixels;
}

static bool is_painted(const Damage *damage, int x, int y) {
    for (Rect part = {0}; damage_next(damage, &part);)
        if (x >= part.left && x < part.right && y >= part.top && y < part.bottom) return true;
    return false;
}

/* Pictures of 150 x 100 pixels have two rows of three tiles; those at the right and at the bottom are cut off. */
TEST(only_what_is_touched_is_damaged) {
    OWN(Drawing) before = {0}, after = {0};
    Damage damage;
    const Rect clip = {0, 0, 150, 100};
    Shape box = {.x = 50, .y = 20, .half_width = 4, .half_height = 4, .cosine = 1, .fill = 1};
    assert_ok(damage_init(&damage, 150, 100, &error), error);
    drawing_add_shape(&before, &box, &clip);
    drawing_add_shape(&after, &box, &clip);
    assert_true(damage_find(&damage, &before, &after));
    for (int y = 0; y < 100; y++) assert_false(damage.rows[y]);
    assert_int_equal(painted(&damage), 0);
    drawing_clear(&after);
    box.y = 56;
    drawing_add_shape(&after, &box, &clip);
    drawing_add_glyph(&after, &(GlyphInstance){{143, 90, 5, 7}, 0, 5, 0});
    assert_true(damage_find(&damage, &before, &after));
    for (int y = 0; y < 100; y++) {
        const bool old = y >= 15 && y < 25, new = y >= 51 && y < 61, glyph = y >= 90 && y < 97;
        assert_int_equal(damage.rows[y], old || new || glyph);
        for (int x = 45; old && x < 55; x++) assert_true(is_painted(&damage, x, y));
        for (int x = 45; new &&x < 55; x++) assert_true(is_painted(&damage, x, y));
        for (int x = 143; glyph && x < 148; x++) assert_true(is_painted(&damage, x, y));
    }
    assert_int_equal(painted(&damage), 64 * 64 + 22 * 36);
    drawing_add_rect(&after, (Rect){0, 0, 1, 1}, 0);
    assert_false(damage_find(&damage, &before, &after));
    for (int y = 0; y < 100; y++) assert_true(damage.rows[y]);
    assert_int_equal(painted(&damage), 150 * 100);
    damage_free(&damage);
}

RUN_TESTS(NULL, NULL)
