/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transfer learning: medians over the seeds, and how many launches it saves. */
#include "paper/findings/findings_outlook.h"
#include "paper/findings/findings_tables.h"
#include "study/statistics.h"

#include <math.h>

typedef struct LaunchesRow {
    double launches, scratch, transfer; /* transfer, scratch: median errors, m/s */
    double needed; /* the fewest launches with transfer for the error from scratch; NAN: none suffice */
} LaunchesRow;

typedef struct Launches {
    int count;
    LaunchesRow rows[PAPER_MAX_ROWS]; /* by rising numbers of launches */
} Launches;

static double median_error(const StudyTables *study, int transfer, double launches) {
    double values[PAPER_MAX_ROWS];
    int count = 0;
    for (int i = 0; i < study->transfer_count; i++) {
        const TransferRow *row = &study->transfers[i];
        if (row->transfer == transfer && row->launches == launches && !isnan(row->error)) values[count++] = row->error;
    }
    return statistics_quantile(values, count, 0.5);
}

/* The lowest number of launches above `than`; INFINITY if there is none. */
static double next_launches(const StudyTables *study, double than) {
    double next = INFINITY;
    for (int i = 0; i < study->transfer_count; i++)
        if (study->transfers[i].launches > than) next = fmin(next, study->transfers[i].launches);
    return next;
}

static double launches_needed(const Launches *all, double error) {
    for (int i = 0; i < all->count; i++)
        if (all->rows[i].transfer <= error) return all->rows[i].launches;
    return NAN;
}

static void find_launches(const StudyTables *study, Launches *all) {
    all->count = 0;
    for (double n = next_launches(study, 0); isfinite(n); n = next_launches(study, n))
        all->rows[all->count++] =
            (LaunchesRow){.launches = n, .scratch = median_error(study, 0, n), .transfer = median_error(study, 1, n)};
    for (int i = 0; i < all->count; i++) all->rows[i].needed = launches_needed(all, all->rows[i].scratch);
}

static bool write_transfer(const FindingsFile *file, const StudyTables *study) {
    Launches all;
    find_launches(study, &all);
    for (int i = 0; i < all.count; i++)
        if (!findings_add(file, &all.rows[i])) return false;
    return true;
}

static const CsvColumn columns[] = {FINDINGS_NUMBER(LaunchesRow, launches), FINDINGS_NUMBER(LaunchesRow, scratch),
                                    FINDINGS_NUMBER(LaunchesRow, transfer), FINDINGS_NUMBER(LaunchesRow, needed)};
const FindingsTable findings_transfer = FINDINGS_TABLE("transfer", columns, LaunchesRow, write_transfer);

TransferCounts transfer_counts(const StudyTables *study) {
    TransferCounts counts = {.constant = study->transfers[0].constant, .scratch = NAN, .transfer = NAN};
    Launches all;
    find_launches(study, &all);
    for (int i = 0; i < all.count; i++) {
        const LaunchesRow *row = &all.rows[i];
        /* Nothing can need fewer than the fewest. */
        counts.rows += i > 0 && !isnan(row->scratch);
        counts.saved += row->needed < row->launches;
        counts.scratch = fmin(counts.scratch, row->scratch); /* of a number and NAN, the number */
        counts.transfer = fmin(counts.transfer, row->transfer);
    }
    return counts;
}
