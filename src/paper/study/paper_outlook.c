/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper_outlook.h"

#include "paper/study/paper_tables.h"
#include "study/piece_tables.h"

#include <math.h>
#include <string.h>

void paper_outlook_free(PaperOutlook *outlook) {
    dataset_destroy(outlook->laws);
    for (int i = 0; i < 3; i++) dataset_destroy(outlook->scenes[i]);
}

bool paper_laws_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    PaperLaws *part = context;
    PaperOutlook *outlook = part->outlook;
    if (outlook->laws == NULL) outlook->laws = paper_context_dataset(outlook->datasets, error);
    if (outlook->laws == NULL) return false;
    LawResult result;
    const LawStudy *study = &part->study;
    const bool labels = study->laws == NULL;
    if (!(labels ? law_study_labels(outlook->laws, &result, error)
                 : law_study_train(outlook->laws, study, &result, progress, error)))
        return false;
    LawRow row = {.laws = labels ? LAW_SET_ENGINE : csv_word(paper_law_words, study->laws),
                  .weight = labels ? NAN : study->weight,
                  .seed = labels ? NAN : (double)study->seed,
                  .test = result.test,
                  .constant = result.constant};
    memcpy(row.violation, result.violations.of, sizeof row.violation);
    return piece_tables_print(lines, &paper_law_layout, -1, &row, error);
}

bool paper_transfer_write(void *context, FILE *lines, const Progress *progress, Error *error) {
    PaperTransfer *part = context;
    PaperOutlook *outlook = part->outlook;
    for (int i = 0; i < 3; i++) {
        if (outlook->scenes[i] == NULL)
            outlook->scenes[i] = paper_scene_dataset(outlook->datasets, i, outlook->bomb_x[i], error);
        if (outlook->scenes[i] == NULL) return false;
    }
    const TransferData data = {outlook->scenes[0], outlook->scenes[1], outlook->scenes[2]};
    const TransferStudy *study = &part->study;
    TransferResult result;
    if (!transfer_study_run(&data, study, &result, progress, error)) return false;
    const TransferRow row = {study->transfer, (double)study->seed, study->launches, result.error, result.constant};
    return piece_tables_print(lines, &paper_transfer_layout, -1, &row, error);
}
