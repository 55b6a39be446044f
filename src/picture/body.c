/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/body.h"

#include "picture/panel.h"
#include "picture/pose.h"

/* In units of a box's shorter side; the values are chosen by eye. */
static const double CORNER = 0.11, OUTLINE = 0.045, BAND = 0.13, TARGET = 0.30;
static const double MIN_OUTLINE = 1.0;       /* pixels */
static const double MIN_OUTLINED_SIDE = 5.0; /* pixels; a smaller box has no outline */
static const double MAX_CORNER = 0.009;      /* relative to shorter side of the panel */
static const double MAX_OUTLINE = 0.0026;
static const double GHOST_OUTLINE =
    0.0034; /* thickness of an outline drawn without its box / shorter side of the panel */
static const double MIN_GHOST_OUTLINE = 1.6; /* pixels */
static const double NESTED_TOTAL = 1.2;      /* overlay: the first outline is at most this many thicknesses thicker than
                                           the last */
static const double NESTED_STEP = 0.7;       /* from one outline to the next, at most */
static const double FADE = 0.55;             /* share of the panel's colour in boxes behind outlines */

/* A box of the given width and height in pixels, not rotated, at (0, 0). */
static Shape styled_box(const Picture *picture, double width, double height, const BodyColors *colors) {
    Rect panel = picture->layout.panels[0];
    double side = fmin(width, height), limit = fmin(panel.right - panel.left, panel.bottom - panel.top);
    double outline = fmin(fmax(OUTLINE * side, MIN_OUTLINE), fmax(MAX_OUTLINE * limit, MIN_OUTLINE));
    return (Shape){.half_width = width / 2,
                   .half_height = height / 2,
                   .cosine = 1,
                   .radius = fmin(CORNER * side, MAX_CORNER * limit),
                   .outline = side < MIN_OUTLINED_SIDE ? 0 : outline,
                   .fill = colors->fill,
                   .line = colors->line,
                   .band = (side < MIN_OUTLINED_SIDE ? 0 : outline) + BAND * side,
                   .band_color = colors->band};
}

static void place(Shape *shape, const Picture *picture, int panel, const Pose *pose) {
    Point at = panel_point(picture, panel, pose->x, pose->y);
    shape->x = at.x, shape->y = at.y;
    shape->cosine = cos(pose->angle), shape->sine = sin(pose->angle);
}

static void draw_part(Shape part, const Shape *whole, double up, const Rect *clip, Drawing *drawing) {
    part.cosine = whole->cosine, part.sine = whole->sine;
    part.x = whole->x - up * whole->sine, part.y = whole->y - up * whole->cosine;
    drawing_add_shape(drawing, &part, clip);
}

/* A dot in a ring, and a bar from the ring towards the local top. */
static void draw_target(const Shape *bomb, double radius, uint32_t light, const Rect *clip, Drawing *drawing) {
    Shape bar = {.half_width = radius / 7, .half_height = 0.3 * radius, .fill = light};
    Shape ring = {.half_width = radius, .half_height = radius, .radius = radius, .outline = radius / 3};
    Shape dot = {.half_width = radius / 3, .half_height = radius / 3, .radius = radius / 3, .fill = light};
    ring.fill = bomb->fill, ring.line = light;
    draw_part(bar, bomb, 1.2 * radius, clip, drawing);
    draw_part(ring, bomb, 0, clip, drawing);
    draw_part(dot, bomb, 0, clip, drawing);
}

/* Filled by the colour scale of the distance; the band contrasts with both its ends. Grey if there is no distance. */
static BodyColors distance_colors(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    const Trajectory *first = picture->runs[0], *other = picture->runs[run];
    uint32_t line = picture_body_colors(picture, run)->line;
    bool ended = moment.frame >= first->frames || moment.frame >= other->frames;
    double distance = pose_distance(pose_at(first, moment, body), pose_at(other, moment, body));
    if (ended || isnan(distance)) return (BodyColors){theme->ground, line, theme->ground_line};
    double share = scales_share(&picture->scales, distance);
    uint32_t fill = theme_ramp(theme, share), white = 0xFFFFFF;
    bool is_light = (fill >> 8 & 255) > 140; /* green dominates luminance */
    return (BodyColors){fill, line, is_light ? theme_mix(fill, 0, 0.6) : theme_mix(fill, white, 0.7)};
}

static BodyColors colors_of(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    const Trajectory *trajectory = picture->runs[run];
    if (trajectory->fixed[body]) return (BodyColors){theme->ground, theme->ground_line, theme->ground};
    if (picture_colors_distance(picture, run)) return distance_colors(picture, run, moment, body);
    BodyColors colors = body == trajectory->bomb ? theme->bomb : *picture_body_colors(picture, run);
    if (picture->look.compare != LOOK_OVERLAY) return colors;
    return (BodyColors){theme_mix(colors.fill, theme->panel, FADE), colors.line,
                        theme_mix(colors.band, theme->panel, FADE)};
}

static Shape body_shape(const Picture *picture, int panel, int run, Moment moment, int body, const BodyColors *colors) {
    const Trajectory *trajectory = picture->runs[run];
    double scale = picture->camera.scale;
    Shape shape =
        styled_box(picture, scale * (double)trajectory->size[body].x, scale * (double)trajectory->size[body].y, colors);
    Pose pose = pose_at(trajectory, moment, body);
    place(&shape, picture, panel, &pose);
    return shape;
}

void body_draw(const Picture *picture, int panel, int run, Moment moment, int body, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    const Rect *clip = &picture->layout.panels[panel];
    bool fixed = trajectory->fixed[body], bomb = body == trajectory->bomb;
    BodyColors colors = colors_of(picture, run, moment, body);
    Shape shape = body_shape(picture, panel, run, moment, body, &colors);
    if (fixed) shape.radius = 0;
    if (fixed || bomb) shape.band = 0;
    drawing_add_shape(drawing, &shape, clip);
    double side = 2 * fmin(shape.half_width, shape.half_height);
    if (bomb) draw_target(&shape, TARGET * side, colors.band, clip, drawing);
}

void body_draw_all(const Picture *picture, int panel, int run, Moment moment, bool fixed, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    for (int body = 0; body < trajectory->bodies; body++)
        if ((trajectory->fixed[body] != 0) == fixed && body != trajectory->bomb)
            body_draw(picture, panel, run, moment, body, drawing);
}

/* The first run's bomb keeps its colour; the others have the colour of their run. */
static uint32_t outline_color(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    if (picture_colors_distance(picture, run)) return colors_of(picture, run, moment, body).fill;
    if (run > 0) return picture_body_colors(picture, run)->fill;
    return body == picture->runs[0]->bomb ? theme->bomb.fill : picture_ghost_color(picture, 0);
}

/* Coincident outlines of several runs: later ones are thinner, so all are visible. */
void body_draw_outlines(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    int above = picture->look.compare == LOOK_OVERLAY ? picture->count - 1 - run : 0;
    double thickness = fmax(GHOST_OUTLINE * panel_side(picture), MIN_GHOST_OUTLINE) *
                       (1 + above * fmin(NESTED_STEP, NESTED_TOTAL / picture->count));
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body]) continue;
        Shape shape = body_shape(picture, panel, run, moment, body, picture_body_colors(picture, run));
        shape.hollow = true;
        shape.line = outline_color(picture, run, moment, body);
        shape.outline = thickness;
        drawing_add_shape(drawing, &shape, &picture->layout.panels[panel]);
    }
}

int body_draw_swatch(const Picture *picture, int run, bool hollow, int left, int baseline, int pixels,
                     Drawing *drawing) {
    int side = pixels * 3 / 4;
    const BodyColors *colors = picture_body_colors(picture, run);
    Shape shape = styled_box(picture, side, side, colors);
    shape.x = left + side / 2.0;
    shape.y = baseline - side / 2.0;
    shape.hollow = hollow;
    if (hollow)
        shape.line = run == 0 ? picture_ghost_color(picture, 0) : colors->fill, shape.outline = fmax(2, side / 8.0);
    drawing_add_shape(drawing, &shape, &(Rect){left, baseline - side, left + side, baseline});
    return left + side;
}
