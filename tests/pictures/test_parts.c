/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whatever a picture draws outside its panels is in one of its parts, and nothing but the panels' content is in
   panels. */
#include "testing.h"
#include "owned_drawings.h"

#include "pictures/pictures_internal.h"
#include "pictures/look_runs.h"

static const int sizes[][2] = {{420, 300}, {640, 360}, {1280, 720}, {720, 1280}, {2000, 400}, {100, 80}, {3840, 2160}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

typedef struct Places {
    Rect rects[PARTS_MAX + RENDER_PANELS_MAX];
    int count;
} Places;

/* The panels with their frames, and the parts. */
static Places places_of(const Picture *picture) {
    Part parts[PARTS_MAX];
    const int line = picture->layout.hairline;
    Places places = {.count = parts_find(picture, parts)};
    for (int i = 0; i < places.count; i++) places.rects[i] = parts[i].rect;
    for (int i = 0; i < picture->panel_count; i++) {
        const Rect *r = &picture->layout.panels[i];
        places.rects[places.count++] = (Rect){r->left - line, r->top - line, r->right + line, r->bottom + line};
    }
    return places;
}

static void assert_in_a_place(const Places *places, Rect mark, const char *what) {
    for (int i = 0; i < places->count; i++) {
        const Rect *r = &places->rects[i];
        if (mark.left >= r->left && mark.right <= r->right && mark.top >= r->top && mark.bottom <= r->bottom) return;
    }
    fail_msg("%s at %d to %d, %d to %d is in no part", what, mark.left, mark.right, mark.top, mark.bottom);
}

static void check(const RenderLook *look, int count, int width, int height) {
    Error error = {0};
    OWN(Picture) picture;
    OWN(Drawing) drawing = {0};
    RenderOptions options = {.width = width, .height = height, .look = *look};
    options.look.costs[0] = options.look.costs[1] = "8 \xC2\xB5s a step";
    assert_ok(picture_plan(&picture, panels, count, width, height, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    picture_draw(&picture, (Moment){MOMENT_STORED, 25, 0, 4, 4}, &drawing);
    const Places places = places_of(&picture);
    for (size_t i = 0; i < drawing.rect_count; i++) assert_in_a_place(&places, drawing.rects[i].rect, "a rectangle");
    for (size_t i = 0; i < drawing.shape_count; i++) {
        const int32_t *b = drawing.shapes[i].bounds;
        assert_in_a_place(&places, (Rect){b[0], b[1], b[2], b[3]}, "a shape");
    }
    for (size_t i = 0; i < drawing.glyph_count; i++) {
        const int32_t *b = drawing.glyphs[i].box;
        assert_in_a_place(&places, (Rect){b[0], b[1], b[0] + b[2], b[1] + b[3]}, "a character");
    }
}

TEST_WITH(every_mark_is_in_a_part, make, destroy) {
    for (int i = 0; i < SIZES; i++)
        for (int compare = LOOK_SPLIT; compare <= LOOK_DIFFERENCE; compare++)
            for (int camera = LOOK_FIT; camera <= LOOK_DIVERGENCE; camera++)
                for (unsigned show = 0; show <= ALL_SHOWN; show += ALL_SHOWN)
                    check(&(RenderLook){.compare = (LookCompare)compare, .camera = (LookCamera)camera, .show = show},
                          RUNS, sizes[i][0], sizes[i][1]);
}

/* A region in a panel must not be taken for a caption. */
TEST_WITH(parts_and_panels_do_not_overlap, make, destroy) {
    for (int i = 0; i < SIZES; i++) {
        OWN(Picture) picture;
        Part parts[PARTS_MAX];
        RenderOptions options = {.width = sizes[i][0], .height = sizes[i][1], .look = {.show = ALL_SHOWN}};
        assert_ok(picture_plan(&picture, panels, RUNS, sizes[i][0], sizes[i][1], &error), error);
        assert_ok(picture_apply_options(&picture, &options, &error), error);
        const int count = parts_find(&picture, parts);
        for (int part = 0; part < count; part++)
            for (int panel = 0; panel < picture.panel_count; panel++) {
                const Rect *a = &parts[part].rect, *b = &picture.layout.panels[panel];
                if (a->left < b->right && b->left < a->right && a->top < b->bottom && b->top < a->bottom)
                    fail_msg("%d x %d: the %s overlaps panel %d", sizes[i][0], sizes[i][1],
                             part_names[parts[part].kind], panel);
            }
    }
}

/* A wall 60 m long or high, whose panels are not those of other scenes. */
static void make_box(Vec2 size) {
    for (int i = 0; i < RUNS; i++) {
        runs[i]->bomb = -1;
        for (int body = FIRST_BOX; body <= BOMB_BODY; body++) {
            runs[i]->size[body] = size;
            for (int frame = 0; frame < FRAMES; frame++)
                *run_position(runs[i], frame, body) = vec2(0.1F * (float)i, size.y / 2);
        }
    }
}

TEST_WITH(every_mark_of_long_scenes_is_in_a_part, make, destroy) {
    for (int wide = 0; wide < 2; wide++) {
        make_box(wide ? vec2(60, 3) : vec2(3, 60));
        for (int i = 0; i < SIZES; i++)
            for (int count = 1; count <= RUNS; count++)
                check(&(RenderLook){.show = count > 1 ? ALL_SHOWN : 0}, count, sizes[i][0], sizes[i][1]);
    }
}

RUN_TESTS(NULL, NULL)
