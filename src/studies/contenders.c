/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The methods of a study, from the words of the command line or the registry. */
#include "base/base.h"
#include "methods/methods.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static MethodRuns default_runs(const MethodDescription *method, ContenderStudy study) {
    static const char *const one_run[] = {"", NULL};
    const MethodRuns runs = study == STUDY_CHART         ? method->chart
                            : study == STUDY_CHART_QUICK ? method->chart_quick
                                                         : method->stability;
    return runs != NULL ? runs : one_run;
}

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

static bool add_runs(ContenderList *list, const char *name, MethodRuns runs, Error *error) {
    for (; *runs != NULL; runs++)
        if (!add(list, name, *runs, error)) return false;
    return true;
}

/* Ends the first word of the list, at a comma that no setting follows. Returns the next word, or NULL. */
static char *split(char *text) {
    for (char *comma = strchr(text, ','); comma != NULL; comma = strchr(comma + 1, ',')) {
        size_t word = strcspn(comma + 1, ",:=");
        if (comma[1 + word] == '=') continue;
        *comma = '\0';
        return comma + 1;
    }
    return NULL;
}

static int place_of(const MethodDescription *method, ContenderStudy study) {
    return study == STUDY_STABILITY ? method->stability_place : 0;
}

/* Methods with a place in their order, then the others in the order of the registry. */
static bool add_all(ContenderList *list, ContenderStudy study, Error *error) {
    int last = 0;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
        if (place_of(kind->description, study) > last) last = place_of(kind->description, study);
    for (int place = 1; place <= last + 1; place++)
        for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
            const MethodDescription *method = kind->description;
            if (place_of(method, study) != place % (last + 1)) continue;
            if (!add_runs(list, method->name, default_runs(method, study), error)) return false;
        }
    return true;
}

static bool add_words(ContenderList *list, const char *text, ContenderStudy study, Error *error) {
    char *copy = strdup(text), *word = copy;
    bool ok = copy != NULL || error_memory(error, "contenders");
    while (ok && word != NULL) {
        char *next = split(word), *colon = strchr(word, ':');
        const MethodDescription *method = method_describe(word);
        const MethodRuns runs = method != NULL ? default_runs(method, study) : NULL;
        if (colon != NULL && colon[1] == '\0')
            ok = method_parse(&(Method){0}, word, error); /* refused */
        else if (colon != NULL) {
            *colon = '\0';
            ok = add(list, word, colon + 1, error);
        } else if (study == STUDY_STABILITY || runs == NULL || *runs == NULL)
            ok = add(list, word, "", error);
        else /* a name without settings: the default runs of a chart */
            ok = add_runs(list, word, runs, error);
        word = next;
    }
    free(copy);
    return ok;
}

bool contenders_parse(ContenderList *list, const char *text, ContenderStudy study, Error *error) {
    *list = (ContenderList){0};
    if (text != NULL ? add_words(list, text, study, error) : add_all(list, study, error)) return true;
    contenders_free(list);
    return false;
}

void contenders_free(ContenderList *list) {
    free(list->items);
    *list = (ContenderList){0};
}

bool contenders_add_to_key(const ContenderList *list, StudyKey *key, Error *error) {
    for (int i = 0; i < list->count; i++) {
        const Method *method = &list->items[i].method;
        char program[SETTING_VALUE_SIZE], *rest = program;
        struct stat file;
        if (!method->kind->description->external) continue;
        snprintf(program, sizeof program, "%s", settings_get(&method->settings, "program"));
        for (char *word; (word = strtok_r(rest, " ", &rest)) != NULL;)
            if (stat(word, &file) == 0 && S_ISREG(file.st_mode) && !study_key_add_file(key, word, error)) return false;
    }
    return true;
}

NameList contenders_left_out(ContenderStudy study) {
    NameList names = {0};
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
        if (*default_runs(kind->description, study) == NULL) name_list_add(&names, kind->description->name);
    return names;
}

int contenders_for(const ContenderList *list, const Scene *scene, const Contender **fit) {
    int count = 0;
    for (int i = 0; i < list->count; i++)
        if (!method_lacks_network(&list->items[i].method, scene)) fit[count++] = &list->items[i];
    return count;
}

NameList contenders_without_network(const ContenderList *list, const Scene *scene) {
    NameList names = {0};
    for (int i = 0; i < list->count; i++)
        if (method_lacks_network(&list->items[i].method, scene)) name_list_add(&names, list->items[i].name);
    return names;
}
