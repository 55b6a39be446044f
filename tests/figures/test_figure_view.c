/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of the world that figures of runs show. */
#include "owned.h"

#include "figures/run_figure.h"
#include "figures/figures_internal.h"

static const int frames[] = {0, 5, 11};
enum { COUNT = 3 };

static void assert_same(WorldWindow a, WorldWindow b) {
    assert_near(a.left, b.left, 1e-9);
    assert_near(a.bottom, b.bottom, 1e-9);
    assert_near(a.width, b.width, 1e-9);
    assert_near(a.height, b.height, 1e-9);
}

/* The box is in the middle in the frames before, and far away in the last one shown. */
TEST(a_body_that_has_flown_off_changes_nothing) {
    OWN(Trajectory) *run = run_make("engine", 12);
    const FigureSpec spec = spec_of(&run, 1);
    for (int frame = 0; frame < 12; frame++) *run_position(run, frame, FIRST_BOX) = vec2(0, 0.5F);
    const WorldWindow before = run_window(&spec, frames, COUNT);
    for (float far = 20; far < 1e30F; far *= 30) {
        *run_position(run, 11, FIRST_BOX) = vec2(-far, far);
        assert_same(run_window(&spec, frames, COUNT), before);
    }
}

static bool shows(const WorldWindow *window, double x, double y) {
    return x > window->left && x < window->left + window->width && y > window->bottom &&
           y < window->bottom + window->height;
}

/* A box of the second run falls farther than those of the first: their figure shows it. What flies off in the second
   run, or sinks into the ground, changes nothing, not even by where it was before. */
TEST(a_view_holds_what_all_runs_show) {
    Trajectory *runs[] = {run_make("engine", 12), run_make("pair-net", 12)};
    const FigureSpec one = spec_of(runs, 1), both = spec_of(runs, 2);
    *run_position(runs[1], 11, SECOND_BOX) = vec2(7, 0.5F);
    const WorldWindow first = run_window(&one, frames, COUNT), all = run_window(&both, frames, COUNT);
    assert_false(shows(&first, 5, 0.5));
    assert_true(shows(&all, 7.5, 0.5) && shows(&all, -2.5, 0.5));
    *run_position(runs[1], 5, SECOND_BOX) = vec2(7, 0.5F);
    const Vec2 gone[] = {{40, 1}, {0, 90}, {0, -2}};
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++) {
        *run_position(runs[1], 11, SECOND_BOX) = gone[i];
        assert_same(run_window(&both, frames, COUNT), first);
    }
    *run_position(runs[1], 11, BOMB_BODY) = vec2(7, 1.5F); /* which appears after the first of the frames */
    const WorldWindow bomb = run_window(&both, frames, COUNT);
    assert_true(shows(&bomb, 7.5, 1.5));
    for (int i = 0; i < 2; i++) trajectory_destroy(runs[i]);
}

TEST(a_view_is_that_of_the_spec_or_of_another_run) {
    Trajectory *runs[] = {run_make("engine", 12), run_make("engine", 4)};
    run_position(runs[1], 0, FIRST_BOX)->x = -9;
    FigureSpec spec = spec_of(runs, 1);
    const FigureSpec others = spec_of(runs + 1, 1);
    spec.view_from = runs[1];
    assert_same(run_window(&spec, frames, 1), run_window(&others, frames, 1));
    run_window(&spec, frames, COUNT); /* frames beyond the other run's last */
    runs[1]->camera_center = vec2(1, 2), runs[1]->camera_size = vec2(6, 4);
    assert_same(run_window(&spec, frames, COUNT), (WorldWindow){-2, 0, 6, 4});
    spec.view_from = NULL;
    spec.view = (CameraView){3, 5, 8, 2};
    assert_same(run_window(&spec, frames, COUNT), (WorldWindow){-1, 4, 8, 2});
    for (int i = 0; i < 2; i++) trajectory_destroy(runs[i]);
}

RUN_TESTS(NULL, NULL)
