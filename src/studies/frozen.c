/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frozen protocol: the methods that are compared, and the steps of the engine that all of them solve. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/chart.h"

#include <assert.h>
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

/* A method with the settings that follow its name, if any. */
static bool add_as_given(ContenderList *list, char *word, Error *error) {
    char *colon = strchr(word, ':');
    if (colon == NULL) return add(list, word, "", error);
    if (colon[1] == '\0') return method_parse(&(Method){0}, word, error); /* refused */
    *colon = '\0';
    return add(list, word, colon + 1, error);
}

/* A name without settings: the default runs of a chart, or one run if there are none. */
static bool add_word(ContenderList *list, char *word, ContenderStudy study, Error *error) {
    const MethodDescription *method = method_describe(word);
    if (study == STUDY_STABILITY || strchr(word, ':') != NULL || method == NULL) return add_as_given(list, word, error);
    const MethodRuns runs = default_runs(method, study);
    return *runs != NULL ? add_runs(list, word, runs, error) : add(list, word, "", error);
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
        char *next = split(word);
        ok = add_word(list, word, study, error);
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

static void snapshot_free(Snapshot *snapshot) {
    world_destroy(snapshot->world);
    free(snapshot->reference);
    free(snapshot->no_push_out);
}

void snapshots_free(SnapshotList *list) {
    for (int i = 0; i < list->count; i++) snapshot_free(&list->items[i]);
    free(list->items);
    *list = (SnapshotList){0};
}

static World *empty_world(const Scene *scene, Error *error) {
    Scene empty = *scene;
    empty.body_count = 0;
    empty.bomb.present = false;
    return scene_world(&empty, error);
}

/* *velocities: a copy of the converged velocities of a step, or NULL if the solve has not converged. */
static bool converged_velocities(ConvergedStep *converged, const ContactProblem *problem, bool push_out,
                                 ReferenceVelocity **velocities, Error *error) {
    const size_t size = (size_t)problem->body_count * sizeof **velocities;
    if (!converged_step_solve(converged, problem, push_out, error)) return false;
    if (!converged_step_found(converged)) return true;
    *velocities = malloc(size + 1);
    if (*velocities == NULL) return error_memory(error, "study");
    if (size > 0) memcpy(*velocities, converged->reference.velocities, size);
    return true;
}

/* Stores the state before the step that led to `after`, and the step's converged velocities, if there are any. */
static bool store(SnapshotList *list, const Scene *scene, const World *before, const World *after, int frame,
                  Phase phase, ConvergedStep *converged, Error *error) {
    const ContactProblem *problem = world_problem(after);
    if (!array_reserve((void **)&list->items, &list->capacity, (size_t)list->count + 1, sizeof *list->items))
        return error_memory(error, "study");
    Snapshot *snapshot = &list->items[list->count];
    *snapshot = (Snapshot){.scene = scene, .frame = frame, .phase = phase};
    bool ok = converged_velocities(converged, problem, true, &snapshot->reference, error);
    if (ok && list->no_push_out) ok = converged_velocities(converged, problem, false, &snapshot->no_push_out, error);
    if (ok && (snapshot->reference == NULL || (list->no_push_out && snapshot->no_push_out == NULL))) {
        snapshot_free(snapshot);
        list->unconverged++;
        return true;
    }
    list->count++;
    if (ok) snapshot->world = empty_world(scene, error);
    return ok && snapshot->world != NULL && world_copy(snapshot->world, before, error);
}

typedef struct Sampler {
    Stepper *engine;
    World *world, *before;
    ConvergedStep converged;
} Sampler;

static bool sample(SnapshotList *list, Sampler *sampler, const Scene *launched, const Sampling *sampling,
                   Error *error) {
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    for (int frame = 1; frame <= launched->frames; frame++) {
        const Step step = {.scene = launched, .frame = frame};
        if (!world_copy(sampler->before, sampler->world, error) ||
            !simulate_step(sampler->engine, sampler->world, &step, error))
            return false;
        Phase phase = phase_next(&tracker, world_problem(sampler->world), frame);
        if (sampling_takes(sampling, phase, &tracker, frame) &&
            !store(list, launched, sampler->before, sampler->world, frame, phase, &sampler->converged, error))
            return false;
    }
    return true;
}

bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error) {
    Method engine;
    if (!method_parse(&engine, "engine", error)) return false;
    Sampler sampler = {.engine = stepper_create(&engine, launched, error),
                       .world = scene_world(launched, error),
                       .before = empty_world(launched, error)};
    bool ok = sampler.engine != NULL && sampler.world != NULL && sampler.before != NULL &&
              sample(list, &sampler, launched, sampling, error);
    stepper_destroy(sampler.engine);
    world_destroy(sampler.world);
    world_destroy(sampler.before);
    converged_step_free(&sampler.converged);
    return ok;
}

bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES],
                     Error *error) {
    const bool push_out = !stepper_describe(stepper)->no_push_out;
    assert(push_out || list->no_push_out);
    for (int i = 0; i < list->count; i++) {
        const Snapshot *snapshot = &list->items[i];
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame, .engine_step = true};
        Error failure = {0};
        if (!world_copy(world, snapshot->world, error)) return false;
        if (!stepper_step(stepper, world, &step, &failure)) {
            if (failure.failure == FAILURE_ADAPTER) return true; /* as in closed loop */
            *error = failure;
            return false;
        }
        if (!step_scores_add(&scores[snapshot->phase], snapshot->frame, world_problem(world), world_solution(world),
                             push_out ? snapshot->reference : snapshot->no_push_out, push_out))
            return error_memory(error, "study");
    }
    return true;
}
