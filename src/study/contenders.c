/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/contenders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the study has for each method. */
typedef struct Entry {
    const char *name;
    const char *settings, *quick; /* separated by spaces; NULL: the method without settings */
} Entry;

static const Entry entries[] = {
    {"engine", "k=1 k=2 k=4 k=7 k=10 k=20 k=50 k=100", "k=4 k=10 k=50"},
    {"engine", "k=4,warm=off k=10,warm=off k=20,warm=off k=50,warm=off k=100,warm=off", "k=10,warm=off"},
    {"over-relaxation", "k=5 k=10 k=20 k=50 k=100", "k=10"},
    {"momentum", "k=5 k=10 k=20 k=50 k=100", "k=10 k=20"},
    {"learned-momentum", "k=5 k=10 k=20 k=50", "k=10 k=20"},
    {"block", "k=5 k=10 k=20 k=50 k=100", "k=10"},
    {"nncg", "k=5 k=10 k=20 k=50 k=100", "k=20"},
    {"robust", "k=5 k=10 k=20 k=50 k=100", "k=10"},
    {"substepping", "substeps=2 substeps=4 substeps=10 substeps=20 substeps=50", "substeps=10"},
    {"pair-net", NULL, NULL},
    {"contact-net", NULL, NULL},
    {"scene-net", NULL, NULL},
    {"scene-net", "near=3 near=0.5 near=0.1", ""},
    {"constant", NULL, NULL},
    {"playback", "launches=25 launches=100", "launches=25"},
    {"reference", NULL, NULL}};

enum { ENTRIES = sizeof entries / sizeof entries[0] };

static bool add(ContenderList *list, const char *name, const char *setting, Error *error) {
    Contender contender;
    char text[CHART_NAME_SIZE + CHART_SETTING_SIZE + 1];
    if (strlen(name) >= sizeof contender.name || strlen(setting) >= sizeof contender.setting)
        return error_input(error, name, "the method's text is too long");
    strcpy(contender.name, name);
    strcpy(contender.setting, setting);
    snprintf(text, sizeof text, "%s%s%s", name, setting[0] != '\0' ? ":" : "", setting);
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->items[i].name, name) == 0 && strcmp(list->items[i].setting, setting) == 0)
            return error_input(error, text, "is given twice");
    if (!method_parse(&contender.method, text, error)) return false;
    Contender *grown = realloc(list->items, (size_t)(list->count + 1) * sizeof *grown);
    if (grown == NULL) return error_memory(error, "contenders");
    list->items = grown;
    list->items[list->count++] = contender;
    return true;
}

static bool add_entry(ContenderList *list, const Entry *entry, bool quick, Error *error) {
    const char *settings = quick ? entry->quick : entry->settings;
    if (settings == NULL) return add(list, entry->name, "", error);
    while (*settings != '\0') {
        char setting[CHART_SETTING_SIZE];
        size_t length = strcspn(settings, " ");
        snprintf(setting, sizeof setting, "%.*s", (int)length, settings);
        if (!add(list, entry->name, setting, error)) return false;
        settings += length + strspn(settings + length, " ");
    }
    return true;
}

/* One method of the list with its own settings. */
static bool add_as_given(ContenderList *list, char *word, Error *error) {
    char *colon = strchr(word, ':');
    if (colon == NULL) return add(list, word, "", error);
    *colon = '\0';
    return add(list, word, colon + 1, error);
}

/* The same, or with all that the study has. */
static bool add_word(ContenderList *list, char *word, bool quick, Error *error) {
    bool known = false;
    if (strchr(word, ':') != NULL) return add_as_given(list, word, error);
    for (int i = 0; i < ENTRIES; i++) {
        if (strcmp(entries[i].name, word) != 0) continue;
        if (!add_entry(list, &entries[i], quick, error)) return false;
        known = true;
    }
    return known || add(list, word, "", error);
}

/* Ends the first word of the list: a comma separates methods, unless a setting follows it. Returns the next or NULL. */
static char *split(char *text) {
    for (char *comma = strchr(text, ','); comma != NULL; comma = strchr(comma + 1, ',')) {
        size_t word = strcspn(comma + 1, ",:=");
        if (comma[1 + word] == '=') continue;
        *comma = '\0';
        return comma + 1;
    }
    return NULL;
}

static bool add_all(ContenderList *list, bool quick, Error *error) {
    for (int i = 0; i < ENTRIES; i++)
        if (!add_entry(list, &entries[i], quick, error)) return false;
    return true;
}

typedef enum Names { NAMES_AS_GIVEN, NAMES_WHOLE, NAMES_QUICK } Names;

/* What a name alone stands for is said by `names`. Of a list that is refused nothing is left. */
static bool add_words(ContenderList *list, const char *text, Names names, Error *error) {
    char *copy = strdup(text), *word = copy;
    bool ok = copy != NULL || error_memory(error, "contenders");
    while (ok && word != NULL) {
        char *next = split(word);
        ok = names == NAMES_AS_GIVEN ? add_as_given(list, word, error)
                                     : add_word(list, word, names == NAMES_QUICK, error);
        word = next;
    }
    free(copy);
    if (!ok) contenders_free(list);
    return ok;
}

bool contenders_parse(ContenderList *list, const char *text, bool quick, Error *error) {
    *list = (ContenderList){0};
    if (text != NULL) return add_words(list, text, quick ? NAMES_QUICK : NAMES_WHOLE, error);
    if (add_all(list, quick, error)) return true;
    contenders_free(list);
    return false;
}

bool contenders_read(ContenderList *list, const char *text, Error *error) {
    *list = (ContenderList){0};
    return add_words(list, text, NAMES_AS_GIVEN, error);
}

void contenders_free(ContenderList *list) {
    free(list->items);
    *list = (ContenderList){0};
}

int contenders_for(const ContenderList *list, const Scene *scene, const Contender **fit) {
    int count = 0;
    for (int i = 0; i < list->count; i++)
        if (!method_lacks_network(&list->items[i].method, scene)) fit[count++] = &list->items[i];
    return count;
}
