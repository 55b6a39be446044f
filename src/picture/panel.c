/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/panel.h"

#include "picture/body.h"
#include "picture/grid.h"
#include "picture/marks.h"
#include "picture/pose.h"

#include <math.h>

Point panel_point(const Picture *picture, int panel, double x, double y) {
    const Camera *camera = &picture->camera;
    const Rect *rect = &picture->layout.panels[panel];
    return (Point){rect->left + camera->left + camera->scale * x, rect->top + camera->top - camera->scale * y};
}

double panel_side(const Picture *picture) {
    Rect panel = picture->layout.panels[0];
    return fmin(panel.right - panel.left, panel.bottom - panel.top);
}

static void draw_frame(const Rect *r, int thickness, uint32_t color, Drawing *drawing) {
    int left = r->left - thickness, right = r->right + thickness;
    drawing_add_rect(drawing, (Rect){left, r->top - thickness, right, r->top}, color);
    drawing_add_rect(drawing, (Rect){left, r->bottom, right, r->bottom + thickness}, color);
    drawing_add_rect(drawing, (Rect){left, r->top, r->left, r->bottom}, color);
    drawing_add_rect(drawing, (Rect){r->right, r->top, right, r->bottom}, color);
}

void panel_draw_static(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Rect *rect = &picture->layout.panels[panel];
    drawing_add_rect(drawing, *rect, picture->theme->panel);
    grid_draw_lines(picture, panel, drawing);
    body_draw_all(picture, panel, picture_run(picture, panel), moment, true, drawing);
    draw_frame(rect, picture->layout.hairline, picture->theme->frame, drawing);
    grid_draw_axes(picture, panel, drawing);
}

void panel_draw_moving(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int run = picture_run(picture, panel), bomb = picture->runs[run]->bomb;
    marks_draw_below(picture, panel, moment, drawing);
    body_draw_all(picture, panel, run, moment, false, drawing);
    if (bomb >= 0) body_draw(picture, panel, run, moment, bomb, drawing);
    for (int other = 0; other < picture->count; other++)
        if (picture_draws_outlines(picture, panel, other)) body_draw_outlines(picture, panel, other, moment, drawing);
    marks_draw_above(picture, panel, moment, drawing);
}

int panel_count_out_of_view(const Picture *picture, int panel, Moment moment) {
    int run = picture_run(picture, panel), count = 0;
    const Trajectory *trajectory = picture->runs[run];
    const Rect *rect = &picture->layout.panels[panel];
    int frame = pose_moment(trajectory, moment).frame;
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body] || !trajectory_has(trajectory, frame, body)) continue;
        Pose pose = pose_at(trajectory, moment, body);
        Point at = panel_point(picture, panel, pose.x, pose.y);
        bool inside = at.x >= rect->left && at.x < rect->right && at.y >= rect->top && at.y < rect->bottom;
        count += !inside;
    }
    return count;
}
