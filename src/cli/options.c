/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options as tables: the values of each kind, and the reading of a command line. */
#include "cli/options.h"

#include "base/base.h"
#include "base/file.h"
#include "cli/installed.h"
#include "cli/notes.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "scenes/scenes.h"

#include <argp.h>
#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool option_text(const Option *option, const char *text, void *value, Error *error) {
    (void)option, (void)error;
    *(const char **)value = text;
    return true;
}

/* Only one input can be standard input. */
static bool check_input(const char *text, Error *error) {
    static int count;
    return !path_is_standard(text) || ++count == 1 ||
           error_input(error, "-", "only one file can be read from standard input");
}

bool option_path(const Option *option, const char *text, void *value, Error *error) {
    return check_input(text, error) && option_text(option, installed_path(text), value, error);
}

bool option_output(const Option *option, const char *text, void *value, Error *error) {
    return (!path_is_standard(text) || standard_output_reserve(error)) && option_text(option, text, value, error);
}

bool option_binary(const Option *option, const char *text, void *value, Error *error) {
    if (path_is_standard(text) && isatty(STDOUT_FILENO))
        return error_input(error, option->name, "binary data cannot go to a terminal; redirect standard output");
    return option_output(option, text, value, error);
}

bool option_flag(const Option *option, const char *text, void *value, Error *error) {
    (void)option, (void)text, (void)error;
    *(bool *)value = true;
    return true;
}

static bool read_int(const Option *option, const char *text, int64_t least, int64_t most, int64_t *value,
                     Error *error) {
    return parse_int(text, least, most, value) ||
           error_input(error, option->name, "'%.64s' is not a whole number from %lld to %lld", text, (long long)least,
                       (long long)most);
}

bool option_int(const Option *option, const char *text, void *value, Error *error) {
    int64_t parsed;
    if (!read_int(option, text, (int64_t)option->least, (int64_t)option->most, &parsed, error)) return false;
    *(int *)value = (int)parsed;
    return true;
}

bool option_seed(const Option *option, const char *text, void *value, Error *error) {
    int64_t parsed;
    if (!read_int(option, text, 0, UINT32_MAX, &parsed, error)) return false;
    *(uint64_t *)value = (uint64_t)parsed;
    return true;
}

/* Whether the text is a number, and that number within the bounds; else error is set. */
static bool check_number(const Option *option, const char *text, bool is_number, double parsed, Error *error) {
    return (is_number && parsed >= option->least && parsed <= option->most) ||
           error_input(error, option->name, "'%.64s' is not a number from %g to %g", text, option->least, option->most);
}

bool option_float(const Option *option, const char *text, void *value, Error *error) {
    float parsed = 0;
    const bool is_number = parse_float(text, &parsed);
    if (!check_number(option, text, is_number, (double)parsed, error)) return false;
    *(float *)value = parsed;
    return true;
}

bool option_double(const Option *option, const char *text, void *value, Error *error) {
    double parsed = 0;
    const bool is_number = parse_double(text, &parsed);
    if (!check_number(option, text, is_number, parsed, error)) return false;
    *(double *)value = parsed;
    return true;
}

/* The index of the name that `text` begins with, up to `length`; -1 with error set if there is no such name. */
static int find_name(const Option *option, const char *text, size_t length, Error *error) {
    NameList known = {0};
    char name[65];
    for (int i = 0; option->names[i] != NULL; i++) {
        if (strlen(option->names[i]) == length && strncmp(option->names[i], text, length) == 0) return i;
        name_list_add(&known, option->names[i]);
    }
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name), text);
    return error_unknown(error, option->name, name, "a valid value", &known), -1;
}

bool option_enum(const Option *option, const char *text, void *value, Error *error) {
    const int i = find_name(option, text, strlen(text), error);
    if (i >= 0) *(unsigned *)value = (unsigned)i;
    return i >= 0;
}

bool option_flags(const Option *option, const char *text, void *value, Error *error) {
    *(unsigned *)value = 0;
    for (;; text++) {
        const size_t length = strcspn(text, ",");
        const int i = find_name(option, text, length, error);
        if (i < 0) return false;
        *(unsigned *)value |= 1u << i;
        text += length;
        if (*text == '\0') return true;
    }
}

bool option_texts(const Option *option, const char *text, void *value, Error *error) {
    int *count = (int *)((char *)value - option->at + option->count_at);
    if (*count == (int)option->most) return error_input(error, option->name, "can be given at most %d times", *count);
    ((const char **)value)[(*count)++] = text;
    return true;
}

bool option_method(const Option *option, const char *text, void *value, Error *error) {
    programs_allow(text);
    return option_text(option, text, value, error);
}

bool option_method_texts(const Option *option, const char *text, void *value, Error *error) {
    programs_allow(text);
    return option_texts(option, text, value, error);
}

bool option_paths(const Option *option, const char *text, void *value, Error *error) {
    return check_input(text, error) && option_texts(option, installed_path(text), value, error);
}

bool option_range(const Option *option, const char *text, void *value, Error *error) {
    enum { MAX_VALUES = 100000 };
    return parse_range(text, MAX_VALUES, value) ||
           error_input(error, option->name, "'%.64s' is not A:B:STEP with A <= B, STEP > 0 and at most %d values", text,
                       MAX_VALUES);
}

bool option_set(const Option *option, const char *text, void *value, Error *error) {
    return scene_settings_add(value, text) ||
           error_input(error, option->name, "'%.64s' is not NAME=VALUE with a number after '='", text);
}

enum { FIRST_KEY = 256, SHOWN_SIZE = 72 };

static const Option options_of_all[] = {
    {.name = "--quiet", .letter = 'q', .help = "Print errors, and results that go to no file: no progress, no notes"},
    {.name = "--verbose",
     .letter = 'v',
     .help = "Print what is done to get the result: files, settings, programs, threads, time, memory"},
    {0}};
enum { OPTIONS_OF_ALL = sizeof options_of_all / sizeof *options_of_all - 1, GROUP_OF_HELP = -1 };

typedef struct Parsing {
    const CommandSpec *spec;
    char *options;
    Error *error;
    int input_count;
    bool given[OPTIONS_MAX];
    NoteLevel level;
} Parsing;

static int key_of(const Option *rows, int i) { return rows[i].letter != 0 ? rows[i].letter : FIRST_KEY + i; }

/* -1: none. */
static int find_row(const Option *rows, int key) {
    for (int i = 0; rows[i].help != NULL; i++)
        if (key_of(rows, i) == key) return i;
    return -1;
}

/* The first error stays, so reading continues after it: bad usage is reported before bad values. */
static void read_value(const Parsing *parsing, const Option *row, const char *text) {
    const unsigned control = text != NULL ? control_in_text(text) : 0;
    if (control != 0) /* Results repeat names, and go to terminals. */
        error_input(parsing->error, row->name != NULL ? row->name : text, "the text has the control character U+%04X",
                    control);
    else
        row->read(row, text, parsing->options + row->at, parsing->error);
}

static error_t parse(int key, char *text, struct argp_state *state) {
    Parsing *parsing = state->input;
    const CommandSpec *spec = parsing->spec;
    const int i = find_row(spec->options, key);
    char shown[SHOWN_SIZE];
    if (i >= 0) {
        parsing->given[i] = true;
        read_value(parsing, &spec->options[i], text);
    } else if (key == 'q' || key == 'v') {
        const NoteLevel level = key == 'q' ? NOTES_QUIET : NOTES_VERBOSE;
        if (parsing->level != NOTES_NORMAL && parsing->level != level)
            argp_error(state, "--quiet cannot be combined with --verbose");
        parsing->level = level;
    } else if (key == ARGP_KEY_ARG) {
        visible_text(shown, sizeof shown, text, VISIBLE_ONE_LINE);
        if (spec->inputs.most == 0) argp_error(state, "'%s' is not expected", shown);
        if (parsing->input_count == spec->inputs.most)
            argp_error(state, "only %d %s%s can be given ('%s' is one more)", spec->inputs.most, spec->inputs.noun,
                       spec->inputs.most > 1 ? "s" : "", shown);
        parsing->input_count++;
        read_value(parsing, &spec->input, text);
    } else if (key == ARGP_KEY_END) {
        if (parsing->input_count < spec->inputs.least) argp_error(state, "%s", spec->input.needed);
        for (int k = 0; spec->options[k].help != NULL; k++)
            if (spec->options[k].needed != NULL && !parsing->given[k]) argp_error(state, "%s", spec->options[k].needed);
    } else {
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

/* The help of an option, with its default. argp frees it. */
static char *add_standard(int key, const char *text, void *input) {
    const Option *rows = ((const Parsing *)input)->spec->options;
    const int i = find_row(rows, key);
    if (i < 0 || rows[i].standard == NULL) return (char *)text;
    const size_t size = strlen(text) + strlen(rows[i].standard) + sizeof " (default: )";
    char *help = malloc(size);
    if (help != NULL) snprintf(help, size, "%s (default: %s)", text, rows[i].standard);
    return help;
}

static void make_rows(const CommandSpec *spec, struct argp_option rows[OPTIONS_MAX + OPTIONS_OF_ALL + 1]) {
    int count = 0;
    for (int i = 0; spec->options[i].help != NULL; i++, count++) {
        const Option *row = &spec->options[i];
        assert(i < OPTIONS_MAX);
        rows[i] = (struct argp_option){.doc = row->help, .group = row->group};
        if (row->name == NULL) continue;
        rows[i].name = row->name + strlen("--");
        rows[i].key = key_of(spec->options, i);
        rows[i].arg = row->value;
    }
    for (int i = 0; i < OPTIONS_OF_ALL; i++) {
        const Option *row = &options_of_all[i];
        rows[count++] = (struct argp_option){
            .name = row->name + strlen("--"), .key = row->letter, .doc = row->help, .group = GROUP_OF_HELP};
    }
}

/* The row of the word's last option, which may be abbreviated if it is long; NULL if the word has an unknown or
   ambiguous one. *value: behind it, if there is a value. */
static const struct argp_option *find_option(const struct argp_option *rows, const char *word, const char **value) {
    const struct argp_option *found = NULL;
    size_t length = strcspn(word, "=");
    *value = word[1] == '-' && word[length] == '=' ? word + length + 1 : NULL;
    if (word[1] == '-') {
        word += 2, length -= 2;
        for (; rows->name != NULL || rows->doc != NULL; rows++) {
            if (rows->name == NULL || strncmp(rows->name, word, length) != 0) continue;
            if (rows->name[length] == '\0') return rows;
            if (found != NULL) return NULL;
            found = rows;
        }
        return found;
    }
    while (*++word != '\0' && *value == NULL) { /* "-qo" */
        found = NULL;
        for (const struct argp_option *row = rows; found == NULL && (row->name != NULL || row->doc != NULL); row++)
            if (row->name != NULL && row->key == (unsigned char)*word) found = row;
        if (found == NULL) return NULL;
        if (found->arg != NULL && word[1] != '\0') *value = word + 1;
    }
    return found;
}

/* False with error set if a long option that argp does not know is near one that there is. */
static bool suggest(const struct argp_option *rows, const char *word, const char *command, Error *error) {
    const char *names[2 + OPTIONS_MAX + OPTIONS_OF_ALL] = {"help", "usage"}; /* argp's own */
    char name[SHOWN_SIZE];
    int count = 2;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);
    for (; rows->name != NULL || rows->doc != NULL; rows++)
        if (rows->name != NULL) names[count++] = rows->name;
    for (int i = 0; i < count; i++)
        if (strncmp(names[i], name, strlen(name)) == 0) return true; /* an ambiguous one, of which argp lists all */
    const char *nearest = nearest_word(name, names, count);
    return nearest == NULL ||
           error_input(error, command, "unrecognized option '--%s'; did you mean '--%s'?", name, nearest);
}

/* argp prints an option that it does not know as it is. It may do so with a short one of visible characters. */
static bool check_words(const struct argp_option *rows, char **argv, Error *error) {
    for (int i = 1; argv[i] != NULL; i++) {
        char shown[SHOWN_SIZE];
        const char *word = argv[i], *value;
        if (strcmp(word, "--") == 0) return true;
        if (word[0] != '-' || word[1] == '\0') continue;
        const struct argp_option *row = find_option(rows, word, &value);
        visible_text(shown, sizeof shown, word, VISIBLE_ONE_LINE);
        if (row == NULL && strcmp(shown, word) != 0)
            return error_input(error, argv[0], "unrecognized option '%s'", shown);
        if (row == NULL && word[1] == '-' && !suggest(rows, word, argv[0], error)) return false;
        if (row != NULL && row->arg != NULL && value == NULL && argv[i + 1] != NULL) i++;
    }
    return true;
}

bool options_parse(const CommandSpec *spec, int argc, char **argv, void *options, Error *error) {
    struct argp_option rows[OPTIONS_MAX + OPTIONS_OF_ALL + 1] = {{0}};
    make_rows(spec, rows);
    if (!check_words(rows, argv, error)) return false;
    const struct argp argp = {.options = rows,
                              .parser = parse,
                              .args_doc = spec->input.value != NULL ? spec->input.value : "",
                              .doc = spec->help,
                              .help_filter = add_standard};
    Parsing parsing = {.spec = spec, .options = options, .error = error, .level = NOTES_NORMAL};
    argp_err_exit_status = ERROR_INPUT;
    const error_t status = argp_parse(&argp, argc, argv, 0, NULL, &parsing);
    if (status != 0 && error->kind == ERROR_NONE) error_memory(error, argv[0]);
    if (parsing.level != NOTES_NORMAL)
        note_set_level(parsing.level); /* that of a merge stays in the command that it runs */
    /* Where the results are files that the command line names, -q prints nothing beside them, unless it is asked to. */
    bool writes = false, asked = false;
    for (int i = 0; spec->options[i].help != NULL; i++) {
        const Option *row = &spec->options[i];
        writes = writes || (parsing.given[i] && row->letter == 'o');
        asked = asked || (parsing.given[i] && row->name != NULL && strcmp(row->name, "--json") == 0);
    }
    if (note_level() == NOTES_QUIET && writes && !asked) results_keep();
    note_begin(argv[0]);
    return error->kind == ERROR_NONE;
}
