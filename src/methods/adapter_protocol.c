/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The protocol of programs in its two forms: requests and answers. */
#define _GNU_SOURCE
#include "methods/adapter.h"

#include "base/base.h"

#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBER_MAX = 32 };

/* Numbers of a body in a request. For an engine: static, width, height, x, y, angle, vx, vy, omega, mass, friction. For
   a solver, and of a contact behind its two bodies: put_problem(). */
enum { BODY_NUMBERS = 11, PROBLEM_BODY_NUMBERS = 10, CONTACT_NUMBERS = 11 };

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

/* JSON of one line. */

static void skip_space(const char **at) { *at += strspn(*at, " \t\r"); }

static bool take(const char **at, char c) {
    skip_space(at);
    if (**at != c) return false;
    ++*at;
    return true;
}

/* The four digits of "\uXXXX". */
static bool take_unit(const char **at, uint32_t *unit) {
    *unit = 0;
    for (int i = 0; i < 4; i++, ++*at) {
        static const char digits[] = "0123456789abcdef";
        const char *digit = **at != '\0' ? strchr(digits, tolower((unsigned char)**at)) : NULL;
        if (digit == NULL) return false;
        *unit = *unit << 4 | (uint32_t)(digit - digits);
    }
    return true;
}

/* The character of an escape, behind its backslash. Not 0, which ends texts in C. */
static bool take_escape(const char **at, uint32_t *character) {
    static const char letters[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    const char letter = **at, *found = letter != '\0' ? strchr(letters, letter) : NULL;
    if (found != NULL) {
        *character = (unsigned char)meant[found - letters];
        ++*at;
        return true;
    }
    uint32_t low;
    if (letter != 'u' || (++*at, !take_unit(at, character)) || *character == 0) return false;
    if (*character < 0xd800 || *character > 0xdfff) return true;
    if (*character > 0xdbff || strncmp(*at, "\\u", 2) != 0) return false;
    *at += 2;
    if (!take_unit(at, &low) || low < 0xdc00 || low > 0xdfff) return false;
    *character = 0x10000 + ((*character - 0xd800) << 10) + (low - 0xdc00);
    return true;
}

bool line_take_text(const char **at, char *text, size_t size, bool cut) {
    size_t length = 0;
    bool full = false;
    if (!take(at, '"')) return false;
    for (; **at != '"';) {
        char bytes[4] = {**at};
        size_t count = 1;
        uint32_t character;
        if (*(*at)++ == '\0') return false;
        if (bytes[0] == '\\') {
            if (!take_escape(at, &character)) return false;
            count = utf8_put(bytes, character);
        }
        full = full || length + count >= size;
        if (full && !cut) return false;
        if (full) continue;
        memcpy(text + length, bytes, count);
        length += count;
    }
    text[length] = '\0';
    if (full) strcpy(text + utf8_cut(text, size - sizeof "..."), "...");
    ++*at;
    return true;
}

bool line_take_number(const char **at, double *number) {
    char *end;
    skip_space(at);
    if (strchr("-0123456789", **at) == NULL || **at == '\0') return false;
    *number = strtod(*at, &end);
    const bool decimal = (size_t)(end - *at) <= strspn(*at, "+-.0123456789eE") && end > *at;
    *at = end;
    return decimal && isfinite(*number);
}

bool line_take_key(const char **at, bool first, char *key, size_t size) {
    return take(at, first ? '{' : ',') && line_take_text(at, key, size, false) && take(at, ':');
}

bool line_take_end(const char **at) {
    const bool end = take(at, '}');
    skip_space(at);
    return end && **at == '\0';
}

bool adapter_failed(Adapter *adapter, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(adapter->why, sizeof adapter->why, format, list);
    va_end(list);
    return false;
}

bool adapter_not_understood(Adapter *adapter, const char *what, const char *line) {
    return adapter_failed(adapter, "%s is not as it should be: '%.60s%s'", what, line, strlen(line) > 60 ? "..." : "");
}

/* Requests. */

static bool put(Adapter *adapter, const char *format, ...) PRINTF_LIKE(2, 3);
static bool put(Adapter *adapter, const char *format, ...) {
    enum { MOST = 256 };
    va_list list;
    if (!array_reserve((void **)&adapter->request, &adapter->request_capacity, adapter->request_size + MOST, 1))
        return adapter_failed(adapter, "cannot be asked: out of memory");
    va_start(list, format);
    adapter->request_size += (size_t)vsnprintf(adapter->request + adapter->request_size, MOST, format, list);
    va_end(list);
    return true;
}

static bool put_bytes(Adapter *adapter, const void *bytes, size_t size) {
    if (!array_reserve((void **)&adapter->request, &adapter->request_capacity, adapter->request_size + size, 1))
        return adapter_failed(adapter, "cannot be asked: out of memory");
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

/* The numbers of an item of an array, behind its "[" and perhaps others. */
static bool put_numbers(Adapter *adapter, const float *numbers, int count, bool first) {
    for (int i = 0; i < count; i++)
        if (!put(adapter, "%s%.9g", i > 0 || !first ? ", " : "", (double)numbers[i])) return false;
    return put(adapter, "]");
}

static bool put_text(Adapter *adapter, const AdapterRequest *request) {
    bool done = put(adapter, "{\"scene\": %u, \"frame\": %d, ", adapter->scene, request->frame);
    if (request->frame == 0)
        done = done &&
               put(adapter, "\"gravity\": [%.9g, %.9g], \"dt\": %.9g, \"iterations\": %d, ", (double)request->gravity.x,
                   (double)request->gravity.y, (double)request->dt, request->iterations);
    done = done && put(adapter, "\"remove\": %d, \"add\": [", request->removed);
    for (int i = 0; done && i < request->added; i++) {
        float numbers[BODY_NUMBERS];
        list_numbers(&request->add[i], numbers);
        done = put(adapter, i == 0 ? "[" : ", [") && put_numbers(adapter, numbers, BODY_NUMBERS, true);
    }
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

static bool put_problem(Adapter *adapter, const ContactProblem *problem) {
    bool done = put(adapter, "{\"problem\": %u, \"dt\": %.9g, \"bodies\": [", adapter->scene, (double)problem->dt);
    for (int i = 0; done && i < problem->body_count; i++) {
        const ProblemBody *b = &problem->bodies[i];
        const float numbers[PROBLEM_BODY_NUMBERS] = {b->inv_mass,   b->inv_inertia,     b->size.x, b->size.y,
                                                     b->position.x, b->position.y,      b->angle,  b->velocity.x,
                                                     b->velocity.y, b->angular_velocity};
        done = put(adapter, i > 0 ? ", [" : "[") && put_numbers(adapter, numbers, PROBLEM_BODY_NUMBERS, true);
    }
    done = done && put(adapter, "], \"contacts\": [");
    for (int i = 0; done && i < problem->contact_count; i++) {
        const ContactPoint *c = &problem->contacts[i];
        const float numbers[CONTACT_NUMBERS] = {c->normal.x, c->normal.y,    c->arm_a.x,     c->arm_a.y,
                                                c->arm_b.x,  c->arm_b.y,     c->separation,  c->friction,
                                                c->bias,     c->warm_normal, c->warm_tangent};
        done = put(adapter, "%s[%d, %d", i > 0 ? ", " : "", c->a, c->b) &&
               put_numbers(adapter, numbers, CONTACT_NUMBERS, false);
    }
    return done && put(adapter, "]}\n");
}

bool adapter_ask(Adapter *adapter, const AdapterRequest *request, double until) {
    const ContactProblem *problem = request->problem;
    if (problem != NULL || request->frame == 0) {
        adapter->scene++;
        adapter->bodies = 0;
    }
    adapter->contacts = problem != NULL ? problem->contact_count : -1;
    adapter->bodies += request->added - request->removed;
    adapter->frame = request->frame;
    adapter->left = problem != NULL ? 1 : request->steps;
    const size_t answers =
        problem != NULL ? 2 * (size_t)problem->contact_count : (size_t)adapter->bodies * ADAPTER_NUMBERS;
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0); /* with its decimal point */
    if (c == (locale_t)0 ||
        !array_reserve((void **)&adapter->numbers, &adapter->number_capacity, answers + 1, sizeof *adapter->numbers)) {
        if (c != (locale_t)0) freelocale(c);
        return adapter_failed(adapter, "cannot be asked: out of memory");
    }
    locale_t before = uselocale(c);
    adapter->request_size = 0;
    const bool done = problem != NULL   ? put_problem(adapter, problem)
                      : adapter->binary ? put_binary(adapter, request)
                                        : put_text(adapter, request);
    uselocale(before);
    freelocale(c);
    if (!done) return false;
    if (adapter->talk.begin < adapter->talk.end)
        return adapter_failed(adapter, "has written more than it was asked for");
    return talk_send(&adapter->talk, adapter->request, adapter->request_size, until) ||
           adapter_failed(adapter, "%s", adapter->talk.why);
}

/* Answers. */

/* The array of an answer: so many numbers for each item. */
typedef struct AnswerForm {
    const char *key, *item, *items;
    int each;
    const char *names[ADAPTER_NUMBERS];
} AnswerForm;

static const AnswerForm states = {
    "states", "body", "bodies", ADAPTER_NUMBERS, {"x", "y", "angle", "vx", "vy", "omega"}};
static const AnswerForm impulses = {"impulses", "contact", "contacts", 2, {"normal impulse", "tangent impulse"}};

/* What an answer is for, and the time that it took; -1: not said. */
typedef struct Answer {
    double scene, frame, problem, ns;
} Answer;

/* All that the array holds, which must be the numbers of all items. */
static bool take_numbers(Adapter *adapter, const AnswerForm *form, int items, const char **at) {
    const int wanted = items * form->each;
    int count = 0;
    if (!take(at, '[')) return adapter_failed(adapter, "has not answered with an array of %s", form->key);
    for (bool more = !take(at, ']'); more; count++) {
        const char *name = form->names[count % form->each];
        double number;
        skip_space(at);
        const char *text = *at;
        if (!line_take_number(at, &number) || !isfinite((float)number))
            return adapter_failed(adapter, "%s %d: its %s is no finite number: '%.*s'", form->item, count / form->each,
                                  name, (int)strcspn(text, ",] "), text);
        if (count < wanted) adapter->numbers[count] = (float)number;
        more = take(at, ',');
        if (!more && !take(at, ']'))
            return adapter_failed(adapter, "%s %d: no ',' or ']' behind its %s", form->item, count / form->each, name);
    }
    if (count == wanted) return true;
    return adapter_failed(adapter, "has answered with %d numbers; %d %s have %d%s", count, items, form->items, wanted,
                          count == 2 * wanted ? " (is the decimal point a comma?)" : "");
}

static bool check_place(Adapter *adapter, double scene, double frame) {
    if (scene != adapter->scene)
        return adapter_failed(adapter, "has answered for scene %.9g; it is at scene %u", scene, adapter->scene);
    return frame == adapter->frame ||
           adapter_failed(adapter, "has answered with frame %.9g; frame %d was asked for", frame, adapter->frame);
}

static bool take_line(Adapter *adapter, const AnswerForm *form, int items, const char *line, Answer *answer) {
    char key[32], message[TALK_WHY_SIZE - 8] = "";
    bool found = false;
    const char *at = line;
    for (bool first = true; line_take_key(&at, first, key, sizeof key); first = false) {
        if (strcmp(key, form->key) == 0) {
            if (found || !take_numbers(adapter, form, items, &at))
                return found ? adapter_not_understood(adapter, "its answer", line) : false;
            found = true;
        } else if (strcmp(key, "scene") == 0     ? answer->scene != -1 || !line_take_number(&at, &answer->scene)
                   : strcmp(key, "frame") == 0   ? answer->frame != -1 || !line_take_number(&at, &answer->frame)
                   : strcmp(key, "problem") == 0 ? answer->problem != -1 || !line_take_number(&at, &answer->problem)
                   : strcmp(key, "ns") == 0      ? answer->ns != -1 || !line_take_number(&at, &answer->ns)
                   : strcmp(key, "error") == 0
                       ? message[0] != '\0' || !line_take_text(&at, message, sizeof message, true)
                       : true) {
            return adapter_not_understood(adapter, "its answer", line);
        }
    }
    if (message[0] != '\0') return adapter_failed(adapter, "says: %s", message);
    return (line_take_end(&at) && found) || adapter_not_understood(adapter, "its answer", line);
}

/* An answer as a line of JSON. */
static bool read_text(Adapter *adapter, int64_t *ns, double until) {
    const bool solves = adapter->contacts >= 0;
    const AnswerForm *form = solves ? &impulses : &states;
    const int items = solves ? adapter->contacts : adapter->bodies;
    Answer answer = {-1, -1, -1, -1};
    const char *line = talk_line(&adapter->talk, 256 + NUMBER_MAX * (size_t)(form->each * items), until);
    if (line == NULL) return adapter_failed(adapter, "%s", adapter->talk.why);
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c == (locale_t)0) return adapter_failed(adapter, "cannot be read: out of memory");
    locale_t before = uselocale(c);
    const bool done = take_line(adapter, form, items, line, &answer);
    uselocale(before);
    freelocale(c);
    if (!done) return false;
    *ns = answer.ns > 0 && answer.ns < 1e18 ? (int64_t)answer.ns : 0;
    if (!solves) return check_place(adapter, answer.scene, answer.frame);
    return answer.problem == adapter->scene ||
           adapter_failed(adapter, "has answered problem %.9g; problem %u was asked", answer.problem, adapter->scene);
}

static bool read_binary(Adapter *adapter, int64_t *ns, double until) {
    FrameHead head;
    const char *bytes = talk_read(&adapter->talk, sizeof head, until);
    if (bytes == NULL) return adapter_failed(adapter, "%s", adapter->talk.why);
    memcpy(&head, bytes, sizeof head);
    if (!check_place(adapter, head.scene, head.frame)) return false;
    if (head.bodies != (uint32_t)adapter->bodies || head.zero != 0)
        return adapter_failed(adapter, "has answered with %u bodies; there are %d", head.bodies, adapter->bodies);
    const size_t count = (size_t)adapter->bodies * ADAPTER_NUMBERS;
    bytes = talk_read(&adapter->talk, count * sizeof(float), until);
    if (bytes == NULL) return adapter_failed(adapter, "%s", adapter->talk.why);
    if (count > 0) memcpy(adapter->numbers, bytes, count * sizeof(float));
    for (size_t i = 0; i < count; i++)
        if (!isfinite(adapter->numbers[i]))
            return adapter_failed(adapter, "body %zu: its %s is no finite number", i / ADAPTER_NUMBERS,
                                  states.names[i % ADAPTER_NUMBERS]);
    *ns = head.ns < (uint64_t)1e18 ? (int64_t)head.ns : 0;
    return true;
}

bool adapter_read(Adapter *adapter, AdapterFrame *frame, double until) {
    adapter->frame++;
    *frame = (AdapterFrame){.numbers = adapter->numbers};
    if (!(adapter->binary ? read_binary : read_text)(adapter, &frame->ns, until)) return false;
    adapter->left--;
    return true;
}
