/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/panel.h"

#include "render/grid.h"
#include "render/style.h"

#include <math.h>

/* Shares of a box's shorter side, in words: what looks right at every size. */
static const double CORNER = 0.11, OUTLINE = 0.045, BAND = 0.13, TARGET = 0.30;
static const double LEAST_OUTLINE = 1.0;    /* pixels */
static const double LEAST_OUTLINED = 5.0;   /* pixels; a smaller box would be all outline */
static const double LARGEST_CORNER = 0.009; /* of the panel's shorter side */
static const double LARGEST_OUTLINE = 0.0026;

static const BodyColors body_colors[RENDER_PANELS_MAX] = {
    {0x0072B2, 0x00395C, 0x4FA6D8}, /* blue: the physics, or whatever comes first */
    {0xE69F00, 0x7A4F00, 0xFFD47A}, /* orange */
    {0x009E73, 0x004D38, 0x5CCBAA}, /* bluish green */
    {0xCC79A7, 0x6E2F52, 0xEBBBD5}, /* reddish purple */
    {0x56B4E9, 0x1D5F87, 0xB5DFF7}, /* sky blue */
    {0xD8CB2B, 0x6B640E, 0xF4EDA0}, /* yellow, darkened to stand out from white */
};

/* A box of the width and height given in pixels, upright in the middle of nowhere. */
static Shape styled_box(const Picture *picture, double width, double height, const BodyColors *colors) {
    Rect panel = picture->layout.panels[0];
    double side = fmin(width, height), limit = fmin(panel.right - panel.left, panel.bottom - panel.top);
    double outline = fmin(fmax(OUTLINE * side, LEAST_OUTLINE), fmax(LARGEST_OUTLINE * limit, LEAST_OUTLINE));
    return (Shape){.half_width = width / 2,
                   .half_height = height / 2,
                   .cosine = 1,
                   .radius = fmin(CORNER * side, LARGEST_CORNER * limit),
                   .outline = side < LEAST_OUTLINED ? 0 : outline,
                   .fill = colors->fill,
                   .line = colors->line,
                   .band = (side < LEAST_OUTLINED ? 0 : outline) + BAND * side,
                   .band_color = colors->band};
}

static void place(Shape *shape, const Picture *picture, const Rect *panel, Vec2 position, double angle) {
    const Camera *camera = &picture->camera;
    shape->x = panel->left + camera->left + camera->scale * (double)position.x;
    shape->y = panel->top + camera->top - camera->scale * (double)position.y;
    shape->cosine = cos(angle);
    shape->sine = sin(angle);
}

static void draw_part(Shape part, const Shape *whole, double up, const Rect *clip, Drawing *drawing) {
    part.cosine = whole->cosine, part.sine = whole->sine;
    part.x = whole->x - up * whole->sine, part.y = whole->y - up * whole->cosine;
    drawing_add_shape(drawing, &part, clip);
}

/* A dot in a ring, and a bar from it towards the local top. */
static void draw_target(const Shape *bomb, double radius, const Rect *clip, Drawing *drawing) {
    uint32_t light = BOMB.band;
    Shape bar = {.half_width = radius / 7, .half_height = 0.3 * radius, .fill = light};
    Shape ring = {.half_width = radius, .half_height = radius, .radius = radius, .outline = radius / 3};
    Shape dot = {.half_width = radius / 3, .half_height = radius / 3, .radius = radius / 3, .fill = light};
    ring.fill = BOMB.fill, ring.line = light;
    draw_part(bar, bomb, 1.2 * radius, clip, drawing);
    draw_part(ring, bomb, 0, clip, drawing);
    draw_part(dot, bomb, 0, clip, drawing);
}

static void draw_body(const Picture *picture, int panel, int frame, int body, Drawing *drawing) {
    static const BodyColors ground = {GROUND, GROUND_LINE, GROUND};
    const Trajectory *trajectory = picture->panels[panel];
    const Rect *clip = &picture->layout.panels[panel];
    size_t i = (size_t)frame * (size_t)trajectory->bodies + (size_t)body;
    double width = picture->camera.scale * (double)trajectory->size[body].x;
    double height = picture->camera.scale * (double)trajectory->size[body].y;
    bool fixed = trajectory->fixed[body], bomb = body == trajectory->bomb;
    const BodyColors *colors = fixed ? &ground : bomb ? &BOMB : &body_colors[panel];
    Shape shape = styled_box(picture, width, height, colors);
    place(&shape, picture, clip, trajectory->position[i], (double)trajectory->angle[i]);
    if (fixed) shape.radius = 0;
    if (fixed || bomb) shape.band = 0;
    drawing_add_shape(drawing, &shape, clip);
    if (bomb) draw_target(&shape, TARGET * fmin(width, height), clip, drawing);
}

void panel_draw_bodies(const Picture *picture, int panel, int frame, bool fixed, Drawing *drawing) {
    const Trajectory *trajectory = picture->panels[panel];
    for (int body = 0; body < trajectory->bodies; body++)
        if ((trajectory->fixed[body] != 0) == fixed && body != trajectory->bomb)
            draw_body(picture, panel, picture_panel_frame(picture, panel, frame), body, drawing);
}

static void draw_frame(const Rect *r, int thickness, Drawing *drawing) {
    int left = r->left - thickness, right = r->right + thickness;
    drawing_add_rect(drawing, (Rect){left, r->top - thickness, right, r->top}, FRAME);
    drawing_add_rect(drawing, (Rect){left, r->bottom, right, r->bottom + thickness}, FRAME);
    drawing_add_rect(drawing, (Rect){left, r->top, r->left, r->bottom}, FRAME);
    drawing_add_rect(drawing, (Rect){r->right, r->top, right, r->bottom}, FRAME);
}

void panel_draw_still(const Picture *picture, int panel, int frame, Drawing *drawing) {
    const Rect *rect = &picture->layout.panels[panel];
    drawing_add_rect(drawing, *rect, PANEL);
    grid_draw_lines(picture, panel, drawing);
    panel_draw_bodies(picture, panel, frame, true, drawing);
    draw_frame(rect, picture->layout.hairline, drawing);
    grid_draw_axes(picture, panel, drawing);
}

void panel_draw_moving(const Picture *picture, int panel, int frame, Drawing *drawing) {
    int bomb = picture->panels[panel]->bomb;
    panel_draw_bodies(picture, panel, frame, false, drawing);
    if (bomb >= 0) draw_body(picture, panel, picture_panel_frame(picture, panel, frame), bomb, drawing);
}

int panel_count_unseen(const Picture *picture, int panel, int frame) {
    const Trajectory *trajectory = picture->panels[panel];
    const Rect *rect = &picture->layout.panels[panel];
    int shown = picture_panel_frame(picture, panel, frame), count = 0;
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body] || !trajectory_has(trajectory, shown, body)) continue;
        Shape shape = {0};
        place(&shape, picture, rect, trajectory->position[(size_t)shown * (size_t)trajectory->bodies + (size_t)body],
              0);
        bool inside = shape.x >= rect->left && shape.x < rect->right && shape.y >= rect->top && shape.y < rect->bottom;
        count += !inside;
    }
    return count;
}

int panel_draw_swatch(const Picture *picture, int panel, int left, int baseline, Drawing *drawing) {
    int side = picture->layout.title.pixels * 3 / 4;
    Shape shape = styled_box(picture, side, side, &body_colors[panel]);
    shape.x = left + side / 2.0;
    shape.y = baseline - side / 2.0;
    drawing_add_shape(drawing, &shape, &(Rect){left, baseline - side, left + side, baseline});
    return left + side;
}
