/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The legend below the panels: what outlines, colours, dots and arrows mean. */
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>

const char *const mode_words[] = {"open", "sticks", "slips", "not as the reference"};

/* The room of a legend: where the next entry stands, in the row that was begun last. */
typedef struct Row {
    const Picture *picture;
    Drawing *drawing;
    const Font *font;
    int x, baseline, rows;
    double middle; /* of the text, for samples */
    Rect clip;
} Row;

static void add_text(Row *row, const char *text) {
    row->x = font_add(row->drawing, row->font, text, row->x, row->baseline, row->picture->theme->ink_soft);
}

/* The text of an entry, and the space behind it. */
static void end_entry(Row *row, const char *text) {
    add_text(row, text);
    row->x += row->font->pixels * 2;
}

static void add_arrow(Row *row, double pixels, uint32_t color, double value, const char *unit) {
    ArrowStyle style = marks_arrow_style(row->picture, color);
    char text[64];
    style.thickness = fmax(style.thickness, LEGEND_LINE * row->font->pixels);
    style.halo = row->picture->theme->page;
    stroke_arrow(row->drawing, (Point){row->x + 1, row->middle}, (Point){row->x + 1 + pixels, row->middle}, false,
                 &style, &row->clip);
    row->x += (int)ceil(pixels) + row->font->pixels / 2;
    snprintf(text, sizeof text, "%g %s", value, unit);
    end_entry(row, text);
}

typedef enum Entry {
    ENTRY_OUTLINE,
    ENTRY_COLOURS,
    ENTRY_LABELS,
    ENTRY_TRAIL,
    ENTRY_APPROACH,
    ENTRY_CONTACT,
    ENTRY_IMPULSE,
    ENTRY_VELOCITY,
    ENTRY_HEADS,
    ENTRY_MODES
} Entry;

/* A sample, unless the entry is text alone, and what it means. */
static void add(Row *row, Entry entry) {
    static const char *const labels[] = {
        [LOOK_NUMBERS] = "number of the body", [LOOK_MASSES] = "mass, kg", [LOOK_NAMES] = "name"};
    const Picture *picture = row->picture;
    const Theme *theme = picture->theme;
    const Scales *scales = &picture->scales;
    Drawing *drawing = row->drawing;
    const int em = row->font->pixels;
    char text[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    switch (entry) {
    case ENTRY_OUTLINE:
        row->x = body_draw_swatch(picture, 0, true, row->x, row->baseline, em, drawing) + em / 2;
        caption_method(picture, 0, text, note);
        end_entry(row, text);
        break;
    case ENTRY_COLOURS: {
        /* A number stands between the colours of its two decades, of one rectangle per pixel column. */
        const int decades = scales->last_decade - SCALE_FIRST_DECADE, width = (int)rint(LEGEND_DECADE * em),
                  top = row->baseline - em * 3 / 4;
        add_text(row, "distance  0.001 ");
        double power = pow(10, SCALE_FIRST_DECADE);
        for (int decade = 0; decade < decades; decade++) {
            power *= 10;
            for (int x = 0; x < width; x++)
                drawing_add_rect(drawing, (Rect){row->x + x, top, row->x + x + 1, row->baseline},
                                 theme_ramp(theme, (decade + (x + 0.5) / width) / decades));
            row->x += width;
            snprintf(text, sizeof text, " %g%s", power,
                     decade + 1 < decades ? " "
                     : scales->exceeded   ? " m or more"
                                          : " m");
            add_text(row, text);
        }
        end_entry(row, "");
        break;
    }
    case ENTRY_LABELS:
        add_text(row, "in boxes that are large enough: ");
        end_entry(row, labels[picture->look.labels]);
        break;
    case ENTRY_TRAIL: {
        const double parts = LEGEND_TRAIL_PARTS, width = em * 2;
        for (int i = 0; i < LEGEND_TRAIL_PARTS; i++)
            stroke_line(drawing, (Point){row->x + width * i / parts, row->middle},
                        (Point){row->x + width * (i + 1) / parts, row->middle}, marks_line_thickness(picture),
                        theme_mix(theme->page, theme->ink_soft, (i + 2) / (parts + 1)), &row->clip);
        row->x += em * 2 + em / 2;
        snprintf(text, sizeof text, "path of the last %g s", TRAIL_DURATION);
        end_entry(row, text);
        break;
    }
    case ENTRY_APPROACH: {
        const Trajectory *run = picture->runs[0];
        DashedLine line = approach_line(picture);
        stroke_dashed(drawing, (Point){row->x, row->middle}, (Point){row->x + em * 2, row->middle}, &line, &row->clip);
        row->x += em * 2 + em / 2;
        snprintf(text, sizeof text, "path of the bomb, from %.3g s until it strikes",
                 bomb_first_frame(run) * (double)run->dt);
        end_entry(row, text);
        break;
    }
    case ENTRY_CONTACT: {
        const double radius = fmax(marks_dot_radius(picture), LEGEND_DOT * em);
        stroke_dot(drawing, (Point){row->x + radius, row->middle}, radius, theme->panel, theme->impulse, &row->clip);
        row->x += (int)ceil(2 * radius) + em / 2;
        end_entry(row, "contact");
        break;
    }
    case ENTRY_IMPULSE:
        add_arrow(row, scales->legend_impulse * scales->impulse, theme->impulse, scales->legend_impulse, "N s");
        break;
    case ENTRY_VELOCITY:
        add_arrow(row, scales->legend_velocity * scales->velocity, theme->velocity, scales->legend_velocity, "m/s");
        break;
    case ENTRY_HEADS: end_entry(row, ARROW_NOTE); break;
    case ENTRY_MODES: {
        const double radius = fmax(marks_dot_radius(picture), LEGEND_DOT * em);
        for (int i = 0; i < CONTACT_MODES + (picture->mode_base >= 0); i++) {
            const double room = radius * (i == CONTACT_MODES ? MODE_WRONG : MODE_SIDE * MODE_BAR) + MODE_HALO;
            const ModeMark mark = {.at = {row->x + room, row->middle},
                                   .cosine = 1,
                                   .radius = radius,
                                   .mode = i < CONTACT_MODES ? (ContactMode)i : CONTACT_STICKS,
                                   .wrong = i == CONTACT_MODES};
            marks_draw_mode(picture, &mark, &row->clip, drawing);
            row->x += (int)ceil(2 * room) + em / 2;
            add_text(row, mode_words[i]);
            row->x += em;
        }
        end_entry(row, "");
        break;
    }
    }
}

static void begin_row(Row *row) {
    const Layout *layout = &row->picture->layout;
    row->x = layout->area.left;
    row->baseline = layout->legend_baseline + row->rows * layout->legend_pitch;
    row->middle = row->baseline - row->font->pixels * LEGEND_MIDDLE;
    row->rows++;
}

/* An entry that reaches too far right is removed and added again at the start of the next row. */
static void place(Row *row, Entry entry) {
    if (row->rows == 0) begin_row(row);
    const Row before = *row;
    Drawing *drawing = row->drawing;
    const size_t rects = drawing->rect_count, shapes = drawing->shape_count, glyphs = drawing->glyph_count;
    add(row, entry);
    const bool first = before.x == row->picture->layout.area.left;
    if (first || row->x - row->font->pixels * 2 <= row->picture->layout.right) return;
    drawing->rect_count = rects, drawing->shape_count = shapes, drawing->glyph_count = glyphs;
    *row = before;
    begin_row(row);
    add(row, entry);
}

static int place_entries(const Picture *picture, Drawing *drawing) {
    const RenderLook *look = &picture->look;
    const Layout *layout = &picture->layout;
    Row row = {.picture = picture, .drawing = drawing, .font = &layout->axis};
    row.clip = (Rect){0, 0, layout->width, layout->height};
    bool difference = look->compare == LOOK_DIFFERENCE;
    if (difference || (look->show & SHOW_GHOSTS && look->compare == LOOK_SPLIT)) place(&row, ENTRY_OUTLINE);
    if (difference || look->show & SHOW_DISTANCE) place(&row, ENTRY_COLOURS);
    if (look->labels != LOOK_NO_LABELS) place(&row, ENTRY_LABELS);
    if (look->show & SHOW_TRAILS) place(&row, ENTRY_TRAIL);
    if (look->approach && picture->runs[0]->bomb >= 0) place(&row, ENTRY_APPROACH);
    if (look->show & SHOW_CONTACTS) place(&row, ENTRY_CONTACT);
    if (look->show & SHOW_IMPULSES) place(&row, ENTRY_IMPULSE);
    if (look->show & SHOW_VELOCITIES) place(&row, ENTRY_VELOCITY);
    if (look->show & (SHOW_IMPULSES | SHOW_VELOCITIES)) place(&row, ENTRY_HEADS);
    if (look->show & SHOW_MODES) place(&row, ENTRY_MODES);
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
