/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdio.h>

typedef struct Options {
    const char *scene, *output, *method;
    int frame;
    float bomb_x; /* m; NaN: the scene's */
} Options;

static const Option option_table[] = {
    {"--frame", 0, "N", "Number of the step, from 1: the step that leads to frame N of a run",
     OPTION_INT(Options, frame, 1, SCENE_MAX_FRAMES), .needed = "--frame N is needed"},
    {"--output", 'o', "P.npz", "Contact problem to write", OPTION_BINARY(Options, output),
     .needed = "-o P.npz is needed"},
    {"--bomb-x", 0, "X", "Where the bomb is launched, m (default: the scene's x)",
     OPTION_FLOAT(Options, bomb_x, -SCENE_MAX_POSITION, SCENE_MAX_POSITION)},
    {"--method", 'm', "NAME[:KEY=VALUE,...]", "Method that runs the scene up to this step (default: engine)",
     OPTION_TEXT(Options, method)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE", .needed = "a scene file is needed", OPTION_PATH(Options, scene)},
    .inputs = {1, 1, "scene"},
    .help =
        "Write the contact problem of one step: bodies with their velocities before any impulse, and contacts. twinbox "
        "solve reads it.\v"
        "Example: twinbox problem scenes/stack.yaml --frame 41 -o impact.npz\n"
        "In Python: problem = numpy.load('impact.npz'); problem['velocity'] has shape (bodies, 2)."};

typedef struct Writing {
    const Scene *scene;
    const char *path;
} Writing;

static bool write_last(void *context, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const Writing *writing = context;
    if (frame < writing->scene->frames) return true;
    if (!problem_write(problem, writing->scene->name, frame, writing->path, error)) return false;
    printf("%s, step %d: %d bodies, %d contacts -> %s\n", writing->scene->name, frame, problem->body_count,
           problem->contact_count, writing->path);
    return true;
}

static bool write_problem(Scene *scene, const Options *options, Error *error) {
    Method method;
    if (!isnan(options->bomb_x) && !scene->bomb.present)
        return error_input(error, options->scene, "the scene has no bomb to launch");
    if (!isnan(options->bomb_x)) scene->bomb.body.position.x = options->bomb_x;
    scene->frames = options->frame;
    if (!method_parse(&method, options->method, error)) return false;
    Writing writing = {scene, options->output};
    return simulate_observed(scene, &method, &(StepObserver){write_last, &writing}, error);
}

bool command_problem(int argc, char **argv, Error *error) {
    Options options = {.method = "engine", .bomb_x = NAN};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!output_check_npz(options.output, "contact problem", error)) return false;
    Scene *scene = scene_read(options.scene, error);
    bool ok = scene != NULL && write_problem(scene, &options, error);
    scene_destroy(scene);
    return ok;
}
