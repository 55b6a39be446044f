/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Programs that step scenes or solve contact problems for twinbox: how they are started, asked and ended. One protocol
   for both, scenes/engines/README.md:

       Adapter *adapter = adapter_take(&stepping_exec.description, &settings, 10, why, sizeof why);
       adapter_ask(adapter, &(AdapterRequest){.frame = 0, .steps = 2, .added = 1, .add = bodies, ...}, until);
       while (adapter_frames_left(adapter) > 0) adapter_read(adapter, &frame, until);
       adapter_give(adapter); */
#pragma once
#include "base/base.h"
#include "base/process.h"
#include "engine/engine.h"
#include "methods/methods.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { ADAPTER_STEPS_MAX = 64, ADAPTER_NUMBERS = 6, ADAPTER_KEY_SIZE = 2 * METHOD_TEXT_SIZE };

typedef struct Adapter {
    struct Adapter *next; /* in the pool */
    Talk talk;
    char key[ADAPTER_KEY_SIZE];
    bool binary;
    uint32_t scene;          /* number of the scene, or of the contact problem: an answer to a former one is noticed */
    int bodies, frame, left; /* of the scene; the last frame read; frames that are still to be read */
    int contacts;            /* of a contact problem; -1: a scene is asked for */
    float *numbers;          /* of the last answer */
    char *request;           /* text of a request */
    size_t number_capacity, request_size, request_capacity;
    char why[TALK_WHY_SIZE]; /* it has failed */
} Adapter;

/* What is asked: the impulses of a contact problem, or steps of a scene: bodies to appear and steps to take. frame 0
   begins a scene, with its bodies. */
typedef struct AdapterRequest {
    const ContactProblem *problem; /* or NULL, and: */
    int frame;                     /* steps that the scene has had */
    int steps;                     /* to take now; 1 .. ADAPTER_STEPS_MAX */
    int added, removed; /* before the steps: bodies that appear behind the others; of the last ones, that vanish */
    const BodyDef *add; /* [added] */
    Vec2 gravity;       /* m/s^2; like the next two, for frame 0 only */
    float dt;           /* s */
    int iterations;
} AdapterRequest;

/* The answer to a step, or to a contact problem. */
typedef struct AdapterFrame {
    /* [bodies, ADAPTER_NUMBERS] x, y, angle, vx, vy, omega; or [contacts, 2] normal and tangent impulse, N s: any
       finite numbers. Valid until the next call. */
    const float *numbers;
    int64_t ns; /* that the program took for it, as it says; 0: unknown */
} AdapterFrame;

/* An adapter of the program in the setting `program`, to which the other settings are passed, but for those in the
   method's table, which twinbox reads itself: one that runs already and has nothing to do, else a new one. NULL with
   `why` set: the program cannot be run, does not answer in `seconds` as it should, or answers what another method
   takes. */
Adapter *adapter_take(const MethodDescription *method, const Settings *settings, double seconds, char why[],
                      size_t size);

/* The program may serve another run, unless it is in the middle of an answer. Not after a failure. */
void adapter_give(Adapter *adapter);

/* Ends the program. */
void adapter_end(Adapter *adapter);

/* One request after the other; all frames of one must be read before the next. False: the program has failed, and
   adapter->why tells how. `until`: clock_seconds() at which it must have answered. */
bool adapter_ask(Adapter *adapter, const AdapterRequest *request, double until);
bool adapter_read(Adapter *adapter, AdapterFrame *frame, double until);

/* Frames that were asked for and have not been read. */
static inline int adapter_frames_left(const Adapter *adapter) { return adapter->left; }

/* Keeps the text for programs_failure(). */
void program_failed(const char *text);

/* What the two files of adapters share. Sets `why`; returns false. */
bool adapter_failed(Adapter *adapter, const char *format, ...) PRINTF_LIKE(2, 3);

/* With the start of an answer that is not understood. */
bool adapter_not_understood(Adapter *adapter, const char *what, const char *line);

/* JSON of one line, as far as answers have it: base/json.h is not for threads. line_take_key begins with the "{" or the
   "," before a key, and ends behind its ":"; it is false at the end of the object, and if there is no key. A text that
   does not fit into `size` is refused, or cut, with "...". */
bool line_take_text(const char **at, char *text, size_t size, bool cut);
bool line_take_number(const char **at, double *number);
bool line_take_key(const char **at, bool first, char *key, size_t size);
bool line_take_end(const char **at);
