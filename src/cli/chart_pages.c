/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/chart_pages.h"

#include "chart/chart_html.h"
#include "cli/page_set.h"
#include "simulate/simulate.h"
#include "study/launch_page.h"
#include "study/worst_launch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TITLE_SIZE = CHART_NAME_SIZE + 64 };

/* s before the bomb touches, and after the last frame of the phase "after". */
static const double margin = 0.25;

typedef struct Pages {
    PageSet set;
    SceneStudy study;
    Method reference;
    Trajectory **converged; /* [launches] as far as they were needed; NULL: not */
    int contender;
} Pages;

/* The converged run of a launch, with at least so many frames. */
static const Trajectory *converged_run(Pages *pages, const Scene *scene, int launch, Error *error) {
    Trajectory **run = &pages->converged[launch];
    if (*run != NULL && (*run)->frames > scene->frames) return *run;
    trajectory_destroy(*run);
    return *run = simulate(scene, &pages->reference, NULL, error);
}

/* Both runs, from before the bomb touches until after the phase "after". */
static bool write_page(Pages *pages, const Contender *contender, const WorstLaunch *worst, PageFile *file,
                       Error *error) {
    char name[3 * CHART_NAME_SIZE], title[TITLE_SIZE];
    Scene scene = pages->study.launches[worst->launch];
    const int around = (int)lround(margin / (double)scene.dt);
    const int end = worst->touch + scene.bomb.impact_frames + AFTER_FRAMES + around;
    scene.frames = end < worst->frames ? end : worst->frames;
    const Trajectory *converged = converged_run(pages, &scene, worst->launch, error);
    Trajectory *run = converged != NULL ? simulate(&scene, &contender->method, NULL, error) : NULL;
    if (run == NULL) return false;
    snprintf(name, sizeof name, "%s-%s-%d-launch-%d", scene.name, contender->name, pages->contender + 1,
             worst->launch + 1);
    snprintf(title, sizeof title, "%s, launch %d from x = %.4g m", scene.name, worst->launch + 1,
             (double)launch_of(&scene).x);
    const PlayerOptions options = {.first = worst->touch > around ? worst->touch - around : 0,
                                   .last = scene.frames,
                                   .title = title,
                                   .describe = method_describe};
    const bool done =
        page_set_write(&pages->set, name, (const Trajectory *const[]){converged, run}, 2, &options, file, error);
    trajectory_destroy(run);
    return done;
}

static LaunchPage describe(const Pages *pages, const Contender *contender, const WorstLaunch *worst, int phase) {
    const Scene *scene = &pages->study.launches[worst->launch];
    const Launch launch = launch_of(scene);
    return (LaunchPage){.scene = pages->study.scene->name,
                        .method = contender->name,
                        .setting = contender->setting,
                        .phase = (Phase)phase,
                        .launch = worst->launch + 1,
                        .x = launch.x,
                        .rotation = launch.rotation,
                        .spin = launch.spin,
                        .mass = launch.mass,
                        .launch_frame = launch.frame,
                        .error_worst = worst->mean,
                        .error = worst->error,
                        .time = worst->frame * (double)scene->dt,
                        .frame = worst->frame,
                        .body = worst->body};
}

/* Both phases have one page if they have the same worst launch. */
static bool write_contender(void *context, FILE *lines, const Progress *progress, Error *error) {
    Pages *pages = context;
    const Contender *contender = pages->study.contenders[pages->contender];
    WorstLaunch worst[PHASES];
    PageFile file = {0};
    char link[PAGE_LINK_SIZE];
    if (!worst_launch_find(&pages->study, &contender->method, worst, progress, error)) return false;
    for (int phase = PHASE_IMPACT; phase <= PHASE_AFTER; phase++) {
        if (worst[phase].launch < 0) continue;
        const bool same = phase == PHASE_AFTER && worst[phase].launch == worst[PHASE_IMPACT].launch;
        if (!same && !write_page(pages, contender, &worst[phase], &file, error)) return false;
        LaunchPage row = describe(pages, contender, &worst[phase], phase);
        page_set_link(link, &file, row.time, row.body, 1);
        row.page = link;
        row.bytes = file.bytes;
        if (!study_parts_print(lines, &launch_page_layout, &row, error)) return false;
    }
    return true;
}

static void free_runs(Pages *pages) {
    for (int i = 0; pages->converged != NULL && i < pages->study.launch_count; i++)
        trajectory_destroy(pages->converged[i]);
    free(pages->converged);
    pages->converged = NULL;
}

static bool write_scene(Pages *pages, const SpeedAccuracyOptions *options, const ContenderList *contenders, int scene,
                        Error *error) {
    SceneStudy *study = &pages->study;
    if (!scene_study_begin(study, options->scenes[scene], contenders, &options->launches,
                           speed_accuracy_size(options->quick), error))
        return false;
    pages->converged = calloc((size_t)study->launch_count, sizeof *pages->converged);
    bool ok = pages->converged != NULL || error_memory(error, "pages");
    for (pages->contender = 0; ok && pages->contender < study->contender_count; pages->contender++) {
        char part[64];
        snprintf(part, sizeof part, "%d-%d", scene + 1, pages->contender + 1);
        ok = page_set_do(&pages->set, part, write_contender, pages, error);
    }
    free_runs(pages);
    scene_study_end(study);
    return ok;
}

bool chart_pages_write(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, uint64_t key,
                       Error *error) {
    Pages pages = {0};
    ContenderList contenders;
    int total = 0;
    for (int i = 0; i < options->scene_count; i++) total += scenes[i].contenders;
    if (!contenders_parse(&contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    bool ok = method_parse(&pages.reference, "reference", error) &&
              page_set_open(&pages.set, options->folder, key, total, error);
    for (int i = 0; ok && i < options->scene_count; i++) ok = write_scene(&pages, options, &contenders, i, error);
    ok = ok && page_set_table(&pages.set, &launch_page_layout, error) && chart_html_write(options->folder, error) &&
         page_set_end(&pages.set, error);
    page_set_close(&pages.set);
    contenders_free(&contenders);
    if (ok) page_set_print(&pages.set, "chart.html");
    return ok;
}
