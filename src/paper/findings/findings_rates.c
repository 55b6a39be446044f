/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates of right predictions beside those of cheaper predictors. */
#include "paper/findings/findings_tables.h"

#include <math.h>

/* Networks that vary another factor are not in the report's tables of rates. */
static bool is_main(const StudyTables *study, const RateRow *row) {
    return study_has_factor(study, row->network, "baseline") || study_has_factor(study, row->network, "best") ||
           study_has_factor(study, row->network, "contact-net");
}

static double warm_start_rate(const StudyTables *study, const RateRow *row) {
    const RateRow *warm = study_rate_of(study, "warm-start", row);
    return warm != NULL ? warm->share[RATE_NETWORK] : NAN;
}

/* Of the main networks: in how many rows something cheaper is right at least as often. Of the baseline over all frames:
   its lowest and highest rate. */
typedef struct DefinitionRow {
    const char *definition;
    int rows, constant, warm_start, one_sweep;
    int baseline_scenes, baseline_constant;
    double baseline_low, baseline_high;
} DefinitionRow;

static void count_row(const StudyTables *study, const RateRow *rate, DefinitionRow *row) {
    const double share = rate->share[RATE_NETWORK];
    row->rows++;
    row->constant += share <= rate->share[RATE_CONSTANT];
    row->warm_start += share <= warm_start_rate(study, rate);
    row->one_sweep += share <= rate->share[RATE_ENGINE1];
    if (rate->phase != RATE_ALL || isnan(share) || !study_has_factor(study, rate->network, "baseline")) return;
    row->baseline_scenes++;
    row->baseline_constant += share <= rate->share[RATE_CONSTANT];
    row->baseline_low = fmin(row->baseline_low, share); /* of a number and NAN, the number */
    row->baseline_high = fmax(row->baseline_high, share);
}

static bool write_definitions(const FindingsFile *file, const StudyTables *study) {
    for (RateDefinition definition = 0; definition < RATE_DEFINITIONS; definition++) {
        DefinitionRow row = {
            .definition = rate_definition_names[definition], .baseline_low = NAN, .baseline_high = NAN};
        for (int i = 0; i < study->rate_count; i++)
            if (study->rates[i].definition == (int)definition && is_main(study, &study->rates[i]))
                count_row(study, &study->rates[i], &row);
        if (!findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn definition_columns[] = {
    FINDINGS_TEXT(DefinitionRow, definition),        FINDINGS_COUNT(DefinitionRow, rows),
    FINDINGS_COUNT(DefinitionRow, constant),         FINDINGS_COUNT(DefinitionRow, warm_start),
    FINDINGS_COUNT(DefinitionRow, one_sweep),        FINDINGS_COUNT(DefinitionRow, baseline_scenes),
    FINDINGS_NUMBER(DefinitionRow, baseline_low),    FINDINGS_NUMBER(DefinitionRow, baseline_high),
    FINDINGS_COUNT(DefinitionRow, baseline_constant)};
const FindingsTable findings_definitions =
    FINDINGS_TABLE("definitions", definition_columns, DefinitionRow, write_definitions);
