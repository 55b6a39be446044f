/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The look: its check, colours, and the legend that explains it. */
#include "base/base.h"
#include "methods/methods.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

const char *const look_compare_names[] = {"split", "overlay", "difference", NULL};
const char *const look_camera_names[] = {"fit", "bomb", "divergence", NULL};
const char *const look_theme_names[] = {"light", "dark", NULL};
const char *const look_labels_names[] = {"none", "number", "mass", "name", NULL};
const char *const look_show_names[] = {"ghosts",   "distance",   "trails",   "contacts",
                                       "impulses", "velocities", "timeline", NULL};

/* The part of a look that compares bodies of several runs; NULL if none does. */
static const char *compares(const RenderLook *look) {
    if (look->compare != LOOK_SPLIT) return look_compare_names[look->compare];
    if (look->camera == LOOK_DIVERGENCE) return look_camera_names[LOOK_DIVERGENCE];
    if (look->show & LOOK_GHOSTS) return "ghosts";
    if (look->show & LOOK_DISTANCE) return "distance";
    return look->show & LOOK_TIMELINE ? "timeline" : NULL;
}

/* What was not recorded would look like what did not happen. */
static bool check_known(const RenderLook *look, const Trajectory *const *runs, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        if ((look->show & LOOK_VELOCITIES) != 0 && runs[i]->no_velocities)
            return error_input(error, "render", "'velocities' cannot be shown: run %d (%s) does not have them", i + 1,
                               runs[i]->method);
        if (look->labels == LOOK_MASSES && !trajectory_has_masses(runs[i]))
            return error_input(error, "render",
                               "masses cannot be shown: run %d (%s) does not have them; simulate it again", i + 1,
                               runs[i]->method);
        if (look->labels == LOOK_NAMES && runs[i]->name == NULL)
            return error_input(error, "render",
                               "names cannot be shown: no body of run %d (%s) has one; the scene's key 'name' gives it",
                               i + 1, runs[i]->method);
        if ((look->show & (LOOK_CONTACTS | LOOK_IMPULSES)) != 0 && runs[i]->no_contacts)
            return error_input(error, "render", "'%s' cannot be shown: run %d (%s) has no contacts",
                               look->show & LOOK_CONTACTS ? "contacts" : "impulses", i + 1, runs[i]->method);
    }
    return true;
}

bool look_check(const RenderLook *look, const Trajectory *const *runs, int count, Error *error) {
    const char *what = compares(look);
    char difference[256];
    if (look->view.width != 0 && !camera_view_is_usable(&look->view))
        return error_input(error, "render", "the view %g x %g m at (%g, %g) cannot be drawn", look->view.width,
                           look->view.height, look->view.x, look->view.y);
    if (look->camera == LOOK_BOMB && runs[0]->bomb < 0)
        return error_input(error, "render", "the camera cannot follow the bomb: the first run has none");
    if (!check_known(look, runs, count, error)) return false;
    if (what == NULL) return true;
    if (count < 2) return error_input(error, "render", "'%s' compares runs, but there is only one", what);
    for (int i = 1; i < count; i++)
        if (trajectory_different_worlds(runs[0], runs[i], difference, sizeof difference))
            return error_input(error, "render", "'%s' compares run %d with the first, but their worlds differ (%s)",
                               what, i + 1, difference);
    return true;
}

static const Theme light = {
    .page = PAGE,
    .panel = PANEL,
    .frame = FRAME,
    .grid = GRID,
    .grid_strong = GRID_STRONG,
    .ink = INK,
    .ink_soft = INK_SOFT,
    .ground = GROUND,
    .ground_line = GROUND_LINE,
    .impulse = 0x10161F,
    .velocity = 0xA3005C,
    .event = 0x8A94A3,
    .ghost_is_band = false,
    .bomb = BOMB_COLORS,
    .ramp_near = 0,
    .ramp_far = 1,
};

static const Theme dark = {
    .page = 0x12161C,
    .panel = 0x1A2028,
    .frame = 0x465161,
    .grid = 0x222A34,
    .grid_strong = 0x313B48,
    .ink = 0xEDF1F6,
    .ink_soft = 0x9AA6B6,
    .ground = 0x343E4B,
    .ground_line = 0x93A0B1,
    .impulse = 0xF7F9FB,
    .velocity = 0xFF8AC4,
    .event = 0x77849A,
    .ghost_is_band = true,
    .bomb = {0xCC3620, 0x3D0D03, 0xFFF1EA},
    .ramp_near = 0.86,
    .ramp_far = 0,
};

const Theme *theme_get(LookTheme theme) { return theme == LOOK_DARK ? &dark : &light; }

static uint32_t mix_channel(uint32_t from, uint32_t to, int shift, double share) {
    double a = from >> shift & 255, b = to >> shift & 255;
    return (uint32_t)rint(a + (b - a) * share) << shift;
}

uint32_t theme_mix(uint32_t from, uint32_t to, double share) {
    return mix_channel(from, to, 16, share) | mix_channel(from, to, 8, share) | mix_channel(from, to, 0, share);
}

/* Oklab: hue 104 to 295 degrees, chroma 0.135 or the most that sRGB can show, lightness fitted to CIE L*. */
const uint32_t theme_stops[THEME_STOPS] = {0xFEF483, 0xC6E57E, 0x8AD482, 0x46C18C, 0x02A995, 0x0B8F95,
                                           0x08778E, 0x005E89, 0x04438D, 0x272879, 0x2E085E};

uint32_t theme_ramp(const Theme *theme, double share) {
    enum { LAST = THEME_STOPS - 1 };
    double at = LAST * (theme->ramp_near + (theme->ramp_far - theme->ramp_near) * fmin(fmax(share, 0), 1));
    int below = at < LAST - 1 ? (int)at : LAST - 1;
    return theme_mix(theme_stops[below], theme_stops[below + 1], at - below);
}

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

/* The text of an entry, and the space behind it. */
static void end_entry(Row *row, const char *text) {
    add_text(row, text);
    row->x += row->font->pixels * 2;
}

static void add_outline(Row *row) {
    char text[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    row->x = body_draw_swatch(row->picture, 0, true, row->x, row->baseline, row->font->pixels, row->drawing);
    row->x += row->font->pixels / 2;
    caption_method(row->picture, 0, text, note);
    end_entry(row, text);
}

/* One rectangle per pixel column. */
static void add_decade(Row *row, int decade, int decades) {
    int width = (int)rint(LEGEND_DECADE * row->font->pixels), top = row->baseline - row->font->pixels * 3 / 4;
    for (int x = 0; x < width; x++)
        drawing_add_rect(row->drawing, (Rect){row->x + x, top, row->x + x + 1, row->baseline},
                         theme_ramp(row->picture->theme, (decade + (x + 0.5) / width) / decades));
    row->x += width;
}

/* Each number stands between the colours of its two decades. */
static void add_colors(Row *row) {
    int decades = row->picture->scales.last_decade - SCALE_FIRST_DECADE;
    add_text(row, "distance  0.001 ");
    double power = pow(10, SCALE_FIRST_DECADE);
    for (int i = 0; i < decades; i++) {
        char text[32];
        power *= 10;
        add_decade(row, i, decades);
        const char *unit = row->picture->scales.exceeded ? " m or more" : " m";
        snprintf(text, sizeof text, " %g%s", power, i + 1 < decades ? " " : unit);
        add_text(row, text);
    }
    end_entry(row, "");
}

static void add_trail(Row *row) {
    const Picture *picture = row->picture;
    char text[64];
    int width = row->font->pixels * 2;
    const double parts = LEGEND_TRAIL_PARTS;
    for (int i = 0; i < LEGEND_TRAIL_PARTS; i++) {
        Point from = {row->x + width * i / parts, row->middle}, to = {row->x + width * (i + 1) / parts, row->middle};
        stroke_line(row->drawing, from, to, marks_line_thickness(picture),
                    theme_mix(picture->theme->page, picture->theme->ink_soft, (i + 2) / (parts + 1)), &row->clip);
    }
    row->x += width + row->font->pixels / 2;
    snprintf(text, sizeof text, "path of the last %g s", TRAIL_DURATION);
    end_entry(row, text);
}

static void add_approach(Row *row) {
    const Trajectory *run = row->picture->runs[0];
    DashedLine line = approach_line(row->picture);
    char text[64];
    const int width = row->font->pixels * 2;
    stroke_dashed(row->drawing, (Point){row->x, row->middle}, (Point){row->x + width, row->middle}, &line, &row->clip);
    row->x += width + row->font->pixels / 2;
    snprintf(text, sizeof text, "path of the bomb, from %.3g s until it strikes",
             bomb_first_frame(run) * (double)run->dt);
    end_entry(row, text);
}

static void add_dot(Row *row) {
    double radius = fmax(marks_dot_radius(row->picture), LEGEND_DOT * row->font->pixels);
    stroke_dot(row->drawing, (Point){row->x + radius, row->middle}, radius, row->picture->theme->panel,
               row->picture->theme->impulse, &row->clip);
    row->x += (int)ceil(2 * radius) + row->font->pixels / 2;
    end_entry(row, "contact");
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

static void add_heads(Row *row) { end_entry(row, ARROW_NOTE); }

static void add_labels(Row *row) {
    static const char *const words[] = {
        [LOOK_NUMBERS] = "number of the body", [LOOK_MASSES] = "mass, kg", [LOOK_NAMES] = "name"};
    add_text(row, "in boxes that are large enough: ");
    end_entry(row, words[row->picture->look.labels]);
}

static void begin_row(Row *row) {
    const Layout *layout = &row->picture->layout;
    row->x = layout->area.left;
    row->baseline = layout->legend_baseline + row->rows * layout->legend_pitch;
    row->middle = row->baseline - row->font->pixels * LEGEND_MIDDLE;
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
    if (look->labels != LOOK_NO_LABELS) place_entry(&row, add_labels);
    if (look->show & LOOK_TRAILS) place_entry(&row, add_trail);
    if (look->show & LOOK_APPROACH && picture->runs[0]->bomb >= 0) place_entry(&row, add_approach);
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
