/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Consecutive frames of which only the changes are drawn, read and compressed, compared with the same frames drawn
   whole: equal pixels and equal bytes, along the runs of golden/ and across jumps. */
#include "made.h"
#include "sanitized.h"
#include "owned_drawings.h"

#include "regression/image_compare.h"
#include "mesa.h"
#include "pixels/gl.h"
#include "pictures/render_internal.h"
#include "runs.h"

#include <limits.h>

enum { WIDTH = 640, HEIGHT = 360, PANELS = 2 };
static const char TRAJECTORIES[] = SOURCE_DIR "/golden/trajectories";

/* The same picture twice: `next` draws the changes, `whole` every frame completely. */
typedef struct Twins {
    Renderer *next, *whole;
    Image *next_image, *whole_image;
    PngEncoder *next_encoder;
    int drawn;
    long painted; /* rows that `next` painted */
} Twins;

static void open_twins(Twins *twins, const Trajectory *const *panels, int count) {
    Error error = {0};
    RenderOptions options = {.width = WIDTH, .height = HEIGHT};
    *twins = (Twins){.next = renderer_create(panels, count, &options, &error),
                     .whole = renderer_create(panels, count, &options, &error),
                     .next_image = image_sized(WIDTH, HEIGHT),
                     .whole_image = image_sized(WIDTH, HEIGHT),
                     .next_encoder = png_encoder_create(WIDTH, HEIGHT, PNG_FAST, &error)};
    assert_ok(twins->next != NULL && twins->whole != NULL && twins->next_encoder != NULL, error);
}

static void close_twins(Twins *twins) {
    renderer_destroy(twins->next);
    renderer_destroy(twins->whole);
    image_destroy(twins->next_image);
    image_destroy(twins->whole_image);
    png_encoder_destroy(twins->next_encoder);
}

static void assert_same_bytes(Twins *twins, const bool *changed) {
    Error error = {0};
    const uint8_t *next, *whole;
    size_t next_size, whole_size;
    OWN(PngEncoder) *encoder = png_encoder_create(WIDTH, HEIGHT, PNG_FAST, &error);
    assert_ok(png_encode(twins->next_encoder, twins->next_image, changed, NULL, 0, &next, &next_size, &error), error);
    assert_ok(png_encode(encoder, twins->whole_image, NULL, NULL, 0, &whole, &whole_size, &error), error);
    assert_true(next_size == whole_size && memcmp(next, whole, next_size) == 0);
}

static void assert_same_frame(Twins *twins, int frame) {
    Error error = {0};
    ImageDifference difference;
    const bool *changed;
    assert_ok(renderer_draw_next(twins->next, moment_stored(frame), twins->next_image, &changed, &error), error);
    assert_ok(renderer_draw(twins->whole, frame, twins->whole_image, &error), error);
    image_compare_masked(twins->next_image, twins->whole_image, NULL, 0, &difference);
    if (!difference.equal)
        fail_msg("frame %d: %d pixels differ, the first at (%d, %d)", frame, (int)difference.pixels, difference.first_x,
                 difference.first_y);
    assert_same_bytes(twins, changed);
    for (int y = 0; y < HEIGHT; y++) twins->painted += changed[y];
    twins->drawn++;
}

static Trajectory *golden_run(const char *scene, const char *method) {
    return trajectory_of(printed("%s/%s-%s.npz", TRAJECTORIES, scene, method));
}

TEST(followed_frames_equal_whole_ones) {
    static const char *const scenes[] = {"single", "stack", "pyramid", "pyramid_settled"};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i += (size_t)sampled(3)) {
        Trajectory *runs[PANELS] = {golden_run(scenes[i], "engine"), golden_run(scenes[i], "pair-net")};
        const Trajectory *const panels[PANELS] = {runs[0], runs[1]};
        int last = runs[0]->frames - 1;
        Twins twins;
        open_twins(&twins, panels, PANELS);
        for (int frame = 0; frame <= last; frame += last / 60 > 1 ? last / 60 : 1) assert_same_frame(&twins, frame);
        const int jumps[] = {0, last, last, 1, last / 2, last / 2 + 1, 0};
        for (size_t jump = 0; jump < sizeof jumps / sizeof jumps[0]; jump++) assert_same_frame(&twins, jumps[jump]);
        assert_true(twins.painted < (long)HEIGHT * twins.drawn * 3 / 4); /* otherwise nothing is saved */
        close_twins(&twins);
        for (int k = 0; k < PANELS; k++) trajectory_destroy(runs[k]);
    }
}

/* Bodies that appear and disappear, shapes taller than the picture, a moving ground, NaN and infinite poses. */
TEST(wild_frames_equal_whole_ones) {
    static const float wild[] = {0, 1, 40, -40, 3e38F, NAN, INFINITY, 5, -1e6F, 2};
    enum { FRAMES = sizeof wild / sizeof wild[0] };
    OWN(Trajectory) *run = run_make("engine", FRAMES);
    const Trajectory *const panels[] = {run};
    run->size[SECOND_BOX] = vec2(0.5F, 300);
    for (int frame = 0; frame < FRAMES; frame++) {
        run_position(run, frame, FIRST_BOX)->x = wild[frame];
        run_position(run, frame, SECOND_BOX)->y = wild[(frame + 3) % FRAMES];
        *run_angle(run, frame, FIRST_BOX) = wild[(frame + 5) % FRAMES];
        *run_angle(run, frame, GROUND_BODY) = frame < 4 ? 0 : 0.1F;
    }
    run->camera_size = vec2(20, 10);
    Twins twins;
    open_twins(&twins, panels, 1);
    for (int from = 0; from < FRAMES; from += sampled(3))
        for (int to = 0; to < FRAMES; to++) {
            assert_same_frame(&twins, from);
            assert_same_frame(&twins, to);
        }
    close_twins(&twins);
}

/* A single frame drawn in between invalidates the canvas; a frame that does not exist does not. */
TEST(other_calls_may_come_between) {
    OWN(Trajectory) *run = run_make("engine", 6);
    const Trajectory *const panels[] = {run};
    for (int frame = 0; frame < 6; frame++) run_position(run, frame, FIRST_BOX)->y += 1.6F * (float)frame;
    Twins twins;
    open_twins(&twins, panels, 1);
    for (int frame = 0; frame < 6; frame++) {
        assert_same_frame(&twins, frame);
        if (frame % 2 == 0)
            assert_ok(renderer_draw(twins.next, 5 - frame, twins.whole_image, &error), error);
        else
            assert_false(
                renderer_draw_next(twins.next, moment_stored(6), twins.next_image, &(const bool *){NULL}, &(Error){0}));
    }
    close_twins(&twins);
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
