/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/chart_plan.h"

#include "study/launch_piece.h"
#include "study/scene_times.h"

#include <stdlib.h>
#include <string.h>

/* Seconds of one core per step of a body: of the converged run, of a method with the solutions that it is scored against, and
   of a method whose times are measured. */
static const double converged_seconds = 1.5e-6, scored_seconds = 8e-7, timed_seconds = 3e-7;

static ChartScene *scene_of(const ChartPlan *plan, int64_t piece) {
    int i = 0;
    while (i + 1 < plan->count && plan->scenes[i + 1].first <= piece) i++;
    return &plan->scenes[i];
}

static bool is_times(const ChartScene *scene, int64_t piece) {
    return piece == scene->first + scene->study.launch_count;
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const ChartScene *scene = scene_of(context, piece);
    const char *name = scene->study.scene->name;
    if (is_times(scene, piece)) {
        snprintf(info->name, sizeof info->name, "times of %.100s", name);
        info->weight = scene->times_weight;
        info->alone = info->timed = true;
        return;
    }
    snprintf(info->name, sizeof info->name, "launch %d of %.100s", (int)(piece - scene->first) + 1, name);
    info->weight = scene->launch_weight;
}

/* Destroys the steppers of scenes that no piece works on. */
static void empty_pools(const ChartPlan *plan) {
    for (int i = 0; i < plan->count; i++)
        if (plan->scenes[i].working == 0) stepper_pool_empty(&plan->scenes[i].study.steppers);
}

/* Pieces come scene by scene: the steppers of a scene go when work on another begins. */
static void begin_work(const ChartPlan *plan, ChartScene *scene) {
#pragma omp critical(chart_plan)
    {
        scene->working++;
        empty_pools(plan);
    }
}

static void end_work(ChartScene *scene) {
#pragma omp critical(chart_plan)
    scene->working--;
}

/* Times are measured with steppers of their own. */
static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    ChartScene *scene = scene_of(context, piece);
    if (is_times(scene, piece)) {
        empty_pools(context);
        return scene_times_write(&scene->study, results, progress, error);
    }
    begin_work(context, scene);
    const bool ok = launch_piece_write(&scene->study, (int)(piece - scene->first), results, progress, error);
    end_work(scene);
    return ok;
}

static void weigh(ChartScene *scene) {
    const SceneStudy *study = &scene->study;
    const double steps = (double)study->scene->frames * (study->scene->body_count + 1);
    const int timed =
        study->size.timed_launches < study->launch_count ? study->size.timed_launches : study->launch_count;
    scene->launch_weight = steps * (converged_seconds + scored_seconds * study->contender_count);
    scene->times_weight =
        steps * timed * (converged_seconds + timed_seconds * study->contender_count * (study->size.repetitions + 1));
}

static bool has_own_name(const ChartPlan *plan, const char *path, Error *error) {
    const char *name = plan->scenes[plan->count - 1].study.scene->name;
    for (int i = 0; i + 1 < plan->count; i++)
        if (strcmp(plan->scenes[i].study.scene->name, name) == 0)
            return error_input(error, path, "another scene has the same name (%s)", name);
    return true;
}

bool chart_plan_make(ChartPlan *plan, const char *const *paths, int count, const ContenderList *contenders,
                     const LaunchChoice *launches, const StudySize *size, Error *error) {
    *plan = (ChartPlan){.scenes = calloc((size_t)count + 1, sizeof *plan->scenes),
                        .plan = {.describe = describe, .work = work, .context = plan}};
    if (plan->scenes == NULL) return error_memory(error, "study");
    for (int i = 0; i < count; i++) {
        ChartScene *scene = &plan->scenes[i];
        if (!scene_study_begin(&scene->study, paths[i], contenders, launches, size, error)) return false;
        plan->count++;
        if (!has_own_name(plan, paths[i], error)) return false;
        weigh(scene);
        scene->first = plan->plan.count;
        plan->plan.count += scene->study.launch_count + 1;
    }
    return true;
}

void chart_plan_free(ChartPlan *plan) {
    for (int i = 0; i < plan->count; i++) scene_study_end(&plan->scenes[i].study);
    free(plan->scenes);
    *plan = (ChartPlan){0};
}
