/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/legend.h"

#include "picture/body.h"
#include "picture/caption.h"
#include "picture/marks.h"

#include <math.h>
#include <stdio.h>

static const double DECADE = 3;              /* ems, width of a decade on the colour scale */
static const double DOT = 0.18, LINE = 0.11; /* ems: samples are at least this large, or they could not be made out */
/* Position of the next entry. */
typedef struct Row {
    const Picture *picture;
    Drawing *drawing;
    const Font *font;
    int x, baseline;
    double middle; /* middle of the x-height, where line samples are */
    Rect clip;
    int rows; /* started */
} Row;

typedef void AddEntry(Row *row);

static void add_text(Row *row, const char *text) {
    row->x = font_add(row->drawing, row->font, text, row->x, row->baseline, row->picture->theme->ink_soft);
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

/* One rectangle per pixel column. */
static void add_decade(Row *row, int decade, int decades) {
    int width = (int)rint(DECADE * row->font->pixels), top = row->baseline - row->font->pixels * 3 / 4;
    for (int x = 0; x < width; x++)
        drawing_add_rect(row->drawing, (Rect){row->x + x, top, row->x + x + 1, row->baseline},
                         theme_ramp(row->picture->theme, (decade + (x + 0.5) / width) / decades));
    row->x += width;
}

/* Each number stands between the colours of its two decades. */
static void add_colors(Row *row) {
    int decades = row->picture->scales.last_decade - SCALE_FIRST_DECADE;
    add_text(row, "distance  0.001 ");
    double power = 1e-3;
    for (int i = 0; i < decades; i++) {
        char text[32];
        power *= 10;
        add_decade(row, i, decades);
        const char *unit = row->picture->scales.exceeded ? " m or more" : " m";
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
        stroke_line(row->drawing, from, to, marks_line_thickness(picture),
                    theme_mix(picture->theme->page, picture->theme->ink_soft, (i + 2) / 9.0), &row->clip);
    }
    row->x += width + row->font->pixels / 2;
    add_text(row, "path of the last 2 s");
    end_entry(row);
}

static void add_dot(Row *row) {
    double radius = fmax(marks_dot_radius(row->picture), DOT * row->font->pixels);
    stroke_dot(row->drawing, (Point){row->x + radius, row->middle}, radius, row->picture->theme->panel,
               row->picture->theme->impulse, &row->clip);
    row->x += (int)ceil(2 * radius) + row->font->pixels / 2;
    add_text(row, "contact");
    end_entry(row);
}

static void add_arrow(Row *row, double pixels, uint32_t color, double value, const char *unit) {
    ArrowStyle style = marks_arrow_style(row->picture, color);
    char text[64];
    style.thickness = fmax(style.thickness, LINE * row->font->pixels);
    style.halo = row->picture->theme->page;
    stroke_arrow(row->drawing, (Point){row->x + 1, row->middle}, (Point){row->x + 1 + pixels, row->middle}, false,
                 &style, &row->clip);
    row->x += (int)ceil(pixels) + row->font->pixels / 2;
    snprintf(text, sizeof text, "%g %s", value, unit);
    add_text(row, text);
    end_entry(row);
}

static void add_impulse(Row *row) {
    const Scales *scales = &row->picture->scales;
    add_arrow(row, scales->legend_impulse * scales->impulse, row->picture->theme->impulse, scales->legend_impulse,
              "N s");
}

static void add_velocity(Row *row) {
    const Scales *scales = &row->picture->scales;
    add_arrow(row, scales->legend_velocity * scales->velocity, row->picture->theme->velocity, scales->legend_velocity,
              "m/s");
}

static void add_heads(Row *row) {
    add_text(row, "(two heads: arrow truncated to fit)");
    end_entry(row);
}

static void begin_row(Row *row) {
    const Layout *layout = &row->picture->layout;
    row->x = layout->area.left;
    row->baseline = layout->legend_baseline + row->rows * layout->legend_pitch;
    row->middle = row->baseline - row->font->pixels * 0.36;
    row->rows++;
}

/* An entry that reaches too far right is removed and added again at the start of the next row. */
static void place_entry(Row *row, AddEntry *add) {
    if (row->rows == 0) begin_row(row);
    Row before = *row;
    Drawing *drawing = row->drawing;
    size_t rects = drawing->rect_count, shapes = drawing->shape_count, glyphs = drawing->glyph_count;
    add(row);
    bool first = before.x == row->picture->layout.area.left;
    if (first || row->x - row->font->pixels * 2 <= row->picture->layout.right) return;
    drawing->rect_count = rects, drawing->shape_count = shapes, drawing->glyph_count = glyphs;
    *row = before;
    begin_row(row);
    add(row);
}

static int place_entries(const Picture *picture, Drawing *drawing) {
    const RenderLook *look = &picture->look;
    const Layout *layout = &picture->layout;
    Row row = {.picture = picture, .drawing = drawing, .font = &layout->axis};
    row.clip = (Rect){0, 0, layout->width, layout->height};
    bool difference = look->compare == LOOK_DIFFERENCE;
    if (difference || (look->show & LOOK_GHOSTS && look->compare == LOOK_SPLIT)) place_entry(&row, add_outline);
    if (difference || look->show & LOOK_DISTANCE) place_entry(&row, add_colors);
    if (look->show & LOOK_TRAILS) place_entry(&row, add_trail);
    if (look->show & LOOK_CONTACTS) place_entry(&row, add_dot);
    if (look->show & LOOK_IMPULSES) place_entry(&row, add_impulse);
    if (look->show & LOOK_VELOCITIES) place_entry(&row, add_velocity);
    if (look->show & (LOOK_IMPULSES | LOOK_VELOCITIES)) place_entry(&row, add_heads);
    return row.rows;
}

int legend_rows(const Picture *picture) {
    Drawing scratch = {0};
    int rows = place_entries(picture, &scratch);
    drawing_free(&scratch);
    return rows;
}

void legend_draw(const Picture *picture, Drawing *drawing) {
    if (picture->layout.legend_baseline > 0) place_entries(picture, drawing);
}
