/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What must be in view, and what must not affect it. */
#include "owned.h"

#include "pictures/picture.h"
#include "pictures/runs.h"

static const int sizes[][2] = {{900, 880}, {1800, 880}, {300, 900}, {58, 56}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

static Trajectory *run;

FIXTURE(make) { run = run_make("engine", 12); }

FIXTURE(destroy) { trajectory_destroy(run); }

/* What a picture of this run alone shows in a panel of this size. */
static Camera fitted(int width, int height) {
    const CameraFrame frame = camera_frame((const Trajectory *[]){run}, 1);
    return camera_fit(&frame, width, height);
}

static void assert_inside(const Camera *camera, double x, double y, const int size[2]) {
    double left = camera->left + camera->scale * x, top = camera->top - camera->scale * y;
    if (left < 0 || left > size[0] || top < 0 || top > size[1])
        fail_msg("(%g, %g) is at pixel (%g, %g) of %d x %d", x, y, left, top, size[0], size[1]);
}

/* All corners of a body in a frame. */
static void assert_body_held(const Camera *camera, int frame, int body, const int size[2]) {
    for (int corner = 0; corner < 4; corner++) {
        Vec2 at = *run_position(run, frame, body), local = vec2_scale(0.5F, run->size[body]);
        if (corner & 1) local.x = -local.x;
        if (corner & 2) local.y = -local.y;
        at = vec2_add(at, mat22_multiply(mat22_rotation(*run_angle(run, frame, body)), local));
        assert_inside(camera, (double)at.x, (double)at.y, size);
    }
}

/* The bomb touches a box in this step. */
static void add_impact(int step) {
    const TrajectoryContact contact = {.a = SECOND_BOX, .b = BOMB_BODY, .normal = {0, 1}};
    add_contact(run, step, contact);
    trajectory_end_contacts(run);
}

TEST_WITH(what_stands_and_what_strikes_is_held, make, destroy) {
    add_impact(9);
    for (int i = 0; i < SIZES; i++)
        for (float far = 1; far < 3; far += 1) {
            *run_position(run, 0, FIRST_BOX) = vec2(-2 * far, 3 * far);
            *run_position(run, 5, BOMB_BODY) = vec2(4 * far, 5 * far);
            const Camera camera = fitted(sizes[i][0], sizes[i][1]);
            assert_body_held(&camera, 9, BOMB_BODY, sizes[i]);
            for (int body = FIRST_BOX; body <= SECOND_BOX; body++) assert_body_held(&camera, 0, body, sizes[i]);
            assert_inside(&camera, -2 * (double)far, -0.05, sizes[i]); /* the ground below a box in the air */
        }
}

/* Wherever a body flies after the impact, or less than half of all bodies without one, every frame has the same
   view. */
TEST_WITH(a_body_that_flies_off_changes_nothing, make, destroy) {
    static const float far[] = {20, 1e3F, 1e5F, 1e30F, NAN};
    for (int impact = 0; impact < 2; impact++) {
        if (impact) add_impact(5);
        const Camera before = fitted(900, 880);
        for (size_t i = 0; i < sizeof far / sizeof far[0]; i++)
            for (int body = FIRST_BOX; body <= (impact ? BOMB_BODY : FIRST_BOX); body++)
                for (int frame = 6; frame < run->frames; frame++) {
                    *run_position(run, frame, body) = vec2(-far[i] * (float)(frame - 5), far[i]);
                    const Camera camera = fitted(900, 880);
                    assert_memory_equal(&before, &camera, sizeof camera);
                }
    }
}

/* What a frame without marks draws depends on no later frame, in any panel: neither camera nor texts. */
TEST_WITH(no_mark_of_frame_0_moves, make, destroy) {
    OWN(Trajectory) *other = run_make("pair-net", 12);
    const Trajectory *panels[] = {run, other, run};
    for (int count = 1; count <= 3; count++) {
        Drawing drawings[2] = {{0}, {0}};
        for (int i = 0; i < 2; i++) {
            Picture picture;
            for (int frame = 8; frame < 12; frame++) {
                run_position(run, frame, FIRST_BOX)->x = i == 0 ? -2 : 700;
                run_position(other, frame, SECOND_BOX)->y = i == 0 ? 0.5F : 90;
            }
            assert_ok(picture_plan(&picture, panels, count, 1280, 720, &error), error);
            picture_draw(&picture, moment_stored(0), &drawings[i]);
        }
        const Drawing *a = &drawings[0], *b = &drawings[1];
        assert_true(a->rect_count == b->rect_count && a->shape_count == b->shape_count &&
                    a->glyph_count == b->glyph_count);
        assert_memory_equal(a->rects, b->rects, a->rect_count * sizeof *a->rects);
        assert_memory_equal(a->shapes, b->shapes, a->shape_count * sizeof *a->shapes);
        assert_memory_equal(a->glyphs, b->glyphs, a->glyph_count * sizeof *a->glyphs);
        for (int i = 0; i < 2; i++) drawing_free(&drawings[i]);
    }
}

/* What falls over near in half of the runs is in view; in one of three it counts for nothing, nor does a sag. */
TEST_WITH(what_half_of_the_runs_do_is_in_view, make, destroy) {
    Trajectory *others[2] = {run_make("momentum", 12), run_make("pair-net", 12)};
    const Trajectory *panels[] = {run, others[0], others[1]};
    add_impact(5);
    for (int i = 0; i < SIZES; i++) {
        const CameraFrame stands = camera_frame(panels, 3);
        const Camera before = camera_fit(&stands, sizes[i][0], sizes[i][1]);
        for (int frame = 6; frame < 12; frame++) run_position(others[0], frame, FIRST_BOX)->x = -3.8F;
        const CameraFrame one = camera_frame(panels, 3);
        const Camera same = camera_fit(&one, sizes[i][0], sizes[i][1]);
        assert_memory_equal(&before, &same, sizeof before);
        for (int frame = 6; frame < 12; frame++) run_position(others[1], frame, FIRST_BOX)->x = -3.8F;
        const CameraFrame two = camera_frame(panels, 3);
        const Camera farther = camera_fit(&two, sizes[i][0], sizes[i][1]);
        assert_inside(&farther, -4.3, 0.5, sizes[i]);
        assert_inside(&farther, 4.3, 0.5, sizes[i]); /* as far to the other side */
        assert_true(farther.scale <= before.scale && farther.scale > 0.68 * before.scale);
        for (int frame = 6; frame < 12; frame++)
            run_position(others[0], frame, FIRST_BOX)->x = run_position(others[1], frame, FIRST_BOX)->x = -2;
    }
    for (int i = 0; i < 2; i++) trajectory_destroy(others[i]);
}

/* On a slope without a view of its own, nothing stays where it starts. */
TEST_WITH(where_most_bodies_leave_all_their_way_is_held, make, destroy) {
    for (int frame = 1; frame < run->frames; frame++) {
        run_position(run, frame, FIRST_BOX)->x += 5 * (float)frame;
        run_position(run, frame, SECOND_BOX)->x += 6 * (float)frame;
    }
    for (int i = 0; i < SIZES; i++) {
        const Camera camera = fitted(sizes[i][0], sizes[i][1]);
        for (int frame = 0; frame < run->frames; frame++)
            for (int body = FIRST_BOX; body <= SECOND_BOX; body++) assert_body_held(&camera, frame, body, sizes[i]);
    }
}

/* A bomb from 1 km away is not framed: nothing else could be made out. */
TEST_WITH(a_bomb_from_far_away_does_not_count, make, destroy) {
    add_impact(9);
    const Camera near = fitted(900, 880);
    *run_position(run, 2, BOMB_BODY) = vec2(700, 700);
    const Camera far = fitted(900, 880);
    assert_true(far.scale >= near.scale);
}

/* Boxes on the ground, from -2 m to 2 m and 5 m high; the bomb comes by this way from the left or the right. */
static Camera struck(float side, Vec2 way, const int size[2]) {
    *run_position(run, 0, FIRST_BOX) = vec2(-1.5F, 0.5F);
    *run_position(run, 0, SECOND_BOX) = vec2(1.5F, 4.5F);
    run->size[FIRST_BOX] = run->size[SECOND_BOX] = vec2(1, 1);
    *run_angle(run, 0, FIRST_BOX) = *run_angle(run, 0, SECOND_BOX) = 0;
    for (int frame = 2; frame < run->frames; frame++) {
        const float left = frame < 8 ? (float)(8 - frame) / 6 : 0; /* of the way */
        *run_position(run, frame, BOMB_BODY) = vec2(side * (2.5F + left * way.x), 2.5F + left * way.y);
    }
    return fitted(size[0], size[1]);
}

TEST_WITH(what_is_struck_from_the_side_has_room_to_fall, make, destroy) {
    add_impact(9);
    for (int i = 0; i < SIZES; i++) {
        const Camera from_left = struck(-1, vec2(4, 1), sizes[i]), from_right = struck(1, vec2(4, 1), sizes[i]);
        const Camera above_left = struck(-1, vec2(4, 4.1F), sizes[i]), above_right = struck(1, vec2(4, 4.1F), sizes[i]);
        assert_true(from_left.left <= above_left.left && from_right.left >= above_right.left);
        assert_true(i != 1 || from_left.left < above_left.left - from_left.scale);
    }
    const Camera wide = struck(-1, vec2(4, 1), sizes[1]);
    assert_inside(&wide, 2 + 5, 0, sizes[1]);
}

enum { TOWER = 8 };

/* A tower of boxes this far apart, which is this high when the bomb strikes it in frame 9. */
static Camera dropped(float spacing, float height) {
    trajectory_destroy(run);
    run = run_sized(12, TOWER + 1);
    run->bomb = BOMB_BODY, run->dt = 1.0F / 60;
    for (int body = 0; body <= TOWER; body++) {
        const float place = (float)(body < BOMB_BODY ? body : body - 1);
        run->size[body] = vec2(1, 1);
        for (int frame = 0; frame < 12; frame++)
            *run_angle(run, frame, body) = 0,
                                   *run_position(run, frame, body) =
                                       body == BOMB_BODY
                                           ? vec2(0.9F, 2)
                                           : vec2(0, place * (frame < 8 ? spacing : (height - 1) / (TOWER - 1)));
    }
    add_impact(9);
    return fitted(900, 900);
}

/* Boxes that fall together before they are struck may begin above the picture, but not most of them; in steps, so that
   a little less is the same view. A sag changes nothing. */
TEST_WITH(what_falls_together_is_framed_as_it_is_struck, make, destroy) {
    const Camera stands = dropped(1, 8), falls = dropped(1.25F, 8), little = dropped(1.25F, 7.98F), far = dropped(2, 8);
    const Camera loose = dropped(1.25F, 9.75F), sags = dropped(1.25F, 9);
    assert_memory_equal(&loose, &sags, sizeof loose);
    assert_true(falls.scale > 1.1 * loose.scale && falls.scale <= stands.scale);
    assert_memory_equal(&falls, &little, sizeof falls);
    assert_true(far.scale * 15 <= 900); /* or half of the boxes would be above the picture */
}

/* With room at both sides, the boxes from -2.5 m to 3 m are in the middle, wherever the bomb comes from. */
TEST_WITH(what_stands_is_in_the_middle, make, destroy) {
    add_impact(9);
    for (float x = -4; x <= 4; x += 2) {
        for (int frame = 2; frame < run->frames; frame++) run_position(run, frame, BOMB_BODY)->x = x;
        const Camera camera = fitted(1800, 880);
        assert_true(fabs(camera.left + camera.scale * 0.25 - 900) <= 1);
    }
}

/* The ground is 100 m wide, the movement 5 m. */
TEST_WITH(the_ground_does_not_count, make, destroy) {
    Camera camera = fitted(900, 880), without;
    assert_true(camera.scale > 900 / 12.0);
    run->size[GROUND_BODY] = vec2(5000, 20);
    without = fitted(900, 880);
    assert_memory_equal(&camera, &without, sizeof camera);
    assert_inside(&camera, 0, -0.1, sizes[0]); /* but its top is visible */
}

TEST_WITH(grid_lines_fall_between_pixels, make, destroy) {
    for (int i = 0; i < SIZES; i++) {
        Camera camera = fitted(sizes[i][0], sizes[i][1]);
        assert_true(camera.left == rint(camera.left) && camera.top == rint(camera.top));
        assert_true(camera.scale < 12 || camera.scale == rint(camera.scale));
    }
}

TEST_WITH(what_the_scene_asks_for_is_shown, make, destroy) {
    run->camera_center = vec2(3, 4);
    run->camera_size = vec2(40, 10);
    for (int i = 0; i < SIZES; i++) {
        Camera camera = fitted(sizes[i][0], sizes[i][1]);
        assert_inside(&camera, 3 - 20 + 0.1, 4 - 5 + 0.1, sizes[i]);
        assert_inside(&camera, 3 + 20 - 0.1, 4 + 5 - 0.1, sizes[i]);
        assert_true(fabs(camera.left + camera.scale * 3 - sizes[i][0] / 2.0) <= 1);
        assert_true(fabs(camera.top - camera.scale * 4 - sizes[i][1] / 2.0) <= 1);
    }
}

/* The point in the middle of the panel and the view's corners. */
TEST_WITH(a_view_is_shown_where_it_is, make, destroy) {
    const CameraView view = {-3, 2, 8, 3};
    for (int i = 0; i < SIZES; i++) {
        const CameraFrame frame = camera_frame_of(&view);
        const Camera camera = camera_fit(&frame, sizes[i][0], sizes[i][1]);
        assert_inside(&camera, -7 + 0.05, 0.5 + 0.05, sizes[i]);
        assert_inside(&camera, 1 - 0.05, 3.5 - 0.05, sizes[i]);
        assert_true(fabs(camera.left - 3 * camera.scale - sizes[i][0] / 2.0) <= 1);
        assert_true(fabs(camera.top - 2 * camera.scale - sizes[i][1] / 2.0) <= 1);
    }
}

static Camera camera_with(const RenderLook *look) {
    Picture picture;
    Error error = {0};
    const RenderOptions options = {.width = 1280, .height = 720, .look = *look};
    assert_ok(picture_plan(&picture, (const Trajectory *[]){run}, 1, 1280, 720, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    picture_free(&picture);
    return picture.camera;
}

TEST_WITH(a_look_sets_the_view, make, destroy) {
    Trajectory *other = run_make("engine", 12), *first = run;
    run_position(other, 0, FIRST_BOX)->x = -9;
    run = other;
    const Camera others = camera_with(&(RenderLook){0});
    run = first;
    const Camera own = camera_with(&(RenderLook){0}), borrowed = camera_with(&(RenderLook){.view_from = other});
    const Camera set = camera_with(&(RenderLook){.view = {1, 2, 30, 4}, .view_from = other});
    assert_true(memcmp(&own, &others, sizeof own) != 0);
    assert_memory_equal(&borrowed, &others, sizeof others);
    const RenderLook wrong = {.view = {1, 2, 30, -4}};
    assert_refused(look_check(&wrong, (const Trajectory *[]){run}, 1, &error), "cannot be drawn");
    assert_true(set.scale < 45 && set.scale > 30); /* about 1230 pixels for 30 m */
    trajectory_destroy(other);
}

/* What a network does counts for no panel; a box that stands elsewhere in its run does, if it is not far away. */
TEST_WITH(the_start_of_all_panels_counts, make, destroy) {
    OWN(Trajectory) *network = run_make("pair-net", 12);
    const Trajectory *panels[] = {run, network};
    Picture calm, wild;
    for (float away = 4; away < 5000; away *= 1000) {
        run_position(network, 0, FIRST_BOX)->x = -away;
        const CameraFrame one = camera_frame(panels, 1), two = camera_frame(panels, 2);
        assert_near(two.held.right, one.held.right, away < 10 ? 1 : 0);
        assert_true((two.held.left < -4.5) == (away < 10));
    }
    run_position(network, 0, FIRST_BOX)->x = -2;
    assert_ok(picture_plan(&calm, panels, 2, 1280, 720, &error), error);
    for (int frame = 5; frame < 12; frame++) *run_position(network, frame, FIRST_BOX) = vec2(1e4F, 1e6F);
    assert_ok(picture_plan(&wild, panels, 2, 1280, 720, &error), error);
    assert_memory_equal(&calm.camera, &wild.camera, sizeof calm.camera);
}

TEST_WITH(wild_numbers_leave_a_camera, make, destroy) {
    static const float bad[] = {NAN, INFINITY, -INFINITY, 3e38F, -3e38F, 0};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        for (int body = 0; body < RUN_BODIES; body++)
            for (int frame = 0; frame < run->frames; frame++) *run_position(run, frame, body) = vec2(bad[i], bad[i]);
        Camera camera = fitted(900, 880);
        assert_true(isfinite(camera.left) && isfinite(camera.top) && camera.scale > 0);
    }
}

RUN_TESTS(NULL, NULL)
