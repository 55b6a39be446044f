/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies in panels: boxes with their labels, and outlines. */
#include "engine/engine.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A box of the given width and height in pixels, not rotated, at (0, 0). */
static Shape styled_box(const Picture *picture, double width, double height, const BodyColors *colors) {
    double side = fmin(width, height), limit = panel_side(picture);
    double outline = fmin(fmax(OUTLINE * side, MIN_OUTLINE), fmax(MAX_OUTLINE * limit, MIN_OUTLINE));
    if (side < MIN_OUTLINED_SIDE) outline = 0;
    return (Shape){.half_width = width / 2,
                   .half_height = height / 2,
                   .cosine = 1,
                   .radius = fmin(CORNER * side, MAX_CORNER * limit),
                   .outline = outline,
                   .fill = colors->fill,
                   .line = colors->line,
                   .band = outline + BAND * side,
                   .band_color = colors->band};
}

Shape body_shape(const Picture *picture, int panel, int run, Moment moment, int body, const BodyColors *colors) {
    const Trajectory *trajectory = picture->runs[run];
    const double scale = picture->camera.scale;
    const Vec2 size = trajectory->size[body];
    const Pose pose = pose_at(trajectory, moment, body);
    const Point at = panel_point(picture, panel, pose.x, pose.y);
    Shape shape = styled_box(picture, scale * (double)size.x, scale * (double)size.y, colors);
    shape.x = at.x, shape.y = at.y;
    shape.cosine = cos(pose.angle), shape.sine = sin(pose.angle);
    return shape;
}

static BodyColors colors_of(const Picture *picture, int run, Moment moment, int body) {
    const Theme *theme = picture->theme;
    const Trajectory *first = picture->runs[0], *own = picture->runs[run];
    if (own->fixed[body]) return (BodyColors){theme->ground, theme->ground_line, theme->ground};
    if (picture_colors_distance(picture, run)) {
        /* By the colour scale; the band contrasts with both its ends. Grey if there is no distance. */
        const uint32_t line = picture_body_colors(picture, run)->line;
        const bool ended = moment.frame >= first->frames || moment.frame >= own->frames;
        const double distance = pose_distance(pose_at(first, moment, body), pose_at(own, moment, body));
        if (ended || isnan(distance)) return (BodyColors){theme->ground, line, theme->ground_line};
        const uint32_t fill = theme_ramp(theme, scales_share(&picture->scales, distance)), white = 0xFFFFFF;
        const bool light = (int)(fill >> 8 & 255) > LIGHT_GREEN;
        return (BodyColors){fill, line, light ? theme_mix(fill, 0, BAND_DARKER) : theme_mix(fill, white, BAND_LIGHTER)};
    }
    const BodyColors colors = body == own->bomb ? theme->bomb : *picture_body_colors(picture, run);
    if (picture->look.compare != LOOK_OVERLAY) return colors;
    return (BodyColors){theme_mix(colors.fill, theme->panel, FADE), colors.line,
                        theme_mix(colors.band, theme->panel, FADE)};
}

/* Text in a box: a number, a name, or up to three digits of a mass, as the page's script writes numbers. */
static void label_text(const Picture *picture, int run, int body, char *text, size_t size) {
    const Trajectory *trajectory = picture->runs[run];
    text[0] = '\0';
    if (picture->look.labels == LOOK_NUMBERS) snprintf(text, size, "%d", body);
    if (picture->look.labels == LOOK_NAMES) snprintf(text, size, "%s", trajectory->name[body].text);
    if (picture->look.labels != LOOK_MASSES) return;
    char rounded[32];
    snprintf(rounded, sizeof rounded, "%.2e", (double)trajectory->mass[body]);
    const int exponent = atoi(strchr(rounded, 'e') + 1), places = exponent < 2 ? 2 - exponent : 0;
    snprintf(text, size, "%.*f", places, strtod(rounded, NULL));
    if (places == 0) return;
    size_t end = strlen(text);
    while (text[end - 1] == '0') end--;
    if (text[end - 1] == '.') end--;
    text[end] = '\0';
}

static bool is_light(uint32_t color) {
    const double red = (color >> 16 & 255) / 255.0, green = (color >> 8 & 255) / 255.0, blue = (color & 255) / 255.0;
    return RED_LIGHT * red * red + GREEN_LIGHT * green * green + BLUE_LIGHT * blue * blue > LABEL_DARK_FROM;
}

bool body_label(const Picture *picture, int panel, int run, int body, const Shape *shape, BodyLabel *label) {
    char *text = label->text;
    if (picture->runs[run]->fixed[body]) return false;
    label_text(picture, run, body, text, sizeof label->text);
    if (text[0] == '\0') return false;
    /* Width / size of the letters: digits take the same room whatever they are, letters of a name what they need. */
    double ems = LABEL_EMS * fmax((double)strlen(text), LABEL_DIGITS);
    if (picture->look.labels == LOOK_NAMES) {
        const Font font = font_pick(FONT_SEMIBOLD, LABEL_MEASURED);
        ems = fmax(font_width(&font, text) / (double)font.pixels, LABEL_EMS * LABEL_DIGITS);
    }
    const double side = 2 * fmin(shape->half_width, shape->half_height);
    const double most = LABEL_CIRCLE * side / sqrt(ems * ems + LABEL_CAP * LABEL_CAP);
    const Rect *rect = &picture->layout.panels[panel];
    const double least = fmax(picture->label_least, LABEL_LEAST);
    const Font font = font_pick(FONT_SEMIBOLD, fmax(most, least));
    const int width = font_width(&font, text), height = (int)ceil(LABEL_CAP * font.pixels);
    if (!(most >= least || width * width + height * height <= side * side) ||
        !(shape->x > rect->left && shape->x < rect->right) || !(shape->y > rect->top && shape->y < rect->bottom))
        return false;
    const int left = (int)rint(shape->x - width / 2.0), baseline = (int)rint(shape->y + height / 2.0);
    if (left < rect->left || left + width > rect->right || baseline - height < rect->top || baseline > rect->bottom)
        return false;
    label->font = font, label->left = left, label->baseline = baseline;
    label->ink = is_light(shape->fill) ? INK : PANEL;
    return true;
}

/* A dot in a ring, and a bar from the ring towards the local top. */
static void draw_target(const Shape *bomb, uint32_t light, const Rect *clip, Drawing *drawing) {
    const double radius = TARGET * 2 * fmin(bomb->half_width, bomb->half_height), third = radius / TARGET_THIRD;
    const Shape parts[] = {
        {.half_width = radius / TARGET_BAR, .half_height = TARGET_BAR_HEIGHT * radius, .fill = light},
        {.half_width = radius,
         .half_height = radius,
         .radius = radius,
         .outline = third,
         .fill = bomb->fill,
         .line = light},
        {.half_width = third, .half_height = third, .radius = third, .fill = light}};
    const double up[] = {TARGET_BAR_RISE * radius, 0, 0};
    for (int i = 0; i < 3; i++) {
        Shape part = parts[i];
        part.cosine = bomb->cosine, part.sine = bomb->sine;
        part.x = bomb->x - up[i] * bomb->sine, part.y = bomb->y - up[i] * bomb->cosine;
        drawing_add_shape(drawing, &part, clip);
    }
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
    BodyLabel label;
    const bool labelled = body_label(picture, panel, run, body, &shape, &label);
    if (labelled && !picture->labels_apart)
        font_add(drawing, &label.font, label.text, label.left, label.baseline, label.ink);
    if (bomb && !labelled) draw_target(&shape, colors.band, clip, drawing);
}

void body_draw_all(const Picture *picture, int panel, int run, Moment moment, bool fixed, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    for (int body = 0; body < trajectory->bodies; body++)
        if ((trajectory->fixed[body] != 0) == fixed && body != trajectory->bomb)
            body_draw(picture, panel, run, moment, body, drawing);
}

/* Coincident outlines of several runs: later ones are thinner, so all are visible. The first run's bomb keeps its
   colour; other bodies have the colour of their run. */
void body_draw_outlines(const Picture *picture, int panel, int run, Moment moment, Drawing *drawing) {
    const Trajectory *trajectory = picture->runs[run];
    int above = picture->look.compare == LOOK_OVERLAY ? picture->count - 1 - run : 0;
    double thickness = fmax(GHOST_OUTLINE * panel_side(picture), MIN_GHOST_OUTLINE) *
                       (1 + above * fmin(NESTED_STEP, NESTED_TOTAL / picture->count));
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body]) continue;
        Shape shape = body_shape(picture, panel, run, moment, body, picture_body_colors(picture, run));
        shape.hollow = true;
        shape.outline = thickness;
        if (picture_colors_distance(picture, run))
            shape.line = colors_of(picture, run, moment, body).fill;
        else if (run > 0)
            shape.line = picture_body_colors(picture, run)->fill;
        else
            shape.line = body == trajectory->bomb ? picture->theme->bomb.fill : picture_ghost_color(picture, 0);
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
        shape.line = run == 0 ? picture_ghost_color(picture, 0) : colors->fill,
        shape.outline = fmax(MIN_SWATCH_OUTLINE, side / SWATCH_OUTLINE);
    drawing_add_shape(drawing, &shape, &(Rect){left, baseline - side, left + side, baseline});
    return left + side;
}
