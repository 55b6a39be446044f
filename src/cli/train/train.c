/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/train/train.h"

#include "cli/commands.h"
#include "cli/notes.h"
#include "common/file_reserve.h"
#include "common/names.h"
#include "npz/output_check.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#define TRAIN_KIND_ENTRY(name) &train_##name,
const TrainKind *const train_kinds[] = {TRAIN_KINDS(TRAIN_KIND_ENTRY) NULL};

enum { KINDS = sizeof train_kinds / sizeof *train_kinds - 1, TEXT_SIZE = 2048 };

/* The options of all kinds, as given, before it is known what the kind takes. */
typedef struct Options {
    const char *kind, *input, *output;
    int row_count;
    Option rows[OPTIONS_MAX + 1];
    const char *values[OPTIONS_MAX + 1]; /* of the rows */
} Options;

/* The texts of the help that are made from the kinds. */
typedef struct HelpTexts {
    char kind[TEXT_SIZE], headings[KINDS][TEXT_SIZE], usage[TEXT_SIZE];
    const char *names[KINDS + 1]; /* ended by NULL */
} HelpTexts;

static bool remember(const Option *option, const char *text, void *value, Error *error) {
    (void)error;
    Options *options = value;
    options->values[option - options->rows] = text != NULL ? text : "";
    return true;
}

static void add_row(Options *options, Option row) {
    assert(options->row_count < OPTIONS_MAX);
    options->rows[options->row_count++] = row;
}

/* The kinds that have the option; NULL: all. */
static NameList name_kinds(const char *option) {
    NameList names = {0};
    for (const TrainKind *const *kind = train_kinds; *kind != NULL; kind++)
        if (option == NULL || train_find_option(*kind, option) >= 0) name_list_add(&names, (*kind)->name);
    return names;
}

static void add_kind(Options *options, HelpTexts *texts, int k) {
    const TrainKind *kind = train_kinds[k];
    const size_t used = strlen(texts->usage);
    snprintf(texts->usage + used, sizeof texts->usage - used, "%s%s%s%s", k == 0 ? "" : "\n--kind ",
             k == 0 ? "" : kind->name, k == 0 || kind->input == NULL ? "" : " ",
             kind->input != NULL ? kind->input : "");
    snprintf(texts->headings[k], TEXT_SIZE, "%s%s: %s.", kind->name, k == 0 ? " (default)" : "", kind->summary);
    add_row(options, (Option){.help = texts->headings[k]});
    for (const Option *option = kind->options; option->name != NULL; option++) {
        Option row = *option;
        row.read = remember;
        row.at = 0;
        add_row(options, row);
    }
}

static void make_table(Options *options, HelpTexts *texts) {
    snprintf(texts->kind, TEXT_SIZE, "What to train: %s", name_kinds(NULL).text);
    add_row(options, (Option){"--output", 'o', "NET.npz", "File that the network is written to",
                              OPTION_BINARY(Options, output), .needed = "-o NET.npz is needed"});
    for (int k = 0; k < KINDS; k++) texts->names[k] = train_kinds[k]->name;
    add_row(options, (Option){"--kind", 0, "NAME", texts->kind, OPTION_TEXT(Options, kind), .names = texts->names,
                              .standard = train_kinds[0]->name});
    for (int k = 0; k < KINDS; k++) add_kind(options, texts, k);
}

static const TrainKind *find_kind(const char *name, Error *error) {
    for (const TrainKind *const *kind = train_kinds; *kind != NULL; kind++)
        if (strcmp((*kind)->name, name) == 0) return *kind;
    const NameList known = name_kinds(NULL);
    error_unknown(error, "--kind", name, "a kind", &known);
    return NULL;
}

static bool make_request(const Options *options, TrainRequest *request, Error *error) {
    *request =
        (TrainRequest){.kind = find_kind(options->kind, error), .input = options->input, .output = options->output};
    if (request->kind == NULL) return false;
    if ((request->input == NULL) != (request->kind->input == NULL))
        return request->input == NULL
                   ? error_input(error, request->kind->name, "a file to train on is needed: %s", request->kind->input)
                   : error_input(error, request->input, "%s takes no file to train on", request->kind->name);
    for (int i = 0; request->kind->options[i].name != NULL; i++)
        request->values[i] = request->kind->options[i].standard;
    for (int i = 0; i < options->row_count; i++) {
        if (options->values[i] == NULL) continue;
        const char *name = options->rows[i].name;
        const int option = train_find_option(request->kind, name);
        if (option < 0)
            return error_input(error, name, "is an option of %s, not of %s", name_kinds(name).text,
                               request->kind->name);
        request->values[option] = options->values[i];
    }
    return true;
}

bool command_train(int argc, char **argv, Error *error) {
    Options options = {.kind = train_kinds[0]->name};
    HelpTexts texts = {.usage = ""};
    make_table(&options, &texts);
    const CommandSpec spec = {
        .options = options.rows,
        .input = {.value = texts.usage, .needed = "a dataset (or scene) is needed", OPTION_PATH(Options, input)},
        .inputs = {0, 1, "file"},
        .help = "Train the network of a method, or its learned factors. Ctrl-C stops and keeps the best found so far.\v"
                "Example: twinbox train pairs.npz -o pair-net.npz --layers 10-10-2 --optimizer lm --iterations 100\n"
                "         twinbox train --kind scene-net scenes/stack.yaml -o scene-net.npz"};
    TrainRequest request;
    if (!options_parse(&spec, argc, argv, &options, error) || !make_request(&options, &request, error) ||
        !output_check_npz(request.output, request.kind->file_kind, error) ||
        !train_take_shard(&request, argc, argv, error))
        return false;
    char command[TRAIN_COMMAND_SIZE];
    train_describe(&request, command, sizeof command);
    note_verbose("with all options: %s", command);
    if (train_is_shard(&request)) return request.kind->train(&request, error);
    FileReservation reservation;
    if (!file_reserve(&reservation, request.output, error)) return false;
    const bool done = request.kind->train(&request, error);
    return file_release(&reservation, error) && done;
}
