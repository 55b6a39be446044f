/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/chart_pages.h"

#include "chart/chart_html.h"
#include "cli/page_set.h"
#include "cli/progress_bar.h"
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
    const SpeedAccuracyOptions *options;
    const SpeedAccuracyScene *scenes;
    ContenderList contenders;
    Method reference;
    int scene;              /* the current one; -1: not yet */
    SceneStudy study;       /* of the scene */
    Trajectory **converged; /* [launches] as far as they were needed; NULL: not */
    int contender;          /* the current one */
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
    Scene scene = scene_study_launch(&pages->study, worst->launch);
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
    const Launch launch = pages->study.launches[worst->launch];
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
                        .time = worst->frame * (double)pages->study.scene->dt,
                        .frame = worst->frame,
                        .body = worst->body};
}

static void end_scene(Pages *pages) {
    for (int i = 0; pages->converged != NULL && i < pages->study.launch_count; i++)
        trajectory_destroy(pages->converged[i]);
    free(pages->converged);
    pages->converged = NULL;
    scene_study_end(&pages->study);
}

/* Parts are the contenders of scene after scene. */
static bool enter(Pages *pages, int part, Error *error) {
    int scene = 0, first = 0;
    while (part >= first + pages->scenes[scene].contenders) first += pages->scenes[scene++].contenders;
    pages->contender = part - first;
    if (scene == pages->scene) return true;
    end_scene(pages);
    pages->scene = scene;
    if (!scene_study_begin(&pages->study, pages->options->scenes[scene], &pages->contenders, &pages->options->launches,
                           speed_accuracy_size(pages->options->quick), error))
        return false;
    pages->converged = calloc((size_t)pages->study.launch_count, sizeof *pages->converged);
    return pages->converged != NULL || error_memory(error, "pages");
}

/* Both phases have one page if they have the same worst launch. */
static bool write_contender(void *context, int part, FILE *rows, const Progress *progress, Error *error) {
    Pages *pages = context;
    WorstLaunch worst[PHASES];
    PageFile file = {0};
    char link[PAGE_LINK_SIZE];
    if (!enter(pages, part, error)) return false;
    const Contender *contender = pages->study.contenders[pages->contender];
    if (!worst_launch_find(&pages->study, &contender->method, worst, progress, error)) return false;
    for (int phase = PHASE_IMPACT; phase <= PHASE_AFTER; phase++) {
        if (worst[phase].launch < 0) continue;
        const bool same = phase == PHASE_AFTER && worst[phase].launch == worst[PHASE_IMPACT].launch;
        if (!same && !write_page(pages, contender, &worst[phase], &file, error)) return false;
        LaunchPage row = describe(pages, contender, &worst[phase], phase);
        page_set_link(link, &file, row.time, row.body, 1);
        row.page = link;
        row.bytes = file.bytes;
        if (!piece_tables_print(rows, &launch_page_layout, -1, &row, error)) return false;
    }
    return true;
}

bool chart_pages_write(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *scenes, uint64_t key,
                       Error *error) {
    Pages pages = {
        .options = options,
        .scenes = scenes,
        .scene = -1,
        .set = {.folder = options->folder, .layout = &launch_page_layout, .write = write_contender, .context = &pages}};
    for (int i = 0; i < options->scene_count; i++) pages.set.parts += scenes[i].contenders;
    if (!contenders_parse(&pages.contenders, options->methods, options->quick ? STUDY_CHART_QUICK : STUDY_CHART, error))
        return false;
    const bool ok = method_parse(&pages.reference, "reference", error) &&
                    page_set_make(&pages.set, key, progress_bar_begin("pages"), error) &&
                    chart_html_write(options->folder, error) && page_set_end(&pages.set, error);
    progress_bar_end();
    end_scene(&pages);
    contenders_free(&pages.contenders);
    if (ok) page_set_print(&pages.set, "chart.html");
    return ok;
}
