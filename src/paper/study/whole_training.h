/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trainings that count only when they are done: one that is cut short would be told as if it were whole. */
#pragma once
#include "training/training.h"

/* As training_run, but NULL with error set where progress asks to stop. */
Network *whole_training(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);
