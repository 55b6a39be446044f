/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of twinbox train that learn from launches of scenes: sain, hybrid, gns, subspace and scene-net. */
#include "base/base.h"
#include "base/file.h"
#include "cli/installed.h"
#include "cli/interrupt.h"
#include "cli/larger_commands.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "learning/gns_training.h"
#include "learning/hybrid_training.h"
#include "learning/sain_training.h"
#include "learning/scene_training.h"
#include "learning/subspace_training.h"
#include "methods/hybrid_memory.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/kernels.h"
#include "nets/kinds.h"
#include "nets/nets.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <string.h>

enum { LIST_SIZE = 4096, STEPS_SAVED = 100 };

/* Reads the scene of the command line, if there is one, and those of a list, each with an impact; *count grows with
   them, also in a failure. */
static bool read_scenes(const char *first, const char *more, const char *option, Scene **scenes, int most, int *count,
                        Error *error) {
    char list[LIST_SIZE], *rest = list;
    if (snprintf(list, sizeof list, "%s", more != NULL ? more : "") >= (int)sizeof list)
        return error_input(error, option, "the list has more than %d characters", LIST_SIZE - 1);
    for (const char *path = first != NULL ? first : strtok_r(rest, ",", &rest); path != NULL;
         path = strtok_r(rest, ",", &rest)) {
        if (*count == most) return error_input(error, option, "more than %d scenes", most);
        scenes[*count] = scene_read(installed_path(path), error);
        if (scenes[*count] == NULL) return false;
        ++*count;
        if (!scene_check_strike(scenes[*count - 1], error)) return false;
    }
    return *count > 0 || error_input(error, option, "no scene is given");
}

typedef struct SainOptions {
    SainTraining training;
    const char *more;
} SainOptions;

static const Option sain_options[] = {
    {"--with", 0, "SCENE,...", "Further scenes to train on, separated by commas", OPTION_TEXT(SainOptions, more)},
    {"--launches", 0, "N", "Launches of each scene and round", OPTION_INT(SainOptions, training.launches, 1, 10000),
     .standard = "40"},
    {"--rounds", 0, "N", "Rounds; the engine runs the launches of the first, sain those of the others",
     OPTION_INT(SainOptions, training.rounds, 1, SAIN_ROUNDS_MAX), .standard = "2"},
    {"--steps", 0, "N", "Steps of the optimiser in each round", OPTION_INT(SainOptions, training.steps, 1, 1000000),
     .standard = "2000"},
    {"--seed", 0, "N", "Seed of the initial weights and of the samples of each step",
     OPTION_SEED(SainOptions, training.seed), .standard = "1"},
    {0}};

static void sain_print_score(void *context, const SainScore *score) {
    (void)context;
    progress_bar_clear();
    printf("%-8s  %5d  %8zu  %11zu  %7zu  %7.4f  %8.4f  %7.4f  %8.4f\n", sain_form_names[score->form], score->round,
           score->problems, score->unconverged, score->bodies, score->loss, score->held_out.with,
           score->held_out.without, score->held_out.constant);
    fflush(stdout);
}

static bool sain_run(const TrainRequest *request, Error *error) {
    Scene *scenes[SAIN_SCENES_MAX] = {NULL};
    SainOptions given = {.training = {.scenes = scenes,
                                      .batch = SAIN_PARTS * BLOCK_ROWS,
                                      .saved = STEPS_SAVED,
                                      .command = request->command,
                                      .state_path = request->state,
                                      .on_score = sain_print_score}};
    SainTraining *training = &given.training;
    SainNetworks networks = {0};
    bool ok = train_read(request, &given, error) &&
              read_scenes(request->input, given.more, "--with", scenes, SAIN_SCENES_MAX, &training->scene_count, error);
    if (ok) {
        printf("held-out impacts, velocity error in m/s\n"
               "engine    round  problems  unconverged   bodies     loss      sain   engine  constant\n");
        ok = sain_training_run(training, &networks, progress_bar_begin("training"), error);
        progress_bar_end();
        snprintf(networks.command, sizeof networks.command, "%s", request->command);
        ok = ok && sain_networks_write(&networks, request->output, error) && file_remove(request->state, error);
    }
    if (ok)
        printf("%d networks of %d weights -> %s\n", (int)SAIN_FORMS, sain_weight_count(&networks.forms[0]),
               request->output);
    sain_networks_destroy(&networks);
    for (int i = 0; i < SAIN_SCENES_MAX; i++) scene_destroy(scenes[i]);
    return ok;
}

const TrainKind train_sain = {
    .name = "sain",
    .input = "SCENE",
    .summary = "the networks of sain, on launches of one or more scenes: with the engine, without it, and "
               "with its output shuffled. Prints held-out errors after each round. An interrupted "
               "training is resumed by the same command; its state is in NET.npz.part",
    .file_kind = "sain",
    .options = sain_options,
    .train = sain_run,
    .result = "network",
    .command_size = SAIN_COMMAND_SIZE};

enum { MEBIBYTE = 1 << 20, REPORTS = 20 };

typedef struct HybridOptions {
    HybridTraining training;
    double limit; /* MiB */
} HybridOptions;

static const Option hybrid_options[] = {
    {"--launches", 0, "N", "Launches, one after the other",
     OPTION_INT(HybridOptions, training.launches, 1, HYBRID_LAUNCHES_MAX), .standard = "1000"},
    {"--steps", 0, "N", "Steps of each launch, from the bomb's first touch",
     OPTION_INT(HybridOptions, training.steps, 1, 100000), .standard = "66"},
    {"--tolerance", 0, "E", "RMS error of the velocities that answers may have, m/s",
     OPTION_FLOAT(HybridOptions, training.tolerance, 1e-6, 1000), .standard = "0.1"},
    {"--limit", 0, "MB", "Most MiB of the memory; when it is full, entries still grow",
     OPTION_DOUBLE(HybridOptions, limit, 0.001, 65536), .standard = "64"},
    {"--seed", 0, "N", "Seed of the launches", OPTION_SEED(HybridOptions, training.seed), .standard = "1"},
    {0}};

/* Sums over the launches since the last report. */
typedef struct Report {
    int launches;
    HybridLaunch sum;
} Report;

/* Prints the sums over some launches. */
static void add_launch(void *context, const HybridLaunch *launch) {
    Report *report = context;
    HybridLaunch *sum = &report->sum;
    sum->asked += launch->asked;
    sum->answered += launch->answered;
    sum->grown += launch->grown;
    sum->added += launch->added;
    sum->full += launch->full;
    sum->checked += launch->checked;
    sum->error += launch->error;
    const int every = (report->launches + REPORTS - 1) / REPORTS;
    if (launch->number % every != 0 && launch->number != report->launches) return;
    const HybridMemory *memory = launch->memory;
    progress_bar_clear();
    printf("%8d  %6d  %7.1f%%  %6d  %6d", launch->number, sum->asked,
           sum->asked > 0 ? 100.0 * sum->answered / sum->asked : 0, sum->grown, sum->added);
    if (memory != NULL) printf("  %7d  %8.3f", memory->entry_count, (double)hybrid_memory_bytes(memory) / MEBIBYTE);
    if (sum->checked > 0) printf("  %.4f", sum->error / sum->checked);
    printf("%s\n", sum->full > 0 ? "  full" : "");
    fflush(stdout);
    *report = (Report){.launches = report->launches};
}

static bool hybrid_run(const TrainRequest *request, Error *error) {
    Report report = {0};
    HybridOptions given = {.training = {.components = HYBRID_STANDARD_COMPONENTS,
                                        .on_launch = add_launch,
                                        .context = &report,
                                        .command = request->command,
                                        .state_path = request->state}};
    HybridTraining *training = &given.training;
    if (!train_read(request, &given, error)) return false;
    training->limit = (size_t)(given.limit * MEBIBYTE);
    report.launches = training->launches;
    printf("launches   asked  answered   grown   added  entries       MiB  error of answers, m/s\n");
    HybridMemory *memory = hybrid_training_run(request->scene, training, progress_bar_begin("learning"), error);
    progress_bar_end();
    bool ok = memory != NULL && hybrid_memory_write(memory, request->output, error);
    if (ok && memory->launches == training->launches) ok = file_remove(request->state, error);
    if (ok)
        printf("%s%d entries of %d sets of contacts, from %d launch%s -> %s\n",
               interrupt_requested() ? "stopped early; " : "", memory->entry_count, memory->set_count, memory->launches,
               plural_es(memory->launches), request->output);
    hybrid_memory_destroy(memory);
    return ok;
}

const TrainKind train_hybrid = {
    .name = "hybrid",
    .input = "SCENE",
    .summary = "the memory of hybrid for a scene, launch after launch. Prints how many steps with an "
               "impact it answered, and what it learned from the others. An interrupted training is "
               "resumed by the same command; its state is in NET.npz.part",
    .file_kind = "hybrid",
    .options = hybrid_options,
    .train = hybrid_run,
    .reads_scene = true,
    .result = "memory",
    .command_size = HYBRID_TEXT_SIZE};

typedef struct GnsOptions {
    GnsTraining training;
    const char *scenes;
} GnsOptions;

static const Option gns_options[] = {
    {"--scenes", 0, "A,B", "Scenes whose launches are recorded", OPTION_TEXT(GnsOptions, scenes),
     .standard = "single,stack,pyramid,pyramid_settled"},
    {"--launches", 0, "N", "Launches recorded of each scene",
     OPTION_INT(GnsOptions, training.launches, 1, LAUNCHES_MAX), .standard = "24"},
    {"--width", 0, "N", "Hidden units of each layer: a multiple of 16",
     OPTION_INT(GnsOptions, training.width, GNS_WIDTH_STEP, GNS_MAX_WIDTH), .standard = "16"},
    {"--rounds", 0, "M", "Rounds of message passing", OPTION_INT(GnsOptions, training.rounds, 1, GNS_MAX_ROUNDS),
     .standard = "5"},
    {"--radius", 0, "R", "Particles nearer than R m exchange messages",
     OPTION_FLOAT(GnsOptions, training.radius, 0.01, 100), .standard = "0.6"},
    {"--noise", 0, "S", "Standard deviation of the noise on velocities, m/s",
     OPTION_FLOAT(GnsOptions, training.noise, 0, 10), .standard = "0.1"},
    {"--steps", 0, "N", "Gradient steps", OPTION_INT(GnsOptions, training.steps, 1, 100000000), .standard = "20000"},
    {"--batch", 0, "N", "Examples of a gradient step", OPTION_INT(GnsOptions, training.batch, 1, 1024),
     .standard = "8"},
    {"--rate", 0, "R", "Rate of the first step; it falls to 0", OPTION_DOUBLE(GnsOptions, training.rate, 1e-9, 1),
     .standard = "0.005"},
    {"--seed", 0, "N", "Seed of the examples and of the initial weights", OPTION_SEED(GnsOptions, training.seed),
     .standard = "1"},
    {0}};

static void gns_print_score(void *context, const GnsScore *score) {
    (void)context;
    progress_bar_clear();
    printf("%7d  %9.5f  %9.5f\n", score->steps, score->loss, score->held_out);
    fflush(stdout);
}

static bool gns_run(const TrainRequest *request, Error *error) {
    Scene *scenes[GNS_MAX_SCENES] = {NULL};
    GnsOptions given = {
        .training = {
            .scenes = scenes, .command = request->command, .state_path = request->state, .on_score = gns_print_score}};
    GnsTraining *training = &given.training;
    GnsNet net;
    if (!train_read(request, &given, error)) return false;
    if (training->width % GNS_WIDTH_STEP != 0)
        return error_input(error, "--width", "%d is not a multiple of %d", training->width, GNS_WIDTH_STEP);
    if (!read_scenes(NULL, given.scenes, "--scenes", scenes, GNS_MAX_SCENES, &training->scene_count, error)) {
        for (int i = 0; i < training->scene_count; i++) scene_destroy(scenes[i]);
        return false;
    }
    printf("mean squared error of accelerations, in units of their deviation\n  steps       loss   held out\n");
    bool ok = gns_training_run(training, &net, progress_bar_begin("training"), error);
    progress_bar_end();
    snprintf(net.command, sizeof net.command, "%s", request->command);
    ok = ok && gns_net_write(&net, request->output, error) && file_remove(request->state, error);
    if (ok) printf("%d parameters -> %s\n", net.layout.parameters, request->output);
    gns_net_free(&net);
    return ok;
}

const TrainKind train_gns = {
    .name = "gns",
    .summary = "the graph network of gns, on steps of recorded launches. Prints its error during the "
               "training. An interrupted training is resumed by the same command; its state is in NET.npz.part",
    .file_kind = "gns",
    .options = gns_options,
    .train = gns_run,
    .result = "network",
    .command_size = GNS_COMMAND_SIZE};

enum { EPOCH_BATCHES = 20 }; /* a second or so: what an interruption may lose */

static const Option subspace_options[] = {
    {"--launches", 0, "N", "Launches to learn from", OPTION_INT(SubspaceTraining, launches, 1, LAUNCHES_MAX),
     .standard = "201"},
    {"--epochs", 0, "N", "Epochs for each number of components, of 20 batches of 256 windows",
     OPTION_INT(SubspaceTraining, epochs, 1, 100000), .standard = "24"},
    {"--width", 0, "N", "Width of the two hidden layers, a multiple of 16",
     OPTION_INT(SubspaceTraining, hidden, ROW_LANES, SUBSPACE_HIDDEN_MAX), .standard = "64"},
    {"--seed", 0, "N", "Seed of windows and initial weights", OPTION_SEED(SubspaceTraining, seed), .standard = "1"},
    {0}};

static void subspace_print_score(void *context, const SubspaceScore *score, double loss) {
    (void)context;
    progress_bar_clear();
    printf("%10d  %8.4f  %8.4f %4.0f  %8.4f %4.0f  %8.4f %4.0f\n", score->components, loss, score->floor.rms,
           score->floor.frames, score->linear.rms, score->linear.frames, score->net.rms, score->net.frames);
    fflush(stdout);
}

static bool subspace_run(const TrainRequest *request, Error *error) {
    SubspaceTraining training = {.batches = EPOCH_BATCHES,
                                 .command = request->command,
                                 .state_path = request->state,
                                 .on_score = subspace_print_score};
    if (!train_read(request, &training, error)) return false;
    if (training.hidden % ROW_LANES != 0)
        return error_input(error, "--width", "must be a multiple of %d (got %d)", ROW_LANES, training.hidden);
    printf("held-out launches: distance from the recorded run, m (RMS over bodies and frames), and the median of the\n"
           "frames until a body is 0.1 m away\n"
           "components      loss  floor          linear term    with network\n");
    SubspaceNet *net = subspace_train(request->scene, &training, progress_bar_begin("training"), error);
    progress_bar_end();
    const bool ok =
        net != NULL && subspace_net_write(net, request->output, error) && file_remove(request->state, error);
    if (ok) printf("%d bodies -> %s\n", net->shape.bodies, request->output);
    subspace_net_destroy(net);
    return ok;
}

const TrainKind train_subspace = {.name = "subspace",
                                  .input = "SCENE",
                                  .summary =
                                      "the networks of subspace for a scene, with 8, 32 and 128 principal components. "
                                      "Prints held-out errors of each. An interrupted training is resumed by the same "
                                      "command; its state is in NET.npz.part",
                                  .file_kind = SUBSPACE_KIND,
                                  .options = subspace_options,
                                  .train = subspace_run,
                                  .reads_scene = true,
                                  .result = "network",
                                  .command_size = SUBSPACE_TEXT_SIZE};

typedef struct SceneNetOptions {
    SceneTraining training;
    SceneNetVerdict verdict;
    bool smallest;
    double within; /* m/s; negative: not given */
} SceneNetOptions;

static OptionRead read_momentum;

static const Option scene_net_options[] = {
    {"--launches", 0, "N", "Launches of each round; half of them rotated and spinning",
     OPTION_INT(SceneNetOptions, training.launches, 10, 100000), .standard = "3000"},
    {"--rounds", 0, "N", "Rounds; the first runs the launches without the network, the others with it",
     OPTION_INT(SceneNetOptions, training.rounds, 1, 100), .standard = "3"},
    {"--iterations", 0, "N", "Epochs of the first round; the others have half as many",
     OPTION_INT(SceneNetOptions, training.epochs, 1, 100000), .standard = "40"},
    {"--width", 0, "N", "Width of both hidden layers, a multiple of 16",
     OPTION_INT(SceneNetOptions, training.widths.hidden, ROW_LANES, SCENE_NET_WIDTH_MAX), .standard = "64"},
    {"--sweeps", 0, "K", "Sweeps that follow the network",
     OPTION_INT(SceneNetOptions, training.sweeps, 1, SCENE_NET_SWEEPS_MAX), .standard = "14"},
    {"--momentum", 0, "on|off", "Whether the sweeps after the network have learned momentum factors",
     OPTION_READ(read_momentum, SceneNetOptions, training.momentum), .standard = "on"},
    {"--seed", 0, "N", "Seed of the initial weights and of the launches", OPTION_SEED(SceneNetOptions, training.seed),
     .standard = "1"},
    {"--smallest", 0, NULL, "Train the smallest width whose held-out error is at most that of --within",
     OPTION_FLAG(SceneNetOptions, smallest)},
    {"--within", 0, "E", "Held-out error to reach, m/s; only with --smallest",
     OPTION_DOUBLE(SceneNetOptions, within, 0, 1000)},
    {0}};

static bool read_momentum(const Option *option, const char *text, void *value, Error *error) {
    const bool on = *(bool *)value = strcmp(text, "on") == 0;
    return on || strcmp(text, "off") == 0 || error_input(error, option->name, "'%s' is neither on nor off", text);
}

/* Context: the last score. */
static void scene_net_print_score(void *context, const SceneNetScore *score) {
    *(SceneNetScore *)context = *score;
    progress_bar_clear();
    printf("%5d  %7d  %8.4f  %8.4f  %11.4f\n", score->round, score->samples, score->train, score->held_out,
           score->momentum);
    fflush(stdout);
}

/* The stored command trains the width that was found. */
static bool scene_net_store(SceneNet *network, const TrainRequest *request, int width, Error *error) {
    TrainRequest found = *request;
    char text[16];
    snprintf(text, sizeof text, "%d", width);
    train_set(&found, "--width", text);
    train_set(&found, "--smallest", NULL);
    train_set(&found, "--within", NULL);
    train_describe(&found, network->command, sizeof network->command);
    if (!scene_net_write(network, request->output, error)) return false;
    printf("%s%d slots, %zu parameters -> %s\n", interrupt_requested() ? "stopped early; " : "", network->slot_count,
           network->parameter_count, request->output);
    return true;
}

static const char *than(double error, double rival) {
    return error < rival ? "better than" : error > rival ? "worse than" : "as good as";
}

/* Of the last round; absent without held-out impacts. */
static void print_verdict(const SceneNetVerdict *verdict) {
    if (verdict->samples == 0) {
        printf("verdict: none, as no held-out launch has an impact\n");
        return;
    }
    printf("held out: the network and its sweeps %.4f m/s in %.3g us; momentum in that time, %d sweeps, %.4f; with 20 "
           "sweeps %.4f\n",
           verdict->network, verdict->microseconds, verdict->sweeps, verdict->at_equal_time, verdict->at_20);
    printf("verdict: %s momentum at equal time; %s momentum with 20 sweeps\n",
           than(verdict->network, verdict->at_equal_time), than(verdict->network, verdict->at_20));
}

static SceneNet *scene_net_train(const Scene *scene, SceneTraining *training, SceneNetScore *score, Error *error) {
    *score = (SceneNetScore){0};
    training->context = score;
    printf("%d wide; mean velocity error, m/s\nround  samples     train  held out  momentum 20\n",
           training->widths.hidden);
    SceneNet *network = scene_training_run(scene, training, progress_bar_begin("training"), error);
    progress_bar_end();
    if (network != NULL) printf("impacts left out, as the reference does not converge: %d\n", score->unconverged);
    return network;
}

/* Tries one width after the other. NULL without an error: the sweeps alone are good enough. */
static SceneNet *train_smallest(const Scene *scene, SceneTraining *training, double within, Error *error) {
    static const int widths[] = {16, 32, 48, 64, 96, 128, 192, 256};
    SceneNetScore score = {0};
    for (size_t i = 0; i < sizeof widths / sizeof widths[0]; i++) {
        training->widths.hidden = widths[i];
        SceneNet *network = scene_net_train(scene, training, &score, error);
        if (network == NULL) return NULL;
        const bool none = score.momentum <= within;
        if (none) printf("no network is needed: momentum with 20 sweeps is within %g m/s\n", within);
        if (!none && (score.held_out <= within || interrupt_requested())) return network;
        scene_net_destroy(network);
        if (none) return NULL;
    }
    error_input(error, "--within", "no network up to 256 wide comes within %g m/s; the last has %.4f", within,
                score.held_out);
    return NULL;
}

static bool scene_net_run(const TrainRequest *request, Error *error) {
    SceneNetOptions given = {
        .training = {.widths = {.state = 16, .present = 32, .warm = 16}, .on_score = scene_net_print_score},
        .within = -1};
    SceneTraining *training = &given.training;
    SceneNetScore score;
    if (!train_read(request, &given, error)) return false;
    training->verdict = &given.verdict;
    const int width = training->widths.hidden;
    if (width % ROW_LANES != 0) return error_input(error, "--width", "%d is not a multiple of %d", width, ROW_LANES);
    if (given.smallest != (given.within >= 0))
        return error_input(error, "--smallest", "goes with --within E, and that with it");
    SceneNet *network = given.smallest ? train_smallest(request->scene, training, given.within, error)
                                       : scene_net_train(request->scene, training, &score, error);
    if (network == NULL) return error->kind == ERROR_NONE;
    const bool ok = scene_net_store(network, request, training->widths.hidden, error);
    if (ok) print_verdict(&given.verdict);
    scene_net_destroy(network);
    return ok;
}

const TrainKind train_scene_net = {
    .name = "scene-net",
    .input = "SCENE",
    .summary = "a network for the impacts of a scene. Prints its mean velocity error after each round, on the training "
               "and the held-out launches, beside that of 20 sweeps with momentum",
    .file_kind = "scene-net",
    .options = scene_net_options,
    .train = scene_net_run,
    .reads_scene = true};
