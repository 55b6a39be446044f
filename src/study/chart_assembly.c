/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/chart_assembly.h"

#include "study/method_scores.h"
#include "study/scene_rows.h"
#include "study/scene_times.h"

#include <stdlib.h>

/* Methods are put together in groups that take about this much, so that a launch is read a few times only. */
enum { GROUP_BYTES = 64 << 20 };

typedef struct Assembly {
    const Pieces *pieces;
    const ChartScene *scene;
    SceneSolves *solves;
    MethodScores *scores; /* [contenders] */
} Assembly;

/* The results of a launch; *text is to be freed. */
static bool open_launch(const Assembly *assembly, int launch, char path[PIECES_PATH_SIZE], StoredScores *stored,
                        char **text, Error *error) {
    const int64_t piece = assembly->scene->first + launch;
    size_t size;
    if (!pieces_path(assembly->pieces, piece, path, error)) return false;
    *text = pieces_read(assembly->pieces, piece, &size, NULL, error);
    return *text != NULL &&
           stored_scores_open(stored, path, *text, size, assembly->scene->study.contender_count, error);
}

/* Adds a launch to the scores of some methods. */
static bool add_launch(const Assembly *assembly, int launch, int first, int end, Error *error) {
    char path[PIECES_PATH_SIZE], *text = NULL;
    StoredScores stored;
    bool ok = open_launch(assembly, launch, path, &stored, &text, error);
    if (ok && stored.residual > assembly->solves->frozen_residual) assembly->solves->frozen_residual = stored.residual;
    for (int i = first; ok && i < end; i++) ok = method_scores_add(&assembly->scores[i], &stored, i, error);
    free(text);
    return ok;
}

static void fill_rows(const Assembly *assembly, int contender, ChartRow *rows) {
    const SceneStudy *study = &assembly->scene->study;
    MethodScores *scores = &assembly->scores[contender];
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            ChartRow *row = &rows[protocol * PHASES + phase];
            *row = scene_row(study->scene->name, study->launch_count, study->contenders[contender], protocol, phase);
            scene_row_errors(row, &scores->steps[protocol][phase]);
            if (protocol != PROTOCOL_CLOSED) continue;
            row->error_worst = scores->worst[phase];
            scene_row_measures(row, scores->measures, study->launch_count);
        }
    assembly->solves->solves += scores->solves;
    assembly->solves->unconverged += scores->unconverged;
    method_scores_free(scores);
}

/* The number of methods whose scores on all launches fit into GROUP_BYTES, by the size of a launch. */
static bool group_size(const Assembly *assembly, int *count, Error *error) {
    const SceneStudy *study = &assembly->scene->study;
    char path[PIECES_PATH_SIZE], *text = NULL;
    StoredScores stored;
    const bool ok = open_launch(assembly, 0, path, &stored, &text, error);
    if (ok) {
        const double all = (double)stored.size * study->launch_count;
        *count = all <= GROUP_BYTES ? study->contender_count : (int)(study->contender_count * GROUP_BYTES / all);
        if (*count < 1) *count = 1;
    }
    free(text);
    return ok;
}

static bool add_scores(const Assembly *assembly, ChartRow *rows, Error *error) {
    const SceneStudy *study = &assembly->scene->study;
    int group, end;
    if (!group_size(assembly, &group, error)) return false;
    for (int first = 0; first < study->contender_count; first = end) {
        end = study->contender_count - first < group ? study->contender_count : first + group;
        for (int launch = 0; launch < study->launch_count; launch++)
            if (!add_launch(assembly, launch, first, end, error)) return false;
        for (int i = first; i < end; i++) fill_rows(assembly, i, rows + (size_t)i * ROWS_EACH);
    }
    return true;
}

static void add_costs(ChartRow *rows, const MethodTimes *times, const char *cpu) {
    for (int p = 0; p < PROTOCOLS; p++)
        for (int phase = 0; phase < PHASES; phase++)
            scene_row_cost(&rows[p * PHASES + phase], &times->costs[p][phase], cpu);
}

static bool add_times(const Assembly *assembly, ChartRow *rows, char cpu[CPU_NAME_SIZE], Error *error) {
    const SceneStudy *study = &assembly->scene->study;
    const int64_t piece = assembly->scene->first + study->launch_count;
    char path[PIECES_PATH_SIZE];
    size_t size;
    if (!pieces_path(assembly->pieces, piece, path, error)) return false;
    char *text = pieces_read(assembly->pieces, piece, &size, cpu, error);
    MethodTimes *times = text != NULL ? scene_times_read(study, path, text, size, error) : NULL;
    const bool ok = times != NULL;
    for (int i = 0; ok && pieces_keep_times(assembly->pieces, cpu) && i < study->contender_count; i++)
        add_costs(rows + (size_t)i * ROWS_EACH, &times[i], cpu);
    free(times);
    free(text);
    return ok;
}

bool chart_assemble(const Pieces *pieces, const ChartScene *scene, ChartRow *rows, char cpu[CPU_NAME_SIZE],
                    SceneSolves *solves, Error *error) {
    *solves = (SceneSolves){0};
    const size_t count = (size_t)scene->study.contender_count;
    const Assembly assembly = {pieces, scene, solves, calloc(count + 1, sizeof *assembly.scores)};
    if (assembly.scores == NULL) return error_memory(error, "study");
    const bool ok = add_scores(&assembly, rows, error) && add_times(&assembly, rows, cpu, error);
    for (size_t i = 0; i < count; i++) method_scores_free(&assembly.scores[i]);
    free(assembly.scores);
    return ok;
}
