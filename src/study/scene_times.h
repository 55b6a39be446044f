/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A piece of the speed-accuracy study: the times of all methods in a scene, measured in turns by one process. */
#pragma once
#include "common/progress.h"
#include "study/chart_csv.h"
#include "study/scene_study.h"
#include "study/timing.h"

#include <stdio.h>

/* Of a method. */
typedef struct MethodTimes {
    StepCost costs[PROTOCOLS][PHASES];
} MethodTimes;

/* Measures the contenders of the study on some of its launches, and writes their times. */
bool scene_times_write(const SceneStudy *study, FILE *results, const Progress *progress, Error *error);

/* The stored times of the contenders, to be freed. ERROR_INPUT if they are damaged. path: for messages. */
MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error);
