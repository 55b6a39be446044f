/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox simulate: the verdict on its run, what it prints (a line, or with --json an object: src/runs/README.md), the
   command. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "cli/cli.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
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
    bool judged; /* there is a verdict */
} SimulateResult;

/* Prints "    verdict: " and these words. */
static void simulate_verdict_print(const SimulateVerdict *verdict) {
    char words[TRAJECTORY_VERDICT_SIZE];
    simulate_verdict_words(verdict, words);
    printf("    verdict: %s\n", words);
}

Trajectory *simulate_judged(const Scene *scene, const Method *method, const Progress *progress, Error *error) {
    SimulateVerdict verdict;
    char words[TRAJECTORY_VERDICT_SIZE];
    Recorder *recorder = recorder_create(scene, method, error);
    if (recorder == NULL) return NULL;
    const StepObserver observer = simulate_verdict_observer(&verdict);
    const RunWatch watch = {.recorder = recorder, .observers = &observer, .observer_count = 1, .progress = progress};
    Trajectory *run = NULL;
    if (simulate_verdict_begin(&verdict, scene, method, error) && simulate_watched(scene, method, &watch, error) &&
        simulate_verdict_end(&verdict, error)) {
        run = recorder_take(recorder);
        simulate_verdict_words(&verdict, words);
        trajectory_judge(run, words, verdict.reading.frame, verdict.reading.body);
    }
    simulate_verdict_free(&verdict);
    recorder_destroy(recorder);
    return run;
}

/* What the value is. */
static const char *quantity(const VerdictReading *reading) {
    static const char *const quantities[VERDICTS] = {
        [VERDICT_SETTLES] = "speed of the fastest body",
        [VERDICT_STANDS] = "distance moved",
        [VERDICT_CREEPS] = "distance in 10 falls",
        [VERDICT_COLLAPSES] = "bodies that fell",
        [VERDICT_SINKS] = "penetration",
        [VERDICT_TUNNELS] = "speed",
        [VERDICT_EXPLODES] = "energy gained",
        [VERDICT_NON_FINITE] = "highest speed before",
        [VERDICT_ADAPTER_FAILED] = "highest speed before",
    };
    if (reading->verdict == VERDICT_MOVES)
        return strcmp(reading->unit, "s") == 0 ? "time in the air" : "speed of the fastest body";
    if (reading->verdict == VERDICT_FALLS)
        return reading->struck ? "bodies that fell" : strcmp(reading->unit, "deg") == 0 ? "rotation" : "descent";
    return quantities[reading->verdict];
}

/* What became of the bodies that started at rest. */
static void write_fallen(const SimulateVerdict *verdict, JsonWriter *json) {
    const VerdictWatch *watch = &verdict->watch;
    const VerdictCount *count = &verdict->reading.count;
    json_put_int(json, "bodies", count->stood);
    json_begin_array(json, "fallen", JSON_ONE_LINE);
    for (int i = 0; i < watch->body_count; i++)
        if (watch->bodies[i].stands && watch->bodies[i].fell > 0) json_put_int(json, NULL, i);
    json_end(json);
    json_put_int(json, "left", count->left);
    json_put_int(json, "moved", count->moved);
    json_put_number(json, "farthest", count->farthest);
    json_put_bool(json, "at_rest", !verdict->reading.moving);
}

static void write_reading(const SimulateVerdict *verdict, JsonWriter *json) {
    const VerdictReading *reading = &verdict->reading;
    char words[TRAJECTORY_VERDICT_SIZE];
    simulate_verdict_words(verdict, words);
    json_put_text(json, "verdict", verdict_name(reading->verdict));
    json_put_text(json, "words", words);
    json_put_bool(json, "holds", verdict_holds(reading->verdict));
    json_put_bool(json, "sound", verdict_sound(reading->verdict));
    json_put_int(json, "frame", reading->frame);
    json_put_number(json, "time", reading->frame * (double)verdict->scene->dt);
    if (!json_put_absent(json, "body", reading->body < 0)) json_put_int(json, "body", reading->body);
    json_put_text(json, "quantity", quantity(reading));
    json_put_number(json, "value", reading->value);
    json_put_text(json, "unit", reading->unit);
    if (reading->reason[0] != '\0') json_put_text(json, "reason", reading->reason);
}

void simulate_verdict_put(const SimulateVerdict *verdict, JsonWriter *json, const char *key) {
    const VerdictWatch *watch = &verdict->watch;
    json_begin_object(json, key, JSON_LINES);
    json_put_text(json, "format", "twinbox simulate verdict 1");
    json_put_text(json, "scene", verdict->scene->name);
    json_put_text(json, "method", verdict->method);
    json_put_int(json, "steps", watch->frame);
    json_put_number(json, "dt", (double)verdict->scene->dt);
    write_reading(verdict, json);
    json_put_text(json, "falls_judged",
                  watch->run.stands       ? "to the end"
                  : watch->run.until_bomb ? "until the bomb touches"
                                          : "no");
    write_fallen(verdict, json);
    json_put_number(json, "kinetic", watch->kinetic);
    json_put_number(json, "energy", watch->energy);
    json_put_number(json, "available", watch->own.available);
    json_put_number(json, "drift", verdict->reading.drift);
    json_put_number(json, "gained", verdict->reading.gained);
    json_put_number(json, "deepest", verdict->reading.deepest);
    json_put_number(json, "excess", verdict->reading.excess);
    json_end(json);
}

static void write_json(FILE *out, const void *context) {
    JsonWriter json = {.out = out};
    simulate_verdict_put(context, &json, NULL);
}

bool simulate_verdict_write(const SimulateVerdict *verdict, const char *path, Error *error) {
    return file_write_text(path, write_json, verdict, error);
}

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
static void simulate_result_print(const SimulateResult *result) {
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
    .help = "Run a scene with one method and store the trajectory.\v"
            "Example: twinbox simulate stack -o engine.npz\n"
            "         twinbox simulate stack --method momentum:k=20 -o momentum.npz\n"
            "         twinbox simulate stack --bomb-x 2.5 -o struck.npz --hash struck.csv\n"
            "The verdict tells how the run ended: settles, moves, creeps, falls, sinks, tunnels, explodes, non-finite, "
            "adapter "
            "failed; where a bomb or another body strikes: stands, falls or collapses, and how many boxes fell.\n"
            "In Python: run = numpy.load('engine.npz'); run['position'] has shape (frames, bodies, 2)."};

static bool override_bomb(SceneBomb *bomb, const Options *options, Error *error) {
    const bool launched = !isnan(options->bomb_x) || options->bomb_frame >= 0;
    if (options->no_bomb && launched)
        return error_input(error, "--no-bomb", "cannot be combined with --bomb-x or --bomb-frame");
    if (!bomb->present && launched) return error_input(error, options->scene, "the scene has no bomb to launch");
    if (options->no_bomb) bomb->present = false;
    if (!isnan(options->bomb_x)) bomb->x.value = options->bomb_x;
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
static bool simulate_record(const Scene *scene, const Method *method, const Options *options, SimulateResult *result,
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
static bool simulate_judge(SimulateResult *result, const Options *options, Error *error) {
    if (!result->judged || (error->kind != ERROR_NONE && error->failure == FAILURE_NONE)) return false;
    if (!options->json) simulate_verdict_print(&result->verdict);
    return options->verdict == NULL || simulate_verdict_write(&result->verdict, options->verdict, error);
}

static bool run_scene(Scene *scene, const Method *method, const Options *options, Error *error) {
    SimulateResult result = {.scene = scene, .method = method->text, .output = options->output};
    if (!override_scene(scene, options, error) || !simulate_verdict_begin(&result.verdict, scene, method, error))
        return false;
    bool ok = simulate_record(scene, method, options, &result, error);
    if (ok && !options->json) simulate_result_print(&result);
    ok = simulate_judge(&result, options, error) && ok;
    ok = ok && (!options->json || json_output("twinbox simulate 1", write_result, &result, error));
    if (ok && !options->json && options->output != NULL && file_name_ends_with(options->output, ".npz"))
        next_film(options->output);
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
