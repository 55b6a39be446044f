/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/figures/illustrations.h"

#include "common/file.h"
#include "paper/figures/illustration_parts.h"
#include "sketch/sketch_files.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

static const char *const scene_names[ILLUSTRATION_SCENES] = {"single", "stack", "pyramid"};

static const Illustration *const figures[] = {&illustration_loop, &illustration_narrow_phase, &illustration_data,
                                              &illustration_scenes};

const char *const illustration_names[] = {"loop", "narrow-phase", "data", "scenes", NULL};

static bool write_caption(const char *folder, const char *name, const char *caption, Error *error) {
    char path[PATH_MAX], line[CAPTION_SIZE + 1];
    int length = snprintf(line, sizeof line, "%s\n", caption);
    return file_path(path, sizeof path, error, "%s/%s.txt", folder, name) &&
           file_write(path, line, (size_t)length, error);
}

static bool draw_figure(const Illustration *figure, const char *name, Scene *const *scenes, const char *folder,
                        Error *error) {
    Sketch sketch;
    char stem[PATH_MAX], caption[CAPTION_SIZE] = "";
    if (!file_path(stem, sizeof stem, error, "%s/%s", folder, name)) return false;
    sketch_begin(&sketch, figure->width, figure->height);
    bool drawn = figure->draw(&sketch, scenes, caption, error) && sketch_draw(&sketch, stem, SKETCH_SVG, error);
    sketch_free(&sketch);
    return drawn && write_caption(folder, name, caption, error);
}

static Scene *read_scene(const char *folder, const char *name, Error *error) {
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/%s.yaml", folder, name)) return NULL;
    Scene *scene = scene_read(path, error);
    if (scene == NULL || scene->bomb.present) return scene;
    error_input(error, path, "the scene has no bomb to launch");
    scene_destroy(scene);
    return NULL;
}

bool illustrations_draw(const char *scenes_folder, const char *folder, Error *error) {
    Scene *scenes[ILLUSTRATION_SCENES] = {NULL};
    bool done = true;
    for (int i = 0; done && i < ILLUSTRATION_SCENES; i++) {
        scenes[i] = read_scene(scenes_folder, scene_names[i], error);
        done = scenes[i] != NULL;
    }
    for (size_t i = 0; done && illustration_names[i] != NULL; i++)
        done = draw_figure(figures[i], illustration_names[i], scenes, folder, error);
    for (int i = 0; i < ILLUSTRATION_SCENES; i++) scene_destroy(scenes[i]);
    return done;
}
