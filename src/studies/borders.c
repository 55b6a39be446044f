/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axis of a study in the borders figure. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/sketch.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/verdict.h"
#include "studies/chart_internal.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <math.h>
#include <string.h>

typedef struct BorderAxis {
    PlotAxis axis; /* over the study's values, widened if too narrow, with a margin at both ends */
    bool falling;  /* smaller values are harder: most methods hold above their border and fail below */
    char label[STABILITY_TEXT_SIZE];
    PlotTicks ticks; /* within the values */
} BorderAxis;

/* Margin at both ends for the marks of methods that hold over the whole range or never. */
#define BORDER_AXIS_ROOM 4.4 /* mm */

/* The marks in a panel of the borders figure: bars where a method holds, tiles where it fails, arrows and crosses. */

/* The rows of a study's panel, one per method, from the top. */
typedef struct BorderRows {
    const CsvTable *table;
    Sketch *sketch;
    const BorderRow *study; /* any row of the study */
    const PlotPanel *panel; /* placed */
    bool falling;           /* as of BorderAxis */
    const int *methods;     /* [method_count]: a table row of each method */
    int method_count;
} BorderRows;

/* Signs in the legend: holds, holds throughout, never holds, and the line up to which rigid boxes hold where a study has it. */
enum { BORDER_SIGNS = 4 };

/* Axes with a larger ratio of their ends are logarithmic. */
static const double long_axis = 8;

/* An axis with a smaller ratio of its ends would exaggerate differences of a few percent; it is widened by the factor
   `apart` at both ends. */
static const double least_ratio = 1.5, apart = 1.5;

/* Beyond this range numbers are powers of ten. */
static const double plain_least = 1e-3, plain_most = 1e5;

/* The study of the row; NULL: another program's. */
static const StabilityStudy *study_of(const StabilityOwn *own, const BorderRow *row) {
    const StabilityStudy *studies = own != NULL ? own->studies : stability_studies;
    const int count = own != NULL ? own->study_count : stability_study_count;
    for (int i = 0; i < count; i++)
        if (strcmp(studies[i].name, row->study) == 0 && strcmp(studies[i].parameter, row->parameter) == 0)
            return &studies[i];
    return NULL;
}

/* A number at an end of the range, instead of those that it would touch. */
static void name_end(PlotTicks *ticks, const PlotAxis *axis, double value) {
    const double points = 7.5, between = 1;
    PlotTick end = {.value = value};
    snprintf(end.text, sizeof end.text, "%.4g", value);
    for (int i = 0; i < ticks->count; i++) {
        PlotTick *other = &ticks->items[i];
        const double distance = fabs(plot_axis_place(axis, other->value) - plot_axis_place(axis, value));
        const double width = plot_tick_width(other, points);
        if (width == 0 || distance > (width + plot_tick_width(&end, points)) / 2 + between) continue;
        if (distance < 0.01) return;
        other->text[0] = '\0';
        other->digit = 0;
    }
    plot_tick_add(ticks, value, false, end.text);
}

/* From the least to the most value, with numbers at both. */
static void set_axis(BorderAxis *out, double least, double most, bool logarithmic, double width) {
    const double share = BORDER_AXIS_ROOM / (width - 2 * BORDER_AXIS_ROOM);
    PlotAxis axis = plot_linear_axis(least - share * (most - least), most + share * (most - least), NULL), inside;
    if (logarithmic) {
        axis.scale = PLOT_LOG;
        axis.low = least / pow(most / least, share);
        axis.high = most * pow(most / least, share);
        axis.powers = least < plain_least || most >= plain_most;
    }
    axis.outside = true;
    inside = axis;
    inside.low = least, inside.high = most;
    inside.to = width - 2 * BORDER_AXIS_ROOM;
    plot_ticks_choose(&out->ticks, &inside, 7.5, true);
    name_end(&out->ticks, &inside, least);
    name_end(&out->ticks, &inside, most);
    out->axis = axis;
}

/* The axis of the study of row `first`, `width` mm long; its label and ticks are not set in `axis`. */
static BorderAxis border_axis(const CsvTable *table, int first, const StabilityStudy *study, double width) {
    BorderAxis axis = {0};
    double least = INFINITY, most = -INFINITY;
    int falling = 0;
    for (int i = first; i < table->count; i++) {
        const BorderRow *row = border_row(table, i);
        if (strcmp(row->study, border_row(table, first)->study) != 0) continue;
        least = fmin(least, fmin(row->holds_at, row->fails_at));
        most = fmax(most, fmax(row->holds_at, row->fails_at));
        falling += (row->fails_at < row->holds_at) - (row->fails_at > row->holds_at);
    }
    if (!(least <= most)) least = most = 0;
    if (study != NULL) {
        least = study->scan.from;
        most = study->scan.to;
    } else if (least > 0 && most / least < least_ratio) {
        least /= apart;
        most *= apart;
    }
    set_axis(&axis, least, most, study != NULL ? study->scan.logarithmic : least > 0 && most / least > long_axis,
             width);
    axis.falling = study != NULL && !study->scan.either ? study->scan.fails_low : falling > 0;
    stability_axis_text(axis.label, border_row(table, first)->parameter, border_row(table, first)->unit);
    return axis;
}

/* mm; half_tile, half_sign: from the centre of a tile, arrow head or cross to its edge */
static const double bar_height = 1.2, half_tile = 1.15, half_sign = 0.75;

static const Pen bar_pen = {0xA3CBE5, 1, NO_COLOUR, 0, NULL}, sign_pen = {NO_COLOUR, 1, 0x000000, 1.6, NULL},
                 rigid_pen = {NO_COLOUR, 1, 0x000000, 0.8, "(3,3)"};

static bool holds_throughout(const BorderRow *row) {
    return isnan(row->fails_at) && !isnan(row->holds_at) && verdict_holds((Verdict)row->verdict);
}

static bool never_holds(const BorderRow *row) { return isnan(row->holds_at) && !isnan(row->fails_at); }

static double place_of(const BorderRows *rows, double value) { return plot_axis_place(&rows->panel->x, value); }

/* The other end of the bar that starts at a border: the next border of the same method in that direction, or the
   panel's edge. */
static double far_end(const BorderRows *rows, const BorderRow *row, bool low) {
    double end = low ? rows->panel->x.from : rows->panel->x.to, from = place_of(rows, row->holds_at);
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *other = border_row(rows->table, i);
        if (other == row || !border_same_study(other, row) || !border_same_method(other, row)) continue;
        double place = place_of(rows, other->holds_at);
        if (low ? place <= from && place > end : place >= from && place < end) end = place;
    }
    return end;
}

static void put_bar(Sketch *sketch, double from, double to, double y) {
    sketch_rectangle(sketch, (Point){fmin(from, to), y - bar_height / 2}, (Point){fmax(from, to), y + bar_height / 2},
                     &bar_pen);
}

static void draw_bar(const BorderRows *rows, const BorderRow *row, double y) {
    if (isnan(row->holds_at)) return;
    if (holds_throughout(row)) {
        put_bar(rows->sketch, rows->panel->x.from, rows->panel->x.to, y);
        return;
    }
    const bool low = isnan(row->fails_at) ? !rows->falling : row->holds_at < row->fails_at;
    put_bar(rows->sketch, far_end(rows, row, low), place_of(rows, row->holds_at), y);
}

/* An arrow head. */
static void put_head(Sketch *sketch, Point tip, bool to_the_left) {
    const double back = tip.x + (to_the_left ? 2 : -2) * half_sign;
    sketch_path(sketch, (const Point[]){{back, tip.y + half_sign}, tip, {back, tip.y - half_sign}}, 3, &sign_pen);
}

static void put_cross(Sketch *sketch, Point at) {
    for (int up = -1; up <= 1; up += 2)
        sketch_line(sketch, (Point){at.x - half_sign, at.y - up * half_sign},
                    (Point){at.x + half_sign, at.y + up * half_sign}, &sign_pen);
}

/* In the margin next to the study's easiest value, or to its hardest one. */
static double margin_of(const BorderRows *rows, bool easy) {
    const PlotAxis *axis = &rows->panel->x;
    return easy == rows->falling ? axis->to - BORDER_AXIS_ROOM / 2 : axis->from + BORDER_AXIS_ROOM / 2;
}

/* Without fails_at: in the margin, as all values beyond holds_at are undecided. */
static double tile_place(const BorderRows *rows, const BorderRow *row) {
    return isnan(row->fails_at) ? margin_of(rows, isnan(row->holds_at)) : place_of(rows, row->fails_at);
}

static void draw_sign(const BorderRows *rows, const BorderRow *row, double y) {
    const double tip = rows->falling ? rows->panel->x.from + half_sign : rows->panel->x.to - half_sign;
    if (holds_throughout(row)) put_head(rows->sketch, (Point){tip, y}, rows->falling);
    if (never_holds(row)) put_cross(rows->sketch, (Point){margin_of(rows, true), y});
}

static void draw_each(const BorderRows *rows, void (*put)(const BorderRows *, const BorderRow *, double)) {
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *row = border_row(rows->table, i);
        for (int method = 0; border_same_study(row, rows->study) && method < rows->method_count; method++)
            if (border_same_method(border_row(rows->table, rows->methods[method]), row))
                put(rows, row, plot_axis_place(&rows->panel->y, method));
    }
}

static void draw_tile(const BorderRows *rows, const BorderRow *row, double y) {
    const Tile tile = {.at = {tile_place(rows, row), y}, .look = row->verdict};
    if (holds_throughout(row)) return;
    verdict_draw_tiles(rows->sketch, &tile, 1, (TileSize){.width = 2 * half_tile, .height = 2 * half_tile});
}

static void border_marks_draw(const BorderRows *rows) {
    draw_each(rows, draw_bar);
    draw_each(rows, draw_tile);
    draw_each(rows, draw_sign);
}

static void border_sample_draw(Sketch *sketch, int sign, Point left, double width) {
    if (sign < 2) put_bar(sketch, left.x, left.x + width, left.y);
    if (sign == 1) put_head(sketch, (Point){left.x + width, left.y}, false);
    if (sign == 2) put_cross(sketch, (Point){left.x + width / 2, left.y});
    if (sign == 3)
        sketch_line(sketch, (Point){left.x + width / 2, left.y - 1.5}, (Point){left.x + width / 2, left.y + 1.5},
                    &rigid_pen);
}

/* mm */
static const double left = 33, left_of_one = 52, right = 2, gap = 3.5, title_room = 5.5, axis_room = 8.8,
                    legend_left = 20, most_page = 235, most_row = 3.4, least_row = 2.5, sample = 5.5, name_gap = 1.3;

enum { LEGEND_COLUMNS = 5 };

typedef struct Borders {
    const CsvTable *table;
    const CsvTable *unconverged;
    const StabilityOwn *own; /* or NULL */
    Sketch *sketch;
    LeftOut foot; /* what is left out, where the reference did not converge */
    int study_count, method_count;
    int studies[BORDERS_MAX_STUDIES], methods[BORDERS_MAX_METHODS]; /* first row of each */
    int left_out[BORDERS_MAX_METHODS], left_out_count;              /* the same of methods that no study applies to */
    int columns, rows, signs, legend_rows;
    double row_height; /* mm */
    PlotGrid grid;
    bool used[VERDICT_LOOKS];
} Borders;

/* Adds row i if it is the first of its study or method. False if there are too many. */
static bool add_first(const CsvTable *table, int i, bool (*same)(const BorderRow *, const BorderRow *), int *firsts,
                      int *count, int most) {
    for (int k = 0; k < *count; k++)
        if (same(border_row(table, firsts[k]), border_row(table, i))) return true;
    if (*count == most) return false;
    firsts[(*count)++] = i;
    return true;
}

/* Whether a study applies to the row's method. */
static bool is_applicable(const CsvTable *table, const BorderRow *row) {
    bool found = false;
    for (int i = 0; !found && i < table->count; i++)
        found = border_row(table, i)->verdict != LOOK_NOT_APPLICABLE && border_same_method(border_row(table, i), row);
    return found;
}

static bool gather(Borders *borders, Error *error) {
    const CsvTable *table = borders->table;
    bool any = false;
    for (int i = 0; i < table->count; i++) any = any || border_row(table, i)->verdict != LOOK_NOT_APPLICABLE;
    for (int i = 0; i < table->count; i++) {
        const BorderRow *row = border_row(table, i);
        if (!add_first(table, i, border_same_study, borders->studies, &borders->study_count, BORDERS_MAX_STUDIES))
            return csv_table_error(table, i, 0, error, "more than %d studies: too many for a figure",
                                   BORDERS_MAX_STUDIES);
        const bool left_out = any && !is_applicable(table, row);
        if (!add_first(table, i, border_same_method, left_out ? borders->left_out : borders->methods,
                       left_out ? &borders->left_out_count : &borders->method_count, BORDERS_MAX_METHODS))
            return csv_table_error(table, i, 0, error, "more than %d methods: too many for a figure",
                                   BORDERS_MAX_METHODS);
        if (!left_out && !verdict_holds((Verdict)row->verdict)) borders->used[row->verdict] = true;
    }
    borders->signs = BORDER_SIGNS - 1;
    for (int i = 0; i < borders->study_count; i++) {
        const StabilityStudy *study = study_of(borders->own, border_row(table, borders->studies[i]));
        if (study != NULL && study->rigid != NULL) borders->signs = BORDER_SIGNS;
    }
    return true;
}

static void list_left_out(Borders *borders) {
    for (int i = 0; i < borders->left_out_count; i++) {
        const BorderRow *row = border_row(borders->table, borders->left_out[i]);
        left_out_add(&borders->foot, "Left out, as not applicable: ", row->method, row->setting);
    }
    for (int i = 0; i < borders->study_count; i++)
        left_out_add_unconverged(&borders->foot, borders->unconverged,
                                 border_row(borders->table, borders->studies[i])->study);
}

/* mm */
static double foot_of(const Borders *borders) {
    return NOTE_ROW * left_out_rows(&borders->foot, FIGURE_PAGE_WIDTH - legend_left - 1);
}

static const double name_points = 7, most_names = 0.45; /* share of the page; longer names are smaller */

/* mm: left of the panels, for the names of methods. */
static double room_of_names(const Borders *borders) {
    double longest = borders->columns > 1 ? left : left_of_one;
    for (int method = 0; method < borders->method_count; method++) {
        const BorderRow *row = border_row(borders->table, borders->methods[method]);
        char text[STABILITY_TEXT_SIZE];
        stability_method_text(text, row->method, row->setting);
        longest = fmax(longest, type_width(text, name_points) + 3);
    }
    return fmin(longest, most_names * FIGURE_PAGE_WIDTH);
}

/* The title of a study's panel, in lines. */
static int wrap_title(char title[STABILITY_TEXT_SIZE], const Borders *borders, int study, double width) {
    const BorderRow *first = border_row(borders->table, borders->studies[study]);
    const StabilityStudy *known = study_of(borders->own, first);
    stability_axis_text(title, known != NULL ? known->title : first->study, "");
    chart_make_plain(title);
    return text_wrap(title, STABILITY_TEXT_SIZE, 8, width);
}

/* mm: above panels of this width. */
static double room_of_titles(const Borders *borders, double width) {
    char title[STABILITY_TEXT_SIZE];
    int lines = 1;
    for (int study = 0; study < borders->study_count; study++)
        lines = (int)fmax(lines, wrap_title(title, borders, study, width));
    return title_room + (lines - 1) * line_height(8);
}

/* Uses the height of a printed page if that gives rows of a readable height. */
static void lay_out(Borders *borders) {
    int items = borders->signs;
    for (int look = 0; look < VERDICT_LOOKS; look++) items += borders->used[look];
    borders->legend_rows = (items + LEGEND_COLUMNS - 1) / LEGEND_COLUMNS;
    borders->columns = borders->study_count <= 2 ? borders->study_count : borders->study_count <= 6 ? 3 : 4;
    borders->rows = (borders->study_count + borders->columns - 1) / borders->columns;
    PlotGrid grid = {.width = FIGURE_PAGE_WIDTH,
                     .left = room_of_names(borders),
                     .right = right,
                     .columns = borders->columns,
                     .rows = borders->rows,
                     .gap = gap};
    grid.top = room_of_titles(borders, plot_grid_box(&grid, 0).width);
    const double legend = foot_of(borders) + LEGEND_ROW * borders->legend_rows + 2, around = grid.top + axis_room;
    const double room = (most_page - legend) / borders->rows - around;
    borders->row_height = fmin(fmax(room / borders->method_count, least_row), most_row);
    grid.height = legend + borders->rows * (around + borders->row_height * borders->method_count);
    grid.bottom = legend + axis_room;
    grid.row_gap = around;
    borders->grid = grid;
}

/* A guide for each method, and in the first column its name. */
static void draw_rows(const Borders *borders, const PlotPanel *panel, bool named) {
    const Pen guide = pen_line(0xE2E2E2, 0.6, NULL);
    for (int method = 0; method < borders->method_count; method++) {
        const BorderRow *row = border_row(borders->table, borders->methods[method]);
        const double y = plot_axis_place(&panel->y, method);
        char text[STABILITY_TEXT_SIZE];
        sketch_line(borders->sketch, (Point){panel->x.from, y}, (Point){panel->x.to, y}, &guide);
        if (!named) continue;
        stability_method_text(text, row->method, row->setting);
        plot_text(borders->sketch, (Point){borders->grid.left - 1.5, y}, TEXT_RIGHT,
                  text_points(text, name_points, borders->grid.left - 3), text);
    }
}

static void draw_panel(const Borders *borders, int place) {
    static const PlotTicks none;
    const BorderRow *first = border_row(borders->table, borders->studies[place]);
    const StabilityStudy *study = study_of(borders->own, first);
    PlotPanel panel = {.box = plot_grid_box(&borders->grid, place)};
    BorderAxis axis = border_axis(borders->table, borders->studies[place], study, panel.box.width);
    char title[STABILITY_TEXT_SIZE];
    wrap_title(title, borders, place, panel.box.width);
    panel.title = title;
    panel.x = axis.axis;
    panel.x.label = axis.label;
    panel.x.ticks = &axis.ticks;
    panel.y = plot_linear_axis(borders->method_count - 0.5, -0.5, NULL);
    panel.y.ticks = &none;
    plot_panel_place(&panel);
    draw_rows(borders, &panel, place % borders->columns == 0);
    if (study != NULL && study->rigid != NULL) {
        const double x = plot_axis_place(&panel.x, study->rigid());
        sketch_line(borders->sketch, (Point){x, panel.y.from}, (Point){x, panel.y.to}, &rigid_pen);
    }
    border_marks_draw(&(BorderRows){borders->table, borders->sketch, first, &panel, axis.falling, borders->methods,
                                    borders->method_count});
    plot_panel_draw(borders->sketch, &panel);
}

/* How many rows are of struck scenes. */
static int struck_rows(const Borders *borders) {
    int count = 0;
    for (int i = 0; i < borders->table->count; i++) count += border_is_struck(borders->table, i);
    return count;
}

/* Of struck scenes a bar says that a method agrees with the reference, not that boxes stand. */
static void draw_samples(const Borders *borders, const LegendPlace *place, int first) {
    static const char *const holds[BORDER_SIGNS] = {"holds", "holds throughout", "never holds", "rigid boxes"};
    static const char *const agrees[BORDER_SIGNS] = {"as the reference", "throughout", "never", "rigid boxes"};
    static const char *const both[BORDER_SIGNS] = {"holds, or agrees", "throughout", "never", "rigid boxes"};
    const int struck = struck_rows(borders);
    const char *const *names = struck == 0 ? holds : struck == borders->table->count ? agrees : both;
    for (int i = 0; i < borders->signs; i++) {
        const Point at = {place->left + place->width * ((first + i) % place->columns),
                          place->top - LEGEND_ROW * ((first + i) / place->columns)};
        border_sample_draw(borders->sketch, i, at, sample);
        plot_text(borders->sketch, (Point){at.x + sample + name_gap, at.y}, TEXT_LEFT, LEGEND_POINTS, names[i]);
    }
}

static void draw_legend(const Borders *borders) {
    LegendPlace place = {legend_left, foot_of(borders) + LEGEND_ROW * (borders->legend_rows - 0.5) + 0.5,
                         (FIGURE_PAGE_WIDTH - legend_left) / LEGEND_COLUMNS, LEGEND_COLUMNS};
    draw_samples(borders, &place, verdict_draw_legend(borders->sketch, borders->used, &place));
}

static void write_caption(const Borders *borders, PlotPage *page) {
    WordList words = {0};
    text_add(page->caption, sizeof page->caption,
             "How far each method holds, on each study's own axis. Bars cover the values that hold. Tiles show how a "
             "method fails: at the first value that fails or, where tiny shifts of the start decide beyond the bar, at "
             "the far end. Arrow: holds over the whole range; cross: never holds; no mark: not in the study.%s",
             borders->signs == BORDER_SIGNS ? " Dashed line: rigid boxes hold up to here, in closed form." : "");
    if (struck_rows(borders) > 0) text_add(page->caption, sizeof page->caption, " %s", stability_struck_words);
    if (borders->foot.count > (borders->left_out_count > 0))
        text_add(page->caption, sizeof page->caption, " %s", stability_unconverged_words);
    left_out_draw(&borders->foot, page, legend_left);
    for (int i = 0; i < borders->method_count; i++)
        words_add_method(&words, border_row(borders->table, borders->methods[i])->method);
    for (int i = 0; i < borders->method_count; i++) {
        const BorderRow *row = border_row(borders->table, borders->methods[i]);
        words_add_settings(&words, row->method, row->setting);
    }
    words_join(&words, page->caption, sizeof page->caption);
}

bool stability_borders_write(const CsvTable *table, const CsvTable *unconverged, const StabilityOwn *own,
                             PlotPage *page, Error *error) {
    Borders borders = {.table = table, .unconverged = unconverged, .own = own, .sketch = &page->sketch};
    if (!gather(&borders, error)) return false;
    list_left_out(&borders);
    lay_out(&borders);
    sketch_begin(&page->sketch, borders.grid.width, borders.grid.height);
    for (int study = 0; study < borders.study_count; study++) draw_panel(&borders, study);
    draw_legend(&borders);
    write_caption(&borders, page);
    return true;
}
