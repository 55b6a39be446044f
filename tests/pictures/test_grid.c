/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both axes have at least three tics, however near the camera is. */
#include "testing.h"
#include "owned_drawings.h"

#include "pictures/picture.h"

/* Tics are the rectangles that touch the frame of the first panel from outside. */
static void count_tics(const Picture *picture, const Drawing *drawing, int *across, int *up) {
    const Rect panel = picture->layout.panels[0];
    const int line = picture->layout.hairline, tic = picture->layout.tick;
    *across = *up = 0;
    for (size_t i = 0; i < drawing->rect_count; i++) {
        const Rect rect = drawing->rects[i].rect;
        *across += rect.top == panel.bottom + line && rect.right - rect.left == line && rect.left >= panel.left &&
                   rect.left < panel.right;
        *up += rect.right == panel.left - line && rect.right - rect.left == tic && rect.bottom - rect.top == line;
    }
}

TEST(every_frame_has_three_tics_on_each_axis) {
    static const LookCamera cameras[] = {LOOK_FIT, LOOK_BOMB, LOOK_DIVERGENCE};
    Trajectory *runs[] = {trajectory_read(SOURCE_DIR "/golden/trajectories/stack-engine.npz", &error),
                          trajectory_read(SOURCE_DIR "/golden/gallery/stack-momentum.npz", &error)};
    assert_ok(runs[0] != NULL && runs[1] != NULL, error);
    for (int i = 0; i < 3; i++) {
        OWN(Picture) picture;
        OWN(Drawing) drawing = {0};
        const RenderOptions options = {.width = 960, .height = 540, .look.camera = cameras[i]};
        assert_ok(picture_plan(&picture, (const Trajectory *const *)runs, 2, 960, 540, &error), error);
        assert_ok(picture_apply_options(&picture, &options, &error), error);
        for (int frame = 0; frame < runs[0]->frames; frame += 4) {
            int across, up;
            drawing_clear(&drawing);
            picture_draw(&picture, moment_stored(frame), &drawing);
            count_tics(&picture, &drawing, &across, &up);
            if (across < 3 || up < 3) fail_msg("camera %d, frame %d: %d and %d tics", i, frame, across, up);
        }
    }
    trajectory_destroy(runs[0]);
    trajectory_destroy(runs[1]);
}

RUN_TESTS(NULL, NULL)
