/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/train.h"

#include "cli/commands.h"
#include "cli/installed.h"
#include "cli/options.h"
#include "common/names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TRAIN_KIND_ENTRY(name) &train_##name,
const TrainKind *const train_kinds[] = {TRAIN_KINDS(TRAIN_KIND_ENTRY) NULL};

/* Keys of argp: --kind, then the options of all kinds, one after the other. */
enum { KIND = 256, FIRST_OPTION, HELP_SIZE = 2048, USAGE_SIZE = 512 };

/* As given, before it is known what the kind takes. */
typedef struct GivenOption {
    const char *name, *value;
} GivenOption;

typedef struct Options {
    const char *kind, *input, *output;
    const TrainOption **options; /* [option_count] of all kinds */
    int option_count, given_count;
    GivenOption *given; /* [given_count] */
} Options;

/* The option table of argp, made from the kinds. */
typedef struct OptionTable {
    struct argp_option *rows;
    int row_count;
    char (*help)[HELP_SIZE]; /* a row each */
    char usage[USAGE_SIZE];
} OptionTable;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    if (key >= FIRST_OPTION && key < FIRST_OPTION + options->option_count) {
        options->given[options->given_count++] =
            (GivenOption){options->options[key - FIRST_OPTION]->name, value != NULL ? value : ""};
        return 0;
    }
    switch (key) {
    case 'o': options->output = value; break;
    case KIND: options->kind = value; break;
    case ARGP_KEY_ARG:
        if (options->input != NULL) argp_error(state, "one file at a time ('%s' is a second)", value);
        options->input = installed_path(value);
        break;
    case ARGP_KEY_END:
        if (options->input == NULL) argp_error(state, "a dataset (or scene) is needed");
        if (options->output == NULL) argp_error(state, "-o NET.npz is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* The kinds that have the option; NULL: all. */
static NameList name_kinds(const char *option) {
    NameList names = {0};
    for (const TrainKind *const *kind = train_kinds; *kind != NULL; kind++)
        if (option == NULL || train_find_option(*kind, option) >= 0) name_list_add(&names, (*kind)->name);
    return names;
}

static void add_row(OptionTable *table, struct argp_option row) {
    row.doc = table->help[table->row_count];
    table->rows[table->row_count++] = row;
}

static char *next_help(const OptionTable *table) { return table->help[table->row_count]; }

static void add_kind(OptionTable *table, Options *options, const TrainKind *kind, int group) {
    const size_t used = strlen(table->usage);
    const bool first = kind == train_kinds[0];
    snprintf(table->usage + used, sizeof table->usage - used, "%s%s%s%s", first ? "" : "\n--kind ",
             first ? "" : kind->name, first ? "" : " ", kind->input);
    snprintf(next_help(table), HELP_SIZE, "%s%s: %s.", kind->name, first ? " (default)" : "", kind->summary);
    add_row(table, (struct argp_option){.group = group});
    for (const TrainOption *option = kind->options; option->name != NULL; option++) {
        const char *standard = option->standard;
        snprintf(next_help(table), HELP_SIZE, "%s%s%s%s", option->help, standard != NULL ? " (default: " : "",
                 standard != NULL ? standard : "", standard != NULL ? ")" : "");
        add_row(table, (struct argp_option){option->name, FIRST_OPTION + options->option_count, option->value, 0, NULL,
                                            group});
        options->options[options->option_count++] = option;
    }
}

static size_t count_options(void) {
    size_t count = 0;
    for (const TrainKind *const *kind = train_kinds; *kind != NULL; kind++)
        for (const TrainOption *option = (*kind)->options; option->name != NULL; option++) count++;
    return count;
}

static size_t count_kinds(void) {
    size_t count = 0;
    while (train_kinds[count] != NULL) count++;
    return count;
}

static void free_options(OptionTable *table, Options *options) {
    free(table->rows);
    free(table->help);
    free(options->options);
    free(options->given);
}

static bool make_table(OptionTable *table, Options *options, int argc, Error *error) {
    const size_t rows = 2 + count_kinds() + count_options();
    table->rows = calloc(rows + 1, sizeof *table->rows);
    table->help = calloc(rows + 1, sizeof *table->help);
    options->options = calloc(count_options(), sizeof *options->options);
    options->given = calloc((size_t)argc, sizeof *options->given);
    if (table->rows == NULL || table->help == NULL || options->options == NULL || options->given == NULL)
        return error_memory(error, "train");
    const NameList names = name_kinds(NULL);
    snprintf(next_help(table), HELP_SIZE, "File that the network is written to");
    add_row(table, (struct argp_option){.name = "output", .key = 'o', .arg = "NET.npz"});
    snprintf(next_help(table), HELP_SIZE, "What to train: %s (default: %s)", names.text, train_kinds[0]->name);
    add_row(table, (struct argp_option){.name = "kind", .key = KIND, .arg = "NAME"});
    for (int i = 0; train_kinds[i] != NULL; i++) add_kind(table, options, train_kinds[i], i + 1);
    return true;
}

static const TrainKind *find_kind(const char *name) {
    for (const TrainKind *const *kind = train_kinds; *kind != NULL; kind++)
        if (strcmp((*kind)->name, name) == 0) return *kind;
    return NULL;
}

static bool make_request(const Options *options, TrainRequest *request, Error *error) {
    *request = (TrainRequest){.kind = find_kind(options->kind), .input = options->input, .output = options->output};
    if (request->kind == NULL) {
        const NameList known = name_kinds(NULL);
        error_unknown(error, "--kind", options->kind, "a kind", &known);
        return false;
    }
    for (int i = 0; request->kind->options[i].name != NULL; i++)
        request->values[i] = request->kind->options[i].standard;
    for (int i = 0; i < options->given_count; i++) {
        const GivenOption *given = &options->given[i];
        const int option = train_find_option(request->kind, given->name);
        if (option < 0) {
            const NameList owners = name_kinds(given->name);
            char dashed[64];
            snprintf(dashed, sizeof dashed, "--%s", given->name);
            return error_input(error, dashed, "is an option of %s, not of %s", owners.text, request->kind->name);
        }
        request->values[option] = given->value;
    }
    return true;
}

int command_train(int argc, char **argv, Error *error) {
    Options options = {.kind = train_kinds[0]->name};
    OptionTable table = {.row_count = 0};
    bool ok = make_table(&table, &options, argc, error);
    const struct argp argp = {
        .options = table.rows,
        .parser = parse,
        .args_doc = table.usage,
        .doc = "Train the network of a method, or its learned factors. Ctrl-C stops and keeps the best found so far.\v"
               "Example: twinbox train pairs.npz -o pair-net.npz --layers 10-10-2 --optimizer lm --iterations 100\n"
               "         twinbox train --kind scene-net scenes/stack.yaml -o scene-net.npz"};
    TrainRequest request;
    ok = ok && options_parse(&argp, argc, argv, &options) && make_request(&options, &request, error) &&
         request.kind->train(&request, error);
    free_options(&table, &options);
    return ok ? STATUS_SAME : STATUS_DIFFERENT;
}
