/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "paper/paper.h"
#include "pictures/picture.h"
#include "pictures/player.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <assert.h>
#include <limits.h>
#include <stdlib.h>

const char *const strip_scene_names[STRIP_SCENES + 1] = {"stack", "pyramid", NULL};

enum {
    MOMENTS = 6,
    LAUNCHES = 5, /* of which one is shown: the bomb comes from the right, neither flat nor steep */
    SHOWN = 3,
    ENGINE = 0, /* the first of the runs; then the systems' */
    CAPTION_SIZE = 400
};

/* s: before the bomb strikes, while boxes fall, and at the end. */
static const double moments[MOMENTS] = {0.3, 0.5, 0.8, 1.2, 2, 5},
                    quick_moments[MOMENTS] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};

/* What is shown of each scene, m: where boxes stand, and room for some to fall. */
static const CameraView views[STRIP_SCENES] = {{0, 5.2, 16, 12.6}, {0, 10, 24, 22.4}};

/* The strips of one scene. */
typedef struct Strips {
    const PaperSystem *const *systems;
    int count;
    Scene *scene;
    Scene launched;
    const char *name; /* of the scene */
    const double *times;
    const CameraView *view;
    Trajectory **runs; /* [count + 1] */
} Strips;

static void strips_end(Strips *strips) {
    for (int i = 0; strips->runs != NULL && i <= strips->count; i++) trajectory_destroy(strips->runs[i]);
    free(strips->runs);
    scene_destroy(strips->scene);
}

static bool strips_begin(Strips *strips, const char *scenes, Error *error) {
    char path[PATH_MAX];
    Launch launches[LAUNCHES];
    if (!file_path(path, sizeof path, error, "%s/%s.yaml", scenes, strips->name)) return false;
    strips->runs = calloc((size_t)strips->count + 1, sizeof *strips->runs);
    if (strips->runs == NULL) return error_memory(error, path);
    strips->scene = scene_read(path, error);
    if (strips->scene == NULL || !launches_for_scoring(strips->scene, LAUNCHES, launches, error)) return false;
    strips->launched = launch_scene(strips->scene, &launches[SHOWN]);
    strips->launched.frames = (int)lround(strips->times[MOMENTS - 1] / (double)strips->scene->dt);
    return true;
}

static const char *method_of(const Strips *strips, int run) {
    return run == ENGINE ? "engine" : strips->systems[run - 1]->methods[0];
}

static bool run_method(void *context, int i, Error *error) {
    const Strips *strips = context;
    Method method;
    return method_parse(&method, method_of(strips, i), error) &&
           (strips->runs[i] = simulate(&strips->launched, &method, NULL, error)) != NULL;
}

static bool write_caption(const Strips *strips, const char *stem, const char *name, Error *error) {
    char path[PATH_MAX], line[CAPTION_SIZE];
    const int length = snprintf(
        line, sizeof line,
        "A held-out launch of %s.yaml with the bomb from x = %.2f m, at %d moments: the engine above, %s below.\n",
        strips->name, (double)strips->launched.bomb.body.position.x, MOMENTS, name);
    return file_path(path, sizeof path, error, "%s.txt", stem) && file_write(path, line, (size_t)length, error);
}

static bool draw_strip(const Strips *strips, int system, const char *folder, Error *error) {
    const char *name = strips->systems[system]->name;
    FigureSpec spec = {.width = FIGURE_PAGE_WIDTH,
                       .points = FIGURE_POINTS,
                       .dpi = SKETCH_DPI,
                       .run_count = 2,
                       .runs = {strips->runs[ENGINE], strips->runs[system + 1]},
                       .paths = {"engine", name},
                       .captions = {"engine", name},
                       .view = *strips->view,
                       .time_count = MOMENTS};
    for (int i = 0; i < MOMENTS; i++) spec.times[i] = strips->times[i];
    char stem[PATH_MAX];
    Sketch sketch = {0};
    const FigureKind *strip = figure_kind("strip", error);
    if (strip == NULL || !file_path(stem, sizeof stem, error, "%s/strip-%s-%s", folder, name, strips->name))
        return false;
    const bool drawn = figure_draw(strip, &sketch, &spec, error) && sketch_draw(&sketch, stem, SKETCH_SVG, error);
    sketch_free(&sketch);
    return drawn && write_caption(strips, stem, name, error);
}

/* Few frames and bodies: some hundred kB. */
static bool write_page(const Strips *strips, const char *folder, Error *error) {
    char path[PATH_MAX];
    PlayerResult result;
    const PlayerOptions options = {.last = -1, .describe = method_describe};
    return file_path(path, sizeof path, error, "%s/strip-%s.html", folder, strips->name) &&
           player_write((const Trajectory *const *)strips->runs, strips->count + 1, &options, path, &result, error);
}

static bool draw_scene(Strips *strips, const char *scenes, const char *folder, Error *error) {
    const ParallelWork running = {run_method, strips};
    bool done = strips_begin(strips, scenes, error) &&
                parallel_for(&running, strips->count + 1, "runs for strips", NULL, error);
    for (int i = 0; done && i < strips->count; i++) done = draw_strip(strips, i, folder, error);
    done = done && write_page(strips, folder, error);
    strips_end(strips);
    return done;
}

bool system_strips_draw(const PaperSystem *const *systems, const char *scenes, bool quick, const char *folder,
                        const Progress *progress, Error *error) {
    int count = 0;
    while (systems[count] != NULL) count++;
    assert(count <= STRIP_SYSTEMS_MAX);
    for (int i = 0; count > 0 && i < STRIP_SCENES; i++) {
        Strips strips = {.systems = systems,
                         .count = count,
                         .name = strip_scene_names[i],
                         .times = quick ? quick_moments : moments,
                         .view = &views[i]};
        if (!progress_report(progress, i, STRIP_SCENES))
            return error_interrupted(error, folder, "stopped; the tables are finished");
        if (!draw_scene(&strips, scenes, folder, error)) return false;
    }
    return true;
}
