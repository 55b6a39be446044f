/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox export: a run as CSV or JSON, a scene with all its numbers as JSON. */
#include "base/base.h"
#include "base/file.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "runs/run_files.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stdio.h>

typedef struct Options {
    const char *input, *output;
    bool flat;
    SceneSettings set;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "FILE", "File to write; its ending states the format: .csv or .json",
     OPTION_OUTPUT(Options, output), .needed = "-o FILE is needed"},
    {"--flat", 0, NULL, "The input is a scene: write its bodies as JSON, patterns and parameters written out",
     OPTION_FLAG(Options, flat)},
    {OPTION_SET(Options, set)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "RUN", .needed = "a run (.npz), or a scene with --flat, is needed", OPTION_PATH(Options, input)},
    .inputs = {1, 1, "run"},
    .help =
        "Write a run for other programs: as CSV, which twinbox import reads back, without contacts; or as JSON.\n"
        "With --flat, write a scene for a program that does not read YAML: gravity, time step, and all bodies and the "
        "bomb with their numbers.\v"
        "Example: twinbox simulate stack -o engine.npz\n"
        "         twinbox export engine.npz -o engine.csv\n"
        "         twinbox export stack --flat -o stack.json"};

static bool export_scene(const Options *options, Error *error) {
    if (!path_is_standard(options->output) && !file_name_ends_with(options->output, ".json"))
        return error_input(error, options->output, "the name of a flat scene must end in .json");
    Scene *scene = scene_read_with(options->input, options->set.items, options->set.count, error);
    const bool ok = scene != NULL && scene_flat_write(scene, options->output, error);
    if (ok)
        printf("%s: %d bodies%s -> %s\n", scene->name, scene->body_count, scene->bomb.present ? " and a bomb" : "",
               options->output);
    scene_destroy(scene);
    return ok;
}

bool command_export(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (options.flat) return export_scene(&options, error);
    if (options.set.count > 0) return error_input(error, "--set", "is for a scene: --flat is needed");
    const bool json = file_name_ends_with(options.output, ".json");
    if (!json && !path_is_standard(options.output) && !file_name_ends_with(options.output, ".csv"))
        return error_input(error, options.output, "the name must end in .csv or .json");
    Trajectory *run = trajectory_read(options.input, error);
    const bool ok = run != NULL && (json ? json_run_write : csv_run_write)(run, options.output, error);
    if (ok)
        printf("%s by %s: %d frames of %d bodies -> %s\n", run->scene, run->method, run->frames, run->bodies,
               options.output);
    trajectory_destroy(run);
    return ok;
}
