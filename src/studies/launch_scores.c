/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scores of launches as they are stored, and the rows of chart.csv that are made of them. */
#include "base/base.h"
#include "base/file.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/launch_scores.h"
#include "studies/rollout.h"
#include "studies/statistics.h"
#include "studies/timing.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct LaunchHead {
    int64_t count; /* of methods */
    LaunchSteps steps;
} LaunchHead;

/* Followed by the errors and the shares of each protocol and phase. */
typedef struct PartHead {
    int64_t unconverged;
    int32_t counts[PROTOCOLS][PHASES];
    CriteriaSum criteria[PROTOCOLS][PHASES];
    RunMeasures measures;
} PartHead;

static_assert(sizeof(PartHead) ==
                  sizeof(int64_t) + PROTOCOLS * PHASES * (sizeof(int32_t) + sizeof(CriteriaSum)) + sizeof(RunMeasures),
              "no byte is left undefined");

void launch_scores_free(LaunchScores *scores) {
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) step_scores_free(&scores->steps[protocol][phase]);
}

static PartHead head_of(const LaunchScores *scores) {
    PartHead head = {.unconverged = scores->unconverged, .measures = scores->measures};
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            head.counts[protocol][phase] = scores->steps[protocol][phase].count;
            head.criteria[protocol][phase] = scores->steps[protocol][phase].criteria;
        }
    return head;
}

static size_t part_size(const PartHead *head) {
    size_t size = sizeof *head;
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) size += 2 * sizeof(double) * (size_t)head->counts[protocol][phase];
    return size;
}

void launch_scores_write(FILE *results, const LaunchScores *scores, int count, const LaunchSteps *steps) {
    const LaunchHead head = {count, *steps};
    int64_t end = (int64_t)sizeof head + count * (int64_t)sizeof end;
    fwrite(&head, sizeof head, 1, results);
    for (int i = 0; i < count; i++) {
        const PartHead part = head_of(&scores[i]);
        end += (int64_t)part_size(&part);
        fwrite(&end, sizeof end, 1, results);
    }
    for (int i = 0; i < count; i++) {
        const PartHead part = head_of(&scores[i]);
        fwrite(&part, sizeof part, 1, results);
        for (int protocol = 0; protocol < PROTOCOLS; protocol++)
            for (int phase = 0; phase < PHASES; phase++) {
                const StepScores *own = &scores[i].steps[protocol][phase];
                stream_put(results, own->error, sizeof(double), (size_t)own->count);
                stream_put(results, own->share, sizeof(double), (size_t)own->count);
            }
    }
}

static bool refuse(const StoredScores *stored, Error *error) {
    return error_input(error, stored->path, "is no result of a launch; delete it, and run the command again");
}

/* The first byte of a method's part; of the number of methods, the end of all. */
static int64_t part_begin(const StoredScores *stored, int method) {
    int64_t begin = (int64_t)sizeof(LaunchHead) + stored->count * (int64_t)sizeof begin;
    if (method > 0)
        memcpy(&begin, stored->bytes + sizeof(LaunchHead) + (size_t)(method - 1) * sizeof begin, sizeof begin);
    return begin;
}

static bool is_step_count(int64_t count) { return count >= 0 && count <= SCENE_MAX_FRAMES; }

bool stored_scores_open(StoredScores *stored, const char *path, const char *bytes, size_t size, int count,
                        Error *error) {
    LaunchHead head = {0};
    *stored = (StoredScores){.path = path, .bytes = bytes, .size = size, .count = count};
    if (size >= sizeof head) memcpy(&head, bytes, sizeof head);
    const size_t begin = sizeof head + (size_t)count * sizeof(int64_t);
    bool sound = size >= begin && head.count == count && is_step_count(head.steps.unconverged) &&
                 is_step_count(head.steps.run_unconverged);
    for (int i = 0; i < PROTOCOLS * PHASES; i++) {
        const FloorSum *floors = &head.steps.floors[i / PHASES][i % PHASES];
        sound = sound && is_step_count(floors->steps) && floors->sum >= 0 && floors->sum <= DBL_MAX;
    }
    if (!sound) return refuse(stored, error);
    for (int i = 0; i < count; i++) {
        const int64_t end = part_begin(stored, i + 1);
        if (end > (int64_t)size || end < part_begin(stored, i) + (int64_t)sizeof(PartHead))
            return refuse(stored, error);
    }
    if (part_begin(stored, count) != (int64_t)size) return refuse(stored, error);
    stored->steps = head.steps;
    return true;
}

/* Errors are not negative, shares at most 1. */
static bool are_scores(const double *values, int count, double most) {
    for (int i = 0; i < count; i++)
        if (values[i] < 0 || values[i] > most) return false;
    return true;
}

bool method_scores_add(MethodScores *scores, const StoredScores *stored, int method, Error *error) {
    const int64_t begin = part_begin(stored, method);
    const size_t size = (size_t)(part_begin(stored, method + 1) - begin);
    PartHead head;
    memcpy(&head, stored->bytes + begin, sizeof head);
    /* The counts must fit the size of the part. */
    size_t rest = (size - sizeof head) / (2 * sizeof(double));
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            const int32_t count = head.counts[protocol][phase];
            if (count < 0 || (size_t)count > rest) return refuse(stored, error);
            rest -= (size_t)count;
        }
    if (part_size(&head) != size || !is_step_count(head.unconverged)) return refuse(stored, error);
    if (!array_reserve((void **)&scores->measures, &scores->measure_capacity, (size_t)scores->launches + 1,
                       sizeof *scores->measures))
        return error_memory(error, "study");
    for (int phase = 0; scores->launches == 0 && phase < PHASES; phase++) scores->worst[phase] = NAN;
    const char *bytes = stored->bytes + begin + sizeof head;
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            PhaseScores *steps = &scores->steps[protocol][phase];
            const CriteriaSum *more = &head.criteria[protocol][phase];
            const int count = head.counts[protocol][phase];
            const size_t before = (size_t)steps->count, part = (size_t)count * sizeof(double);
            if (!(more->signorini >= 0 && more->cone >= 0 && more->dissipation >= 0) || more->steps < 0 ||
                more->steps > count) /* of so many steps, at most as many have impulses */
                return refuse(stored, error);
            steps->criteria.signorini += more->signorini;
            steps->criteria.cone += more->cone;
            steps->criteria.dissipation += more->dissipation;
            steps->criteria.steps += more->steps;
            if (count == 0) continue;
            if (!array_reserve((void **)&steps->error, &steps->error_capacity, before + (size_t)count,
                               sizeof(double)) ||
                !array_reserve((void **)&steps->share, &steps->share_capacity, before + (size_t)count, sizeof(double)))
                return error_memory(error, "study");
            memcpy(steps->error + before, bytes, part);
            memcpy(steps->share + before, bytes + part, part);
            steps->count += count;
            if (!are_scores(steps->error + before, count, INFINITY) || !are_scores(steps->share + before, count, 1))
                return refuse(stored, error);
            bytes += 2 * part;
            if (protocol != PROTOCOL_CLOSED) continue;
            const double mean = statistics_mean(steps->error + before, count);
            if (!(mean > scores->worst[phase]) && !isnan(scores->worst[phase])) continue;
            scores->worst[phase] = mean;
            scores->worst_launch[phase] = scores->launches;
        }
    scores->measures[scores->launches++] = head.measures;
    scores->unconverged += head.unconverged;
    return true;
}

void method_scores_free(MethodScores *scores) {
    for (int protocol = 0; protocol < PROTOCOLS; protocol++)
        for (int phase = 0; phase < PHASES; phase++) {
            free(scores->steps[protocol][phase].error);
            free(scores->steps[protocol][phase].share);
        }
    free(scores->measures);
    *scores = (MethodScores){0};
}

void scene_row_errors(ChartRow *row, const PhaseScores *scores) {
    row->error_mean = statistics_mean(scores->error, scores->count);
    row->share_right = statistics_mean(scores->share, scores->count);
    row->error_median = statistics_quantile(scores->error, scores->count, 0.5);
    row->error_p95 = statistics_quantile(scores->error, scores->count, 0.95);
    if (scores->criteria.steps == 0) return;
    const double steps = (double)scores->criteria.steps;
    row->signorini = scores->criteria.signorini / steps;
    row->cone = scores->criteria.cone / steps;
    row->dissipation = scores->criteria.dissipation / steps;
}

/* Mean or largest over the launches for which the measure at byte `offset` is not NaN. */
static double over_launches(const RunMeasures *measures, int count, size_t offset, bool largest) {
    double sum = 0, most = NAN;
    int found = 0;
    for (int i = 0; i < count; i++) {
        double value;
        memcpy(&value, (const char *)&measures[i] + offset, sizeof value);
        if (isnan(value)) continue;
        sum += value;
        found++;
        if (!(most >= value)) most = value;
    }
    return largest ? most : found > 0 ? sum / found : NAN;
}

void scene_row_measures(ChartRow *row, const RunMeasures *measures, int count) {
    size_t phase = (size_t)row->phase;
    row->penetration_max =
        over_launches(measures, count, offsetof(RunMeasures, penetration) + phase * sizeof(double), true);
    row->energy = over_launches(measures, count, offsetof(RunMeasures, energy) + phase * sizeof(double), false);
    if (row->phase != PHASE_REST) return;
    row->drift = over_launches(measures, count, offsetof(RunMeasures, drift), false);
    row->moved = over_launches(measures, count, offsetof(RunMeasures, moved), false);
    row->rollout_mse = over_launches(measures, count, offsetof(RunMeasures, rollout_mse), false);
}

ChartRow scene_row(const char *scene, int launches, const Contender *contender, int protocol, int phase) {
    return (ChartRow){.scene = scene,
                      .method = contender->name,
                      .setting = contender->setting,
                      .protocol = (ChartProtocol)protocol,
                      .phase = (Phase)phase,
                      .launches = launches,
                      .us_solver = NAN,
                      .us_step = NAN,
                      .error_worst = NAN,
                      .penetration_max = NAN,
                      .drift = NAN,
                      .energy = NAN,
                      .moved = NAN,
                      .cpu = "",
                      .us_engine = NAN,
                      .signorini = NAN,
                      .cone = NAN,
                      .dissipation = NAN,
                      .rollout_mse = NAN,
                      .floor = NAN};
}

void scene_row_cost(ChartRow *row, const StepCost *cost, const char *cpu) {
    row->us_solver = cost->solver;
    row->us_step = cost->step;
    row->us_engine = cost->engine;
    if (!isnan(cost->solver) || !isnan(cost->engine)) row->cpu = cpu;
}
