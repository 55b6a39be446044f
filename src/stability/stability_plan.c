/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_plan.h"

#include <math.h>
#include <stdlib.h>

/* A piece takes about this long on one core: less would make more files, more would lose more when it is cut off. */
static const double piece_seconds = 4;

/* Cells of a scene file take an unknown time. */
enum { MOST_PIECES = 4096 };

/* Index of the group of a piece. */
static int find_group(const StabilityPlan *plan, int64_t piece) {
    int group = 0;
    while (piece >= plan->pieces[group].first + plan->pieces[group].count) group++;
    return group;
}

/* The first item of piece i of a group; of the number of pieces, the end. */
static int first_item(const StabilityPlan *plan, int group, int64_t i) {
    return (int)(plan->groups[group].items * i / plan->pieces[group].count);
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const StabilityPlan *plan = context;
    const int group = find_group(plan, piece);
    const int64_t i = piece - plan->pieces[group].first;
    snprintf(info->name, sizeof info->name, "%s %d-%d", plan->groups[group].name, first_item(plan, group, i) + 1,
             first_item(plan, group, i + 1));
    info->weight = plan->groups[group].weight;
    /* The methods of a study share its converged runs, a third of the work. */
    if (plan->groups[group].scan.study != NULL) info->near = plan->pieces[group].first;
}

/* The context of a group is made by the first of its pieces. */
static bool begin(StabilityGroup *group, Error *error) {
    bool ok = true;
#pragma omp critical(stability_group)
    if (!group->begun) {
        ok = group->scan.study != NULL ? stability_scan_begin(&group->scanned, &group->scan, error)
                                       : stability_grid_begin(&group->mapped, &group->grid, error);
        group->begun = ok;
        if (!ok) stability_scan_end(&group->scanned);
        if (!ok) stability_grid_end(&group->mapped);
    }
    return ok;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const StabilityPlan *plan = context;
    const int number = find_group(plan, piece);
    StabilityGroup *group = &plan->groups[number];
    const int64_t i = piece - plan->pieces[number].first;
    const int first = first_item(plan, number, i), end = first_item(plan, number, i + 1);
    if (!begin(group, error)) return false;
    return group->scan.study != NULL ? stability_scan_write(&group->scanned, first, end, results, progress, error)
                                     : stability_grid_write(&group->mapped, first, end, results, progress, error);
}

/* weight: seconds on two cores, of the whole group. */
static void add_group(StabilityPlan *plan, StabilityGroup group, double weight, bool known, int sections) {
    const double wanted = known ? ceil(2 * weight / piece_seconds) : MOST_PIECES;
    const int count = wanted < group.items ? (int)wanted : group.items;
    group.weight = 2 * weight / count;
    plan->groups[plan->count] = group;
    plan->pieces[plan->count++] = (PieceGroup){plan->plan.count, count, sections};
    plan->plan.count += count;
}

bool stability_plan_make(StabilityPlan *plan, const StabilityStudy *const *studies, int study_count,
                         const StabilityMap *const *maps, int map_count, const char *scenes,
                         const ContenderList *methods, bool quick, Error *error) {
    const size_t count = (size_t)study_count + (size_t)map_count;
    *plan = (StabilityPlan){.plan = {.describe = describe, .work = work, .context = plan}};
    plan->groups = calloc(count + 1, sizeof *plan->groups);
    plan->pieces = calloc(count + 1, sizeof *plan->pieces);
    if (plan->groups == NULL || plan->pieces == NULL) return error_memory(error, "stability");
    for (int i = 0; i < study_count; i++)
        add_group(
            plan,
            (StabilityGroup){.scan = {studies[i], scenes, methods}, .name = studies[i]->name, .items = methods->count},
            studies[i]->weight, studies[i]->file == NULL, 0);
    for (int i = 0; i < map_count; i++) {
        const int cells = stability_grid_cells(maps[i], quick), all = stability_grid_cells(maps[i], false);
        add_group(plan,
                  (StabilityGroup){.grid = {maps[i], scenes, methods, quick}, .name = maps[i]->name, .items = cells},
                  maps[i]->weight * cells / all, maps[i]->file == NULL, methods->count);
    }
    return true;
}

void stability_plan_free(StabilityPlan *plan) {
    for (int i = 0; i < plan->count; i++) {
        stability_scan_end(&plan->groups[i].scanned);
        stability_grid_end(&plan->groups[i].mapped);
    }
    free(plan->groups);
    free(plan->pieces);
    *plan = (StabilityPlan){0};
}
