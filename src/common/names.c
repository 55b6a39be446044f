/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/names.h"

#include "common/nearest.h"

#include <stdio.h>
#include <string.h>

static bool has(const NameList *list, const char *name, size_t length) {
    for (const char *at = list->text; (at = strstr(at, name)) != NULL; at++) {
        bool begins = at == list->text || at[-1] == ' ', ends = at[length] == '\0' || at[length] == ',';
        if (begins && ends) return true;
    }
    return false;
}

void name_list_add(NameList *list, const char *name) {
    size_t length = strlen(name);
    if (length == 0 || list->used + length + 3 > sizeof list->text || has(list, name, length)) return;
    list->used += (size_t)snprintf(list->text + list->used, sizeof list->text - list->used, "%s%s",
                                   list->used > 0 ? ", " : "", name);
}

/* The listed name that is nearest; empty if none is near. */
static void find_nearest(const NameList *list, const char *name, char *nearest, size_t size) {
    enum { WORDS = 256 };
    char text[sizeof list->text], *rest = NULL;
    const char *words[WORDS];
    int count = 0;
    memcpy(text, list->text, sizeof text);
    for (char *word = strtok_r(text, ", ", &rest); word != NULL && count < WORDS; word = strtok_r(NULL, ", ", &rest))
        words[count++] = word;
    const char *found = nearest_word(name, words, count);
    snprintf(nearest, size, "%s", found != NULL ? found : "");
}

bool error_unknown(Error *error, const char *where, const char *name, const char *what, const NameList *known) {
    char nearest[64];
    find_nearest(known, name, nearest, sizeof nearest);
    if (nearest[0] != '\0')
        return error_input(error, where, "'%.64s' is not %s; did you mean '%s'?", name, what, nearest);
    return error_input(error, where, "'%.64s' is not %s; known: %s", name, what,
                       known->used > 0 ? known->text : "none");
}
