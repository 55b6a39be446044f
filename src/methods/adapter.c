/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Programs that step scenes: the pool of those that run, the protocol in its two forms, what they have said of themselves. */
#define _GNU_SOURCE
#include "methods/adapter.h"

#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "methods/methods.h"

#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { VERSION = 1, WORDS_MAX = 32, HELLO_MAX = 4096, KEY_SIZE = 2 * METHOD_TEXT_SIZE, NUMBER_MAX = 32 };

/* A body in a request: static, width, height, x, y, angle, vx, vy, omega, mass, friction. */
enum { BODY_NUMBERS = 11 };

/* Of the binary form, little-endian. */
typedef struct RequestHead {
    uint32_t scene, frame, steps, added, removed, iterations;
    float gravity[2], dt;
} RequestHead;

typedef struct FrameHead {
    uint32_t scene, frame, bodies, zero;
    uint64_t ns;
} FrameHead;

_Static_assert(sizeof(RequestHead) == 36 && sizeof(FrameHead) == 24, "no padding");

/* A program that was started, and what it has said of itself. */
typedef struct Note {
    struct Note *next;
    char key[KEY_SIZE];
    ProgramName name;
} Note;

struct Adapter {
    Adapter *next; /* in the pool */
    Talk talk;
    char key[KEY_SIZE];
    bool binary;
    uint32_t scene;          /* number of the scene, so that an answer to a former one is noticed */
    int bodies, frame, left; /* of the scene; the last frame read; frames that are still to be read */
    float *states;           /* [bodies, ADAPTER_NUMBERS] */
    char *request;           /* text of a request */
    size_t state_capacity, request_size, request_capacity;
    char why[TALK_WHY_SIZE];
};

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static Adapter *pool; /* programs that wait for work */
static Note *notes;   /* of all programs that were started */
static pid_t owner;   /* a fork's end is not that of the pool */
static int argument_count;
static char **arguments;

void programs_allow(int argc, char **argv) {
    argument_count = argc;
    arguments = argv;
}

static bool is_allowed(const char *program) {
    char text[KEY_SIZE];
    const size_t length = (size_t)snprintf(text, sizeof text, "exec:%s", program);
    for (int i = 0; i < argument_count; i++)
        for (const char *at = strstr(arguments[i], text); at != NULL; at = strstr(at + 1, text))
            if (at[length] == '\0' || strchr(",:", at[length]) != NULL) return true;
    return false;
}

static char first_failure[TALK_WHY_SIZE];

void program_failed(const char *text) {
    pthread_mutex_lock(&lock);
    if (first_failure[0] == '\0') snprintf(first_failure, sizeof first_failure, "%s", text);
    pthread_mutex_unlock(&lock);
}

const char *programs_failure(void) { return first_failure[0] != '\0' ? first_failure : NULL; }

static bool failed(Adapter *adapter, const char *format, ...) PRINTF_LIKE(2, 3);
static bool failed(Adapter *adapter, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(adapter->why, sizeof adapter->why, format, list);
    va_end(list);
    return false;
}

const char *adapter_why(const Adapter *adapter) { return adapter->why; }

int adapter_frames_left(const Adapter *adapter) { return adapter->left; }

/* JSON of one line, as far as answers have it. */

static void skip_space(const char **at) { *at += strspn(*at, " \t\r"); }

static bool take(const char **at, char c) {
    skip_space(at);
    if (**at != c) return false;
    ++*at;
    return true;
}

/* A text without escapes. */
static bool take_text(const char **at, char *text, size_t size) {
    if (!take(at, '"')) return false;
    const size_t length = strcspn(*at, "\"\\");
    if ((*at)[length] != '"' || length >= size) return false;
    memcpy(text, *at, length);
    text[length] = '\0';
    *at += length + 1;
    return true;
}

static bool take_number(const char **at, double *number) {
    char *end;
    skip_space(at);
    if (strchr("-0123456789", **at) == NULL || **at == '\0') return false;
    *number = strtod(*at, &end);
    const bool decimal = (size_t)(end - *at) <= strspn(*at, "+-.0123456789eE") && end > *at;
    *at = end;
    return decimal && isfinite(*number);
}

/* Begins with the "{" or the "," before a key, and ends behind its ":". False at the end of the object, and if there is no
   key. */
static bool take_key(const char **at, bool first, char *key, size_t size) {
    return take(at, first ? '{' : ',') && take_text(at, key, size) && take(at, ':');
}

static bool is_end(const char **at) {
    const bool end = take(at, '}');
    skip_space(at);
    return end && **at == '\0';
}

/* The start of an answer that is not understood, for messages. */
static bool not_understood(Adapter *adapter, const char *what, const char *line) {
    return failed(adapter, "%s is not as it should be: '%.60s%s'", what, line, strlen(line) > 60 ? "..." : "");
}

static Note *find_note(const char *key) {
    Note *note = notes;
    while (note != NULL && strcmp(note->key, key) != 0) note = note->next;
    return note;
}

/* The program and the settings that it gets: what it does depends on nothing else. */
static void make_key(char key[KEY_SIZE], const Settings *settings) {
    key[0] = '\0';
    for (int i = 0; i < settings->count; i++)
        if (i == 0 || !exec_reads_setting(settings->items[i].key))
            text_add(key, KEY_SIZE, "%s%s=%s", i > 0 ? "," : "", settings->items[i].key, settings->items[i].value);
}

bool method_program(const Method *method, ProgramName *name) {
    char key[KEY_SIZE];
    if (!method->kind->description->external) return false;
    make_key(key, &method->settings);
    pthread_mutex_lock(&lock);
    const Note *note = find_note(key);
    if (note != NULL) *name = note->name;
    pthread_mutex_unlock(&lock);
    return note != NULL;
}

static void keep_note(const char *key, const ProgramName *name) {
    pthread_mutex_lock(&lock);
    Note *note = find_note(key);
    if (note == NULL && (note = calloc(1, sizeof *note)) != NULL) {
        snprintf(note->key, sizeof note->key, "%s", key);
        note->next = notes;
        notes = note;
    }
    if (note != NULL) note->name = *name;
    pthread_mutex_unlock(&lock);
}

/* Processes. */

void adapter_end(Adapter *adapter) {
    if (adapter == NULL) return;
    talk_end(&adapter->talk);
    free(adapter->states);
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

static Adapter *take_from_pool(const char *key) {
    pthread_mutex_lock(&lock);
    if (owner == 0) atexit(end_all);
    owner = getpid();
    Adapter **at = &pool;
    while (*at != NULL && strcmp((*at)->key, key) != 0) at = &(*at)->next;
    Adapter *adapter = *at;
    if (adapter != NULL) *at = adapter->next;
    pthread_mutex_unlock(&lock);
    return adapter;
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

static void print_hello(FILE *out, const void *context) {
    const Settings *settings = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_ONE_LINE);
    json_put_int(&json, "twinbox", VERSION);
    json_begin_object(&json, "settings", JSON_ONE_LINE);
    for (int i = 0; i < settings->count; i++)
        if (!exec_reads_setting(settings->items[i].key))
            json_put_text(&json, settings->items[i].key, settings->items[i].value);
    json_end(&json);
    json_end(&json);
}

static bool read_hello(Adapter *adapter, const char *line) {
    char key[32], form[16] = "json", message[200] = "";
    ProgramName program = {"", ""};
    double number = 0;
    const char *at = line;
    for (bool first = true; take_key(&at, first, key, sizeof key); first = false)
        if (strcmp(key, "twinbox") == 0   ? !take_number(&at, &number)
            : strcmp(key, "name") == 0    ? !take_text(&at, program.name, sizeof program.name)
            : strcmp(key, "version") == 0 ? !take_text(&at, program.version, sizeof program.version)
            : strcmp(key, "form") == 0    ? !take_text(&at, form, sizeof form)
            : strcmp(key, "error") == 0   ? !take_text(&at, message, sizeof message)
                                          : true)
            return not_understood(adapter, "its first line", line);
    if (!is_end(&at)) return not_understood(adapter, "its first line", line);
    if (message[0] != '\0') return failed(adapter, "says: %s", message);
    if (number != VERSION)
        return failed(adapter, "speaks version %g of the protocol; expected version %d", number, VERSION);
    if (program.name[0] == '\0' || program.version[0] == '\0' || control_in_text(program.name) != 0 ||
        control_in_text(program.version) != 0)
        return failed(adapter, "does not say its name and version: '%.60s'", line);
    adapter->binary = strcmp(form, "binary") == 0;
    if (!adapter->binary && strcmp(form, "json") != 0)
        return failed(adapter, "wants the form '%s'; known: json, binary", form);
    keep_note(adapter->key, &program);
    return true;
}

static bool greet(Adapter *adapter, const Settings *settings, double until) {
    size_t size;
    char *hello = file_print(print_hello, settings, &size);
    if (hello == NULL) return failed(adapter, "cannot be asked: out of memory");
    const bool sent = talk_send(&adapter->talk, hello, size, until);
    free(hello);
    const char *line = sent ? talk_line(&adapter->talk, HELLO_MAX, until) : NULL;
    return line != NULL ? read_hello(adapter, line) : failed(adapter, "%s", adapter->talk.why);
}

/* argv of the words, which are ended by NUL in *text. */
static bool split(char *text, const char *argv[WORDS_MAX + 1]) {
    int count = 0;
    char *rest = text;
    for (char *word; (word = strtok_r(rest, " ", &rest)) != NULL;) {
        if (count == WORDS_MAX) return false;
        argv[count++] = word;
    }
    argv[count] = NULL;
    return count > 0;
}

static Adapter *start(const Settings *settings, const char *key, double seconds, char why[], size_t size) {
    char program[SETTING_VALUE_SIZE];
    const char *argv[WORDS_MAX + 1];
    Adapter *adapter = calloc(1, sizeof *adapter);
    snprintf(program, sizeof program, "%s", settings_get(settings, "program"));
    if (adapter == NULL || !split(program, argv)) {
        snprintf(why, size, adapter == NULL ? "out of memory" : "has no words, or more than %d", WORDS_MAX);
        free(adapter);
        return NULL;
    }
    snprintf(adapter->key, sizeof adapter->key, "%s", key);
    if (!talk_start(&adapter->talk, argv)) {
        snprintf(why, size, "%s", adapter->talk.why);
        free(adapter);
        return NULL;
    }
    if (greet(adapter, settings, clock_seconds() + seconds)) return adapter;
    snprintf(why, size, "%s", adapter->why);
    adapter_end(adapter);
    return NULL;
}

Adapter *adapter_take(const Settings *settings, double seconds, char why[], size_t size) {
    char key[KEY_SIZE];
    make_key(key, settings);
    if (!is_allowed(settings_get(settings, "program"))) {
        snprintf(why, size, "is not started, as the command line does not name it: only a file does");
        return NULL;
    }
    for (Adapter *adapter; (adapter = take_from_pool(key)) != NULL; adapter_end(adapter))
        if (talk_is_quiet(&adapter->talk)) return adapter;
    return start(settings, key, seconds, why, size);
}

/* Requests. */

static bool put(Adapter *adapter, const char *format, ...) PRINTF_LIKE(2, 3);
static bool put(Adapter *adapter, const char *format, ...) {
    enum { MOST = 256 };
    va_list list;
    if (!array_reserve((void **)&adapter->request, &adapter->request_capacity, adapter->request_size + MOST, 1))
        return failed(adapter, "cannot be asked: out of memory");
    va_start(list, format);
    adapter->request_size += (size_t)vsnprintf(adapter->request + adapter->request_size, MOST, format, list);
    va_end(list);
    return true;
}

static bool put_bytes(Adapter *adapter, const void *bytes, size_t size) {
    if (!array_reserve((void **)&adapter->request, &adapter->request_capacity, adapter->request_size + size, 1))
        return failed(adapter, "cannot be asked: out of memory");
    memcpy(adapter->request + adapter->request_size, bytes, size);
    adapter->request_size += size;
    return true;
}

static void list_numbers(const BodyDef *body, float numbers[BODY_NUMBERS]) {
    const float all[BODY_NUMBERS] = {
        body->fixed ? 1 : 0, body->size.x,     body->size.y,     body->position.x,       body->position.y,
        body->angle,         body->velocity.x, body->velocity.y, body->angular_velocity, body->fixed ? 0 : body->mass,
        body->friction};
    memcpy(numbers, all, sizeof all);
}

static bool put_text_body(Adapter *adapter, const BodyDef *body, bool first) {
    float numbers[BODY_NUMBERS];
    list_numbers(body, numbers);
    for (int i = 0; i < BODY_NUMBERS; i++)
        if (!put(adapter, "%s%.9g", i > 0 ? ", " : first ? "[" : ", [", (double)numbers[i])) return false;
    return put(adapter, "]");
}

static bool put_text(Adapter *adapter, const AdapterRequest *request) {
    bool done = put(adapter, "{\"scene\": %u, \"frame\": %d, ", adapter->scene, request->frame);
    if (request->frame == 0)
        done = done &&
               put(adapter, "\"gravity\": [%.9g, %.9g], \"dt\": %.9g, \"iterations\": %d, ", (double)request->gravity.x,
                   (double)request->gravity.y, (double)request->dt, request->iterations);
    done = done && put(adapter, "\"remove\": %d, \"add\": [", request->removed);
    for (int i = 0; done && i < request->added; i++) done = put_text_body(adapter, &request->add[i], i == 0);
    return done && put(adapter, "], \"steps\": %d}\n", request->steps);
}

static bool put_binary(Adapter *adapter, const AdapterRequest *request) {
    const RequestHead head = {adapter->scene,
                              (uint32_t)request->frame,
                              (uint32_t)request->steps,
                              (uint32_t)request->added,
                              (uint32_t)request->removed,
                              (uint32_t)request->iterations,
                              {request->gravity.x, request->gravity.y},
                              request->dt};
    bool done = put_bytes(adapter, &head, sizeof head);
    for (int i = 0; done && i < request->added; i++) {
        float numbers[BODY_NUMBERS];
        list_numbers(&request->add[i], numbers);
        done = put_bytes(adapter, numbers, sizeof numbers);
    }
    return done;
}

/* With the C locale's decimal point. */
static bool put_request(Adapter *adapter, const AdapterRequest *request) {
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c == (locale_t)0) return failed(adapter, "cannot be asked: out of memory");
    locale_t before = uselocale(c);
    const bool done = adapter->binary ? put_binary(adapter, request) : put_text(adapter, request);
    uselocale(before);
    freelocale(c);
    return done;
}

bool adapter_ask(Adapter *adapter, const AdapterRequest *request, double until) {
    if (adapter->talk.begin < adapter->talk.end) return failed(adapter, "has written more than it was asked for");
    if (request->frame == 0) {
        adapter->scene++;
        adapter->bodies = 0;
    }
    adapter->bodies += request->added - request->removed;
    adapter->frame = request->frame;
    adapter->left = request->steps;
    adapter->request_size = 0;
    if (!array_reserve((void **)&adapter->states, &adapter->state_capacity,
                       (size_t)adapter->bodies * ADAPTER_NUMBERS + 1, sizeof *adapter->states))
        return failed(adapter, "cannot be asked: out of memory");
    if (!put_request(adapter, request)) return false;
    return talk_send(&adapter->talk, adapter->request, adapter->request_size, until) ||
           failed(adapter, "%s", adapter->talk.why);
}

/* Answers. */

static const char *const number_names[ADAPTER_NUMBERS] = {"x", "y", "angle", "vx", "vy", "omega"};

/* All that the array holds, which must be the states of all bodies. */
static bool take_states(Adapter *adapter, const char **at) {
    const int wanted = adapter->bodies * ADAPTER_NUMBERS;
    int count = 0;
    if (!take(at, '[')) return failed(adapter, "has not answered with an array of states");
    for (bool more = !take(at, ']'); more; count++) {
        double number;
        skip_space(at);
        const char *text = *at;
        if (!take_number(at, &number) || !isfinite((float)number))
            return failed(adapter, "body %d: its %s is no finite number: '%.*s'", count / ADAPTER_NUMBERS,
                          number_names[count % ADAPTER_NUMBERS], (int)strcspn(text, ",] "), text);
        if (count < wanted) adapter->states[count] = (float)number;
        more = take(at, ',');
        if (!more && !take(at, ']'))
            return failed(adapter, "body %d: no ',' or ']' behind its %s", count / ADAPTER_NUMBERS,
                          number_names[count % ADAPTER_NUMBERS]);
    }
    if (count == wanted) return true;
    return failed(adapter, "has answered with %d numbers; %d bodies have %d%s", count, adapter->bodies, wanted,
                  count == 2 * wanted ? " (is the decimal point a comma?)" : "");
}

static bool check_place(Adapter *adapter, double scene, double frame) {
    if (scene != adapter->scene)
        return failed(adapter, "has answered for scene %.9g; it is at scene %u", scene, adapter->scene);
    return frame == adapter->frame ||
           failed(adapter, "has answered with frame %.9g; frame %d was asked for", frame, adapter->frame);
}

static bool take_line(Adapter *adapter, const char *line, double *ns) {
    char key[32], message[200] = "";
    double scene = -1, frame = -1;
    bool states = false;
    const char *at = line;
    for (bool first = true; take_key(&at, first, key, sizeof key); first = false) {
        if (strcmp(key, "states") == 0) {
            if (states || !take_states(adapter, &at))
                return states ? not_understood(adapter, "its answer", line) : false;
            states = true;
        } else if (strcmp(key, "scene") == 0   ? !take_number(&at, &scene)
                   : strcmp(key, "frame") == 0 ? !take_number(&at, &frame)
                   : strcmp(key, "ns") == 0    ? !take_number(&at, ns)
                   : strcmp(key, "error") == 0 ? !take_text(&at, message, sizeof message)
                                               : true) {
            return not_understood(adapter, "its answer", line);
        }
    }
    if (message[0] != '\0') return failed(adapter, "says: %s", message);
    if (!is_end(&at) || !states) return not_understood(adapter, "its answer", line);
    return check_place(adapter, scene, frame);
}

static bool read_text(Adapter *adapter, int64_t *ns, double until) {
    double took = 0;
    const char *line = talk_line(&adapter->talk, 256 + NUMBER_MAX * ADAPTER_NUMBERS * (size_t)adapter->bodies, until);
    if (line == NULL) return failed(adapter, "%s", adapter->talk.why);
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c == (locale_t)0) return failed(adapter, "cannot be read: out of memory");
    locale_t before = uselocale(c);
    const bool done = take_line(adapter, line, &took);
    uselocale(before);
    freelocale(c);
    *ns = took > 0 && took < 1e18 ? (int64_t)took : 0;
    return done;
}

static bool read_binary(Adapter *adapter, int64_t *ns, double until) {
    FrameHead head;
    const char *bytes = talk_read(&adapter->talk, sizeof head, until);
    if (bytes == NULL) return failed(adapter, "%s", adapter->talk.why);
    memcpy(&head, bytes, sizeof head);
    if (!check_place(adapter, head.scene, head.frame)) return false;
    if (head.bodies != (uint32_t)adapter->bodies || head.zero != 0)
        return failed(adapter, "has answered with %u bodies; there are %d", head.bodies, adapter->bodies);
    const size_t count = (size_t)adapter->bodies * ADAPTER_NUMBERS;
    bytes = talk_read(&adapter->talk, count * sizeof(float), until);
    if (bytes == NULL) return failed(adapter, "%s", adapter->talk.why);
    if (count > 0) memcpy(adapter->states, bytes, count * sizeof(float));
    for (size_t i = 0; i < count; i++)
        if (!isfinite(adapter->states[i]))
            return failed(adapter, "body %zu: its %s is no finite number", i / ADAPTER_NUMBERS,
                          number_names[i % ADAPTER_NUMBERS]);
    *ns = head.ns < (uint64_t)1e18 ? (int64_t)head.ns : 0;
    return true;
}

bool adapter_read(Adapter *adapter, AdapterFrame *frame, double until) {
    adapter->frame++;
    *frame = (AdapterFrame){.states = adapter->states};
    if (!(adapter->binary ? read_binary : read_text)(adapter, &frame->ns, until)) return false;
    adapter->left--;
    return true;
}
