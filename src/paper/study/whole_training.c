/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/study/whole_training.h"

typedef struct Watch {
    const Progress *progress;
    bool stopped;
} Watch;

static bool report(void *context, double done, double total) {
    Watch *watch = context;
    if (!progress_report(watch->progress, done, total)) watch->stopped = true;
    return !watch->stopped;
}

Network *whole_training(const Dataset *dataset, const TrainingOptions *options, const Progress *progress,
                        Error *error) {
    Watch watch = {.progress = progress};
    const Progress watched = {report, &watch};
    Network *network = training_run(dataset, options, &watched, error);
    if (network == NULL || !watch.stopped) return network;
    network_destroy(network);
    return error_interrupted(error, "training", "stopped"), NULL;
}
