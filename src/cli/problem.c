/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "dynamics/problem_file.h"
#include "simulate/simulate.h"

#include <stdio.h>

enum { FRAME = 256, BOMB_X };

static const struct argp_option option_table[] = {
    {"output", 'o', "P.npz", 0, "Contact problem to write", 0},
    {"frame", FRAME, "N", 0, "Number of the step, from 1: the step that leads to frame N of a run", 0},
    {"bomb-x", BOMB_X, "X", 0, "Where the bomb is launched, m (default: the scene's x)", 0},
    {"method", 'm', "NAME[:KEY=VALUE,...]", 0, "Method that runs the scene up to this step (default: engine)", 0},
    {0}};

typedef struct Options {
    const char *scene, *output, *frame, *bomb_x, *method;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case 'o': options->output = value; break;
    case 'm': options->method = value; break;
    case FRAME: options->frame = value; break;
    case BOMB_X: options->bomb_x = value; break;
    case ARGP_KEY_ARG:
        if (options->scene != NULL) argp_error(state, "only one scene can be given (second: '%s')", value);
        options->scene = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->scene == NULL) argp_error(state, "a scene file is needed");
        if (options->frame == NULL) argp_error(state, "--frame N is needed");
        if (options->output == NULL) argp_error(state, "-o P.npz is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "SCENE",
    "Write the contact problem of one step: bodies with their velocities before any impulse, and contacts. twinbox "
    "solve reads it.\v"
    "Example: twinbox problem scenes/stack.yaml --frame 41 -o impact.npz\n"
    "In Python: problem = numpy.load('impact.npz'); problem['velocity'] has shape (bodies, 2).",
    NULL,
    NULL,
    NULL};

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
    if (options->bomb_x != NULL && !scene->bomb.present)
        return error_input(error, options->scene, "the scene has no bomb to launch");
    if ((options->bomb_x != NULL && !option_float("--bomb-x", options->bomb_x, -SCENE_MAX_POSITION, SCENE_MAX_POSITION,
                                                  &scene->bomb.body.position.x, error)) ||
        !option_int("--frame", options->frame, 1, SCENE_MAX_FRAMES, &scene->frames, error) ||
        !method_parse(&method, options->method, error))
        return false;
    Writing writing = {scene, options->output};
    return simulate_observed(scene, &method, &(StepObserver){write_last, &writing}, error);
}

int command_problem(int argc, char **argv, Error *error) {
    Options options = {.method = "engine"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    Scene *scene = scene_read(options.scene, error);
    bool ok = scene != NULL && write_problem(scene, &options, error);
    scene_destroy(scene);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
