/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Only the rows that a change touches are drawn again. (Frames that follow each other equal whole ones, whatever the
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

TEST(only_touched_rows_change) {
    OWN(Drawing) before = {0}, after = {0};
    bool changed[100];
    const Rect clip = {0, 0, 100, 100};
    Shape box = {.x = 50, .y = 20, .half_width = 4, .half_height = 4, .cosine = 1, .fill = 1};
    drawing_add_shape(&before, &box, &clip);
    drawing_add_shape(&after, &box, &clip);
    assert_true(damage_find(&before, &after, 100, changed));
    for (int y = 0; y < 100; y++) assert_false(changed[y]);
    drawing_clear(&after);
    box.y = 60;
    drawing_add_shape(&after, &box, &clip);
    drawing_add_glyph(&after, &(GlyphInstance){{3, 90, 5, 7}, 0, 0});
    assert_true(damage_find(&before, &after, 100, changed));
    for (int y = 0; y < 100; y++) {
        bool old = y >= 15 && y < 25, new = y >= 55 && y < 65, glyph = y >= 90 && y < 97;
        assert_int_equal(changed[y], old || new || glyph);
    }
    drawing_add_rect(&after, (Rect){0, 0, 1, 1}, 0);
    assert_false(damage_find(&before, &after, 100, changed));
    for (int y = 0; y < 100; y++) assert_true(changed[y]);
}

RUN_TESTS(NULL, NULL)
