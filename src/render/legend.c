/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/legend.h"

#include "render/body.h"
#include "render/caption.h"
#include "render/marks.h"

#include <math.h>
#include <stdio.h>

static const double DECADE = 3; /* ems, of the colour scale */
static const unsigned EXPLAINED =
    LOOK_GHOSTS | LOOK_DISTANCE | LOOK_TRAILS | LOOK_CONTACTS | LOOK_IMPULSES | LOOK_VELOCITIES;

bool legend_is_needed(const Picture *picture) {
    return picture->look.compare == LOOK_DIFFERENCE || (picture->look.show & EXPLAINED) != 0;
}

/* Where the next entry begins. */
typedef struct Row {
    const Picture *picture;
    Drawing *drawing;
    const Font *font;
    int x, baseline;
    double middle; /* of small letters: where lines lie */
    Rect clip;
} Row;

static void add_text(Row *row, const char *text) {
    int room = row->picture->layout.right - row->x;
    row->x =
        font_add_fitting(row->drawing, row->font, text, row->x, row->baseline, room, row->picture->theme->ink_soft);
}

static void end_entry(Row *row) { row->x += row->font->pixels * 2; }

static void add_outline(Row *row) {
    char text[CAPTION_SIZE], note[CAPTION_SIZE];
    row->x = body_draw_swatch(row->picture, 0, true, row->x, row->baseline, row->font->pixels, row->drawing);
    row->x += row->font->pixels / 2;
    caption_method(row->picture, 0, text, note);
    add_text(row, text);
    end_entry(row);
}

/* One rectangle a pixel: as fine as the picture can be. */
static void add_decade(Row *row, int decade, int decades) {
    int width = (int)rint(DECADE * row->font->pixels), top = row->baseline - row->font->pixels * 3 / 4;
    for (int x = 0; x < width; x++)
        drawing_add_rect(row->drawing, (Rect){row->x + x, top, row->x + x + 1, row->baseline},
                         theme_ramp(row->picture->theme, (decade + (x + 0.5) / width) / decades));
    row->x += width;
}

/* The numbers part the colours, each where its distance lies. */
static void add_colors(Row *row) {
    int decades = row->picture->scales.last_decade - SCALE_FIRST_DECADE;
    add_text(row, "distance  0.001 ");
    double power = 1e-3;
    for (int i = 0; i < decades; i++) {
        char text[32];
        power *= 10;
        add_decade(row, i, decades);
        const char *unit = row->picture->scales.goes_beyond ? " m or more" : " m";
        snprintf(text, sizeof text, " %g%s", power, i + 1 < decades ? " " : unit);
        add_text(row, text);
    }
    end_entry(row);
}

static void add_trail(Row *row) {
    const Picture *picture = row->picture;
    int width = row->font->pixels * 2;
    for (int i = 0; i < 8; i++) {
        Point from = {row->x + width * i / 8.0, row->middle}, to = {row->x + width * (i + 1) / 8.0, row->middle};
        stroke_line(row->drawing, from, to, marks_line(picture),
                    theme_mix(picture->theme->page, picture->theme->ink_soft, (i + 2) / 9.0), &row->clip);
    }
    row->x += width + row->font->pixels / 2;
    add_text(row, "path of the last 2 s");
    end_entry(row);
}

static void add_dot(Row *row) {
    double radius = marks_dot(row->picture);
    stroke_dot(row->drawing, (Point){row->x + radius, row->middle}, radius, row->picture->theme->panel,
               row->picture->theme->impulse, &row->clip);
    row->x += (int)ceil(2 * radius) + row->font->pixels / 2;
    add_text(row, "contact");
    end_entry(row);
}

static void add_arrow(Row *row, double pixels, uint32_t color, double value, const char *unit) {
    ArrowStyle style = marks_arrow(row->picture, color);
    char text[64];
    style.halo = row->picture->theme->page;
    stroke_arrow(row->drawing, (Point){row->x + 1, row->middle}, (Point){row->x + 1 + pixels, row->middle}, false,
                 &style, &row->clip);
    row->x += (int)ceil(pixels) + row->font->pixels / 2;
    snprintf(text, sizeof text, "%g %s", value, unit);
    add_text(row, text);
    end_entry(row);
}

void legend_draw(const Picture *picture, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Scales *scales = &picture->scales;
    const RenderLook *look = &picture->look;
    if (layout->legend_baseline == 0) return;
    Row row = {.picture = picture, .drawing = drawing, .font = &layout->axis};
    row.x = layout->panels[0].left;
    row.baseline = layout->legend_baseline;
    row.middle = row.baseline - row.font->pixels * 0.36;
    row.clip = (Rect){0, 0, layout->width, layout->height};
    bool difference = look->compare == LOOK_DIFFERENCE;
    if (difference || (look->show & LOOK_GHOSTS && look->compare == LOOK_SPLIT)) add_outline(&row);
    if (difference || look->show & LOOK_DISTANCE) add_colors(&row);
    if (look->show & LOOK_TRAILS) add_trail(&row);
    if (look->show & LOOK_CONTACTS) add_dot(&row);
    if (look->show & LOOK_IMPULSES)
        add_arrow(&row, scales->named_impulse * scales->impulse, picture->theme->impulse, scales->named_impulse, "N s");
    if (look->show & LOOK_VELOCITIES)
        add_arrow(&row, scales->named_velocity * scales->velocity, picture->theme->velocity, scales->named_velocity,
                  "m/s");
    if (look->show & (LOOK_IMPULSES | LOOK_VELOCITIES)) add_text(&row, "(two heads: longer than shown)");
}
