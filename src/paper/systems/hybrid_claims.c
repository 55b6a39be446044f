/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The claims of in-situ adaptive tabulation and of the paper's description of Ajay et al., judged from
   system_hybrid.csv. */
#include "paper/systems/hybrid_study.h"

#include "paper/figures/plot_parts.h"

#include <math.h>
#include <stdlib.h>

enum { SCENES = 3 };

/* Those that the issue of memory is about: single, stack, settled pyramid. */
static const int scenes[SCENES] = {0, 1, 3};

static const double standard_tolerance = 0.1; /* m/s */

typedef struct Rows {
    const HybridRow *items;
    int count;
} Rows;

/* The last row of a scene's learning with the standard tolerance: of one family; before a change; after it. NULL:
   none. */
typedef enum Part { ONE_FAMILY, BEFORE_CHANGE, AFTER_CHANGE } Part;

static const HybridRow *last_row(const Rows *rows, int scene, Part part) {
    const HybridRow *found = NULL;
    for (int i = 0; i < rows->count; i++) {
        const HybridRow *row = &rows->items[i];
        if (row->scene == scene && row->changes == (part != ONE_FAMILY) && row->turned == (part == AFTER_CHANGE) &&
            fabs(row->tolerance - standard_tolerance) < 1e-6)
            found = row;
    }
    return found;
}

static double value(const HybridRow *row, double number) { return row != NULL ? number : NAN; }

#define OF_ROW(row, member) value(row, (row) != NULL ? (row)->member : 0)

static bool claim_growth(const Claims *claims, const Rows *rows, Error *error) {
    double share[SCENES];
    int holding = 0;
    for (int i = 0; i < SCENES; i++) {
        share[i] = OF_ROW(last_row(rows, scenes[i], ONE_FAMILY), share);
        holding += share[i] >= 0.5;
    }
    const Claim claim = {
        "After some launches most queries are answered from memory", "Pope 1997, section 4",
        "share of steps with an impact that the memory answers after all launches of one family; at least half "
        "(single, stack, settled pyramid)",
        claim_in_cases(holding, SCENES)};
    return claim_state(claims, &claim, error, "%.0f%%, %.0f%%, %.0f%%", 100 * share[0], 100 * share[1], 100 * share[2]);
}

static bool claim_error(const Claims *claims, const Rows *rows, Error *error) {
    double wrong[SCENES];
    int holding = 0;
    for (int i = 0; i < SCENES; i++) {
        wrong[i] = OF_ROW(last_row(rows, scenes[i], ONE_FAMILY), error_95);
        holding += wrong[i] <= standard_tolerance;
    }
    const Claim claim = {
        "The error of answers stays within the tolerance", "Pope 1997, section 4; Lu and Pope 2009",
        "95% of the answers on launches not learned are within the tolerance of 0.1 m/s (single, stack, "
        "settled pyramid)",
        claim_in_cases(holding, SCENES)};
    return claim_state(claims, &claim, error, "%.3g, %.3g, %.3g m/s", wrong[0], wrong[1], wrong[2]);
}

static bool claim_speed(const Claims *claims, const Rows *rows, Error *error) {
    double factor[SCENES], whole[SCENES];
    int holding = 0;
    for (int i = 0; i < SCENES; i++) {
        const HybridRow *row = last_row(rows, scenes[i], ONE_FAMILY);
        factor[i] = OF_ROW(row, us_solve) / OF_ROW(row, us_answer);
        whole[i] = OF_ROW(row, us_step_solve) / OF_ROW(row, us_step);
        holding += whole[i] >= 2;
    }
    const Claim claim = {
        "Tabulation is faster than solving, by orders of magnitude", "Pope 1997, section 4 (a factor of 1000)",
        "time of interior:near=0.001 over that of hybrid, on answered steps and, in brackets, on all steps with an "
        "impact, of which the latter is at least 2 (single, stack, settled pyramid)",
        claim_in_cases(holding, SCENES)};
    return claim_state(claims, &claim, error, "%.3g (%.3g), %.3g (%.3g), %.3g (%.3g) times", factor[0], whole[0],
                       factor[1], whole[1], factor[2], whole[2]);
}

static bool claim_paid(const Claims *claims, const Rows *rows, Error *error) {
    char text[SCENES][24];
    int holding = 0;
    for (int i = 0; i < SCENES; i++) {
        const double paid = OF_ROW(last_row(rows, scenes[i], ONE_FAMILY), paid);
        if (isnan(paid))
            snprintf(text[i], sizeof text[i], "never");
        else
            snprintf(text[i], sizeof text[i], "%.0f", paid);
        holding += !isnan(paid);
    }
    const Claim claim = {
        "The time saved pays for the learning", "the paper's description of Ajay et al. 2019",
        "launch from which on time saved exceeds the time spent on learning and questions, with one family "
        "(single, stack, settled pyramid)",
        claim_in_cases(holding, SCENES)};
    return claim_state(claims, &claim, error, "%s, %s, %s", text[0], text[1], text[2]);
}

static bool claim_change(const Claims *claims, const Rows *rows, Error *error) {
    double before[SCENES], after[SCENES];
    int holding = 0;
    for (int i = 0; i < SCENES; i++) {
        before[i] = OF_ROW(last_row(rows, scenes[i], BEFORE_CHANGE), share);
        after[i] = OF_ROW(last_row(rows, scenes[i], AFTER_CHANGE), share);
        holding += after[i] >= 0.5 * before[i];
    }
    const Claim claim = {
        "The memory grows into new situations", "the paper's description of Ajay et al. 2019",
        "share answered before bombs turn and spin, and after as many launches with it; at least half of that "
        "before (single, stack, settled pyramid)",
        claim_in_cases(holding, SCENES)};
    return claim_state(claims, &claim, error, "%.0f%% and %.0f%%, %.0f%% and %.0f%%, %.0f%% and %.0f%%",
                       100 * before[0], 100 * after[0], 100 * before[1], 100 * after[1], 100 * before[2],
                       100 * after[2]);
}

bool hybrid_claim(const Claims *claims, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, claims->folder, &hybrid_layout, error)) return false;
    const Rows rows = {table.rows, table.count};
    const bool ok = claim_growth(claims, &rows, error) && claim_error(claims, &rows, error) &&
                    claim_speed(claims, &rows, error) && claim_paid(claims, &rows, error) &&
                    claim_change(claims, &rows, error);
    csv_table_free(&table);
    return ok;
}

const PaperSystem system_hybrid = {.name = "hybrid",
                                   .methods = SYSTEM_METHODS("hybrid", "hybrid:net=off"),
                                   .table = &hybrid_layout,
                                   .parts = hybrid_parts,
                                   .claim = hybrid_claim,
                                   .plot = plot_hybrid};
