/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds out what the last word is: a command, an option, the value of one, or an argument. */
#include "cli/commands.h"
#include "cli/completion.h"

#include <stdio.h>
#include <string.h>

void completion_offer(const char *begin, const char *typed, const char *word, const char *ending,
                      const char *description) {
    char whole[COMPLETION_WORD_SIZE];
    const int length = snprintf(whole, sizeof whole, "%s%s", word, ending);
    if (length < 0 || (size_t)length >= sizeof whole || strncmp(whole, typed, strlen(typed)) != 0) return;
    printf("%s%s\t%.*s\n", begin, whole, (int)strcspn(description, "\n"), description);
}

void completion_offer_files(const char *begin, const char *endings) { printf("<files>%s\t%s\n", begin, endings); }

void completion_offer_folders(const char *begin) { printf("<folders>%s\n", begin); }

static void offer_options(const Option *rows, const char *typed) {
    for (; rows->help != NULL; rows++)
        if (rows->name != NULL) completion_offer("", typed, rows->name, "", rows->help);
}

/* The row of "--name" or "--name=value", or NULL. */
static const Option *find_long(const Option *rows, const char *word) {
    const size_t length = strcspn(word, "=");
    for (; rows->help != NULL; rows++)
        if (rows->name != NULL && strlen(rows->name) == length && strncmp(rows->name, word, length) == 0) return rows;
    return NULL;
}

static const Option *find_letter(const Option *rows, char letter) {
    for (; rows->help != NULL; rows++)
        if (rows->name != NULL && rows->letter == letter) return rows;
    return NULL;
}

/* The option whose value the next word is, or NULL. */
static const Option *find_waiting(const Option *rows, const char *word) {
    const Option *row = NULL;
    if (strncmp(word, "--", 2) == 0)
        row = strchr(word, '=') == NULL ? find_long(rows, word) : NULL;
    else if (word[0] == '-' && word[1] != '\0' && word[2] == '\0')
        row = find_letter(rows, word[1]);
    return row != NULL && row->value != NULL ? row : NULL;
}

/* What stands before the last word. */
typedef struct Before {
    const Option *waiting; /* for its value */
    int inputs;
    bool only_inputs; /* after "--" */
    const char *scene;
} Before;

static Before look_before(const CommandSpec *spec, const CompletionWords *words) {
    Before before = {.waiting = NULL};
    for (int i = 0; i + 1 < words->count; i++) {
        const char *word = words->words[i];
        if (before.waiting != NULL)
            before.waiting = NULL;
        else if (strcmp(word, "--") == 0 && !before.only_inputs)
            before.only_inputs = true;
        else if (word[0] == '-' && word[1] != '\0' && !before.only_inputs)
            before.waiting = find_waiting(spec->options, word);
        else if (before.inputs++ == 0 && spec->input.value != NULL && strstr(spec->input.value, "SCENE") != NULL)
            before.scene = word;
    }
    return before;
}

/* `context` has the words behind the command. */
static void complete(const CommandSpec *spec, void *context) {
    const CompletionWords *words = context;
    const char *typed = words->words[words->count - 1], *equals = strchr(typed, '=');
    const Before before = look_before(spec, words);
    char begin[COMPLETION_WORD_SIZE] = "";
    CompletionValue value = {before.waiting, begin, typed, before.scene};
    if (before.waiting == NULL && !before.only_inputs && strncmp(typed, "--", 2) == 0 && equals != NULL) {
        value.option = find_long(spec->options, typed);
        value.typed = equals + 1;
        snprintf(begin, sizeof begin, "%.*s", (int)(equals + 1 - typed), typed);
        if (value.option == NULL || value.option->value == NULL) return;
    } else if (before.waiting == NULL && !before.only_inputs && typed[0] == '-') {
        offer_options(spec->options, typed);
        offer_options(options_of_all, typed);
        completion_offer("", typed, "--help", "", "Give this help list");
        completion_offer("", typed, "--version", "", "Print the version");
        return;
    } else if (before.waiting == NULL) {
        /* Names are for the first argument only. */
        Option input = spec->input;
        if (before.inputs > 0) input.names = NULL;
        value.option = &input;
        if (before.inputs < spec->inputs.most && (input.names == NULL || before.inputs == 0))
            completion_print_value(&value);
        return;
    }
    completion_print_value(&value);
}

static void complete_command(const char *typed, bool is_first) {
    for (const Command *command = commands; command->name != NULL; command++)
        if (command->summary != NULL) completion_offer("", typed, command->name, "", command->summary);
    if (!is_first) return;
    completion_offer("", typed, "help", "", "print the help of a command");
    if (typed[0] != '-') return;
    completion_offer("", typed, "--help", "", "list the commands");
    completion_offer("", typed, "--version", "", "print the version");
}

void completion_print(const CompletionWords *words) {
    if (words->count == 0 || strlen(words->words[words->count - 1]) >= COMPLETION_WORD_SIZE) return;
    const bool help = words->count == 2 && strcmp(words->words[0], "help") == 0;
    if (words->count == 1 || help) {
        complete_command(words->words[words->count - 1], !help);
        return;
    }
    for (const Command *command = commands; command->name != NULL; command++) {
        if (strcmp(command->name, words->words[0]) != 0) continue;
        CompletionWords rest = {words->count - 1, words->words + 1};
        options_visit_next(complete, &rest);
        command->run(0, NULL, &(Error){0});
        return;
    }
}
