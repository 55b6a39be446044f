/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every look gives equal pixels in both contexts, and drawn whole or row by row, for all contents of the runs. */
#include "made.h"

#include "pixels/built_contexts.h"
#include "regression/image_compare.h"
#include "look_runs.h"
#include "mesa.h"
#include "pictures/render_internal.h"

static const Moment moments[] = {
    {MOMENT_TITLE, 0, 0, 1, 1},           {MOMENT_STORED, 0, 0, 1, 1},          {MOMENT_BETWEEN, 1, 1, 4, 4},
    {MOMENT_BETWEEN, 1, 3, 4, 4},         {MOMENT_STORED, 2, 0, 4, 4},          {MOMENT_STORED, 19, 0, 1, 1},
    {MOMENT_STORED, 20, 0, 1, 1},         {MOMENT_BETWEEN, 20, 1, 2, 2},        {MOMENT_END, FRAMES - 1, 0, 1, 1},
    {MOMENT_STORED, FRAMES - 1, 0, 1, 1}, {MOMENT_STORED, FRAMES - 1, 0, 1, 1}, {MOMENT_END, FRAMES - 1, 0, 1, 1},
};
enum { MOMENTS = sizeof moments / sizeof moments[0] };

/* One renderer draws the moments one after another, the other starts again for each. */
static void assert_followed(const RenderLook *look, int count, int width, int height) {
    Error error = {0};
    RenderOptions options = {.width = width, .height = height, .look = *look};
    options.context = built_context(CONTEXT_OSMESA);
    Renderer *next = renderer_create(panels, count, &options, &error);
    options.context = built_context(CONTEXT_EGL);
    Renderer *whole = renderer_create(panels, count, &options, &error);
    assert_ok(next != NULL && whole != NULL, error);
    OWN(Image) *a = image_sized(width, height), *b = image_sized(width, height);
    const bool *changed;
    for (int i = 0; i < MOMENTS; i++) {
        ImageDifference difference;
        if (moments[i].frame >= panels[0]->frames) continue;
        assert_ok(renderer_draw_next(next, moments[i], a, &changed, &error), error);
        assert_ok(renderer_draw(whole, 0, b, &error), error);
        assert_ok(renderer_draw_next(whole, moments[i], b, &changed, &error), error);
        for (int y = 0; y < height; y++) assert_true(changed[y]);
        image_compare_masked(a, b, NULL, 0, &difference);
        if (!difference.equal)
            fail_msg("compare %d, camera %d, show %u, moment %d: %d pixels differ", (int)look->compare,
                     (int)look->camera, look->show, i, (int)difference.pixels);
    }
    renderer_destroy(next);
    renderer_destroy(whole);
}

TEST_WITH(every_look_is_the_same_whole_or_followed, make, destroy) {
    static const RenderLook looks[] = {
        {.show = SHOW_GHOSTS | SHOW_CONTACTS},
        {.show = SHOW_DISTANCE | SHOW_VELOCITIES, .theme = LOOK_DARK},
        {.show = SHOW_TRAILS | SHOW_IMPULSES},
        {.show = SHOW_TIMELINE, .theme = LOOK_DARK},
        {.compare = LOOK_OVERLAY},
        {.compare = LOOK_DIFFERENCE, .theme = LOOK_DARK},
        {.compare = LOOK_OVERLAY, .camera = LOOK_DIVERGENCE, .show = ALL_SHOWN},
        {.compare = LOOK_DIFFERENCE, .camera = LOOK_BOMB, .show = ALL_SHOWN},
    };
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) assert_followed(&looks[i], RUNS, WIDTH, HEIGHT);
}

TEST_WITH(looks_fit_every_size_and_length, make, destroy) {
    static const int sizes[][2] = {{64, 64}, {64, 400}, {300, 96}, {420, 560}};
    for (int i = 0; i < 4; i++) {
        RenderLook look = {.compare = (LookCompare)(i % 3), .camera = (LookCamera)(1 + i % 2), .show = ALL_SHOWN};
        for (int run = 0; run < RUNS; run++) runs[run]->frames = i == 3 ? 1 : FRAMES - run;
        assert_followed(&look, RUNS, sizes[i][0], sizes[i][1]);
    }
}

TEST_WITH(hostile_runs_do_no_harm, make, destroy) {
    static const float bad[] = {NAN, INFINITY, -INFINITY, 3e38F, -1e20F, 1e-40F};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        for (int run = 0; run < RUNS; run++) {
            *run_position(runs[run], 20, FIRST_BOX) = vec2(bad[i], 1);
            *run_position(runs[run], 21, BOMB_BODY) = vec2(bad[i], bad[i]);
            *run_angle(runs[run], 20, SECOND_BOX) = bad[i];
            *run_angle(runs[run], 20, GROUND_BODY) = 0.1F; /* the static layer */
            runs[run]->velocity[20 * RUN_BODIES + BOMB_BODY] = vec2(bad[i], 1);
            for (int64_t k = runs[run]->contact_start[20]; k < runs[run]->contact_start[22]; k++) {
                runs[run]->contacts[k].point.x = bad[i];
                runs[run]->contacts[k].normal_impulse = bad[i];
            }
        }
        RenderLook look = {.camera = (LookCamera)(1 + i % 2), .show = ALL_SHOWN};
        assert_followed(&look, 2, 200, 150);
    }
}

RUN_TESTS(NULL, NULL)
