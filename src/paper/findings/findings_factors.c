/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks that differ from the baseline in one factor. */
#include "paper/findings/findings_tables.h"
#include "paper/study/published.h"

#include <math.h>
#include <string.h>

static bool is_factor(const StudyTables *study, int network) {
    const char *factor = study->networks[network].factor;
    if (strcmp(factor, "baseline") == 0) return false;
    for (int i = 0; i < network; i++)
        if (strcmp(study->networks[i].factor, factor) == 0) return false;
    return true;
}

typedef struct FactorRow {
    const char *factor, *best, *verdict;
    int networks, passed; /* passed: the paper's gate */
    double ratio, baseline_ratio;
} FactorRow;

static const char *compare(const TrainedRow *best, const TrainedRow *baseline) {
    if (best->ratio >= 1)
        return baseline->ratio < 1 ? "worse than the constant predictor" : "neither beats the constant predictor";
    return best->ratio < baseline->ratio ? "better than the baseline" : "not better than the baseline";
}

/* Only networks with the same target can be compared. */
static void find_best(const StudyTables *study, FactorRow *row) {
    int among;
    const TrainedRow *baseline = study_baseline(study);
    if (baseline == NULL) return;
    row->baseline_ratio = baseline->ratio;
    const TrainedRow *best = study_best(study, (PairTarget)baseline->target, row->factor, INFINITY, &among);
    if (best == NULL) return;
    row->best = best->value;
    row->ratio = best->ratio;
    row->verdict = compare(best, baseline);
}

static bool write_factors(const FindingsFile *file, const StudyTables *study) {
    for (int first = 0; first < study->network_count; first++) {
        if (!is_factor(study, first)) continue;
        FactorRow row = {
            .factor = study->networks[first].factor, .best = "", .verdict = "", .ratio = NAN, .baseline_ratio = NAN};
        for (int i = first; i < study->network_count; i++) {
            if (strcmp(study->networks[i].factor, row.factor) != 0) continue;
            row.networks++;
            row.passed += study->networks[i].accuracy > PUBLISHED_GATE;
        }
        find_best(study, &row);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn factor_columns[] = {
    FINDINGS_TEXT(FactorRow, factor), FINDINGS_COUNT(FactorRow, networks), FINDINGS_COUNT(FactorRow, passed),
    FINDINGS_TEXT(FactorRow, best),   FINDINGS_NUMBER(FactorRow, ratio),   FINDINGS_NUMBER(FactorRow, baseline_ratio),
    FINDINGS_TEXT(FactorRow, verdict)};
const FindingsTable findings_factors = FINDINGS_TABLE("factors", factor_columns, FactorRow, write_factors);
