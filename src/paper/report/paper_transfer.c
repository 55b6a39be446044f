/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transfer learning: how many launches it saves. */
#include "paper/report/paper_parts.h"
#include "study/statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The median error over the seeds of one number of launches; NAN where there is none. */
static double median_error(const PaperFiles *files, const char *start, double launches, double *values) {
    int count = 0;
    for (int i = 0; i < files->transfer_count; i++)
        if (strcmp(files->transfer[i].start, start) == 0 && files->transfer[i].launches == launches)
            values[count++] = files->transfer[i].error;
    return statistics_quantile(values, count, 0.5);
}

/* The least number of launches above `than` (of any start); INFINITY where there is none. */
static double next_launches(const PaperFiles *files, double than) {
    double next = INFINITY;
    for (int i = 0; i < files->transfer_count; i++)
        if (files->transfer[i].launches > than) next = fmin(next, files->transfer[i].launches);
    return next;
}

typedef struct Point {
    double launches, scratch, transfer; /* median errors, m/s */
} Point;

/* By rising numbers of launches. */
static int gather(const PaperFiles *files, Point *points, double *values) {
    int count = 0;
    for (double n = next_launches(files, -1); isfinite(n); n = next_launches(files, n))
        points[count++] =
            (Point){n, median_error(files, "scratch", n, values), median_error(files, "transfer", n, values)};
    return count;
}

/* The fewest launches with transfer whose median error is at most this; NAN where none is. */
static double launches_needed(const Point *points, int count, double error) {
    for (int i = 0; i < count; i++)
        if (points[i].transfer <= error) return points[i].launches;
    return NAN;
}

static void put_points(Document *document, const Point *points, int count, PaperFindings *findings) {
    document_table(
        document, "Launches of the pyramid needed",
        ">Launches|>Error from scratch (m/s)|>Error after transfer (m/s)|>Launches with transfer for the error "
        "from scratch");
    for (int i = 0; i < count; i++) {
        double needed = launches_needed(points, count, points[i].scratch);
        document_cell(document, "%.0f", points[i].launches);
        document_number(document, points[i].scratch);
        document_number(document, points[i].transfer);
        if (isnan(needed) && !isnan(points[i].scratch))
            document_cell(document, "not reached");
        else
            document_number(document, needed);
        /* Nothing can need fewer than the fewest. */
        findings->transfer_rows += i > 0 && !isnan(points[i].scratch);
        findings->transfer_saved += needed < points[i].launches;
    }
    document_paragraph(
        document,
        "Errors are medians over the seeds. In %d of the %d rows below the first transfer needs fewer launches "
        "than training from scratch.",
        findings->transfer_saved, findings->transfer_rows);
}

static void put_constant(Document *document, const PaperFiles *files, const Point *points, int count) {
    double constant = files->transfer[0].constant, scratch = INFINITY, transfer = INFINITY;
    for (int i = 0; i < count; i++) {
        scratch = fmin(scratch, points[i].scratch);
        transfer = fmin(transfer, points[i].transfer);
    }
    if (isinf(scratch) || isinf(transfer)) return;
    document_paragraph(
        document,
        "The constant's error is %s m/s. From scratch the least is %s m/s (%s it), after transfer %s m/s (%s "
        "it).",
        show_number(constant).text, show_number(scratch).text, scratch < constant ? "below" : "not below",
        show_number(transfer).text, transfer < constant ? "below" : "not below");
}

void paper_put_transfer(Document *document, const PaperFiles *files, PaperFindings *findings) {
    document_heading(document, 2, "Transfer learning");
    document_paragraph(document,
                       "The paper's outlook: a network trained on the single box goes on with the stack, then "
                       "with a few launches of the pyramid; beside it, one that begins with those launches. "
                       "Errors are RMS velocities on pyramid launches held out.");
    double *values = malloc((size_t)files->transfer_count * sizeof *values);
    Point *points = malloc((size_t)files->transfer_count * sizeof *points);
    if (values == NULL || points == NULL) {
        document->failed = true;
    } else {
        int count = gather(files, points, values);
        put_points(document, points, count, findings);
        put_constant(document, files, points, count);
    }
    free(points);
    free(values);
    document_figure(document, &files->figures[FIGURE_TRANSFER]);
}
