/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The borders figure: a table of studies and methods, whose cells show which part of the study's range holds. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "pixels/type.h"
#include "runs/verdict.h"
#include "studies/chart_data.h"
#include "studies/figure_words.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm */
static const double row_height = 4.4, tile_height = 3.5, heading_height = 5.5, most_column = 20, most_study = 62,
                    column_gap = 0.8, least_symbol = 2.4, symbol_width = 1.4, tick_end = 1.3, least_fail = 0.5,
                    number_gap = 0.35, name_gap = 0.6, text_gap = 2, edge = 1, right = 2.5, head_gap = 1,
                    most_label = 0.45 * FIGURE_PAGE_WIDTH, legend_item = 31;

/* A smaller share of a range is not seen. */
static const double least_seen = 0.02;

/* Sizes of text. */
static const double title_points = 7.5, small_points = 6.5, least_size = 0.85; /* of small_points */

static const Pen rigid_pen = {NO_COLOUR, 1, 0x000000, 1.2, NULL};

#define SOFT_COLOUR 0x606060u

/* Of at most so many studies the methods are rows. */
enum { FEW_STUDIES = 3 };

typedef struct BorderStudy {
    const BorderRow *row;        /* the first one of the study */
    const StabilityStudy *known; /* or NULL */
    BorderRange range;
    bool struck;
    double held;                      /* mean share, of the methods that apply */
    char title[STABILITY_TEXT_SIZE];  /* "Heavy box on one" */
    char extent[STABILITY_TEXT_SIZE]; /* "ratio 1 to 1000" */
} BorderStudy;

typedef struct BorderMethod {
    const BorderRow *row; /* its first one */
    double held;          /* mean share, of all studies */
    int as_far;           /* studies in which it holds as far as the reference */
    char name[STABILITY_TEXT_SIZE];
    int lines;     /* of the name */
    double points; /* its size */
} BorderMethod;

typedef struct Borders {
    const CsvTable *table;
    const CsvTable *unconverged;
    const StabilityOwn *own; /* or NULL */
    Sketch *sketch;
    LeftOut foot; /* what is left out, where the reference did not converge */
    int study_count, method_count, struck_count;
    BorderStudy studies[BORDERS_MAX_STUDIES];  /* those that are not struck first; what most methods hold first */
    BorderMethod methods[BORDERS_MAX_METHODS]; /* what holds most first */
    bool used[VERDICT_LOOKS], rigid, hatched;
    bool few;                    /* a column for each study and a row for each method, instead of the reverse */
    double width, label, column; /* mm: of the page, of the names of rows, of a column */
    int tiers, lines;            /* of the methods' names above columns: heights, and lines of the longest */
} Borders;

/* The column of the reference, or -1. */
static int find_reference(const Borders *borders) {
    for (int i = 0; i < borders->method_count; i++)
        if (strcmp(borders->methods[i].row->method, "reference") == 0) return i;
    return -1;
}

static BorderCell cell_at(const Borders *borders, int study, int method) {
    return border_cell(borders->table, borders->studies[study].row, borders->methods[method].row,
                       &borders->studies[study].range);
}

static const char *sign(double value) { return value < 0 ? "−" : ""; }

/* "2 to 40 boxes"; without a unit "ratio 1 to 1000". */
static void name_extent(char text[STABILITY_TEXT_SIZE], const BorderRow *row, const BorderRange *range) {
    text[0] = '\0';
    if (row->unit[0] == '\0') {
        stability_axis_text(text, row->parameter, "");
        text[0] = (char)tolower((unsigned char)text[0]);
        text_add(text, STABILITY_TEXT_SIZE, " ");
    }
    text_add(text, STABILITY_TEXT_SIZE, "%s%.7g to %s%.7g", sign(range->easy), fabs(range->easy), sign(range->hard),
             fabs(range->hard));
    if (row->unit[0] != '\0') text_add(text, STABILITY_TEXT_SIZE, " %s", row->unit);
    chart_make_plain(text);
}

static bool gather(Borders *borders, Error *error) {
    const CsvTable *table = borders->table;
    bool any = false;
    for (int i = 0; i < table->count; i++) any = any || border_row(table, i)->verdict != CELL_NOT_APPLICABLE;
    for (int i = 0; i < table->count; i++) {
        const BorderRow *row = border_row(table, i);
        bool new_study = true, new_method = true, applies = false;
        for (int k = 0; k < table->count; k++) {
            const BorderRow *other = border_row(table, k);
            if (k < i && border_same_study(other, row)) new_study = false;
            if (k < i && border_same_method(other, row)) new_method = false;
            applies |= other->verdict != CELL_NOT_APPLICABLE && border_same_method(other, row);
        }
        if (new_study) {
            if (borders->study_count == BORDERS_MAX_STUDIES)
                return csv_table_error(table, i, 0, error, "more than %d studies: too many for a figure",
                                       BORDERS_MAX_STUDIES);
            BorderStudy *study = &borders->studies[borders->study_count++];
            study->row = row;
            study->known = border_study(borders->own, row);
            study->range = border_range(table, i, study->known);
            study->struck = border_is_struck(table, i, borders->own);
            stability_axis_text(study->title, study->known != NULL ? study->known->title : row->study, "");
            chart_make_plain(study->title);
            name_extent(study->extent, row, &study->range);
            borders->struck_count += study->struck;
            borders->rigid = borders->rigid || (study->known != NULL && study->known->rigid != NULL);
        }
        /* A method to which no study applies is named at the foot, unless that is so of all. */
        if (new_method && any && !applies)
            left_out_add(&borders->foot, "Left out, as not applicable: ", row->method, row->setting);
        else if (new_method) {
            if (borders->method_count == BORDERS_MAX_METHODS)
                return csv_table_error(table, i, 0, error, "more than %d methods: too many for a figure",
                                       BORDERS_MAX_METHODS);
            BorderMethod *method = &borders->methods[borders->method_count++];
            method->row = row;
            stability_method_text(method->name, row->method, row->setting);
        }
    }
    return true;
}

/* Beyond a border of falling it is unknown what collapses. */
static int look_of(const BorderSpan *span) {
    return span->holds ? (int)VERDICT_STANDS : span->look == VERDICT_COLLAPSES ? (int)VERDICT_FALLS : span->look;
}

/* The next part of a struck study in which a method differs from the reference, from span i of one and k of the other
   on. */
static bool next_difference(const BorderCell *cell, const BorderCell *reference, int *i, BorderSpan *part) {
    for (; *i < cell->count * reference->count; ++*i) {
        const BorderSpan *own = &cell->spans[*i / reference->count], *other = &reference->spans[*i % reference->count];
        *part = (BorderSpan){fmax(own->from, other->from), fmin(own->to, other->to), own->holds, own->look};
        if (part->to > part->from && verdict_differs(look_of(own), look_of(other))) return ++*i, true;
    }
    return false;
}

/* The reference of a struck study, with which its methods are compared. No spans: nothing is. */
static BorderCell compared_with(const Borders *borders, int study, int method) {
    const int reference = find_reference(borders);
    const bool none = !borders->studies[study].struck || reference < 0 || method == reference;
    return none ? (BorderCell){0} : cell_at(borders, study, reference);
}

/* Without the reference it is the whole range that counts; of a struck study, that nothing differs from it. */
static bool holds_as_far(const Borders *borders, int study, int method, const BorderCell *cell) {
    const int reference = find_reference(borders);
    if (borders->studies[study].struck && reference >= 0) {
        const BorderCell other = compared_with(borders, study, method);
        double differing = 0;
        BorderSpan part;
        for (int i = 0; next_difference(cell, &other, &i, &part);) differing += part.to - part.from;
        return cell->count > 0 && differing < least_seen;
    }
    if (borders->studies[study].struck || reference < 0) return border_holds_throughout(cell);
    const BorderCell far = cell_at(borders, study, reference);
    if (far.row == NULL) return border_holds_throughout(cell);
    return cell->count > 0 && cell->held >= far.held - least_seen;
}

static void measure(Borders *borders) {
    for (int i = 0; i < borders->study_count; i++)
        left_out_add_unconverged(&borders->foot, borders->unconverged, borders->studies[i].row->study);
    for (int study = 0; study < borders->study_count; study++) {
        int applicable = 0;
        for (int method = 0; method < borders->method_count; method++) {
            const BorderCell cell = cell_at(borders, study, method);
            borders->methods[method].held += cell.held / borders->study_count;
            borders->methods[method].as_far += holds_as_far(borders, study, method, &cell);
            const BorderCell other = compared_with(borders, study, method);
            borders->hatched |= next_difference(&cell, &other, &(int){0}, &(BorderSpan){0});
            borders->studies[study].held += cell.held;
            applicable += cell.row != NULL && cell.row->verdict != CELL_NOT_APPLICABLE;
            double decided = 0;
            for (int i = 0; i < cell.count; i++) {
                decided += cell.spans[i].to - cell.spans[i].from;
                if (!cell.spans[i].holds) borders->used[cell.spans[i].look] = true;
            }
            if (cell.row != NULL && cell.row->verdict == CELL_NOT_APPLICABLE)
                borders->used[CELL_NOT_APPLICABLE] = true;
            else if (cell.row != NULL && decided < 1 - least_seen)
                borders->used[VERDICT_UNDECIDED] = true;
        }
        if (applicable > 0) borders->studies[study].held /= applicable;
    }
}

/* Ties stay in the order of the table, whose rows are in an array. */
static int by_study(const void *a, const void *b) {
    const BorderStudy *one = a, *other = b;
    if (one->struck != other->struck) return one->struck ? 1 : -1;
    if (one->held != other->held) return one->held < other->held ? 1 : -1;
    return one->row < other->row ? -1 : 1;
}

static int by_method(const void *a, const void *b) {
    const BorderMethod *one = a, *other = b;
    const bool reference = strcmp(one->row->method, "reference") == 0;
    if (reference != (strcmp(other->row->method, "reference") == 0)) return reference ? -1 : 1;
    if (one->held != other->held) return one->held < other->held ? 1 : -1;
    return one->row < other->row ? -1 : 1;
}

/* mm: of the widest word of a name, which is broken at spaces and behind colons and commas. */
static double word_width(const char *name) {
    char word[STABILITY_TEXT_SIZE];
    double widest = 0;
    for (const char *start = name; *start != '\0';) {
        const size_t length = strcspn(start, " :,");
        snprintf(word, sizeof word, "%.*s", (int)length + (start[length] != '\0'), start);
        widest = fmax(widest, type_width(word, small_points));
        start += length + (start[length] != '\0');
    }
    return widest;
}

/* Names wider than a column alternate between two heights, and so have twice the room; the last one needs half a column
   beside its own. A word that is still too long is smaller. */
static void lay_out_names(Borders *borders) {
    double widest = 0;
    for (int i = 0; i < borders->method_count; i++) widest = fmax(widest, word_width(borders->methods[i].name));
    borders->tiers = widest > borders->column - name_gap && borders->method_count > 1 ? 2 : 1;
    if (borders->tiers == 2) {
        const double columns = borders->method_count + 0.5;
        borders->column = fmin((FIGURE_PAGE_WIDTH - borders->label - edge) / columns, most_column);
        borders->width = fmax(borders->label + borders->column * columns + edge, FIGURE_COLUMN_WIDTH);
    }
    const double room = borders->tiers * borders->column - name_gap;
    for (int i = 0; i < borders->method_count; i++) {
        BorderMethod *method = &borders->methods[i];
        method->points = small_points * fmin(fmax(0.98 * room / word_width(method->name), least_size), 1);
        method->lines = text_wrap(method->name, sizeof method->name, method->points, room);
        if (method->lines > borders->lines) borders->lines = method->lines;
    }
}

/* Of a few studies the methods' names, which may be long, stand beside the rows. The columns share the page, up to a
   width. */
static void lay_out(Borders *borders) {
    const int columns = borders->few ? borders->study_count : borders->method_count;
    double label = 0;
    for (int i = 0; borders->few && i < borders->method_count; i++)
        label = fmax(label, type_width(borders->methods[i].name, title_points));
    for (int i = 0; !borders->few && i < borders->study_count; i++)
        label = fmax(label, type_width(borders->studies[i].title, title_points) + text_gap +
                                type_width(borders->studies[i].extent, small_points));
    borders->label = fmin(edge + label + text_gap, most_label);
    borders->column =
        fmin((FIGURE_PAGE_WIDTH - borders->label - right) / columns, borders->few ? most_study : most_column);
    borders->width = fmax(borders->label + borders->column * columns + right, FIGURE_COLUMN_WIDTH);
    if (!borders->few) lay_out_names(borders);
}

/* mm: the left edge of a column. */
static double column_left(const Borders *borders, int i) { return borders->label + borders->column * i; }

/* The names of methods; a line leads from those of the upper tier to their column. */
static void draw_head(const Borders *borders, double bottom) {
    const double tier = borders->lines * line_height(small_points) + head_gap;
    const Pen leader = pen_line(0xB0B0B0, 0.8, NULL);
    for (int i = 0; i < borders->method_count; i++) {
        const BorderMethod *method = &borders->methods[i];
        const bool upper = borders->tiers == 2 && i % 2 == 1;
        const double x = column_left(borders, i) + borders->column / 2, low = bottom + head_gap + (upper ? tier : 0);
        if (upper) sketch_line(borders->sketch, (Point){x, bottom}, (Point){x, low - 0.4}, &leader);
        plot_text(borders->sketch, (Point){x, low + (method->lines - 0.5) * line_height(small_points)}, TEXT_CENTER,
                  method->points, method->name);
    }
}

/* In how many studies a method holds as far as can be. */
static void draw_as_far(const Borders *borders, double y) {
    const bool reference = find_reference(borders) >= 0;
    char text[STABILITY_TEXT_SIZE];
    snprintf(text, sizeof text, "%s, of %d", reference ? "As far as the reference" : "Over the whole range",
             borders->study_count);
    plot_text(borders->sketch, (Point){edge, y}, TEXT_LEFT, title_points, text);
    for (int i = reference; i < borders->method_count; i++) {
        snprintf(text, sizeof text, "%d", borders->methods[i].as_far);
        plot_text(borders->sketch, (Point){column_left(borders, i) + borders->column / 2, y}, TEXT_CENTER, title_points,
                  text);
    }
}

static void fill(Sketch *sketch, double from, double to, double y, uint32_t colour) {
    sketch_rectangle(sketch, (Point){from, y - tile_height / 2}, (Point){to, y + tile_height / 2},
                     &(Pen){colour, 1, NO_COLOUR, 0, NULL});
}

/* A verdict's symbol, in the middle of a part that has room for it. */
static void put_symbol(Sketch *sketch, double from, double to, double y, int look) {
    const Tile tile = {.at = {(from + to) / 2, y}, .look = look};
    if (to - from >= least_symbol) verdict_draw_symbol(sketch, &tile, symbol_width);
}

/* A span's ends on the page. What fails is always seen, be it a single value. */
static BorderSpan placed(const BorderSpan *span, double left, double width) {
    BorderSpan out = *span;
    out.from = left + width * span->from;
    out.to = left + width * span->to;
    if (!span->holds && out.to - out.from < least_fail) {
        out.from = fmin(out.from, left + width - least_fail);
        out.to = out.from + least_fail;
    }
    return out;
}

/* The value up to which the first part holds, at that part's end. False: no room. */
static bool put_number(Sketch *sketch, const BorderSpan *span, bool at_right, bool halo, double value, double y) {
    char text[32];
    snprintf(text, sizeof text, fabs(value) >= 10 && fabs(value) < 1e5 ? "%.0f" : "%.2g", value);
    if (span->to - span->from < type_width(text, small_points) + 2 * number_gap) return false;
    const TextStyle style = {.points = small_points,
                             .align = at_right ? TEXT_RIGHT : TEXT_LEFT,
                             .colour = span->holds ? 0x000000 : verdict_looks[span->look].ink,
                             .halo = halo && span->holds};
    sketch_text(sketch, (Point){at_right ? span->to - number_gap : span->from + number_gap, y}, &style, "%s", text);
    return true;
}

/* The first border's value stands in the part that holds or, if that is too narrow, in the one that fails. */
static int number_border(Sketch *sketch, const BorderCell *cell, const BorderSpan *spans, bool halo, double y) {
    const int holds = cell->count > 0 && !spans[0].holds, fails = !holds;
    if (cell->count == 0 || holds >= cell->count || isnan(cell->row->holds_at) || border_holds_throughout(cell))
        return -1;
    if (put_number(sketch, &spans[holds], holds == 0, halo, cell->row->holds_at, y) || fails >= cell->count) return -1;
    return put_number(sketch, &spans[fails], holds != 0, halo, cell->row->holds_at, y) ? fails : -1;
}

static void draw_cell(const Borders *borders, int study, int method, double y) {
    const BorderCell cell = cell_at(borders, study, method);
    const StabilityStudy *known = borders->studies[study].known;
    const double left = column_left(borders, borders->few ? study : method) + column_gap / 2,
                 width = borders->column - column_gap;
    BorderSpan spans[2 * BORDERS_MAX];
    if (cell.row == NULL) return;
    if (cell.row->verdict == CELL_NOT_APPLICABLE) {
        put_symbol(borders->sketch, left, left + width, y, CELL_NOT_APPLICABLE);
        return;
    }
    fill(borders->sketch, left, left + width, y, verdict_looks[VERDICT_UNDECIDED].fill);
    for (int i = 0; i < cell.count; i++) {
        spans[i] = placed(&cell.spans[i], left, width);
        fill(borders->sketch, spans[i].from, spans[i].to, y,
             spans[i].holds ? verdict_looks[VERDICT_MOVES].fill : verdict_looks[spans[i].look].fill);
    }
    const BorderCell other = compared_with(borders, study, method);
    BorderSpan part;
    const bool hatched = next_difference(&cell, &other, &(int){0}, &part);
    for (int i = 0; next_difference(&cell, &other, &i, &part);)
        verdict_hatch(borders->sketch, (Point){left + width * part.from, y - tile_height / 2},
                      (Point){left + width * part.to, y + tile_height / 2},
                      part.holds ? verdict_looks[VERDICT_MOVES].ink : verdict_looks[part.look].ink);
    const int numbered = number_border(borders->sketch, &cell, spans, hatched, y);
    for (int i = 0; i < cell.count; i++)
        if (!spans[i].holds && i != numbered) put_symbol(borders->sketch, spans[i].from, spans[i].to, y, spans[i].look);
    /* Ticks at the edges of the cell, up to which rigid boxes hold. */
    for (int up = -1; known != NULL && known->rigid != NULL && up <= 1; up += 2) {
        const double x = left + width * border_range_share(&borders->studies[study].range, known->rigid());
        sketch_line(borders->sketch, (Point){x, y + up * row_height / 2}, (Point){x, y + up * tick_end}, &rigid_pen);
    }
}

static int legend_columns(const Borders *borders) { return (int)((borders->width - edge) / legend_item); }

static void draw_legend(const Borders *borders, double foot, int rows) {
    const LegendPlace place = {edge, foot + LEGEND_ROW * (rows - 0.5), legend_item, legend_columns(borders)};
    int next = verdict_draw_legend(borders->sketch, borders->used, &place);
    const bool shown[] = {borders->few, borders->rigid, borders->hatched};
    for (int sample = 0; sample < 3; sample++) {
        if (!shown[sample]) continue;
        const Point at = {edge + legend_item * (next % place.columns), place.top - LEGEND_ROW * (next / place.columns)};
        if (sample == 0)
            fill(borders->sketch, at.x, at.x + 2.9, at.y, verdict_looks[VERDICT_MOVES].fill);
        else if (sample == 2)
            verdict_hatch(borders->sketch, (Point){at.x, at.y - 1.4}, (Point){at.x + 2.9, at.y + 1.4}, 0x000000);
        else
            sketch_line(borders->sketch, (Point){at.x + 1.4, at.y - 1.5}, (Point){at.x + 1.4, at.y + 1.5}, &rigid_pen);
        plot_text(borders->sketch, (Point){at.x + 4.2, at.y}, TEXT_LEFT, LEGEND_POINTS,
                  sample == 0   ? "holds"
                  : sample == 1 ? "rigid boxes"
                                : HATCHED_WORDS);
        next++;
    }
}

/* Rows of studies, under a heading for those that are struck and one for the others. Returns where they begin. */
static double draw_studies(const Borders *borders, double below) {
    const bool both = borders->struck_count > 0 && borders->struck_count < borders->study_count;
    const double top = below + row_height * (borders->study_count + 1) + heading_height * (both ? 2 : 1);
    double y = top - row_height / 2;
    draw_head(borders, top);
    draw_as_far(borders, y);
    const double end = borders->label - text_gap;
    const Pen rule = pen_line(0x909090, 0.8, NULL);
    const TextStyle soft = {.points = small_points, .align = TEXT_RIGHT, .colour = SOFT_COLOUR};
    for (int i = 0; i < borders->study_count; i++) {
        const BorderStudy *study = &borders->studies[i];
        if (i == 0 || study->struck != borders->studies[i - 1].struck) { /* what blue means in the rows below */
            const double middle = y - row_height / 2 - heading_height / 2, line = middle + heading_height / 2 - 0.6;
            sketch_line(borders->sketch, (Point){edge, line},
                        (Point){column_left(borders, borders->method_count), line}, &rule);
            fill(borders->sketch, edge, edge + tile_height, middle - 0.4, verdict_looks[VERDICT_MOVES].fill);
            plot_text(borders->sketch, (Point){edge + tile_height + 1.3, middle - 0.4}, TEXT_LEFT, title_points,
                      study->struck ? "struck: no box falls" : "holds");
            y -= heading_height;
        }
        y -= row_height;
        const double room = end - edge - text_gap - type_width(study->extent, small_points);
        plot_text(borders->sketch, (Point){edge, y}, TEXT_LEFT, text_points(study->title, title_points, room),
                  study->title);
        sketch_text(borders->sketch, (Point){end, y}, &soft, "%s", study->extent);
        for (int method = 0; method < borders->method_count; method++) draw_cell(borders, i, method, y);
    }
    return top + borders->tiers * (borders->lines * line_height(small_points) + head_gap) + head_gap;
}

/* Rows of methods; above the columns the names of the studies and their ranges. */
static double draw_methods(const Borders *borders, double below) {
    const double top = below + row_height * borders->method_count;
    double highest = top;
    for (int i = 0; i < borders->study_count; i++) {
        const BorderStudy *study = &borders->studies[i];
        const TextStyle soft = {.points = small_points, .colour = SOFT_COLOUR};
        const double left = column_left(borders, i) + column_gap / 2, low = top + head_gap + line_height(small_points);
        char title[STABILITY_TEXT_SIZE];
        snprintf(title, sizeof title, "%s", study->title);
        const int lines = text_wrap(title, sizeof title, title_points, borders->column - column_gap);
        const double high = low + lines * line_height(title_points);
        sketch_text(borders->sketch, (Point){left, low - line_height(small_points) / 2}, &soft, "%s", study->extent);
        plot_text(borders->sketch, (Point){left, high - line_height(title_points) / 2}, TEXT_LEFT, title_points, title);
        highest = fmax(highest, high + head_gap);
    }
    for (int method = 0; method < borders->method_count; method++) {
        const double y = top - row_height * (method + 0.5), room = borders->label - edge - text_gap;
        const char *name = borders->methods[method].name;
        plot_text(borders->sketch, (Point){edge, y}, TEXT_LEFT, text_points(name, title_points, room), name);
        for (int study = 0; study < borders->study_count; study++) draw_cell(borders, study, method, y);
    }
    return highest;
}

static void write_caption(const Borders *borders, PlotPage *page) {
    WordList words = {0};
    text_add(
        page->caption, sizeof page->caption,
        "How far each method holds. A cell is the study's range, from its easy end (left) to its hard one. Blue "
        "holds, another colour fails in the way that its symbol shows, and where a shift of a micrometre decides it "
        "is pale. The number is the last value that holds, rounded. A stroke: the method does not apply; an empty "
        "cell: not in the study. Sorted by what holds, the reference first.%s",
        borders->rigid ? " Ticks: rigid boxes hold up to here, in closed form." : "");
    if (borders->struck_count > 0) text_add(page->caption, sizeof page->caption, " %s", stability_struck_words);
    for (int i = 0; i < borders->study_count; i++)
        if (stability_unconverged(borders->unconverged, borders->studies[i].row->study,
                                  (char[UNCONVERGED_TEXT_SIZE]){0})) {
            text_add(page->caption, sizeof page->caption, " %s", stability_unconverged_words);
            break;
        }
    left_out_draw(&borders->foot, page, edge);
    for (int i = 0; i < borders->method_count; i++) words_add_method(&words, borders->methods[i].row->method);
    for (int i = 0; i < borders->method_count; i++)
        words_add_settings(&words, borders->methods[i].row->method, borders->methods[i].row->setting);
    words_join(&words, page->caption, sizeof page->caption);
}

bool stability_borders_write(const CsvTable *table, const CsvTable *unconverged, const StabilityOwn *own,
                             PlotPage *page, Error *error) {
    Borders borders = {.table = table, .unconverged = unconverged, .own = own, .sketch = &page->sketch};
    if (!gather(&borders, error)) return false;
    borders.few = borders.study_count <= FEW_STUDIES;
    measure(&borders);
    qsort(borders.studies, (size_t)borders.study_count, sizeof *borders.studies, by_study);
    qsort(borders.methods, (size_t)borders.method_count, sizeof *borders.methods, by_method);
    lay_out(&borders);
    /* From the foot: what is left out, legend, rows, names. */
    int items = borders.rigid + borders.few + borders.hatched;
    for (int look = 0; look < VERDICT_LOOKS; look++) items += borders.used[look];
    const int columns = legend_columns(&borders), rows = (items + columns - 1) / columns;
    const double foot = NOTE_ROW * left_out_rows(&borders.foot, borders.width - edge - 1) + 1;
    const double below = foot + LEGEND_ROW * rows + 1;
    sketch_begin(borders.sketch, borders.width, 0);
    borders.sketch->height = borders.few ? draw_methods(&borders, below) : draw_studies(&borders, below);
    draw_legend(&borders, foot, rows);
    write_caption(&borders, page);
    return true;
}
