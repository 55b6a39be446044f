/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "simulate/simulate.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { NO_BOMB = 256, BOMB_X, BOMB_FRAME, FRAMES, DT, ITERATIONS, NO_WARM, NO_ACCUMULATE, NO_CORRECTION, HASH, SET };

static const struct argp_option option_table[] = {
    {"output", 'o', "RUN", 0, "Trajectory to write: RUN.npz, or RUN.csv for poses as text", 0},
    {"method", 'm', "NAME[:KEY=VALUE,...]", 0, "Method (default: engine); see twinbox methods", 0},
    {"hash", HASH, "FILE", 0, "Write frame,hash of every frame as CSV", 0},
    {NULL, 0, NULL, 0, "Override the scene:", 1},
    OPTION_SET(SET, 1),
    {"bomb-x", BOMB_X, "X", 0, "Where the bomb is launched, m", 1},
    {"bomb-frame", BOMB_FRAME, "N", 0, "Step after which the bomb is added", 1},
    {"no-bomb", NO_BOMB, NULL, 0, "No bomb", 1},
    {"frames", FRAMES, "N", 0, "Number of steps", 1},
    {"dt", DT, "S", 0, "Time step, s: a number or a fraction such as 1/60", 1},
    {"iterations", ITERATIONS, "N", 0, "Sweeps per step", 1},
    {"no-warm-starting", NO_WARM, NULL, 0, "Start every step with impulses of 0", 1},
    {"no-accumulate", NO_ACCUMULATE, NULL, 0, "Clamp each impulse instead of their sum", 1},
    {"no-position-correction", NO_CORRECTION, NULL, 0, "Do not correct overlaps", 1},
    {0}};

typedef struct SimulateOptions {
    const char *scene, *output, *method, *hashes;
    const char *bomb_x, *bomb_frame, *frames, *dt, *iterations; /* NULL: the scene's */
    bool no_bomb, no_warm_starting, no_accumulate, no_position_correction;
    SetOptions set;
} SimulateOptions;

static error_t parse(int key, char *value, struct argp_state *state) {
    SimulateOptions *options = state->input;
    switch (key) {
    case 'o': options->output = value; break;
    case 'm': options->method = value; break;
    case HASH: options->hashes = value; break;
    case SET: options_add_set(&options->set, value); break;
    case BOMB_X: options->bomb_x = value; break;
    case BOMB_FRAME: options->bomb_frame = value; break;
    case NO_BOMB: options->no_bomb = true; break;
    case FRAMES: options->frames = value; break;
    case DT: options->dt = value; break;
    case ITERATIONS: options->iterations = value; break;
    case NO_WARM: options->no_warm_starting = true; break;
    case NO_ACCUMULATE: options->no_accumulate = true; break;
    case NO_CORRECTION: options->no_position_correction = true; break;
    case ARGP_KEY_ARG:
        if (options->scene != NULL) argp_error(state, "only one scene can be given (second: '%s')", value);
        options->scene = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->scene == NULL) argp_error(state, "a scene file is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "SCENE",
    "Run a scene with one method and store the trajectory.\v"
    "Example: twinbox simulate scenes/stack.yaml -o engine.npz\n"
    "         twinbox simulate scenes/stack.yaml --method momentum:k=20 -o momentum.npz\n"
    "         twinbox simulate scenes/stack.yaml --bomb-x 2.5 --frames 120 -o struck.npz --hash struck.csv\n"
    "In Python: run = numpy.load('engine.npz'); run['position'] has shape (frames, bodies, 2).",
    NULL,
    NULL,
    NULL};

static bool override_bomb(SceneBomb *bomb, const SimulateOptions *options, const char *scene, Error *error) {
    if (options->no_bomb) {
        if (options->bomb_x != NULL || options->bomb_frame != NULL)
            return error_input(error, "--no-bomb", "cannot be combined with --bomb-x or --bomb-frame");
        bomb->present = false;
        return true;
    }
    if (!bomb->present && (options->bomb_x != NULL || options->bomb_frame != NULL))
        return error_input(error, scene, "the scene has no bomb to launch");
    return (options->bomb_x == NULL || option_float("--bomb-x", options->bomb_x, -SCENE_MAX_POSITION,
                                                    SCENE_MAX_POSITION, &bomb->body.position.x, error)) &&
           (options->bomb_frame == NULL ||
            option_int("--bomb-frame", options->bomb_frame, 0, SCENE_MAX_FRAMES, &bomb->frame, error));
}

static bool override_scene(Scene *scene, const SimulateOptions *options, Error *error) {
    if (options->no_warm_starting) scene->warm_starting = false;
    if (options->no_accumulate) scene->accumulate_impulses = false;
    if (options->no_position_correction) scene->position_correction = false;
    return override_bomb(&scene->bomb, options, options->scene, error) &&
           (options->frames == NULL ||
            option_int("--frames", options->frames, 1, SCENE_MAX_FRAMES, &scene->frames, error)) &&
           (options->dt == NULL || option_float("--dt", options->dt, SCENE_MIN_DT, SCENE_MAX_DT, &scene->dt, error)) &&
           (options->iterations == NULL ||
            option_int("--iterations", options->iterations, 1, SCENE_MAX_ITERATIONS, &scene->iterations, error));
}

static bool ends_with(const char *text, const char *ending) {
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

static bool store(const Trajectory *run, const SimulateOptions *options, Error *error) {
    bool ok = true;
    if (options->output != NULL)
        ok = ends_with(options->output, ".csv") ? trajectory_write_csv(run, options->output, error)
                                                : trajectory_write(run, options->output, error);
    return ok && (options->hashes == NULL || trajectory_write_hashes(run, options->hashes, error));
}

static bool run_scene(Scene *scene, const Method *method, const SimulateOptions *options, Error *error) {
    if (!override_scene(scene, options, error)) return false;
    ProgressBar bar;
    progress_bar_begin(&bar, scene->name);
    Trajectory *run = simulate(scene, method, &bar.progress, error);
    progress_bar_end(&bar);
    bool ok = run != NULL && store(run, options, error);
    if (ok)
        printf("%s by %s: %d steps of %g s, %d bodies, state %016" PRIx64 "%s%s\n", run->scene, run->method,
               run->frames - 1, (double)run->dt, run->bodies, trajectory_frame_hash(run, run->frames - 1),
               options->output != NULL ? " -> " : "", options->output != NULL ? options->output : "");
    trajectory_destroy(run);
    return ok;
}

int command_simulate(int argc, char **argv, Error *error) {
    SimulateOptions options = {.method = "engine"};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    if (options.output != NULL && !ends_with(options.output, ".npz") && !ends_with(options.output, ".csv")) {
        error_input(error, options.output, "the name of a trajectory must end in .npz or .csv");
        return STATUS_DIFFERENT;
    }
    Method method;
    if (!method_parse(&method, options.method, error)) return STATUS_DIFFERENT;
    Scene *scene = options_read_scene(options.scene, &options.set, error);
    bool ok = scene != NULL && run_scene(scene, &method, &options, error);
    scene_destroy(scene);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
