/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress_bar.h"
#include "cli/train/train.h"
#include "common/file.h"
#include "common/standard_io.h"
#include "relation_training/relation_training.h"

#include <stdio.h>
#include <string.h>

enum { PATH_SIZE = 4096, LIST_SIZE = 2048, STEPS_SAVED = 100 };

typedef struct Options {
    RelationTraining training;
    const char *more;
} Options;

static const Option options[] = {
    {"--with", 0, "SCENE,...", "Further scenes to train on, separated by commas", OPTION_TEXT(Options, more)},
    {"--launches", 0, "N", "Launches of each scene and round", OPTION_INT(Options, training.launches, 1, 10000),
     .standard = "40"},
    {"--rounds", 0, "N", "Rounds; the engine runs the launches of the first, sain those of the others",
     OPTION_INT(Options, training.rounds, 1, RELATION_ROUNDS_MAX), .standard = "2"},
    {"--steps", 0, "N", "Steps of the optimiser in each round", OPTION_INT(Options, training.steps, 1, 1000000),
     .standard = "2000"},
    {"--seed", 0, "N", "Seed of the initial weights and of the samples of each step",
     OPTION_SEED(Options, training.seed), .standard = "1"},
    {0}};

static void print_score(void *context, const RelationScore *score) {
    (void)context;
    progress_bar_clear();
    printf("%-8s  %5d  %8zu  %7zu  %7.4f  %8.4f  %7.4f  %8.4f\n", relation_form_names[score->form], score->round,
           score->problems, score->bodies, score->loss, score->held_out.with, score->held_out.without,
           score->held_out.constant);
    fflush(stdout);
}

/* Reads the scene of the command line and those of the list. */
static bool read_scenes(const char *first, const char *more, Scene *scenes[RELATION_SCENES_MAX], int *count,
                        Error *error) {
    char list[LIST_SIZE], *rest = list;
    if (snprintf(list, sizeof list, "%s", more != NULL ? more : "") >= (int)sizeof list)
        return error_input(error, "--with", "the list has more than %d characters", LIST_SIZE - 1);
    for (const char *path = first; path != NULL; path = strtok_r(rest, ",", &rest)) {
        if (*count == RELATION_SCENES_MAX)
            return error_input(error, "--with", "more than %d scenes", RELATION_SCENES_MAX);
        scenes[*count] = scene_read(path, error);
        if (scenes[*count] == NULL) return false;
        ++*count;
    }
    return true;
}

static bool train_and_store(const TrainRequest *request, RelationTraining *training, Error *error) {
    RelationNetworks networks;
    char command[RELATION_COMMAND_SIZE], state[PATH_SIZE];
    if (!file_path(state, sizeof state, error, "%s.part", request->output)) return false;
    train_describe(request, command, sizeof command);
    training->command = command;
    training->state_path = state;
    printf("held-out impacts, velocity error in m/s\n"
           "engine    round  problems   bodies     loss      sain   engine  constant\n");
    bool ok = relation_training_run(training, &networks, progress_bar_begin("training"), error);
    progress_bar_end();
    snprintf(networks.command, sizeof networks.command, "%s", command);
    ok = ok && relation_networks_write(&networks, request->output, error) && file_remove(state, error);
    if (ok)
        printf("%d networks of %d weights -> %s\n", (int)RELATION_FORMS, relation_weight_count(&networks.forms[0]),
               request->output);
    relation_networks_destroy(&networks);
    return ok;
}

static bool run(const TrainRequest *request, Error *error) {
    Options given = {.training = {.batch = RELATION_PARTS * BLOCK_ROWS, .saved = STEPS_SAVED, .on_score = print_score}};
    Scene *scenes[RELATION_SCENES_MAX] = {NULL};
    if (path_is_standard(request->output))
        return error_input(error, "-o", "sain keeps its state beside the network; give the network a name");
    if (!train_read(request, &given, error)) return false;
    RelationTraining *training = &given.training;
    training->scenes = scenes;
    const bool ok = read_scenes(request->input, given.more, scenes, &training->scene_count, error) &&
                    train_and_store(request, training, error);
    for (int i = 0; i < RELATION_SCENES_MAX; i++) scene_destroy(scenes[i]);
    return ok;
}

const TrainKind train_sain = {
    "sain",
    "SCENE",
    "the networks of sain, on launches of one or more scenes: with the engine, without it, and "
    "with its output shuffled. Prints held-out errors after each round. An interrupted "
    "training is resumed by the same command; its state is in NET.npz.part",
    "sain",
    options,
    run};
