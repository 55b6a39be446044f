/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A training that fails if it is stopped: results of half a training must not enter the study. */
#pragma once
#include "training/training.h"

/* As training_run, but NULL with error set if progress_report() stops it. */
Network *whole_training(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);
