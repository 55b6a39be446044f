/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Long and high scenes fill their panels, in pictures of all shapes, and the grid is the one in which they are
   largest. */
#include "testing.h"
#include "owned_drawings.h"

#include "pictures/pictures_internal.h"
#include "pictures/runs.h"

#include <limits.h>

static const char *const methods[RENDER_PANELS_MAX] = {"engine",   "momentum:k=20", "pair-net",
                                                       "interior", "reference",     "soft-step"};
static const int sizes[][2] = {{1920, 1080}, {1080, 1920}, {1080, 1080}, {640, 360}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static Trajectory *runs[RENDER_PANELS_MAX];

/* A box of this size on a ground of 100 x 20 m, and nothing else. */
static void make(float width, float height) {
    for (int i = 0; i < RENDER_PANELS_MAX; i++) {
        Trajectory *run = runs[i] = run_make(methods[i], 12);
        run->bomb = -1;
        for (int body = FIRST_BOX; body <= BOMB_BODY; body++) {
            run->size[body] = vec2(width, height);
            for (int frame = 0; frame < run->frames; frame++) {
                *run_position(run, frame, body) = vec2(0, height / 2);
                *run_angle(run, frame, body) = 0;
            }
        }
    }
}

static void destroy(void) {
    for (int i = 0; i < RENDER_PANELS_MAX; i++) trajectory_destroy(runs[i]);
}

static Picture plan(int count, const int size[2], const RenderLook *look) {
    Picture picture;
    Error error = {0};
    const RenderOptions options = {.width = size[0], .height = size[1], .look = *look};
    assert_ok(picture_plan(&picture, (const Trajectory *const *)runs, count, size[0], size[1], &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    return picture;
}

static double width_of(const Rect *rect) { return rect->right - rect->left; }
static double height_of(const Rect *rect) { return rect->bottom - rect->top; }

/* The scale in a grid of so many columns, before it is rounded. */
static double scale_in(const Picture *picture, int columns, Vec2 needs) {
    const LayoutRows rows = {picture->layout.header_lines, picture->layout.caption_lines, 0, false};
    const Layout layout =
        layout_make(picture->layout.width, picture->layout.height, picture->panel_count, columns, rows);
    return fmin(width_of(&layout.panels[0]) / (double)needs.x, height_of(&layout.panels[0]) / (double)needs.y);
}

/* No grid in which names are whole shows the scene more than 5% larger. */
TEST(the_grid_is_the_one_with_the_largest_scene) {
    static const float scenes[][2] = {{3, 60}, {60, 3}, {10, 10}, {5, 20}, {20, 5}};
    for (size_t scene = 0; scene < sizeof scenes / sizeof scenes[0]; scene++) {
        make(scenes[scene][0], scenes[scene][1]);
        const CameraFrame frame = camera_frame((const Trajectory *const *)runs, 1);
        const Vec2 needs = camera_needs(&frame);
        for (int i = 0; i < SIZES; i++)
            for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
                const Picture picture = plan(count, sizes[i], &(RenderLook){0});
                const double chosen = scale_in(&picture, picture.layout.columns, needs);
                for (int columns = 1; columns <= count; columns++) {
                    const double panel =
                        (double)(picture.layout.right - picture.layout.area.left) / columns - picture.layout.gap;
                    if (panel < caption_least_width(&picture, true)) continue;
                    if (scale_in(&picture, columns, needs) > 1.05 * chosen)
                        fail_msg("%g x %g m, %d x %d, %d panels: %d columns instead of %d", (double)scenes[scene][0],
                                 (double)scenes[scene][1], sizes[i][0], sizes[i][1], count, picture.layout.columns,
                                 columns);
                }
            }
        destroy();
    }
}

/* A last row that is not full is in the middle. */
TEST(the_last_row_is_in_the_middle) {
    static const float scenes[][2] = {{3, 60}, {60, 3}, {10, 10}, {5, 20}, {20, 5}};
    for (size_t scene = 0; scene < sizeof scenes / sizeof scenes[0]; scene++) {
        make(scenes[scene][0], scenes[scene][1]);
        for (int i = 0; i < SIZES; i++)
            for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
                const Picture picture = plan(count, sizes[i], &(RenderLook){0});
                const Layout *layout = &picture.layout;
                const int empty = layout->rows * layout->columns - count, last = count - layout->columns + empty;
                const int left = layout->panels[last].left - layout->panels[0].left,
                          right = layout->panels[layout->columns - 1].right - layout->panels[count - 1].right;
                assert_true(abs(left - right) <= 1);
            }
        destroy();
    }
}

/* In a row, or in a column, the scene has 78% of the length of the panel but for the rounding of the scale. */
TEST(long_scenes_fill_their_panels) {
    for (int wide = 0; wide < 2; wide++) {
        make(wide ? 60 : 3, wide ? 3 : 60);
        for (int i = 0; i < SIZES; i++)
            for (int count = 1; count <= 4; count++) {
                const Picture picture = plan(count, sizes[i], &(RenderLook){0});
                const Rect *panel = &picture.layout.panels[0];
                const double length = wide ? width_of(panel) : height_of(panel), scale = picture.camera.scale;
                const double breadth = wide ? height_of(panel) : width_of(panel), em = picture.layout.title.pixels;
                if (60 * scale < 0.72 * length && scale > 3)
                    fail_msg("%s, %d x %d, %d panels: %g of %g pixels", wide ? "wide" : "high", sizes[i][0],
                             sizes[i][1], count, 60 * scale, length);
                if (wide) assert_true(3 * scale >= 0.23 * breadth);
                if (!wide && count == 1) assert_true(breadth <= fmax(22 * em + 1, 5.6 * scale / 0.2));
            }
        destroy();
    }
}

TEST(the_ground_takes_little) {
    static const float scenes[][2] = {{3, 60}, {60, 3}, {10, 10}, {1, 1}};
    for (size_t scene = 0; scene < sizeof scenes / sizeof scenes[0]; scene++) {
        make(scenes[scene][0], scenes[scene][1]);
        for (int i = 0; i < SIZES; i++)
            for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
                const Picture picture = plan(count, sizes[i], &(RenderLook){0});
                const double height = height_of(&picture.layout.panels[0]), ground = height - picture.camera.top;
                if (ground < 1 || ground > 0.2 * height)
                    fail_msg("%g x %g m, %d x %d, %d panels: ground %g of %g pixels", (double)scenes[scene][0],
                             (double)scenes[scene][1], sizes[i][0], sizes[i][1], count, ground, height);
            }
        destroy();
    }
}

/* A moving camera comes closer than the fixed one, and an overlay has the names of all runs in one line. */
TEST(panels_that_need_their_room_keep_it) {
    make(3, 60);
    const Picture overlay = plan(3, sizes[0], &(RenderLook){.compare = LOOK_OVERLAY});
    assert_int_equal(overlay.layout.panels[0].right, overlay.layout.right);
    for (int i = 0; i < 3; i++) runs[i]->bomb = BOMB_BODY;
    OWN(Picture) moving = plan(1, sizes[0], &(RenderLook){.camera = LOOK_BOMB});
    assert_int_equal(moving.layout.panels[0].right, moving.layout.right);
    destroy();
}

/* Numbers stand at equal distances: every first, second, fifth, ... line. */
TEST(axes_are_numbered_in_equal_steps) {
    make(60, 3);
    for (int i = 0; i < SIZES; i++)
        for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
            const Picture picture = plan(count, sizes[i], &(RenderLook){0});
            const Rect *panel = &picture.layout.panels[0];
            const int baseline = panel->bottom + picture.layout.axis_drop,
                      digit = font_width(&picture.layout.axis, "0");
            OWN(Drawing) drawing = {0};
            picture_draw(&picture, moment_stored(3), &drawing);
            int ends[256], found = 0; /* right ends of numbers, from left to right */
            for (size_t k = 0; k < drawing.glyph_count && found < 256; k++) {
                const int32_t *box = drawing.glyphs[k].box;
                if (box[1] > baseline || box[1] + box[3] < baseline - 1 || box[1] < panel->bottom ||
                    box[0] < panel->left - 2 * digit || box[0] + box[2] > panel->right)
                    continue;
                if (found > 0 && box[0] - ends[found - 1] < digit / 2 + 1 && box[0] >= ends[found - 1] - 2)
                    ends[found - 1] = box[0] + box[2];
                else
                    ends[found++] = box[0] + box[2];
            }
            int least = INT_MAX, most = 0;
            for (int k = 2; k + 1 < found; k++) { /* without the ends and the unit */
                const int step = ends[k] - ends[k - 1];
                least = step < least ? step : least, most = step > most ? step : most;
            }
            if (found > 4 && 2 * (most - least) > 3 * digit)
                fail_msg("%d x %d, %d panels: steps of %d to %d pixels", sizes[i][0], sizes[i][1], count, least, most);
        }
    destroy();
}

RUN_TESTS(NULL, NULL)
