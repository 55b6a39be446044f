/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which parts of a study's range hold, from the borders in the table. */
#include "base/base.h"
#include "base/csv.h"
#include "runs/verdict.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <math.h>
#include <string.h>

/* Ranges of other programs' studies are logarithmic from this ratio of their ends on. */
static const double long_range = 8;

const StabilityStudy *border_study(const StabilityOwn *own, const BorderRow *row) {
    const StabilityStudy *studies = own != NULL ? own->studies : stability_studies;
    const int count = own != NULL ? own->study_count : stability_study_count;
    for (int i = 0; i < count; i++)
        if (strcmp(studies[i].name, row->study) == 0 && strcmp(studies[i].parameter, row->parameter) == 0)
            return &studies[i];
    return NULL;
}

BorderRange border_range(const CsvTable *table, int first, const StabilityStudy *study) {
    double least = INFINITY, most = -INFINITY;
    int falling = 0;
    for (int i = first; i < table->count; i++) {
        const BorderRow *row = border_row(table, i);
        if (!border_same_study(row, border_row(table, first))) continue;
        least = fmin(least, fmin(row->holds_at, row->fails_at));
        most = fmax(most, fmax(row->holds_at, row->fails_at));
        falling += (row->fails_at < row->holds_at) - (row->fails_at > row->holds_at);
    }
    if (!(least <= most)) least = most = 0;
    bool logarithmic = least > 0 && most / least > long_range, fails_low = falling > 0, whole = false;
    if (study != NULL) {
        least = study->scan.from;
        most = study->scan.to;
        logarithmic = study->scan.logarithmic;
        whole = study->scan.whole;
        if (!study->scan.either) fails_low = study->scan.fails_low;
    }
    return (BorderRange){fails_low ? most : least, fails_low ? least : most, logarithmic, whole};
}

double border_range_share(const BorderRange *range, double value) {
    const bool logarithmic = range->logarithmic && value > 0;
    if (range->easy == range->hard) return 0.5;
    const double share = logarithmic ? log(value / range->easy) / log(range->hard / range->easy)
                                     : (value - range->easy) / (range->hard - range->easy);
    return fmin(fmax(share, 0), 1);
}

static bool is_in(const BorderRow *row, const BorderRow *study, const BorderRow *method) {
    return border_same_study(row, study) && border_same_method(row, method);
}

static void add_span(BorderCell *cell, double from, double to, bool holds, int look) {
    const BorderSpan *last = cell->count > 0 ? &cell->spans[cell->count - 1] : NULL;
    if (last != NULL && last->holds == holds && last->from == from) return; /* between two borders, it is of both */
    if (cell->count == (int)(sizeof cell->spans / sizeof *cell->spans)) return;
    cell->spans[cell->count++] = (BorderSpan){from, to, holds, look};
    if (holds) cell->held += to - from;
}

/* The same side of the method's next border in this direction; NAN: none. */
static double next_border(const CsvTable *table, const BorderRow *row, const BorderRange *range, bool holds,
                          bool down) {
    const double from = border_range_share(range, holds ? row->holds_at : row->fails_at);
    double next = NAN;
    for (int i = 0; i < table->count; i++) {
        const BorderRow *other = border_row(table, i);
        if (other == row || !is_in(other, row, row)) continue;
        const double at = border_range_share(range, holds ? other->holds_at : other->fails_at);
        if (down ? at <= from && !(at <= next) : at >= from && !(at >= next)) next = at;
    }
    return next;
}

/* Nothing lies between the values, to the resolution of the search. */
static bool are_neighbours(const BorderRange *range, double a, double b) {
    const double factor = 1.06, part = 0.011; /* the resolution and a rounding (border_search) */
    if (range->whole && fabs(a - b) <= 1) return true;
    return range->logarithmic ? fmax(a, b) <= factor * fmin(a, b)
                              : fabs(a - b) <= part * fabs(range->hard - range->easy);
}

/* The parts on both sides of a border; of what fails between two borders, each has its half. */
static void add_border(BorderCell *cell, const CsvTable *table, const BorderRow *row, const BorderRange *range) {
    const double holds = border_range_share(range, row->holds_at);
    const double fails =
        are_neighbours(range, row->holds_at, row->fails_at) ? holds : border_range_share(range, row->fails_at);
    const bool easy = range->hard >= range->easy ? row->holds_at < row->fails_at : row->holds_at > row->fails_at;
    const double next_holds = next_border(table, row, range, true, easy);
    const double next_fails = next_border(table, row, range, false, !easy);
    const double holds_end = isnan(next_holds) ? !easy : next_holds; /* the end of the range */
    const double fails_end = isnan(next_fails) ? easy : (fails + next_fails) / 2;
    if (easy) add_span(cell, holds_end, holds, true, 0);
    add_span(cell, fmin(fails, fails_end), fmax(fails, fails_end), false, row->verdict);
    if (!easy) add_span(cell, holds, holds_end, true, 0);
}

bool border_holds_throughout(const BorderCell *cell) {
    return cell->row != NULL && isnan(cell->row->fails_at) && !isnan(cell->row->holds_at) &&
           verdict_holds((Verdict)cell->row->verdict);
}

BorderCell border_cell(const CsvTable *table, const BorderRow *study, const BorderRow *method,
                       const BorderRange *range) {
    BorderCell cell = {0};
    for (int i = 0; i < table->count; i++) {
        const BorderRow *row = border_row(table, i);
        if (!is_in(row, study, method)) continue;
        if (cell.row == NULL) cell.row = row;
        if (row->verdict == CELL_NOT_APPLICABLE) continue;
        if (!isnan(row->holds_at) && !isnan(row->fails_at))
            add_border(&cell, table, row, range);
        else if (!isnan(row->holds_at))
            add_span(&cell, fmax(next_border(table, row, range, true, true), 0),
                     verdict_holds((Verdict)row->verdict) ? 1 : border_range_share(range, row->holds_at), true, 0);
        else if (!isnan(row->fails_at))
            add_span(&cell, 0, 1, false, row->verdict);
    }
    return cell;
}
