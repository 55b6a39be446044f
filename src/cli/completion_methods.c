/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods and their settings, from the registry. */
#include "cli/completion.h"
#include "common/text_add.h"
#include "simulate/method.h"

#include <stdio.h>
#include <string.h>

/* A method's text up to the piece that is being typed: "chart:k=5,mo" has the begin "chart:k=5," and the piece "mo". */
typedef struct Piece {
    char begin[COMPLETION_WORD_SIZE];
    const char *text;
} Piece;

static Piece piece_behind(const char *begin, const char *typed, const char *text) {
    Piece piece = {.begin = "", .text = text};
    text_add(piece.begin, sizeof piece.begin, "%s%.*s", begin, (int)(text - typed), typed);
    return piece;
}

static void offer_value(const Piece *piece, const SettingSpec *settings) {
    const char *equals = strchr(piece->text, '=');
    const size_t length = (size_t)(equals - piece->text);
    const Piece value = piece_behind(piece->begin, piece->text, equals + 1);
    for (const SettingSpec *setting = settings; setting != NULL && setting->key != NULL; setting++) {
        if (strlen(setting->key) != length || strncmp(setting->key, piece->text, length) != 0) continue;
        if (strcmp(setting->key, "network") == 0) completion_offer_files(value.begin, "npz");
        if (strncmp(setting->summary, "on|off", strlen("on|off")) != 0) continue;
        completion_offer(value.begin, value.text, "on", "", setting->summary);
        completion_offer(value.begin, value.text, "off", "", setting->summary);
    }
}

static void offer_settings(const Piece *piece, const SettingSpec *settings) {
    if (strchr(piece->text, '=') != NULL) {
        offer_value(piece, settings);
        return;
    }
    for (const SettingSpec *setting = settings; setting != NULL && setting->key != NULL; setting++)
        completion_offer(piece->begin, piece->text, setting->key, "=", setting->summary);
}

/* A name; with its settings when it is complete. */
static void offer_names(const Piece *piece) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        completion_offer(piece->begin, piece->text, method->name, "", method->summary);
        if (strcmp(method->name, piece->text) != 0) continue;
        for (const SettingSpec *setting = method->settings; setting != NULL && setting->key != NULL; setting++) {
            char ending[64];
            snprintf(ending, sizeof ending, ":%s=", setting->key);
            completion_offer(piece->begin, piece->text, method->name, ending, setting->summary);
        }
    }
}

/* The first character of the last method of a list: behind the last comma, unless settings go on behind it. */
static const char *find_last(const char *typed) {
    const char *last = typed;
    for (const char *comma = strchr(typed, ','); comma != NULL; comma = strchr(comma + 1, ','))
        if (method_describe(comma + 1) != NULL) last = comma + 1;
    return last;
}

void completion_print_methods(const char *begin, const char *typed, bool list) {
    const char *method = list ? find_last(typed) : typed, *colon = strchr(method, ':'), *comma = strrchr(method, ',');
    const MethodDescription *known = method_describe(method);
    if (colon != NULL && known != NULL) {
        const Piece setting = piece_behind(begin, typed, comma != NULL ? comma + 1 : colon + 1);
        offer_settings(&setting, known->settings);
    }
    if (colon == NULL || (list && comma != NULL)) {
        const Piece name = piece_behind(begin, typed, list && comma != NULL ? comma + 1 : method);
        offer_names(&name);
    }
}
