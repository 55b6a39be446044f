/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/paper_outlook.h"

#include <inttypes.h>

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
    if (study->laws == NULL) {
        if (!law_study_labels(outlook->laws, &result, error)) return false;
        fprintf(lines, "laws:engine,,,,");
    } else {
        if (!law_study_train(outlook->laws, study, &result, progress, error)) return false;
        fprintf(lines, "laws:%s,%.6g,%" PRIu64 ",%.6g,%.6g", study->laws, study->weight, study->seed, result.test,
                result.constant);
    }
    for (int law = 0; law < LAWS; law++) fprintf(lines, ",%.6g", result.violations.of[law]);
    fputc('\n', lines);
    return true;
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
    fprintf(lines, "transfer:%s,%" PRIu64 ",%d,%.6g,%.6g\n", study->transfer ? "transfer" : "scratch", study->seed,
            study->launches, result.error, result.constant);
    return true;
}
