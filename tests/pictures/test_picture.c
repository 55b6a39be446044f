/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole frames: equal in both contexts for all contents of the trajectories, and stable from frame to frame. */
#include "made.h"
#include "owned_drawings.h"

#include "pixels/built_contexts.h"
#include "regression/image_compare.h"
#include "mesa.h"
#include "pictures/pictures_internal.h"
#include "pictures/render.h"
#include "runs.h"

static const Trajectory *panels[RENDER_PANELS_MAX];
static Trajectory *runs[RENDER_PANELS_MAX];

FIXTURE(make) {
    static const char *const methods[] = {"engine", "pair-net:network=a/b.npz", "momentum", "x:y=1", "pair-net",
                                          "engine"};
    for (int i = 0; i < RENDER_PANELS_MAX; i++) panels[i] = runs[i] = run_make(methods[i], 12);
}

FIXTURE(destroy) {
    for (int i = 0; i < RENDER_PANELS_MAX; i++) trajectory_destroy(runs[i]);
}

static Image *draw_in(ContextChoice context, int count, int width, int height, int frame) {
    Error error = {0};
    RenderOptions options = {.width = width, .height = height, .context = context};
    Renderer *renderer = renderer_create(panels, count, &options, &error);
    assert_ok(renderer != NULL, error);
    Image *image = image_sized(width, height);
    assert_ok(renderer_draw(renderer, frame, image, &error), error);
    renderer_destroy(renderer);
    return image;
}

static uint64_t hash_of(int count, int width, int height, int frame) {
    OWN(Image) *image = draw_in(CONTEXT_AUTO, count, width, height, frame);
    uint64_t hash = image_hash(image);
    return hash;
}

TEST_WITH(both_contexts_draw_the_same, make, destroy) {
    static const int sizes[][2] = {{640, 360}, {1280, 720}, {360, 640}, {64, 64}, {65, 333}, {2000, 301}};
    for (int count = 1; count <= RENDER_PANELS_MAX; count++) {
        const int *size = sizes[count - 1];
        OWN(Image) *a = draw_in(built_context(CONTEXT_OSMESA), count, size[0], size[1], 5);
        OWN(Image) *b = draw_in(built_context(CONTEXT_EGL), count, size[0], size[1], 5);
        ImageDifference difference;
        image_compare_masked(a, b, NULL, 0, &difference);
        if (!difference.equal) fail_msg("%d panels: %d pixels differ", count, (int)difference.pixels);
    }
}

/* A panel without header and captions. */
static void copy_panel(Image *to, const Image *from, const Rect *rect) {
    for (int y = rect->top; y < rect->bottom; y++) {
        size_t start = ((size_t)y * (size_t)from->width + (size_t)rect->left) * 4;
        memcpy(to->pixels + start, from->pixels + start, (size_t)(rect->right - rect->left) * 4);
    }
}

TEST_WITH(an_ended_panel_holds_its_last_frame, make, destroy) {
    runs[1]->frames = 6;
    Picture picture;
    assert_ok(picture_plan(&picture, panels, 2, 640, 360, &error), error);
    assert_int_equal(picture.frames, 12);
    OWN(Image) *last = draw_in(CONTEXT_AUTO, 2, 640, 360, 5), *later = draw_in(CONTEXT_AUTO, 2, 640, 360, 9);
    OWN(Image) *a = image_sized(640, 360), *b = image_sized(640, 360);
    const Rect *rects = picture.layout.panels;
    copy_panel(a, last, &rects[1]);
    copy_panel(b, later, &rects[1]);
    assert_true(image_hash(a) == image_hash(b));
    copy_panel(a, last, &rects[0]);
    copy_panel(b, later, &rects[0]);
    assert_true(image_hash(a) != image_hash(b));
    Rect caption = {rects[1].left, rects[1].top - 20, rects[1].right, rects[1].top - 2};
    copy_panel(a, later, &rects[0]); /* equal except for "ended" */
    assert_true(image_hash(a) == image_hash(b));
    copy_panel(a, last, &caption);
    copy_panel(b, later, &caption);
    assert_true(image_hash(a) != image_hash(b));
    assert_true(isnan(picture_distance(&picture, moment_stored(9))) &&
                picture_distance(&picture, moment_stored(5)) == 0);
}

TEST_WITH(the_largest_distance_of_any_panel_counts, make, destroy) {
    Picture picture;
    run_position(runs[1], 4, SECOND_BOX)->y += 2;
    run_position(runs[2], 4, FIRST_BOX)->x += 0.5F;
    assert_ok(picture_plan(&picture, panels, 3, 640, 360, &error), error);
    assert_true(fabs(picture_distance(&picture, moment_stored(4)) - 2) < 1e-6);
    assert_true(picture_distance(&picture, moment_stored(3)) == 0);
    assert_true(fabs(picture.largest_distance - 2) < 1e-6);
    assert_ok(picture_plan(&picture, panels, 1, 640, 360, &error), error);
    assert_true(isnan(picture_distance(&picture, moment_stored(4))));
}

TEST_WITH(bodies_out_of_view_are_counted, make, destroy) {
    Picture picture;
    *run_position(runs[1], 5, FIRST_BOX) = vec2(-1000, 3);
    *run_position(runs[1], 5, BOMB_BODY) = vec2(0, 3e38F);
    *run_position(runs[1], 5, SECOND_BOX) = vec2(NAN, NAN); /* does not exist */
    assert_ok(picture_plan(&picture, panels, 2, 640, 360, &error), error);
    assert_int_equal(panel_count_out_of_view(&picture, 1, moment_stored(5)), 1); /* an arrow points to the bomb */
    assert_int_equal(panel_count_out_of_view(&picture, 0, moment_stored(5)), 0);
}

TEST_WITH(an_absent_body_is_not_drawn, make, destroy) {
    run_position(runs[0], 0, BOMB_BODY)->x = 1;
    assert_true(isnan((double)run_position(runs[0], 0, BOMB_BODY)->y));
    uint64_t half = hash_of(1, 640, 360, 0);
    run_position(runs[0], 0, BOMB_BODY)->x = NAN;
    assert_true(hash_of(1, 640, 360, 0) == half);
    *run_position(runs[0], 0, BOMB_BODY) = vec2(1, 5);
    *run_angle(runs[0], 0, BOMB_BODY) = 0;
    assert_true(hash_of(1, 640, 360, 0) != half);
}

static uint64_t hash_with_words(const char *title, const char *note) {
    Error error = {0};
    RenderOptions options = {.width = 1280, .height = 720, .title = title, .notes = {NULL, note}};
    Renderer *renderer = renderer_create(panels, 2, &options, &error);
    assert_ok(renderer != NULL, error);
    OWN(Image) *image = image_sized(1280, 720);
    assert_ok(renderer_draw(renderer, 4, image, &error), error);
    uint64_t hash = image_hash(image);
    renderer_destroy(renderer);
    return hash;
}

/* The scene's own name as title changes nothing; every other text does. */
TEST_WITH(a_title_and_notes_are_drawn, make, destroy) {
    uint64_t plain = hash_of(2, 1280, 720, 4);
    assert_true(hash_with_words(NULL, NULL) == plain);
    assert_true(hash_with_words("two_boxes", NULL) == plain);
    assert_true(hash_with_words("height 15", NULL) != plain);
    uint64_t falls = hash_with_words(NULL, "falls");
    assert_true(falls != plain && falls != hash_with_words(NULL, "sinks"));
}

/* From 9 to 10 and from 99 to 100, the text beside the numbers does not move. */
TEST_WITH(captions_do_not_jump, make, destroy) {
    trajectory_destroy(runs[0]);
    panels[0] = runs[0] = run_make("engine", 1010);
    Picture picture;
    OWN(Drawing) drawing = {0};
    assert_ok(picture_plan(&picture, panels, 1, 1280, 720, &error), error);
    int left = 0;
    for (int frame = 0; frame < 1010; frame += 7) {
        drawing_clear(&drawing);
        picture_draw(&picture, moment_stored(frame), &drawing);
        if (frame == 0) left = drawing.glyphs[0].box[0];
        assert_int_equal(drawing.glyphs[0].box[0], left); /* the "t" of "t = 0.000 s" */
    }
}

TEST_WITH(hostile_names_do_no_harm, make, destroy) {
    for (int byte = 1; byte < 256; byte++) {
        memset(runs[0]->scene, byte, TRAJECTORY_NAME_SIZE - 1);
        memset(runs[0]->method, byte, TRAJECTORY_NAME_SIZE - 1);
        Picture picture;
        OWN(Drawing) drawing = {0};
        assert_ok(picture_plan(&picture, panels, 2, 400, 300, &error), error);
        picture_draw(&picture, moment_stored(3), &drawing);
        for (size_t i = 0; i < drawing.glyph_count; i++) {
            const int32_t *box = drawing.glyphs[i].box;
            assert_true(box[0] >= 0 && box[0] + box[2] <= 400 && box[1] >= 0 && box[1] + box[3] <= 300);
        }
    }
}

RUN_TESTS(NULL, NULL)
