/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/findings/study_tables.h"

#include <math.h>
#include <string.h>

bool study_tables_read(StudyTables *study, const char *folder, Error *error) {
    const CsvLayout *const layouts[STUDY_TABLES] = {
        &paper_score_layout, &paper_trained_layout,  &paper_rate_layout,   &paper_closed_loop_layout,
        &paper_law_layout,   &paper_transfer_layout, &system_score_layout, &claim_layout};
    memset(study, 0, sizeof *study);
    CsvTable *table = study->tables;
    for (int i = 0; i < STUDY_TABLES; i++) {
        if (csv_table_read_from(&table[i], folder, layouts[i], error)) continue;
        study_tables_free(study);
        return false;
    }
    study->scores = table[0].rows, study->score_count = table[0].count;
    study->networks = table[1].rows, study->network_count = table[1].count;
    study->rates = table[2].rows, study->rate_count = table[2].count;
    study->runs = table[3].rows, study->run_count = table[3].count;
    study->laws = table[4].rows, study->law_count = table[4].count;
    study->transfers = table[5].rows, study->transfer_count = table[5].count;
    study->system_scores = table[6].rows, study->system_score_count = table[6].count;
    study->claims = table[7].rows, study->claim_count = table[7].count;
    return true;
}

void study_tables_free(StudyTables *study) {
    for (int i = 0; i < STUDY_TABLES; i++) csv_table_free(&study->tables[i]);
}

const TrainedRow *study_network(const StudyTables *study, const char *name) {
    for (int i = 0; i < study->network_count; i++)
        if (strcmp(study->networks[i].network, name) == 0) return &study->networks[i];
    return NULL;
}

const TrainedRow *study_baseline(const StudyTables *study) {
    for (int i = 0; i < study->network_count; i++)
        if (strcmp(study->networks[i].factor, "baseline") == 0)
            return isnan(study->networks[i].ratio) ? NULL : &study->networks[i];
    return NULL;
}

bool study_has_factor(const StudyTables *study, const char *network, const char *factor) {
    const TrainedRow *row = study_network(study, network);
    return row != NULL && strcmp(row->factor, factor) == 0;
}

const TrainedRow *study_best(const StudyTables *study, PairTarget target, const char *factor, double max_parameters,
                             int *among) {
    const TrainedRow *best = NULL;
    *among = 0;
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *row = &study->networks[i];
        if (row->target != (int)target || isnan(row->ratio) || !(row->parameters <= max_parameters)) continue;
        if (factor != NULL && strcmp(row->factor, factor) != 0) continue;
        ++*among;
        if (best == NULL || row->ratio < best->ratio) best = row;
    }
    return best;
}

const RateRow *study_rate_of(const StudyTables *study, const char *network, const RateRow *row) {
    for (int i = 0; i < study->rate_count; i++) {
        const RateRow *other = &study->rates[i];
        if (strcmp(other->network, network) == 0 && other->scene == row->scene &&
            other->definition == row->definition && other->phase == row->phase)
            return other;
    }
    return NULL;
}

double ratio_of(double a, double b) { return b > 0 ? a / b : NAN; }
