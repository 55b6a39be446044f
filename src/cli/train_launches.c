/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of twinbox train that learn from launches of scenes: sain, hybrid, gns, subspace and scene-net. */
#include "base/base.h"
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

#include <math.h>
#include <string.h>

enum { LIST_SIZE = 4096 };

static const char *stopped_early(void) { return interrupt_requested() ? "stopped early; " : ""; }

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
    printf("%5d  %8zu  %11zu  %7zu  %7.4f  %8.4f  %7.4f  %8.4f\n", score->round, score->problems, score->unconverged,
           score->bodies, score->loss, score->held_out.with, score->held_out.without, score->held_out.constant);
    fflush(stdout);
}

static bool sain_run(const TrainRequest *request, Error *error) {
    Scene *scenes[SAIN_SCENES_MAX] = {NULL};
    SainOptions given = {
        .training = {.scenes = scenes, .batch = SAIN_PARTS * BLOCK_ROWS, .on_score = sain_print_score}};
    SainTraining *training = &given.training;
    SainNetwork network = {0};
    bool ok = train_read(request, &given, error) &&
              read_scenes(request->input, given.more, "--with", scenes, SAIN_SCENES_MAX, &training->scene_count, error);
    if (ok) {
        printf("held-out impacts, velocity error in m/s\n"
               "round  problems  unconverged   bodies     loss      sain   engine  constant\n");
        ok = sain_training_run(training, &network, progress_bar_begin("training"), error);
        progress_bar_end();
        train_describe(request, network.command, sizeof network.command);
        ok = ok && sain_network_write(&network, request->output, error);
    }
    if (ok) printf("%s%d weights -> %s\n", stopped_early(), sain_weight_count(&network), request->output);
    sain_network_destroy(&network);
    for (int i = 0; i < SAIN_SCENES_MAX; i++) scene_destroy(scenes[i]);
    return ok;
}

const TrainKind train_sain = {
    .name = "sain",
    .input = "SCENE",
    .summary = "the network of sain, on launches of one or more scenes. Prints held-out errors after each round",
    .file_kind = "sain",
    .options = sain_options,
    .train = sain_run};

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
    HybridOptions given = {
        .training = {.components = HYBRID_STANDARD_COMPONENTS, .on_launch = add_launch, .context = &report}};
    HybridTraining *training = &given.training;
    if (!train_read(request, &given, error)) return false;
    training->limit = (size_t)(given.limit * MEBIBYTE);
    report.launches = training->launches;
    printf("launches   asked  answered   grown   added  entries       MiB  error of answers, m/s\n");
    HybridMemory *memory = hybrid_training_run(request->scene, training, progress_bar_begin("learning"), error);
    progress_bar_end();
    if (memory != NULL) train_describe(request, memory->command, sizeof memory->command);
    const bool ok = memory != NULL && hybrid_memory_write(memory, request->output, error);
    if (ok)
        printf("%s%d entries of %d sets of contacts, from %d launch%s -> %s\n", stopped_early(), memory->entry_count,
               memory->set_count, memory->launches, plural_es(memory->launches), request->output);
    hybrid_memory_destroy(memory);
    return ok;
}

const TrainKind train_hybrid = {
    .name = "hybrid",
    .input = "SCENE",
    .summary = "the memory of hybrid for a scene, launch after launch. Prints how many steps with an "
               "impact it answered, and what it learned from the others",
    .file_kind = "hybrid",
    .options = hybrid_options,
    .train = hybrid_run,
    .reads_scene = true};

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
    GnsOptions given = {.training = {.scenes = scenes, .on_score = gns_print_score}};
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
    train_describe(request, net.command, sizeof net.command);
    ok = ok && gns_net_write(&net, request->output, error);
    if (ok) printf("%s%d parameters -> %s\n", stopped_early(), net.layout.parameters, request->output);
    gns_net_free(&net);
    return ok;
}

const TrainKind train_gns = {.name = "gns",
                             .summary =
                                 "the graph network of gns, on steps of recorded launches. Prints its error during the "
                                 "training",
                             .file_kind = "gns",
                             .options = gns_options,
                             .train = gns_run};

enum { EPOCH_BATCHES = 20 };

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
    SubspaceTraining training = {.batches = EPOCH_BATCHES, .on_score = subspace_print_score};
    if (!train_read(request, &training, error)) return false;
    if (training.hidden % ROW_LANES != 0)
        return error_input(error, "--width", "must be a multiple of %d (got %d)", ROW_LANES, training.hidden);
    printf("held-out launches: distance from the recorded run, m (RMS over bodies and frames), and the median of the\n"
           "frames until a body is 0.1 m away\n"
           "components      loss  floor          linear term    with network\n");
    SubspaceNet *net = subspace_train(request->scene, &training, progress_bar_begin("training"), error);
    progress_bar_end();
    if (net != NULL) train_describe(request, net->command, sizeof net->command);
    const bool ok = net != NULL && subspace_net_write(net, request->output, error);
    if (ok) printf("%s%d bodies -> %s\n", stopped_early(), net->shape.bodies, request->output);
    subspace_net_destroy(net);
    return ok;
}

const TrainKind train_subspace = {.name = "subspace",
                                  .input = "SCENE",
                                  .summary =
                                      "the networks of subspace for a scene, with 8, 32 and 128 principal components. "
                                      "Prints held-out errors of each",
                                  .file_kind = SUBSPACE_KIND,
                                  .options = subspace_options,
                                  .train = subspace_run,
                                  .reads_scene = true};

static OptionRead read_momentum;

static const Option scene_net_options[] = {
    {"--launches", 0, "N", "Launches of each round; half of them rotated and spinning",
     OPTION_INT(SceneTraining, launches, 10, 100000), .standard = "3000"},
    {"--rounds", 0, "N", "Rounds; the first runs the launches without the network, the others with it",
     OPTION_INT(SceneTraining, rounds, 1, 100), .standard = "3"},
    {"--iterations", 0, "N", "Epochs of the first round; the others have half as many",
     OPTION_INT(SceneTraining, epochs, 1, 100000), .standard = "40"},
    {"--width", 0, "N", "Width of both hidden layers, a multiple of 16",
     OPTION_INT(SceneTraining, widths.hidden, ROW_LANES, SCENE_NET_WIDTH_MAX), .standard = "64"},
    {"--sweeps", 0, "K", "Sweeps that follow the network", OPTION_INT(SceneTraining, sweeps, 1, SCENE_NET_SWEEPS_MAX),
     .standard = "14"},
    {"--momentum", 0, "on|off", "Whether the sweeps after the network have learned momentum factors",
     OPTION_READ(read_momentum, SceneTraining, momentum), .standard = "on"},
    {"--seed", 0, "N", "Seed of the initial weights and of the launches", OPTION_SEED(SceneTraining, seed),
     .standard = "1"},
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

static bool scene_net_run(const TrainRequest *request, Error *error) {
    SceneNetScore score = {0};
    SceneTraining training = {
        .widths = {.state = 16, .present = 32, .warm = 16}, .on_score = scene_net_print_score, .context = &score};
    if (!train_read(request, &training, error)) return false;
    const int width = training.widths.hidden;
    if (width % ROW_LANES != 0) return error_input(error, "--width", "%d is not a multiple of %d", width, ROW_LANES);
    printf("mean velocity error, m/s\nround  samples     train  held out  momentum 20\n");
    SceneNet *network = scene_training_run(request->scene, &training, progress_bar_begin("training"), error);
    progress_bar_end();
    if (network != NULL) train_describe(request, network->command, sizeof network->command);
    const bool ok = network != NULL && scene_net_write(network, request->output, error);
    if (ok) {
        printf("impacts left out, as the reference does not converge: %d\n%s%d slots, %zu parameters -> %s\n",
               score.unconverged, stopped_early(), network->slot_count, network->parameter_count, request->output);
        printf("verdict: %s\n", isnan(score.held_out)             ? "none, as no held-out launch has an impact"
                                : score.held_out < score.momentum ? "better than momentum with 20 sweeps"
                                                                  : "no better than momentum with 20 sweeps");
    }
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
