/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox simulate: runs a scene, and prints the result (lines, or with --json an object: src/runs/README.md). */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/judge.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "cli/output_checks.h"
#include "cli/progress_bar.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

typedef struct SimulateResult {
    const Scene *scene;
    const char *method, *output; /* output: NULL if no run is written */
    int bodies;
    uint64_t state; /* hash of the last frame */
    Fallbacks fallbacks;
    SimulateVerdict verdict;
    bool judged; /* there is a verdict, in these words: */
    char words[TRAJECTORY_VERDICT_SIZE];
} SimulateResult;

/* What the method solved by simpler means than its own, if anything. */
typedef struct Fallback {
    const char *key, *what;
    int count;
} Fallback;

enum { FALLBACKS = 5 };

static void list_fallbacks(const Fallbacks *fallbacks, Fallback list[FALLBACKS]) {
    const Fallback all[FALLBACKS] = {
        {"not_converged", "steps that did not converge", fallbacks->not_converged},
        {"by_sweeps", "steps solved by sweeps instead", fallbacks->by_sweeps},
        {"beyond_training", "steps unlike the training of the network", fallbacks->beyond_training},
        {"not_finite", "outputs of the network that were NaN, infinite or out of bounds", fallbacks->not_finite},
        {"outside_cone", "impulses of the network outside the friction cone", fallbacks->outside_cone}};
    for (int i = 0; i < FALLBACKS; i++) list[i] = all[i];
}

/* Prints all but the verdict. */
static void print_result(const SimulateResult *result) {
    const Scene *scene = result->scene;
    const char *output = result->output;
    Fallback fallbacks[FALLBACKS];
    printf("%s by %s: %d steps of %g s, %d bodies, state %016" PRIx64 "%s%s\n", scene->name, result->method,
           scene->frames, (double)scene->dt, result->bodies, result->state, output != NULL ? " -> " : "",
           output != NULL ? output : "");
    list_fallbacks(&result->fallbacks, fallbacks);
    for (int i = 0; i < FALLBACKS; i++)
        if (fallbacks[i].count > 0) printf("    %s: %d\n", fallbacks[i].what, fallbacks[i].count);
    if (result->fallbacks.not_converged > 0)
        printf("    largest residual: %.2g m/s, above %g m/s: this run is no yardstick\n", result->fallbacks.residual,
               REFERENCE_TOLERANCE);
}

static void write_result(JsonWriter *json, const void *context) {
    const SimulateResult *result = context;
    Fallback fallbacks[FALLBACKS];
    json_put_text(json, "scene", result->scene->name);
    json_put_text(json, "method", result->method);
    json_put_int(json, "steps", result->scene->frames);
    json_put_number(json, "dt", (double)result->scene->dt);
    json_put_int(json, "bodies", result->bodies);
    json_put_hash(json, "state", result->state);
    json_put_text(json, "output", result->output);
    json_begin_object(json, "fallbacks", JSON_ONE_LINE);
    list_fallbacks(&result->fallbacks, fallbacks);
    for (int i = 0; i < FALLBACKS; i++) json_put_int(json, fallbacks[i].key, fallbacks[i].count);
    json_put_number(json, "residual", result->fallbacks.residual);
    json_end(json);
    simulate_verdict_put(&result->verdict, json, "verdict");
}

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
     OPTION_METHOD(Options, method)},
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
        "Example: twinbox simulate stack -o engine.npz\n"
        "         twinbox simulate stack --method momentum:k=20 -o momentum.npz\n"
        "         twinbox simulate stack --bomb-x 2.5 -o struck.npz --hash struck.csv\n"
        "The verdict tells how the run ended: settles, moves or falls; where a bomb or another body strikes, "
        "stands, falls or collapses; how many boxes fell, and since when they rest. Or what is wrong with its physics: "
        "hangs, sinks, tunnels, explodes, non-finite; or adapter failed.\n"
        "In Python: run = numpy.load('engine.npz'); run['position'] has shape (frames, bodies, 2)."};

static bool override_scene(Scene *scene, const Options *options, Error *error) {
    const bool launched = !isnan(options->bomb_x) || options->bomb_frame >= 0;
    SceneBomb *bomb = &scene->bomb;
    if (options->no_warm_starting) scene->warm_starting = false;
    if (options->no_accumulate) scene->accumulate_impulses = false;
    if (options->no_position_correction) scene->position_correction = false;
    if (options->frames > 0) scene->frames = options->frames;
    if (options->dt > 0) scene->dt = options->dt;
    if (options->iterations > 0) scene->iterations = options->iterations;
    if (options->no_bomb && launched)
        return error_input(error, "--no-bomb", "cannot be combined with --bomb-x or --bomb-frame");
    if (!bomb->present && launched) return error_input(error, options->scene, "the scene has no bomb to launch");
    if (options->no_bomb) bomb->present = false;
    if (!isnan(options->bomb_x)) bomb->x.value = options->bomb_x;
    if (options->bomb_frame >= 0) bomb->frame = options->bomb_frame;
    return true;
}

static bool is_csv(const char *path) { return file_name_ends_with(path, ".csv"); }

/* Runs the scene and writes the files; fills the result. */
static bool record(const Scene *scene, const Method *method, const Options *options, SimulateResult *result,
                   Error *error) {
    RecorderOutput outputs[RECORDER_OUTPUTS_MAX];
    int count = 0;
    if (options->output != NULL)
        outputs[count++] = (RecorderOutput){options->output, is_csv(options->output) ? TRAJECTORY_CSV : TRAJECTORY_NPZ};
    if (options->hashes != NULL) outputs[count++] = (RecorderOutput){options->hashes, TRAJECTORY_HASHES};
    Recorder *recorder = recorder_create_to(scene, method, outputs, count, options->no_contacts, error);
    if (recorder == NULL) return false;
    const StepObserver observer = {verdict_watch_observe, &result->verdict.watch};
    const RunWatch watch = {.recorder = recorder,
                            .observers = &observer,
                            .observer_count = 1,
                            .fallbacks = &result->fallbacks,
                            .progress = progress_bar_begin(scene->name)};
    bool ok = simulate_watched(scene, method, &watch, error);
    progress_bar_end();
    result->judged = simulate_verdict_end(&result->verdict, error);
    if (ok || result->judged) simulate_verdict_words(&result->verdict, result->words);
    if (ok) recorder_judge(recorder, result->words, result->verdict.reading.frame, result->verdict.reading.body);
    ok = ok && recorder_finish(recorder, error);
    if (ok) {
        result->bodies = recorder_bodies(recorder);
        result->state = recorder_state_hash(recorder);
    }
    recorder_destroy(recorder);
    return ok;
}

static bool run_scene(Scene *scene, const Method *method, const Options *options, Error *error) {
    SimulateResult result = {.scene = scene, .method = method->text, .output = options->output};
    if (!override_scene(scene, options, error)) return false;
    bool ok =
        simulate_verdict_begin(&result.verdict, scene, method, error) && record(scene, method, options, &result, error);
    if (ok && !options->json) print_result(&result);
    /* A run that ends in a NaN or infinite state has a verdict, too; one that was interrupted has none. */
    if (result.judged && (error->kind == ERROR_NONE || error->failure != FAILURE_NONE)) {
        if (!options->json) printf("    verdict: %s\n", result.words);
        ok = (options->verdict == NULL || simulate_verdict_write(&result.verdict, options->verdict, error)) && ok;
    } else {
        ok = false;
    }
    ok = ok && (!options->json || json_output("twinbox simulate 1", write_result, &result, error));
    if (ok && !options->json && options->output != NULL && file_name_ends_with(options->output, ".npz"))
        next_film(options->output);
    simulate_verdict_free(&result.verdict);
    return ok;
}

bool command_simulate(int argc, char **argv, Error *error) {
    Options options = {.method = "engine", .bomb_x = NAN, .bomb_frame = -1};
    if (!options_parse(&spec, argc, argv, &options, error) || !json_output_check(options.json, error)) return false;
    const char *output = options.output;
    if (output != NULL && !path_is_standard(output) && !file_name_ends_with(output, ".npz") && !is_csv(output))
        return error_input(error, output, "the name of a trajectory must end in .npz or .csv");
    if (output != NULL &&
        !(is_csv(output) ? output_check_file(output, ".csv", error) : output_check_npz(output, NULL, error)))
        return false;
    if ((options.hashes != NULL && !output_check_file(options.hashes, NULL, error)) ||
        (options.verdict != NULL && !output_check_file(options.verdict, NULL, error)))
        return false;
    Method method;
    if (!method_parse(&method, options.method, error)) return false;
    Scene *scene = scene_read_with(options.scene, options.set.items, options.set.count, error);
    const bool ok = scene != NULL && run_scene(scene, &method, &options, error);
    scene_destroy(scene);
    return ok;
}
