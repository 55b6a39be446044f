/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "cli/simulate_print.h"
#include "common/file.h"
#include "common/standard_io.h"
#include "npz/output_check.h"
#include "simulate/recorder.h"

#include <math.h>
#include <string.h>

typedef struct Options {
    const char *scene, *output, *method, *hashes, *verdict;
    float bomb_x;           /* m; NaN: the scene's */
    int bomb_frame;         /* -1: the scene's */
    int frames, iterations; /* 0: the scene's */
    float dt;               /* s; 0: the scene's */
    bool json, no_contacts, no_bomb, no_warm_starting, no_accumulate, no_position_correction;
    SceneSettings set;
} Options;

static const Option option_table[] = {
    {"--output", 'o', "RUN", "Trajectory to write: RUN.npz, or RUN.csv for poses as text",
     OPTION_BINARY(Options, output)},
    {"--method", 'm', "NAME[:KEY=VALUE,...]", "Method (default: engine); see twinbox methods",
     OPTION_TEXT(Options, method)},
    {"--hash", 0, "FILE", "Write frame,hash of every frame as CSV", OPTION_OUTPUT(Options, hashes)},
    {"--verdict", 0, "FILE.json", "Write the verdict with all its figures", OPTION_OUTPUT(Options, verdict)},
    {"--no-contacts", 0, NULL, "Leave the contacts out of RUN.npz; they are most of it",
     OPTION_FLAG(Options, no_contacts)},
    {OPTION_JSON(Options, json)},
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

static bool is_csv(const char *path) { return file_name_ends_with(path, ".csv"); }

static Recorder *create_recorder(const Scene *scene, const Method *method, const Options *options, Error *error) {
    RecorderOutput outputs[RECORDER_OUTPUTS_MAX];
    int count = 0;
    if (options->output != NULL)
        outputs[count++] = (RecorderOutput){options->output, is_csv(options->output) ? TRAJECTORY_CSV : TRAJECTORY_NPZ};
    if (options->hashes != NULL) outputs[count++] = (RecorderOutput){options->hashes, TRAJECTORY_HASHES};
    return recorder_create_to(scene, method, outputs, count, options->no_contacts, error);
}

/* Runs the scene and writes the files; fills the result. */
static bool record(const Scene *scene, const Method *method, const Options *options, SimulateResult *result,
                   Error *error) {
    const StepObserver observer = simulate_verdict_observer(&result->verdict);
    Recorder *recorder = create_recorder(scene, method, options, error);
    if (recorder == NULL) return false;
    const RunWatch watch = {.recorder = recorder,
                            .observers = &observer,
                            .observer_count = 1,
                            .fallbacks = &result->fallbacks,
                            .progress = progress_bar_begin(scene->name)};
    bool ok = simulate_watched(scene, method, &watch, error);
    progress_bar_end();
    result->judged = simulate_verdict_end(&result->verdict, error);
    if (ok) {
        char words[TRAJECTORY_VERDICT_SIZE];
        simulate_verdict_words(&result->verdict, words);
        recorder_judge(recorder, words, result->verdict.reading.frame, result->verdict.reading.body);
    }
    ok = ok && recorder_finish(recorder, error);
    if (ok) {
        result->bodies = recorder_bodies(recorder);
        result->state = recorder_state_hash(recorder);
    }
    recorder_destroy(recorder);
    return ok;
}

/* A run that ends in a NaN or infinite state has a verdict, too; one that was interrupted has none. */
static bool judge(SimulateResult *result, const Options *options, Error *error) {
    if (!result->judged || (error->kind != ERROR_NONE && !verdict_is_non_finite(error))) return false;
    if (!options->json) simulate_verdict_print(&result->verdict);
    return options->verdict == NULL || simulate_verdict_write(&result->verdict, options->verdict, error);
}

static bool run_scene(Scene *scene, const Method *method, const Options *options, Error *error) {
    SimulateResult result = {.scene = scene, .method = method->text, .output = options->output};
    if (!override_scene(scene, options, error) || !simulate_verdict_begin(&result.verdict, scene, method->text, error))
        return false;
    bool ok = record(scene, method, options, &result, error);
    if (ok && !options->json) simulate_result_print(&result);
    ok = judge(&result, options, error) && ok;
    ok = ok && (!options->json || simulate_result_json(&result, error));
    simulate_verdict_free(&result.verdict);
    return ok;
}

static bool check_outputs(const Options *options, Error *error) {
    const char *output = options->output;
    if (output != NULL && !path_is_standard(output) && !file_name_ends_with(output, ".npz") && !is_csv(output))
        return error_input(error, output, "the name of a trajectory must end in .npz or .csv");
    if (output != NULL &&
        !(is_csv(output) ? output_check_file(output, ".csv", error) : output_check_npz(output, NULL, error)))
        return false;
    return (options->hashes == NULL || output_check_file(options->hashes, NULL, error)) &&
           (options->verdict == NULL || output_check_file(options->verdict, NULL, error));
}

bool command_simulate(int argc, char **argv, Error *error) {
    Options options = {.method = "engine", .bomb_x = NAN, .bomb_frame = -1};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    if (!json_output_check(options.json, error) || !check_outputs(&options, error)) return false;
    Method method;
    if (!method_parse(&method, options.method, error)) return false;
    Scene *scene = scene_read_with(options.scene, options.set.items, options.set.count, error);
    bool ok = scene != NULL && run_scene(scene, &method, &options, error);
    scene_destroy(scene);
    return ok;
}
