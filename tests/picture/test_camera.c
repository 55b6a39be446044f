/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What must be in view, and what must not affect it. */
#include "testing.h"

#include "picture/camera.h"
#include "picture/picture.h"
#include "render/runs.h"

static const int sizes[][2] = {{900, 880}, {1800, 880}, {300, 900}, {58, 56}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static Trajectory *run;

static int make(void **state) {
    (void)state;
    run = run_make("engine", 12);
    return 0;
}

static int destroy(void **state) {
    (void)state;
    trajectory_destroy(run);
    return 0;
}

static void assert_inside(const Camera *camera, double x, double y, const int size[2]) {
    double left = camera->left + camera->scale * x, top = camera->top - camera->scale * y;
    if (left < 0 || left > size[0] || top < 0 || top > size[1])
        fail_msg("(%g, %g) is at pixel (%g, %g) of %d x %d", x, y, left, top, size[0], size[1]);
}

static void assert_all_held(const Camera *camera, const int size[2]) {
    for (int frame = 0; frame < run->frames; frame++)
        for (int body = FIRST_BOX; body < RUN_BODIES; body++)
            for (int corner = 0; corner < 4 && trajectory_has(run, frame, body); corner++) {
                Vec2 at = *run_position(run, frame, body);
                Mat22 rotation = mat22_rotation(*run_angle(run, frame, body));
                Vec2 local = vec2_scale(0.5F, run->size[body]);
                if (corner & 1) local.x = -local.x;
                if (corner & 2) local.y = -local.y;
                at = vec2_add(at, mat22_multiply(rotation, local));
                assert_inside(camera, (double)at.x, (double)at.y, size);
            }
}

static void all_that_happens_is_held(void **state) {
    (void)state;
    for (int i = 0; i < SIZES; i++)
        for (float far = 1; far < 2000; far *= 5) {
            *run_position(run, 7, FIRST_BOX) = vec2(-far, 3 * far);
            *run_position(run, 9, SECOND_BOX) = vec2(far, -far);
            Camera camera = camera_fit(run, sizes[i][0], sizes[i][1]);
            assert_all_held(&camera, sizes[i]);
        }
}

/* The ground is 100 m wide, the movement 5 m. */
static void the_ground_does_not_count(void **state) {
    (void)state;
    Camera camera = camera_fit(run, 900, 880), without;
    assert_true(camera.scale > 900 / 12.0);
    run->size[GROUND_BODY] = vec2(5000, 20);
    without = camera_fit(run, 900, 880);
    assert_memory_equal(&camera, &without, sizeof camera);
    assert_inside(&camera, 0, -0.2, sizes[0]); /* but its top is visible */
}

static void grid_lines_fall_between_pixels(void **state) {
    (void)state;
    for (int i = 0; i < SIZES; i++) {
        Camera camera = camera_fit(run, sizes[i][0], sizes[i][1]);
        assert_true(camera.left == rint(camera.left) && camera.top == rint(camera.top));
        assert_true(camera.scale < 12 || camera.scale == rint(camera.scale));
    }
}

static void what_the_scene_asks_for_is_shown(void **state) {
    (void)state;
    run->camera_center = vec2(3, 4);
    run->camera_size = vec2(40, 10);
    for (int i = 0; i < SIZES; i++) {
        Camera camera = camera_fit(run, sizes[i][0], sizes[i][1]);
        assert_inside(&camera, 3 - 20 + 0.1, 4 - 5 + 0.1, sizes[i]);
        assert_inside(&camera, 3 + 20 - 0.1, 4 + 5 - 0.1, sizes[i]);
        assert_true(fabs(camera.left + camera.scale * 3 - sizes[i][0] / 2.0) <= 1);
        assert_true(fabs(camera.top - camera.scale * 4 - sizes[i][1] / 2.0) <= 1);
    }
}

static void only_the_first_panel_counts(void **state) {
    (void)state;
    Trajectory *network = run_make("pair-net", 12);
    const Trajectory *panels[] = {run, network};
    Picture calm, wild;
    Error error = {0};
    assert_ok(picture_plan(&calm, panels, 2, 1280, 720, &error), error);
    for (int frame = 5; frame < 12; frame++) *run_position(network, frame, FIRST_BOX) = vec2(1e4F, 1e6F);
    assert_ok(picture_plan(&wild, panels, 2, 1280, 720, &error), error);
    assert_memory_equal(&calm.camera, &wild.camera, sizeof calm.camera);
    trajectory_destroy(network);
}

static void wild_numbers_leave_a_camera(void **state) {
    (void)state;
    static const float bad[] = {NAN, INFINITY, -INFINITY, 3e38F, -3e38F, 0};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        for (int body = 0; body < RUN_BODIES; body++)
            for (int frame = 0; frame < run->frames; frame++) *run_position(run, frame, body) = vec2(bad[i], bad[i]);
        Camera camera = camera_fit(run, 900, 880);
        assert_true(isfinite(camera.left) && isfinite(camera.top) && camera.scale > 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_that_happens_is_held, make, destroy),
        cmocka_unit_test_setup_teardown(the_ground_does_not_count, make, destroy),
        cmocka_unit_test_setup_teardown(grid_lines_fall_between_pixels, make, destroy),
        cmocka_unit_test_setup_teardown(what_the_scene_asks_for_is_shown, make, destroy),
        cmocka_unit_test_setup_teardown(only_the_first_panel_counts, make, destroy),
        cmocka_unit_test_setup_teardown(wild_numbers_leave_a_camera, make, destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
