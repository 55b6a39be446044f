/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/train/train.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

int train_find_option(const TrainKind *kind, const char *name) {
    for (int i = 0; kind->options[i].name != NULL; i++)
        if (strcmp(kind->options[i].name, name) == 0) return i;
    return -1;
}

bool train_read(const TrainRequest *request, void *options, Error *error) {
    for (int i = 0; request->kind->options[i].name != NULL; i++) {
        const Option *option = &request->kind->options[i];
        if (request->values[i] == NULL) continue;
        if (!option->read(option, request->values[i], (char *)options + option->at, error)) return false;
    }
    return true;
}

void train_set(TrainRequest *request, const char *option, const char *value) {
    const int i = train_find_option(request->kind, option);
    assert(i >= 0);
    request->values[i] = value;
}

static void append(char *command, size_t size, const char *before, const char *text) {
    const size_t used = strlen(command);
    snprintf(command + used, size - used, "%s%s", before, text);
}

void train_describe(const TrainRequest *request, char *command, size_t size) {
    snprintf(command, size, "twinbox train");
    if (request->kind != train_kinds[0]) append(command, size, " --kind ", request->kind->name);
    if (request->input != NULL) append(command, size, " ", request->input);
    append(command, size, " -o ", request->output);
    for (int i = 0; request->kind->options[i].name != NULL; i++) {
        const Option *option = &request->kind->options[i];
        if (request->values[i] == NULL) continue;
        append(command, size, " ", option->name);
        /* A value that begins with '-' would be taken for an option. */
        const bool negative = option->standard != NULL && option->standard[0] == '-';
        if (option->value != NULL) append(command, size, negative ? "=" : " ", request->values[i]);
    }
}
