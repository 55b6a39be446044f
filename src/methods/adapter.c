/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Programs of others: the pool of those that run, their hello, what they have said of themselves. */
#define _GNU_SOURCE
#include "methods/adapter.h"

#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "methods/programs.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { VERSION = 1, WORDS_MAX = 32, HELLO_MAX = 4096 };

/* A program that was started, and what it has said of itself. */
typedef struct Note {
    struct Note *next;
    char key[ADAPTER_KEY_SIZE];
    ProgramName name;
} Note;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static Adapter *pool;        /* programs that wait for work */
static Note *notes;          /* of all programs that were started */
static pid_t owner;          /* a fork's end is not that of the pool */
static const char **allowed; /* [allowed_count] values of options */
static size_t allowed_count, allowed_capacity;

void programs_allow(const char *methods) {
    /* Without memory the program is not started. */
    if (array_reserve((void **)&allowed, &allowed_capacity, allowed_count + 1, sizeof *allowed))
        allowed[allowed_count++] = methods;
}

static char first_failure[TALK_WHY_SIZE];

void program_failed(const char *text) {
    pthread_mutex_lock(&lock);
    if (first_failure[0] == '\0') snprintf(first_failure, sizeof first_failure, "%s", text);
    pthread_mutex_unlock(&lock);
}

const char *programs_failure(void) { return first_failure[0] != '\0' ? first_failure : NULL; }

static Note *find_note(const char *key) {
    Note *note = notes;
    while (note != NULL && strcmp(note->key, key) != 0) note = note->next;
    return note;
}

static bool is_passed(const MethodDescription *method, const Setting *setting) {
    return strcmp(setting->key, "program") != 0 && !settings_known(method->settings, setting->key);
}

/* The method, the program and the settings that it gets: what it does depends on nothing else. */
static void make_key(char key[ADAPTER_KEY_SIZE], const MethodDescription *method, const Settings *settings) {
    snprintf(key, ADAPTER_KEY_SIZE, "%s:%s", method->name, settings_get(settings, "program"));
    for (int i = 0; i < settings->count; i++)
        if (is_passed(method, &settings->items[i]))
            text_add(key, ADAPTER_KEY_SIZE, ",%s=%s", settings->items[i].key, settings->items[i].value);
}

bool method_program(const Method *method, ProgramName *name) {
    char key[ADAPTER_KEY_SIZE];
    if (!method->kind->description->external) return false;
    make_key(key, method->kind->description, &method->settings);
    pthread_mutex_lock(&lock);
    const Note *note = find_note(key);
    if (note != NULL) *name = note->name;
    pthread_mutex_unlock(&lock);
    return note != NULL;
}

/* Processes. */

void adapter_end(Adapter *adapter) {
    if (adapter == NULL) return;
    talk_end(&adapter->talk);
    free(adapter->numbers);
    free(adapter->request);
    free(adapter);
}

static void end_all(void) {
    if (getpid() != owner) return;
    while (pool != NULL) {
        Adapter *adapter = pool;
        pool = adapter->next;
        adapter_end(adapter);
    }
    while (notes != NULL) {
        Note *note = notes;
        notes = note->next;
        free(note);
    }
}

void adapter_give(Adapter *adapter) {
    if (adapter == NULL) return;
    if (adapter->left > 0 || !talk_is_quiet(&adapter->talk)) {
        adapter_end(adapter);
        return;
    }
    pthread_mutex_lock(&lock);
    adapter->next = pool;
    pool = adapter;
    pthread_mutex_unlock(&lock);
}

/* Who is greeted. */
typedef struct Greeting {
    const MethodDescription *method;
    const Settings *settings;
} Greeting;

static void print_hello(FILE *out, const void *context) {
    const Greeting *greeting = context;
    const Settings *settings = greeting->settings;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_ONE_LINE);
    json_put_int(&json, "twinbox", VERSION);
    json_begin_object(&json, "settings", JSON_ONE_LINE);
    for (int i = 0; i < settings->count; i++)
        if (is_passed(greeting->method, &settings->items[i]))
            json_put_text(&json, settings->items[i].key, settings->items[i].value);
    json_end(&json);
    json_end(&json);
}

static bool read_hello(Adapter *adapter, const MethodDescription *method, const char *line) {
    char key[32], form[16] = "", answers[16] = "", message[TALK_WHY_SIZE - 8] = "";
    ProgramName program = {"", ""};
    double number = 0;
    const char *at = line;
    for (bool first = true; line_take_key(&at, first, key, sizeof key); first = false)
        if (strcmp(key, "twinbox") == 0 ? number != 0 || !line_take_number(&at, &number)
            : strcmp(key, "name") == 0
                ? program.name[0] != '\0' || !line_take_text(&at, program.name, sizeof program.name, false)
            : strcmp(key, "version") == 0
                ? program.version[0] != '\0' || !line_take_text(&at, program.version, sizeof program.version, false)
            : strcmp(key, "form") == 0    ? form[0] != '\0' || !line_take_text(&at, form, sizeof form, false)
            : strcmp(key, "answers") == 0 ? answers[0] != '\0' || !line_take_text(&at, answers, sizeof answers, false)
            : strcmp(key, "error") == 0   ? message[0] != '\0' || !line_take_text(&at, message, sizeof message, true)
                                          : true)
            return adapter_not_understood(adapter, "its first line", line);
    if (!line_take_end(&at)) return adapter_not_understood(adapter, "its first line", line);
    if (message[0] != '\0') return adapter_failed(adapter, "says: %s", message);
    if (number != VERSION)
        return adapter_failed(adapter, "speaks version %g of the protocol; expected version %d", number, VERSION);
    if (!text_is_utf8(program.name) || !text_is_utf8(program.version))
        return adapter_failed(adapter, "has a name or version that is not UTF-8: '%.60s'", line);
    if (program.name[0] == '\0' || program.version[0] == '\0' || control_in_text(program.name) != 0 ||
        control_in_text(program.version) != 0)
        return adapter_failed(adapter, "does not say its name and version: '%.60s'", line);
    adapter->binary = strcmp(form, "binary") == 0;
    if (!adapter->binary && form[0] != '\0' && strcmp(form, "json") != 0)
        return adapter_failed(adapter, "wants the form '%s'; known: json, binary", form);
    const bool states = answers[0] == '\0' || strcmp(answers, "states") == 0;
    if (!states && strcmp(answers, "impulses") != 0)
        return adapter_failed(adapter, "answers '%s'; known: states, impulses", answers);
    if (!states && adapter->binary) return adapter_failed(adapter, "wants the form 'binary'; impulses have: json");
    if (states != method->whole_scenes)
        return adapter_failed(adapter, "answers %s, which '%s:PROGRAM' takes", states ? "states" : "impulses",
                              states ? "exec" : "exec-solver");
    pthread_mutex_lock(&lock);
    Note *note = find_note(adapter->key);
    if (note == NULL && (note = calloc(1, sizeof *note)) != NULL) {
        snprintf(note->key, sizeof note->key, "%s", adapter->key);
        note->next = notes;
        notes = note;
    }
    if (note != NULL) note->name = program;
    pthread_mutex_unlock(&lock);
    return true;
}

static bool greet(Adapter *adapter, const Greeting *greeting, double until) {
    size_t size;
    char *hello = file_print(print_hello, greeting, &size);
    if (hello == NULL) return adapter_failed(adapter, "cannot be asked: out of memory");
    const bool sent = talk_send(&adapter->talk, hello, size, until);
    free(hello);
    const char *line = sent ? talk_line(&adapter->talk, HELLO_MAX, until) : NULL;
    return line != NULL ? read_hello(adapter, greeting->method, line)
                        : adapter_failed(adapter, "%s", adapter->talk.why);
}

Adapter *adapter_take(const MethodDescription *method, const Settings *settings, double seconds, char why[],
                      size_t size) {
    char key[ADAPTER_KEY_SIZE], program[SETTING_VALUE_SIZE], named[ADAPTER_KEY_SIZE];
    make_key(key, method, settings);
    snprintf(program, sizeof program, "%s", settings_get(settings, "program"));
    /* Alone or in a list of an option. */
    const size_t length = (size_t)snprintf(named, sizeof named, "%s:%s", method->name, program);
    bool is_allowed = false;
    for (size_t i = 0; i < allowed_count; i++)
        for (const char *at = strstr(allowed[i], named); at != NULL; at = strstr(at + 1, named))
            is_allowed |=
                (at == allowed[i] || at[-1] == ',') && (at[length] == '\0' || strchr(",:", at[length]) != NULL);
    if (!is_allowed) {
        snprintf(why, size, "is not started, as the command line does not name it: only a file does");
        return NULL;
    }
    /* One that runs already. */
    for (;;) {
        pthread_mutex_lock(&lock);
        if (owner == 0) atexit(end_all);
        owner = getpid();
        Adapter **at = &pool;
        while (*at != NULL && strcmp((*at)->key, key) != 0) at = &(*at)->next;
        Adapter *adapter = *at;
        if (adapter != NULL) *at = adapter->next;
        pthread_mutex_unlock(&lock);
        if (adapter == NULL) break;
        if (talk_is_quiet(&adapter->talk)) return adapter;
        adapter_end(adapter);
    }
    /* A new one; argv: its words. */
    const char *argv[WORDS_MAX + 1];
    int words = 0;
    char *rest = program;
    for (char *word; words <= WORDS_MAX && (word = strtok_r(rest, " ", &rest)) != NULL;) argv[words++] = word;
    Adapter *adapter = calloc(1, sizeof *adapter);
    if (adapter == NULL || words == 0 || words > WORDS_MAX) {
        snprintf(why, size, adapter == NULL ? "out of memory" : "has no words, or more than %d", WORDS_MAX);
        free(adapter);
        return NULL;
    }
    argv[words] = NULL;
    snprintf(adapter->key, sizeof adapter->key, "%s", key);
    if (!talk_start(&adapter->talk, argv)) {
        snprintf(why, size, "%s", adapter->talk.why);
        free(adapter);
        return NULL;
    }
    if (greet(adapter, &(Greeting){method, settings}, clock_seconds() + seconds)) return adapter;
    snprintf(why, size, "%s", adapter->why);
    adapter_end(adapter);
    return NULL;
}
