/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/simulate_verdict.h"
#include "simulate/simulate.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct Options {
    const char *scene, *output, *method, *hashes, *verdict;
    float bomb_x;           /* m; NaN: the scene's */
    int bomb_frame;         /* -1: the scene's */
    int frames, iterations; /* 0: the scene's */
    float dt;               /* s; 0: the scene's */
    bool no_bomb, no_warm_starting, no_accumulate, no_position_correction;
    SceneSettings set;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "RUN", "Trajectory to write: RUN.npz, or RUN.csv for poses as text",
     OPTION_TEXT(Options, output)},
    {"--method", 'm', "NAME[:KEY=VALUE,...]", "Method (default: engine); see twinbox methods",
     OPTION_TEXT(Options, method)},
    {"--hash", 0, "FILE", "Write frame,hash of every frame as CSV", OPTION_TEXT(Options, hashes)},
    {"--verdict", 0, "FILE.json", "Write the verdict with all its figures", OPTION_TEXT(Options, verdict)},
    {.help = "Override the scene:"},
    {OPTION_SET(Options, set)},
    {"--bomb-x", 0, "X", "Where the bomb is launched, m",
     OPTION_FLOAT(Options, bomb_x, -SCENE_MAX_POSITION, SCENE_MAX_POSITION)},
    {"--bomb-frame", 0, "N", "Step after which the bomb is added",
     OPTION_INT(Options, bomb_frame, 0, SCENE_MAX_FRAMES)},
    {"--no-bomb", 0, NULL, "No bomb", OPTION_FLAG(Options, no_bomb)},
    {"--frames", 0, "N", "Number of steps", OPTION_INT(Options, frames, 1, SCENE_MAX_FRAMES)},
    {"--dt", 0, "S", "Time step, s: a number or a fraction such as 1/60",
     OPTION_FLOAT(Options, dt, SCENE_MIN_DT, SCENE_MAX_DT)},
    {"--iterations", 0, "N", "Sweeps per step", OPTION_INT(Options, iterations, 1, SCENE_MAX_ITERATIONS)},
    {"--no-warm-starting", 0, NULL, "Start every step with impulses of 0", OPTION_FLAG(Options, no_warm_starting)},
    {"--no-accumulate", 0, NULL, "Clamp each impulse instead of their sum", OPTION_FLAG(Options, no_accumulate)},
    {"--no-position-correction", 0, NULL, "Do not correct overlaps", OPTION_FLAG(Options, no_position_correction)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "SCENE", .needed = "a scene file is needed", OPTION_PATH(Options, scene)},
    .inputs = {1, 1, "scene"},
    .help =
        "Run a scene with one method and store the trajectory.\v"
        "Example: twinbox simulate scenes/stack.yaml -o engine.npz\n"
        "         twinbox simulate scenes/stack.yaml --method momentum:k=20 -o momentum.npz\n"
        "         twinbox simulate scenes/stack.yaml --bomb-x 2.5 --frames 120 -o struck.npz --hash struck.csv\n"
        "The verdict tells how the run ended: settles, sways, creeps, falls, sinks, tunnels, explodes, non-finite.\n"
        "In Python: run = numpy.load('engine.npz'); run['position'] has shape (frames, bodies, 2)."};

static bool override_bomb(SceneBomb *bomb, const Options *options, Error *error) {
    const bool launched = !isnan(options->bomb_x) || options->bomb_frame >= 0;
    if (options->no_bomb && launched)
        return error_input(error, "--no-bomb", "cannot be combined with --bomb-x or --bomb-frame");
    if (!bomb->present && launched) return error_input(error, options->scene, "the scene has no bomb to launch");
    if (options->no_bomb) bomb->present = false;
    if (!isnan(options->bomb_x)) bomb->body.position.x = options->bomb_x;
    if (options->bomb_frame >= 0) bomb->frame = options->bomb_frame;
    return true;
}

static bool override_scene(Scene *scene, const Options *options, Error *error) {
    if (options->no_warm_starting) scene->warm_starting = false;
    if (options->no_accumulate) scene->accumulate_impulses = false;
    if (options->no_position_correction) scene->position_correction = false;
    if (options->frames > 0) scene->frames = options->frames;
    if (options->dt > 0) scene->dt = options->dt;
    if (options->iterations > 0) scene->iterations = options->iterations;
    return override_bomb(&scene->bomb, options, error);
}

static bool ends_with(const char *text, const char *ending) {
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcmp(text + length - tail, ending) == 0;
}

static bool store(const Trajectory *run, const Options *options, Error *error) {
    bool ok = true;
    if (options->output != NULL)
        ok = ends_with(options->output, ".csv") ? trajectory_write_csv(run, options->output, error)
                                                : trajectory_write(run, options->output, error);
    return ok && (options->hashes == NULL || trajectory_write_hashes(run, options->hashes, error));
}

/* What the method solved by simpler means than its own, if anything. */
static void print_fallbacks(const NetworkFallbacks *fallbacks) {
    const struct {
        int count;
        const char *what;
    } rows[] = {{fallbacks->by_sweeps, "steps solved by sweeps instead"},
                {fallbacks->beyond_training, "steps without the network, as they are unlike its training"},
                {fallbacks->not_finite, "outputs of the network that were NaN, infinite or out of bounds"},
                {fallbacks->outside_cone, "impulses of the network outside the friction cone"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].count > 0) printf("    %s: %d\n", rows[i].what, rows[i].count);
}

/* A run that ends in a NaN or infinite state has a verdict, too. */
static bool judge(SimulateVerdict *verdict, const Options *options, Error *error) {
    if (!simulate_verdict_end(verdict, error)) return false;
    simulate_verdict_print(verdict);
    return options->verdict == NULL || simulate_verdict_write(verdict, options->verdict, error);
}

static bool record(const Scene *scene, const Method *method, SimulateVerdict *verdict, const Options *options,
                   Error *error) {
    const StepObserver observer = simulate_verdict_observer(verdict);
    NetworkFallbacks fallbacks = {0};
    Trajectory *run = simulate_counting(scene, method, &fallbacks, &observer, progress_bar_begin(scene->name), error);
    progress_bar_end();
    bool ok = run != NULL && store(run, options, error);
    if (ok) {
        printf("%s by %s: %d steps of %g s, %d bodies, state %016" PRIx64 "%s%s\n", run->scene, run->method,
               run->frames - 1, (double)run->dt, run->bodies, trajectory_frame_hash(run, run->frames - 1),
               options->output != NULL ? " -> " : "", options->output != NULL ? options->output : "");
        print_fallbacks(&fallbacks);
    }
    trajectory_destroy(run);
    return ok;
}

static bool run_scene(Scene *scene, const Method *method, const Options *options, Error *error) {
    SimulateVerdict verdict;
    if (!override_scene(scene, options, error) || !simulate_verdict_begin(&verdict, scene, method->text, error))
        return false;
    bool ok = record(scene, method, &verdict, options, error);
    ok = judge(&verdict, options, error) && ok;
    simulate_verdict_free(&verdict);
    return ok;
}

bool command_simulate(int argc, char **argv, Error *error) {
    Options options = {.method = "engine", .bomb_x = NAN, .bomb_frame = -1};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (options.output != NULL && !ends_with(options.output, ".npz") && !ends_with(options.output, ".csv"))
        return error_input(error, options.output, "the name of a trajectory must end in .npz or .csv");
    Method method;
    if (!method_parse(&method, options.method, error)) return false;
    Scene *scene = scene_read_with(options.scene, options.set.items, options.set.count, error);
    bool ok = scene != NULL && run_scene(scene, &method, &options, error);
    scene_destroy(scene);
    return ok;
}
