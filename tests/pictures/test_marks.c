/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact points and arrows are in proportion to the panel, but never cover the boxes; an arrow points to a bomb
   outside. */
#include "testing.h"
#include "owned_drawings.h"

#include "pictures/pictures_internal.h"
#include "pictures/look_runs.h"

/* All boxes are 1 m high; the view is `metres` wide. */
static Picture picture_of(double metres) {
    Picture picture;
    Error error = {0};
    const RenderOptions options = {.width = 1280,
                                   .height = 720,
                                   .look = {.show = SHOW_CONTACTS | SHOW_IMPULSES, .view = {0, 1, metres, metres / 2}}};
    assert_ok(picture_plan(&picture, panels, 1, 1280, 720, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    return picture;
}

TEST_WITH(marks_shrink_with_the_boxes, make, destroy) {
    for (double metres = 4; metres < 1000; metres *= 1.5) {
        OWN(Picture) picture = picture_of(metres);
        const double box = picture.camera.scale, side = panel_side(&picture);
        assert_near(picture.scales.box, box, 1e-9);
        assert_true(marks_dot_radius(&picture) <= fmax(0.15 * box, 0.6));
        assert_true(marks_line_thickness(&picture) <= fmax(0.1 * box, 0.6));
        assert_true(picture.scales.max_arrow <= 4 * box && picture.scales.max_arrow <= 0.28 * side);
    }
}

TEST_WITH(beside_large_boxes_marks_have_the_panels_proportions, make, destroy) {
    OWN(Picture) near = picture_of(4), nearer = picture_of(2);
    assert_near(marks_dot_radius(&near), marks_dot_radius(&nearer), 0);
    assert_near(marks_line_thickness(&near), marks_line_thickness(&nearer), 0);
    assert_near(near.scales.max_arrow, nearer.scales.max_arrow, 0);
}

/* Thin arrows have no halo: of 5,000 boxes nothing else would be seen. */
TEST(a_thin_arrow_is_drawn_once) {
    const Rect clip = {0, 0, 100, 100};
    for (double thickness = 0.6; thickness < 4; thickness += 0.2) {
        OWN(Drawing) drawing = {0};
        const ArrowStyle style = {thickness, 1, 2};
        stroke_arrow(&drawing, (Point){20, 20}, (Point){60, 20}, false, &style, &clip);
        assert_int_equal(drawing.shape_count,
                         thickness < 1.01 ? 3 : 6); /* a shaft and two sides of the head, each time */
    }
}

/* Where the pointer to the bomb is in the panel, from 0 to 1 on each axis, x from the bomb's; false if there is none.
   */
static bool find_pointer(Vec2 bomb, double *x, double *y) {
    Picture picture;
    Error error = {0};
    OWN(Drawing) drawing = {0};
    *run_position(runs[0], 5, BOMB_BODY) = bomb;
    assert_ok(picture_plan(&picture, panels, 1, 1280, 720, &error), error);
    marks_draw_above(&picture, 0, moment_stored(5), &drawing);
    const Rect *panel = &picture.layout.panels[0];
    const bool found = drawing.shape_count > 0;
    if (found) { /* the last shape of an arrow is a side of its head */
        const int32_t *bounds = drawing.shapes[drawing.shape_count - 1].bounds;
        *x = ((bounds[0] + bounds[2]) / 2.0 - panel->left) / (panel->right - panel->left);
        *y = ((bounds[1] + bounds[3]) / 2.0 - panel->top) / (panel->bottom - panel->top);
        assert_true(*x > 0 && *x < 1 && *y > 0 && *y < 1);
    }
    *x -= fmin(fmax(picture.camera.left + picture.camera.scale * (double)bomb.x, 0) / (panel->right - panel->left), 1);
    return found;
}

TEST_WITH(an_arrow_at_the_edge_points_to_a_bomb_outside, make, destroy) {
    double x, y;
    assert_false(find_pointer(vec2(1, 2), &x, &y));
    assert_false(find_pointer(vec2(NAN, NAN), &x, &y));
    assert_false(find_pointer(vec2(0, INFINITY), &x, &y));
    assert_true(find_pointer(vec2(0, 300), &x, &y) && fabs(x) < 0.02 && y < 0.15);
    assert_true(find_pointer(vec2(0, -300), &x, &y) && fabs(x) < 0.02 && y > 0.85);
    assert_true(find_pointer(vec2(-300, 1), &x, &y) && fabs(x) < 0.05 && y < 0.85);
    assert_true(find_pointer(vec2(300, 300), &x, &y) && fabs(x) < 0.1 && y < 0.15);
}

RUN_TESTS(NULL, NULL)
