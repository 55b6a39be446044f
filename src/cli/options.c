/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/options.h"

#include <argp.h>
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

enum { FIRST_KEY = 256, HELP_SIZE = 1024 };

typedef struct Parsing {
    const CommandSpec *spec;
    char *options;
    Error *error;
    int input_count;
    bool given[OPTIONS_MAX];
} Parsing;

static int key_of(const Option *rows, int i) { return rows[i].letter != 0 ? rows[i].letter : FIRST_KEY + i; }

static void read_value(Parsing *parsing, const Option *row, const char *text) {
    if (parsing->error->kind == ERROR_NONE) row->read(row, text, parsing->options + row->at, parsing->error);
}

static void take_input(Parsing *parsing, const char *text, struct argp_state *state) {
    const CommandSpec *spec = parsing->spec;
    if (spec->inputs.most == 0) argp_error(state, "'%s' is not expected", text);
    if (parsing->input_count == spec->inputs.most)
        argp_error(state, "only %d %s%s can be given ('%s' is one more)", spec->inputs.most, spec->inputs.noun,
                   spec->inputs.most > 1 ? "s" : "", text);
    parsing->input_count++;
    read_value(parsing, &spec->input, text);
}

static void check_needed(const Parsing *parsing, struct argp_state *state) {
    const CommandSpec *spec = parsing->spec;
    if (parsing->input_count < spec->inputs.least) argp_error(state, "%s", spec->input.needed);
    for (int i = 0; spec->options != NULL && spec->options[i].help != NULL; i++)
        if (spec->options[i].needed != NULL && !parsing->given[i]) argp_error(state, "%s", spec->options[i].needed);
}

static error_t parse(int key, char *text, struct argp_state *state) {
    Parsing *parsing = state->input;
    const Option *rows = parsing->spec->options;
    if (key == ARGP_KEY_ARG) {
        take_input(parsing, text, state);
        return 0;
    }
    if (key == ARGP_KEY_END) {
        check_needed(parsing, state);
        return 0;
    }
    for (int i = 0; rows != NULL && rows[i].help != NULL; i++) {
        if (key != key_of(rows, i)) continue;
        parsing->given[i] = true;
        read_value(parsing, &rows[i], text);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* The help of an option, with its default. argp frees it. */
static char *add_standard(int key, const char *text, void *input) {
    const Option *rows = ((const Parsing *)input)->spec->options;
    for (int i = 0; rows != NULL && rows[i].help != NULL; i++) {
        char *help;
        if (key != key_of(rows, i) || rows[i].standard == NULL || (help = malloc(HELP_SIZE)) == NULL) continue;
        snprintf(help, HELP_SIZE, "%s (default: %s)", text, rows[i].standard);
        return help;
    }
    return (char *)text;
}

bool options_parse(const CommandSpec *spec, int argc, char **argv, void *options, Error *error) {
    struct argp_option rows[OPTIONS_MAX + 1] = {{0}};
    for (int i = 0; spec->options != NULL && spec->options[i].help != NULL; i++) {
        const Option *row = &spec->options[i];
        assert(i < OPTIONS_MAX);
        /* Names are stored with their dashes. */
        rows[i] =
            row->name == NULL
                ? (struct argp_option){.doc = row->help}
                : (struct argp_option){row->name + 2, key_of(spec->options, i), row->value, 0, row->help, row->group};
    }
    const struct argp argp = {.options = rows,
                              .parser = parse,
                              .args_doc = spec->input.value != NULL ? spec->input.value : "",
                              .doc = spec->help,
                              .help_filter = add_standard};
    Parsing parsing = {.spec = spec, .options = options, .error = error};
    argp_err_exit_status = ERROR_INPUT;
    const error_t status = argp_parse(&argp, argc, argv, 0, NULL, &parsing);
    if (status != 0 && error->kind == ERROR_NONE) error_memory(error, argv[0]);
    return error->kind == ERROR_NONE;
}
