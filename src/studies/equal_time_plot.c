/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The grid of scenes and methods that the figure of errors at equal time shows. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "studies/chart_data.h"
#include "studies/chart_table.h"
#include "studies/equal_time.h"
#include "studies/statistics.h"
#include "studies/figure_words.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EQUAL_TIME_COLUMNS = 40, EQUAL_TIME_SCENES = 64 };

typedef struct EqualTimeCell {
    bool ran;
    double ratio; /* EqualMethodRow; NaN: none */
    bool below;   /* BELOW_BOTH */
} EqualTimeCell;

typedef struct EqualTimeGrid {
    int columns, rows;
    char time[CHART_TEXT_SIZE];                        /* setting of momentum whose time all methods have: "k=100" */
    char methods[EQUAL_TIME_COLUMNS][CHART_TEXT_SIZE]; /* plain */
    bool joined[EQUAL_TIME_COLUMNS]; /* the column and the one before it differ only in what was learned */
    char scenes[EQUAL_TIME_SCENES][CHART_TEXT_SIZE];
    char times[CHART_TIMES_SIZE]; /* chart_times_note(), plain; set by the caller */
    const char *floor;            /* what else than PARETO_RESOLUTION limits the comparison; set by the caller */
    NameList left_out;            /* methods and scenes without a ratio */
    WordList words;               /* methods and what sets learned ones apart from their twins */
    EqualTimeCell cells[EQUAL_TIME_SCENES][EQUAL_TIME_COLUMNS];
} EqualTimeGrid;

/* Columns in order: index of their family. */
typedef struct Columns {
    int count, family[EQUAL_TIME_COLUMNS];
    bool joined[EQUAL_TIME_COLUMNS];
} Columns;

static const char *twin_of(const RivalCurves *curves, int family) {
    const MethodDescription *method = curves->families[family].description;
    return method == NULL ? NULL : method->twin;
}

/* The family of the silenced twin of a learned one, or -1. */
static int find_twin(const RivalCurves *curves, int family) {
    char method[CHART_NAME_SIZE], name[CHART_FAMILY_SIZE];
    const char *twin = twin_of(curves, family), *colon = twin == NULL ? NULL : strchr(twin, ':');
    if (colon == NULL) return -1;
    snprintf(method, sizeof method, "%.*s", (int)(colon - twin), twin);
    const ChartRow row = {.method = method, .setting = colon + 1};
    chart_row_family(&row, name);
    for (int i = 0; i < curves->family_count; i++)
        if (i != family && strcmp(curves->families[i].name, name) == 0) return i;
    return -1;
}

/* Of a method, or of any (-1), in a scene, or in any (NULL). */
static bool has_ratio(const EqualTime *table, int family, const char *scene) {
    for (int i = 0; i < table->method_count; i++) {
        const EqualMethodRow *row = &table->methods[i];
        if ((family < 0 || row->family == family) && (scene == NULL || strcmp(row->scene, scene) == 0) &&
            !isnan(row->ratio))
            return true;
    }
    return false;
}

static void add_column(Columns *columns, EqualTimeGrid *grid, const EqualTime *table, int family, bool joined) {
    if (!has_ratio(table, family, NULL))
        name_list_add(&grid->left_out, table->curves.families[family].name);
    else if (columns->count < EQUAL_TIME_COLUMNS) {
        columns->family[columns->count] = family;
        columns->joined[columns->count++] = joined;
    }
}

/* ERROR_INPUT with the path if the grid has no room. */
static bool equal_time_grid(EqualTimeGrid *grid, const EqualTime *table, const char *path, Error *error) {
    const RivalCurves *curves = &table->curves;
    Columns columns = {0};
    *grid = (EqualTimeGrid){0};
    if (curves->family_count > EQUAL_TIME_COLUMNS)
        return error_input(error, path, "a figure has at most %d methods (got %d)", EQUAL_TIME_COLUMNS,
                           curves->family_count);
    /* Learned methods stand beside their silenced twins; other variants of them are in the tables only. */
    for (int i = 0; i < curves->family_count; i++)
        if (twin_of(curves, i) == NULL) add_column(&columns, grid, table, i, false);
    for (int i = 0; i < curves->family_count; i++) {
        const int twin = find_twin(curves, i);
        if (twin_of(curves, i) == NULL || strcmp(curves->families[i].name, curves->families[i].method) != 0) continue;
        add_column(&columns, grid, table, i, false);
        if (twin >= 0) add_column(&columns, grid, table, twin, has_ratio(table, i, NULL));
    }
    grid->columns = columns.count;
    chart_plain(grid->time, table->time);
    words_add(&grid->words, "rival", "any other method without a network");
    for (int i = 0; i < columns.count; i++) words_add_method(&grid->words, curves->families[columns.family[i]].method);
    for (int i = 0; i < columns.count; i++) {
        const char *name = curves->families[columns.family[i]].name;
        words_add_settings(&grid->words, name, name + strcspn(name, ":") + (strchr(name, ':') != NULL));
    }
    for (int i = 0; i < columns.count; i++) {
        chart_plain(grid->methods[i], curves->families[columns.family[i]].name);
        grid->joined[i] = columns.joined[i];
    }
    for (int i = 0; i < table->method_count; i++) {
        const EqualMethodRow *row = &table->methods[i];
        char name[CHART_TEXT_SIZE];
        int column = 0, scene = 0;
        while (column < columns.count && columns.family[column] != row->family) column++;
        const bool any = has_ratio(table, -1, row->scene);
        if (!any) name_list_add(&grid->left_out, row->scene);
        if (column == columns.count || !any) continue;
        chart_plain(name, row->scene);
        while (scene < grid->rows && strcmp(grid->scenes[scene], name) != 0) scene++;
        if (scene == EQUAL_TIME_SCENES)
            return error_input(error, path, "a figure has at most %d scenes", EQUAL_TIME_SCENES);
        if (scene == grid->rows) strcpy(grid->scenes[grid->rows++], name);
        grid->cells[scene][column] = (EqualTimeCell){true, row->ratio, row->below == BELOW_BOTH};
    }
    return true;
}

/* mm */
static const double cell_height = 6.2, cell_least = 9.5, gap = 1.2, foot = 19.5, bar_height = 2.6, bar_width = 62,
                    note_width = 76, name_row = 3.1;
static const double scene_points = 8, method_points = 7;
static const double strongest = 1000; /* ratio, and its inverse, with the full colour */

enum { NAME_ROWS = 4 };

/* The name of a method in rows, broken behind "-" and before ":": "scene-", "net", "net=off". */
typedef struct BrokenName {
    int count;
    char rows[NAME_ROWS][CHART_TEXT_SIZE];
    double width; /* mm */
} BrokenName;

static BrokenName break_name(const char *name) {
    BrokenName broken = {0};
    while (*name != '\0' && broken.count < NAME_ROWS) {
        size_t length = broken.count == NAME_ROWS - 1 ? strlen(name) : strcspn(name, "-:");
        length += name[length] == '-';
        char *row = broken.rows[broken.count++];
        snprintf(row, CHART_TEXT_SIZE, "%.*s", (int)length, name);
        broken.width = fmax(broken.width, type_width(row, method_points));
        name += length + (name[length] == ':');
    }
    return broken;
}

typedef struct Layout {
    const EqualTimeGrid *grid;
    Sketch *sketch;
    double width, height;               /* mm: of the page */
    double left, top;                   /* mm: left of the first cell, top of the first row */
    double columns[EQUAL_TIME_COLUMNS]; /* mm: left edges */
    double cells[EQUAL_TIME_COLUMNS];   /* mm: widths */
} Layout;

static Layout lay_out(const EqualTimeGrid *grid) {
    double longest = 0;
    for (int i = 0; i < grid->rows; i++) longest = fmax(longest, type_width(grid->scenes[i], scene_points));
    Layout layout = {.grid = grid, .left = longest + 4, .top = foot + grid->rows * cell_height};
    double right = layout.left - gap;
    int rows = 1;
    for (int i = 0; i < grid->columns; i++) {
        const BrokenName name = break_name(grid->methods[i]);
        layout.columns[i] = right + (grid->joined[i] ? 0 : gap);
        layout.cells[i] = fmax(cell_least, name.width + 1.2);
        right = layout.columns[i] + layout.cells[i];
        if (name.count > rows) rows = name.count;
    }
    layout.width = fmax(right + 1, layout.left + bar_width + note_width);
    layout.height = layout.top + rows * name_row + 3;
    return layout;
}

/* -1: the full colour of less error, 1: that of more. */
static double strength(double ratio) { return fmax(-1, fmin(1, log(ratio) / log(strongest))); }

static uint32_t colour_of(double ratio) {
    static const double less[] = {0x21, 0x66, 0xAC}, even[] = {0xF4, 0xF4, 0xF4}, more[] = {0xB3, 0x58, 0x06};
    const double t = strength(ratio);
    uint32_t colour = 0;
    for (int i = 0; i < 3; i++)
        colour = colour << 8 | (uint32_t)lround(even[i] + fabs(t) * ((t < 0 ? less[i] : more[i]) - even[i]));
    return colour;
}

static double linear(uint32_t channel) { return pow(channel / 255.0, 2.2); }

/* White or black, whichever has more contrast (WCAG 2): at least the root of 21. */
static uint32_t ink_on(uint32_t rgb) {
    const double luminance = 0.2126 * linear(rgb >> 16) + 0.7152 * linear(rgb >> 8 & 255) + 0.0722 * linear(rgb & 255);
    return 1.05 / (luminance + 0.05) > (luminance + 0.05) / 0.05 ? 0xFFFFFF : 0x000000;
}

static void draw_box(Sketch *sketch, PlotBox box, uint32_t colour, uint32_t line) {
    const Pen pen = pen_fill(colour, 1, line);
    sketch_rectangle(sketch, (Point){box.left, box.bottom}, (Point){box.left + box.width, box.bottom + box.height},
                     &pen);
}

enum { RATIO_SIZE = FACTOR_SIZE + 4 };

/* "1/52", "1/3.1", "1", "×2.4". */
static void name_ratio(char text[RATIO_SIZE], double ratio) {
    const double factor = ratio < 1 ? 1 / ratio : ratio;
    char number[FACTOR_SIZE];
    factor_text(number, factor);
    snprintf(text, RATIO_SIZE, "%s%s", factor < 1.05 ? "" : ratio < 1 ? "1/" : "×", factor < 1.05 ? "1" : number);
}

/* What does not fit into a cell is beyond a power of ten: ">10⁵", "<10⁻⁴". */
static void draw_power(Sketch *sketch, Point at, const TextStyle *style, double ratio) {
    const int power = ratio < 1 ? -(int)floor(-log10(ratio)) : (int)floor(log10(ratio));
    const char *beyond = ratio < 1 ? "<" : ">";
    TextStyle left = *style;
    left.align = TEXT_LEFT;
    at.x -= (type_width(beyond, style->points) + sketch_power_width(style->points, 1, power)) / 2;
    sketch_text(sketch, at, &left, "%s", beyond);
    at.x += type_width(beyond, style->points);
    sketch_power_of_ten(sketch, at, &left, 1, power);
}

static void draw_cell(const Layout *layout, int row, int column) {
    const EqualTimeCell *cell = &layout->grid->cells[row][column];
    const double x = layout->columns[column], y = layout->top - (row + 1) * cell_height, edge = 0.25;
    if (!cell->ran) return;
    const bool none = isnan(cell->ratio);
    const uint32_t colour = none ? 0xD8D8D8 : cell->below ? 0xFFFFFF : colour_of(cell->ratio);
    draw_box(layout->sketch, (PlotBox){x + edge, y + edge, layout->cells[column] - 2 * edge, cell_height - 2 * edge},
             colour, !none && cell->below ? 0xB0B0B0 : NO_COLOUR);
    const Point middle = {x + layout->cells[column] / 2, y + cell_height / 2};
    const TextStyle style = {7.5, TEXT_CENTER, ink_on(colour), 0, false};
    char text[RATIO_SIZE] = "–";
    if (!none && fabs(log10(cell->ratio)) >= log10(9995)) {
        draw_power(layout->sketch, middle, &style, cell->ratio);
        return;
    }
    if (!none) name_ratio(text, cell->ratio);
    sketch_text(layout->sketch, middle, &style, "%s", text);
}

static void draw_names(const Layout *layout) {
    const EqualTimeGrid *grid = layout->grid;
    for (int i = 0; i < grid->columns; i++) {
        const BrokenName name = break_name(grid->methods[i]);
        for (int row = 0; row < name.count; row++)
            plot_text(
                layout->sketch,
                (Point){layout->columns[i] + layout->cells[i] / 2, layout->top + name_row * (name.count - row - 0.3)},
                TEXT_CENTER, method_points, name.rows[row]);
    }
    for (int i = 0; i < grid->rows; i++)
        plot_text(layout->sketch, (Point){layout->left - 2, layout->top - (i + 0.5) * cell_height}, TEXT_RIGHT,
                  scene_points, grid->scenes[i]);
}

/* The scale of colours, as a bar of steps. */
static void draw_scale(const Layout *layout) {
    static const double marks[] = {1.0 / 1000, 1.0 / 30, 1, 30, 1000};
    enum { STEPS = 61 };
    Sketch *sketch = layout->sketch;
    const double bottom = foot - 7.2, right = layout->left + bar_width + 6;
    char text[RATIO_SIZE], note[CHART_TEXT_SIZE + 64];
    for (int i = 0; i < STEPS; i++)
        draw_box(sketch, (PlotBox){layout->left + bar_width * i / STEPS, bottom, bar_width / STEPS + 0.05, bar_height},
                 colour_of(pow(strongest, 2 * (i + 0.5) / STEPS - 1)), NO_COLOUR);
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        name_ratio(text, marks[i]);
        plot_text(sketch, (Point){layout->left + bar_width * (strength(marks[i]) + 1) / 2, bottom - 2}, TEXT_CENTER, 7,
                  text);
    }
    snprintf(note, sizeof note, "in the time of momentum with %s sweeps per step",
             layout->grid->time + strcspn(layout->grid->time, "0123456789"));
    plot_text(sketch, (Point){right, bottom + bar_height / 2}, TEXT_LEFT, 8,
              "error at the impact / error of the best rival,");
    plot_text(sketch, (Point){right, bottom - 2}, TEXT_LEFT, 8, note);
    plot_text(sketch, (Point){right, bottom - 5.5}, TEXT_LEFT, 8, "– slower, or unstable before the impact");
    if (layout->grid->left_out.used > 0) {
        char names[sizeof layout->grid->left_out.text + 16];
        snprintf(names, sizeof names, "left out: %s", layout->grid->left_out.text);
        while (type_width(names, 7) > bar_width) strcpy(names + utf8_cut(names, strlen(names) - 4), "...");
        plot_text(sketch, (Point){layout->left, bottom - 6}, TEXT_LEFT, 7, names);
    }
    snprintf(note, sizeof note, "white: both below %g m/s%s", PARETO_RESOLUTION, layout->grid->floor);
    plot_text(sketch, (Point){right, bottom - 9}, TEXT_LEFT, 8, note);
}

static bool write_caption(const EqualTimeGrid *grid, const char *stem, Error *error) {
    char path[PATH_MAX], caption[PLOT_CAPTION_SIZE] = "";
    text_add(caption, sizeof caption,
             "Mean error at the impact in the time of momentum:%s, over that of the best rival in the same time. "
             "Dashes: slower "
             "than that, or unstable before the impact. White: both errors are below %g m/s%s.",
             grid->time, PARETO_RESOLUTION, grid->floor);
    if (grid->left_out.used > 0)
        text_add(caption, sizeof caption, " Left out, as without a ratio: %s.", grid->left_out.text);
    if (grid->times[0] != '\0') text_add(caption, sizeof caption, " %s", grid->times);
    words_join(&grid->words, caption, sizeof caption);
    return file_path(path, sizeof path, error, "%s.txt", stem) && file_write(path, caption, strlen(caption), error);
}

static bool draw(const EqualTimeGrid *grid, const char *folder, Error *error) {
    char stem[PATH_MAX];
    Sketch sketch;
    Layout layout = lay_out(grid);
    layout.sketch = &sketch;
    if (!file_path(stem, sizeof stem, error, "%s/%s", folder, equal_time_layout.name)) return false;
    sketch_begin(&sketch, layout.width, layout.height);
    strcpy(sketch.title, "Error at the impact in equal time / that of the best rival");
    for (int row = 0; row < grid->rows; row++)
        for (int column = 0; column < grid->columns; column++) draw_cell(&layout, row, column);
    draw_names(&layout);
    draw_scale(&layout);
    const bool drawn = sketch_draw(&sketch, stem, SKETCH_PDF, error) && write_caption(grid, stem, error);
    sketch_free(&sketch);
    return drawn;
}

bool equal_time_plot(const char *chart_csv, const char *folder, EqualTimeFigure *figure, Error *error) {
    CsvTable chart;
    EqualTime table;
    char path[CSV_PATH_SIZE], methods[CSV_PATH_SIZE];
    if (!csv_table_path(path, folder, &equal_time_layout, error) ||
        !csv_table_path(methods, folder, &equal_methods_layout, error) ||
        !csv_table_read(&chart, chart_csv, &chart_layout, error))
        return false;
    EqualTimeGrid *grid = malloc(sizeof *grid);
    bool ok = grid != NULL || error_memory(error, path);
    ok = ok && equal_time_make(&table, chart.rows, chart.count, error);
    if (ok) {
        ok = csv_table_write(path, &equal_time_layout, table.rows, table.count, error) &&
             csv_table_write(methods, &equal_methods_layout, table.methods, table.method_count, error) &&
             equal_time_grid(grid, &table, chart_csv, error);
        if (ok) {
            chart_times_note(grid->times, chart.rows, chart.count);
            chart_make_plain(grid->times);
            grid->floor = "";
            for (int i = 0; i < chart.count; i++)
                if (chart_row_resolution(chart_row(&chart, i)) > PARETO_RESOLUTION) grid->floor = ", or the floor";
        }
        if (ok) *figure = (EqualTimeFigure){grid->columns > 0, grid->left_out};
        ok = ok && (!figure->drawn || draw(grid, folder, error));
        equal_time_free(&table);
    }
    free(grid);
    csv_table_free(&chart);
    return ok;
}
