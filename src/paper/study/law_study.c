/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/law_study.h"

#include "paper/study/whole_training.h"

#include <math.h>

bool law_study_train(const Dataset *dataset, const LawStudy *study, LawResult *result, const Progress *progress,
                     Error *error) {
    TrainingOptions options = {.layers = 3,
                               .widths = {dataset_inputs(dataset), 8, 8, PAIR_CHANGES},
                               .optimizer = "adam",
                               .iterations = study->iterations,
                               .seed = study->seed};
    if (!law_weights_named(study->laws, study->weight, &options.laws, error)) return false;
    Network *network = whole_training(dataset, &options, progress, error);
    TrainingScore score;
    bool ok = network != NULL && training_score(dataset, network, NULL, &score, error) &&
              laws_measure(dataset, network, &result->violations, error);
    if (ok) result->test = score.test, result->constant = score.constant_test;
    network_destroy(network);
    return ok;
}

bool law_study_labels(const Dataset *dataset, LawResult *result, Error *error) {
    result->test = result->constant = NAN;
    return laws_measure(dataset, NULL, &result->violations, error);
}
