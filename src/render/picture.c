/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/picture.h"

#include "render/caption.h"
#include "render/panel.h"

#include <math.h>

static bool check_panels(const Trajectory *const *panels, int count, Error *error) {
    if (count < 1 || count > RENDER_PANELS_MAX)
        return error_input(error, "render", "%d panels asked for; 1 to %d can be shown", count, RENDER_PANELS_MAX);
    for (int i = 1; i < count; i++)
        if (panels[i]->dt != panels[0]->dt)
            return error_input(error, "render",
                               "panel %d (%s) has time steps of %g s and the first of %g s: their frames are not of "
                               "the same times",
                               i + 1, panels[i]->method, (double)panels[i]->dt, (double)panels[0]->dt);
    return true;
}

static bool check_size(int width, int height, Error *error) {
    if (width >= RENDER_LEAST_SIDE && height >= RENDER_LEAST_SIDE && width <= RENDER_LARGEST_SIDE &&
        height <= RENDER_LARGEST_SIDE)
        return true;
    return error_input(error, "render", "a picture of %d x %d pixels asked for; each side can be %d to %d", width,
                       height, RENDER_LEAST_SIDE, RENDER_LARGEST_SIDE);
}

static double largest_apart(const Picture *picture) {
    double largest = 0;
    for (int frame = 0; frame < picture->frames; frame++) largest = fmax(largest, picture_apart(picture, frame));
    return largest;
}

bool picture_plan(Picture *picture, const Trajectory *const *panels, int count, int width, int height, Error *error) {
    if (!check_size(width, height, error) || !check_panels(panels, count, error)) return false;
    *picture = (Picture){.count = count, .layout = layout_make(width, height, count)};
    for (int i = 0; i < count; i++) {
        picture->panels[i] = panels[i];
        if (panels[i]->frames > picture->frames) picture->frames = panels[i]->frames;
    }
    Rect first = picture->layout.panels[0];
    picture->camera = camera_fit(panels[0], first.right - first.left, first.bottom - first.top);
    picture->largest_apart = largest_apart(picture);
    return true;
}

bool picture_dress(Picture *picture, const RenderOptions *options, Error *error) {
    (void)error;
    picture->title = options->title;
    for (int i = 0; i < picture->count; i++) picture->notes[i] = options->notes[i];
    return true;
}

void picture_free(Picture *picture) { (void)picture; }

int picture_panel_frame(const Picture *picture, int panel, int frame) {
    int last = picture->panels[panel]->frames - 1;
    return frame < last ? frame : last;
}

double picture_apart(const Picture *picture, int frame) {
    double largest = NAN;
    for (int i = 1; i < picture->count; i++) {
        if (frame >= picture->panels[0]->frames || frame >= picture->panels[i]->frames) continue;
        largest = fmax(largest, trajectory_distance(picture->panels[0], picture->panels[i], frame));
    }
    return largest;
}

void picture_draw(const Picture *picture, Moment moment, Drawing *drawing) {
    const int frame = moment.frame;
    for (int i = 0; i < picture->count; i++) panel_draw_still(picture, i, frame, drawing);
    drawing->still_shapes = drawing->shape_count;
    caption_header(picture, frame, drawing);
    for (int i = 0; i < picture->count; i++) {
        caption_panel(picture, i, frame, drawing);
        panel_draw_moving(picture, i, frame, drawing);
    }
}
