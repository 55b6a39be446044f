/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws in the loss: medians over the seeds. */
#include "paper/findings/findings_outlook.h"
#include "paper/findings/findings_tables.h"
#include "study/statistics.h"

#include <math.h>

typedef struct LawCase {
    const char *laws;
    int seeds;
    double weight, test, lowest_test, highest_test, ratio;
    double momentum, energy, approach, cone;
} LawCase;

/* The engine's rows have no weight: they are a case, too. */
static bool same_case(const LawRow *a, const LawRow *b) {
    return a->laws == b->laws && (a->weight == b->weight || (isnan(a->weight) && isnan(b->weight)));
}

typedef double Value(const LawRow *row);

static double test_of(const LawRow *row) { return row->test; }
static double relative_test_of(const LawRow *row) { return ratio_of(row->test, row->constant); }
static double momentum_of(const LawRow *row) { return row->violation[LAW_MOMENTUM]; }
static double energy_of(const LawRow *row) { return row->violation[LAW_ENERGY]; }
static double approach_of(const LawRow *row) { return row->violation[LAW_APPROACH]; }
static double cone_of(const LawRow *row) { return row->violation[LAW_CONE]; }

/* A quantile over the seeds of a case; 0 and 1 are the least and the most. */
static double quantile(const StudyTables *study, const LawRow *of, Value *value, double fraction) {
    double values[PAPER_MAX_ROWS];
    int count = 0;
    for (int i = 0; i < study->law_count; i++)
        if (same_case(&study->laws[i], of) && !isnan(value(&study->laws[i]))) values[count++] = value(&study->laws[i]);
    return statistics_quantile(values, count, fraction);
}

static LawCase case_of(const StudyTables *study, const LawRow *row) {
    LawCase law_case = {.laws = paper_law_words[row->laws],
                        .weight = row->weight,
                        .test = quantile(study, row, test_of, 0.5),
                        .lowest_test = quantile(study, row, test_of, 0),
                        .highest_test = quantile(study, row, test_of, 1),
                        .ratio = quantile(study, row, relative_test_of, 0.5),
                        .momentum = quantile(study, row, momentum_of, 0.5),
                        .energy = quantile(study, row, energy_of, 0.5),
                        .approach = quantile(study, row, approach_of, 0.5),
                        .cone = quantile(study, row, cone_of, 0.5)};
    for (int i = 0; i < study->law_count; i++) law_case.seeds += same_case(&study->laws[i], row);
    return law_case;
}

static bool is_first_of_case(const StudyTables *study, int row) {
    for (int i = 0; i < row; i++)
        if (same_case(&study->laws[i], &study->laws[row])) return false;
    return true;
}

static bool write_laws(const FindingsFile *file, const StudyTables *study) {
    for (int i = 0; i < study->law_count; i++) {
        if (!is_first_of_case(study, i)) continue;
        const LawCase row = case_of(study, &study->laws[i]);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn columns[] = {
    FINDINGS_TEXT(LawCase, laws),       FINDINGS_NUMBER(LawCase, weight),      FINDINGS_COUNT(LawCase, seeds),
    FINDINGS_NUMBER(LawCase, test),     FINDINGS_NUMBER(LawCase, lowest_test), FINDINGS_NUMBER(LawCase, highest_test),
    FINDINGS_NUMBER(LawCase, ratio),    FINDINGS_NUMBER(LawCase, momentum),    FINDINGS_NUMBER(LawCase, energy),
    FINDINGS_NUMBER(LawCase, approach), FINDINGS_NUMBER(LawCase, cone)};
const FindingsTable findings_laws = FINDINGS_TABLE("laws", columns, LawCase, write_laws);

LawCounts law_counts(const StudyTables *study) {
    static Value *const violations[LAWS] = {
        [LAW_MOMENTUM] = momentum_of, [LAW_ENERGY] = energy_of, [LAW_APPROACH] = approach_of, [LAW_CONE] = cone_of};
    LawCounts counts = {0};
    const LawRow *none = NULL;
    for (int i = 0; i < study->law_count && none == NULL; i++)
        if (study->laws[i].laws == LAW_SET_NONE) none = &study->laws[i];
    for (int i = 0; none != NULL && i < study->law_count; i++) {
        const LawRow *row = &study->laws[i];
        if (row->laws >= LAWS || !(row->weight > 0) || !is_first_of_case(study, i)) continue;
        Value *const violation = violations[row->laws];
        counts.cases++;
        counts.obeyed += quantile(study, row, violation, 0.5) < quantile(study, none, violation, 0.5);
        counts.better += quantile(study, row, test_of, 0.5) < quantile(study, none, test_of, 0.5);
    }
    return counts;
}
