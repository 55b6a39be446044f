/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of a picture's legend fit the room that the layout keeps for them. */
#include "testing.h"

#include "pictures/pictures_internal.h"
#include "pictures/runs.h"

enum { NARROWEST = 320, WIDEST = 1600, STEP = 8 };

/* Whether the layout is the one for the rows drawn. The scales, and by them the width of the entries, depend on the
   room that rows leave. */
static bool has_room_for_its_rows(const Trajectory *const *runs, const RenderLook *look, int width, int height) {
    Error error = {0};
    Picture picture;
    const RenderOptions options = {.width = width, .height = height, .look = *look};
    assert_ok(picture_plan(&picture, runs, 2, width, height, &error), error);
    assert_ok(picture_apply_options(&picture, &options, &error), error);
    const LayoutRows rows = {1, 1, legend_rows(&picture), false};
    const Layout layout = layout_make(width, height, picture.panel_count, picture.layout.columns, rows);
    const bool same = layout.legend_baseline == picture.layout.legend_baseline;
    if (!same) print_error("%d x %d: not the layout for %d rows\n", width, height, rows.legend);
    picture_free(&picture);
    return same;
}

TEST(the_layout_has_the_rows_that_are_drawn) {
    static const RenderLook looks[] = {
        {.show = SHOW_CONTACTS | SHOW_IMPULSES | SHOW_VELOCITIES},
        {.compare = LOOK_DIFFERENCE, .show = SHOW_TRAILS | SHOW_VELOCITIES | SHOW_CONTACTS}};
    Trajectory *runs[2] = {run_make("engine", 60), run_make("engine", 60)};
    run_position(runs[1], 59, FIRST_BOX)->x += 1;
    for (int frame = 0; frame < 60; frame++) runs[0]->velocity[frame * RUN_BODIES + FIRST_BOX].x = 3;
    bool same = true;
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
        for (int width = NARROWEST; width <= WIDEST; width += STEP)
            for (int height = width / 4; height <= width; height += width / 8)
                same &= has_room_for_its_rows((const Trajectory *const *)runs, &looks[i], width, height);
    assert_true(same);
    for (int i = 0; i < 2; i++) trajectory_destroy(runs[i]);
}

RUN_TESTS(NULL, NULL)
