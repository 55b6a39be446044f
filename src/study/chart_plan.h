/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The speed-accuracy study in pieces (pieces/pieces.h): the launches of a scene, then the times of its methods; scene after
   scene. */
#pragma once
#include "pieces/pieces.h"
#include "study/scene_study.h"

/* A scene and its pieces: a launch each, the last one is of the times. */
typedef struct ChartScene {
    SceneStudy study;
    int64_t first;
    double launch_weight, times_weight; /* of pieces */
    int working;                        /* launches that are being scored */
} ChartScene;

/* chart_plan_free(), also after a failure. */
typedef struct ChartPlan {
    ChartScene *scenes; /* [count] */
    int count;
    PiecePlan plan;
} ChartPlan;

/* Reads the scenes. ERROR_INPUT also if two have the same name. The contenders must outlive the plan. */
bool chart_plan_make(ChartPlan *plan, const char *const *paths, int count, const ContenderList *contenders,
                     const LaunchChoice *launches, const StudySize *size, Error *error);
void chart_plan_free(ChartPlan *plan);
