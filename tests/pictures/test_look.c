/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Effects of each look: required runs, and positions of poses, cameras, colours and curves. */
#include "made.h"
#include "files.h"
#include "owned_drawings.h"

#include "look_runs.h"
#include "mesa.h"
#include "pictures/pictures_internal.h"
#include "pictures/render_internal.h"

static Picture picture_with_look(int count, const RenderLook *look) {
    Picture picture;
    Error error = {0};
    RenderOptions options = {.width = WIDTH, .height = HEIGHT, .look = *look};
    assert_ok(picture_plan(&picture, panels, count, WIDTH, HEIGHT, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    return picture;
}

TEST_WITH(poses_between_frames_lie_between, make, destroy) {
    Moment between = {MOMENT_BETWEEN, 4, 1, 4, 4};
    Pose a = pose_stored(runs[0], 4, SECOND_BOX), b = pose_stored(runs[0], 5, SECOND_BOX);
    Pose pose = pose_at(runs[0], between, SECOND_BOX);
    assert_near(pose.angle, 0.75 * a.angle + 0.25 * b.angle, 1e-12);
    between.frame = 1;
    assert_true(isnan(pose_at(runs[0], between, BOMB_BODY).x)); /* it appears in frame 2 */
    between.frame = FRAMES - 1;
    assert_near(pose_at(runs[0], between, SECOND_BOX).angle, pose_stored(runs[0], FRAMES - 1, SECOND_BOX).angle, 0);
    *run_position(runs[0], 11, BOMB_BODY) = vec2(NAN, NAN);
    between.frame = 10; /* it disappears */
    assert_near(pose_at(runs[0], between, BOMB_BODY).y, pose_stored(runs[0], 10, BOMB_BODY).y, 0);
}

TEST_WITH(distances_between_frames_lie_between, make, destroy) {
    OWN(Picture) picture = picture_with_look(2, &(RenderLook){0});
    double before = picture_distance(&picture, moment_stored(9)), after = picture_distance(&picture, moment_stored(10));
    assert_near(picture_distance(&picture, (Moment){MOMENT_BETWEEN, 9, 1, 2, 2}), (before + after) / 2, 1e-6);
    assert_true(isnan(picture_run_distance(&picture, 0, moment_stored(9))));
}

TEST_WITH(events_are_found_where_they_are, make, destroy) {
    Events events = events_find(panels, 2);
    assert_int_equal(events.impact, 20);
    assert_int_equal(events.divergence, 5); /* 2 mm */
    assert_int_equal(events.run, 1);
    assert_int_equal(events.body, FIRST_BOX);
    events = events_find(panels, 3);
    assert_int_equal(events.divergence, 1);
    assert_int_equal(events.run, 2);
    runs[2]->size[FIRST_BOX].x = 2; /* another world */
    assert_int_equal(events_find(panels, 3).run, 1);
    runs[0]->bomb = runs[1]->bomb = -1;
    assert_int_equal(events_find(panels, 2).impact, -1);
}

TEST_WITH(each_compare_has_its_panels, make, destroy) {
    static const int shown[] = {3, 1, 2}, first[] = {0, 0, 1};
    for (int compare = LOOK_SPLIT; compare <= LOOK_DIFFERENCE; compare++) {
        OWN(Picture) picture = picture_with_look(3, &(RenderLook){.compare = (LookCompare)compare});
        assert_int_equal(picture.panel_count, shown[compare]);
        assert_int_equal(picture_run(&picture, 0), first[compare]);
    }
}

/* With a fixed camera only the timeline takes room. */
TEST_WITH(curves_are_the_largest_distances, make, destroy) {
    OWN(Picture) picture = picture_with_look(3, &(RenderLook){.show = SHOW_TIMELINE});
    assert_int_equal(picture.curve_points, FRAMES);
    for (int frame = 0; frame < FRAMES; frame++) {
        assert_near(picture.curves[FRAMES + frame], trajectory_distance(runs[0], runs[1], frame), 1e-6);
        assert_true(isnan((double)picture.curves[frame]));
    }
    assert_true(picture.layout.timeline.top > picture.layout.panels[0].bottom);
}

/* No jumps: from frame to frame, centre and size of the view change by a small fraction. */
TEST_WITH(cameras_ease, make, destroy) {
    for (int run = 0; run < RUNS; run++) trajectory_destroy(runs[run]);
    for (int run = 0; run < RUNS; run++) panels[run] = runs[run] = run_make("engine", 400);
    for (int frame = 200; frame < 400; frame++) run_position(runs[1], frame, SECOND_BOX)->x += 1;
    for (int run = 0; run < RUNS; run++) run_position(runs[run], 0, FIRST_BOX)->x = -30; /* a wide view to zoom from */
    for (int run = 0; run < RUNS; run++)
        for (int frame = 2; frame < 400; frame++) /* from left to right, with a jump */
            *run_position(runs[run], frame, BOMB_BODY) = vec2(frame < 150 ? -10 : 10 + 0.01F * (float)frame, 3);
    for (int camera = LOOK_BOMB; camera <= LOOK_DIVERGENCE; camera++) {
        OWN(Picture) picture = picture_with_look(2, &(RenderLook){.camera = (LookCamera)camera});
        const Rect panel = picture.layout.panels[0];
        double width = panel.right - panel.left, whole = width / picture.camera.scale, closest = 0;
        for (int frame = 0; frame < 400; frame++) {
            const Camera *at = &picture.path[frame], *before = &picture.path[frame > 0 ? frame - 1 : 0];
            double middle = (width / 2 - at->left) / at->scale, last = (width / 2 - before->left) / before->scale;
            if (fabs(middle - last) > 0.12 * whole || fabs(at->scale / before->scale - 1) > 0.12)
                fail_msg("camera %d jumps in frame %d", camera, frame);
            closest = fmax(closest, at->scale);
        }
        assert_true(closest > 1.9 * picture.camera.scale);
        Camera halfway = camera_at(picture.path, 400, (Moment){MOMENT_BETWEEN, 100, 1, 2, 2}, (int)width, 100);
        assert_true(halfway.scale >= fmin(picture.path[100].scale, picture.path[101].scale) - 1e-9);
        if (camera == LOOK_DIVERGENCE) {
            picture.camera = picture.path[205];
            Point at = panel_point(&picture, 0, 2, 0.5);
            assert_near(at.x, (panel.left + panel.right) / 2.0, 2);
        }
    }
}

static double lightness(uint32_t color) {
    static const double weights[] = {0.0722, 0.7152, 0.2126};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double c = (color >> 8 * i & 255) / 255.0;
        sum += weights[i] * (c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
    }
    return 116 * cbrt(sum) - 16; /* CIE L*, above 8 */
}

/* Equal steps of distance are equal steps of lightness, so that grey prints show distances as well. */
TEST_WITH(colors_of_distance_are_even_in_lightness, make, destroy) {
    for (int theme = LOOK_LIGHT; theme <= LOOK_DARK; theme++) {
        const Theme *colors = theme_get((LookTheme)theme);
        double first = lightness(theme_ramp(colors, 0)), last = lightness(theme_ramp(colors, 1));
        assert_true(fabs(last - first) > 65);
        for (int i = 0; i <= 10; i++)
            assert_near(lightness(theme_ramp(colors, i / 10.0)), first + (last - first) * i / 10, 2);
        assert_int_equal(theme_ramp(colors, -1), theme_ramp(colors, 0));
        assert_int_equal(theme_ramp(colors, 2), theme_ramp(colors, 1));
        double panel = lightness(colors->panel); /* large distances stand out from the page */
        assert_true(fabs(last - panel) > fabs(first - panel));
    }
}

TEST_WITH(distances_have_their_place_on_the_scale, make, destroy) {
    Scales scales;
    OWN(Picture) picture = picture_with_look(2, &(RenderLook){.show = SHOW_IMPULSES});
    assert_ok(scales_choose(&scales, runs[0], &picture.layout, picture.camera.scale, 0.5, &error), error);
    assert_int_equal(scales.last_decade, 0);
    assert_false(scales.exceeded);
    assert_near(scales_share(&scales, 0), 0, 0);
    assert_near(scales_share(&scales, NAN), 0, 0);
    assert_near(scales_share(&scales, 0.001), 0, 1e-12);
    assert_near(scales_share(&scales, 0.1), 2.0 / 3, 1e-12);
    assert_near(scales_share(&scales, 5), 1, 0);
    assert_ok(scales_choose(&scales, runs[0], &picture.layout, picture.camera.scale, 5000, &error), error);
    assert_true(scales.exceeded && scales.last_decade == 1);
}

static uint64_t hash_of(const RenderLook *look, int width, int height, Moment moment) {
    Error error = {0};
    RenderOptions options = {.width = width, .height = height, .look = *look};
    Renderer *renderer = renderer_create(panels, 2, &options, &error);
    OWN(Image) *image = image_sized(width, height);
    const bool *changed;
    assert_ok(renderer != NULL, error);
    assert_ok(renderer_draw_next(renderer, moment, image, &changed, &error), error);
    uint64_t hash = image_hash(image);
    renderer_destroy(renderer);
    return hash;
}

/* In a picture without a legend, as it is too small for text; in pages, by the script that the table names (a browser
   sees it drawn: controls.py). */
TEST_WITH(every_mark_is_drawn_in_frames_and_pages, make, destroy) {
    const Moment moment = moment_stored(25);
    const uint64_t plain = hash_of(&(RenderLook){0}, 320, 200, moment);
    for (int i = 0; i < SHOW_COUNT; i++) {
        const ShowMark *mark = &show_marks[i];
        assert_string_equal(look_show_names[i], mark->name);
        if (hash_of(&(RenderLook){.show = 1u << i}, 320, 200, moment) == plain)
            fail_msg("%s is not drawn in frames", mark->name);
        if (mark->script == NULL) continue;
        char path[4096], use[64];
        snprintf(path, sizeof path, SOURCE_DIR "/src/pictures/player/%s", mark->script);
        snprintf(use, sizeof use, "shows(\"%s\")", mark->name);
        FREED char *script = text_of(path);
        if (strstr(script, use) == NULL) fail_msg("%s has no %s", mark->script, use);
    }
}

/* Each option changes the picture, and so do costs and the text of the end card. */
TEST_WITH(every_option_changes_the_picture, make, destroy) {
    const Moment moment = moment_stored(25), end = {MOMENT_END, FRAMES - 1, 0, 1, 1};
    const uint64_t plain = hash_of(&(RenderLook){0}, 800, 450, moment);
    assert_true(hash_of(&(RenderLook){.theme = LOOK_DARK}, 800, 450, moment) != plain);
    assert_true(hash_of(&(RenderLook){.costs = {NULL, "8 s"}}, 800, 450, moment) != plain);
    assert_true(hash_of(&(RenderLook){0}, 800, 450, (Moment){MOMENT_STORED, 25, 0, 4, 4}) != plain); /* slow motion */
    assert_true(hash_of(&(RenderLook){.end = "Over"}, 800, 450, end) != hash_of(&(RenderLook){0}, 800, 450, end));
}

RUN_TESTS(NULL, NULL)
