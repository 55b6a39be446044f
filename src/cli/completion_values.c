/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values of options. What a value may be is read from its row: names, the name of the value ("FILE.csv", "on|off",
   "SCENE"), and the endings in the help ("Figure to write: .png, .svg or .pdf"). */
#include "cli/completion.h"
#include "cli/installed.h"
#include "common/text_add.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static bool has(const char *text, const char *piece) { return strstr(text, piece) != NULL; }

/* One of the names; with `list`, further ones separated by commas. */
static void offer_names(const CompletionValue *value, const char *const *names, bool list) {
    const char *comma = list ? strrchr(value->typed, ',') : NULL;
    const char *typed = comma != NULL ? comma + 1 : value->typed;
    char begin[COMPLETION_WORD_SIZE] = "";
    text_add(begin, sizeof begin, "%s%.*s", value->begin, (int)(typed - value->typed), value->typed);
    for (int i = 0; names[i] != NULL; i++) completion_offer(begin, typed, names[i], "", "");
}

/* "fast|small", but not "N|FILE.csv": words in lower case. */
static void offer_alternatives(const CompletionValue *value, const char *text) {
    while (*text != '\0') {
        const size_t length = strcspn(text, "|");
        char word[64];
        bool lower = length > 0 && length < sizeof word;
        for (size_t i = 0; i < length; i++) lower = lower && islower((unsigned char)text[i]);
        if (lower) {
            snprintf(word, sizeof word, "%.*s", (int)length, text);
            completion_offer(value->begin, value->typed, word, "", "");
        }
        text += length + (text[length] == '|');
    }
}

static void offer_parameters(const CompletionValue *value) {
    if (value->scene == NULL || strchr(value->typed, '=') != NULL) return;
    Scene *scene = scene_read(installed_path(value->scene), &(Error){0});
    for (int i = 0; scene != NULL && i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        char range[128];
        snprintf(range, sizeof range, "%g to %g%s%s (the scene's: %g)", parameter->from, parameter->to,
                 parameter->unit[0] != '\0' ? " " : "", parameter->unit, parameter->value);
        completion_offer(value->begin, value->typed, parameter->name, value->option->read == option_set ? "=" : "",
                         range);
    }
    scene_destroy(scene);
}

/* The endings of files in a text, separated by spaces, without the dot. */
static void find_endings(const char *text, char endings[64]) {
    static const char *const known[] = {"npz", "csv", "yaml", "png", "svg", "pdf", "json", "mp4", "webm", "gif", "xml"};
    endings[0] = '\0';
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const size_t length = strlen(known[i]);
        for (const char *dot = strchr(text, '.'); dot != NULL; dot = strchr(dot + 1, '.')) {
            if (strncmp(dot + 1, known[i], length) != 0 || isalnum((unsigned char)dot[1 + length])) continue;
            snprintf(endings + strlen(endings), 64 - strlen(endings), "%s%s", endings[0] != '\0' ? " " : "", known[i]);
            break;
        }
    }
}

/* Paths only where one is being typed: there are as many as names. */
static void offer_scene(const char *scene, void *context) {
    const CompletionValue *value = context;
    if (strchr(scene, '/') == NULL || strchr(value->typed, '/') != NULL)
        completion_offer(value->begin, value->typed, scene, "", "scene");
}

/* Files that an option takes, by the name of its value. */
static void offer_files(const CompletionValue *value) {
    const Option *option = value->option;
    const char *name = option->value, *help = option->help != NULL ? option->help : "";
    char endings[64], named[64];
    if (has(name, "DIR")) {
        completion_offer_folders(value->begin);
        return;
    }
    find_endings(name, named);
    snprintf(endings, sizeof endings, "%s", named);
    if (endings[0] == '\0') find_endings(help, endings);
    if (has(named, "yaml")) { /* a scene that is written */
        completion_offer_files(value->begin, named);
    } else if (has(name, "SCENE")) {
        text_add(named, sizeof named, "%syaml%s", named[0] != '\0' ? " " : "", has(name, "RUN") ? " npz" : "");
        completion_offer_files(value->begin, named);
        installed_scenes(offer_scene, (void *)value);
    } else if (endings[0] == '\0' && has(name, "RUN"))
        completion_offer_files(value->begin, "npz");
    else if (named[0] != '\0' || has(name, "RUN") || has(name, "FILE") || option->name == NULL)
        completion_offer_files(value->begin, endings);
}

void completion_print_value(const CompletionValue *value) {
    const Option *option = value->option;
    if (option->value == NULL) return;
    if (option->read == option_set || (option->name != NULL && strcmp(option->name, "--vary") == 0))
        offer_parameters(value);
    else if (option->names != NULL)
        offer_names(value, option->names, option->read == option_flags);
    else if (has(option->value, "KEY=VALUE") || (option->name != NULL && strcmp(option->name, "--methods") == 0))
        completion_print_methods(value->begin, value->typed, !has(option->value, "KEY=VALUE"));
    else {
        offer_alternatives(value, option->value);
        offer_files(value);
    }
}
