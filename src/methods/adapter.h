/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Programs that step scenes or solve contact problems for twinbox: how they are started, asked and ended. The protocol
   is in scenes/engines/README.md. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct Adapter Adapter;

/* Bodies to appear and steps to take. frame 0 begins a scene, with its bodies. */
typedef struct AdapterRequest {
    int frame;          /* steps that the scene has had */
    int steps;          /* to take now; 1 .. ADAPTER_STEPS_MAX */
    int added, removed; /* before the steps: bodies that appear behind the others; of the last ones, that vanish */
    const BodyDef *add; /* [added] */
    Vec2 gravity;       /* m/s^2; like the next two, for frame 0 only */
    float dt;           /* s */
    int iterations;
} AdapterRequest;

enum { ADAPTER_STEPS_MAX = 64, ADAPTER_NUMBERS = 6 };

/* The state after a step. */
typedef struct AdapterFrame {
    const float *states; /* [bodies, ADAPTER_NUMBERS] x, y, angle, vx, vy, omega; valid until the next call */
    int64_t ns;          /* that the engine took for the step, as it says; 0: unknown */
} AdapterFrame;

/* Keeps the text for programs_failure(). */
void program_failed(const char *text);

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
   adapter_why() tells how. `until`: clock_seconds() at which it must have answered. */
bool adapter_ask(Adapter *adapter, const AdapterRequest *request, double until);
bool adapter_read(Adapter *adapter, AdapterFrame *frame, double until);
const char *adapter_why(const Adapter *adapter);

/* Frames that were asked for and have not been read. */
int adapter_frames_left(const Adapter *adapter);

/* Asks for the impulses [contact_count] of a contact problem, N s: any finite numbers. *ns: that the program took, as
   it says; 0: unknown. */
bool adapter_solve(Adapter *adapter, const ContactProblem *problem, ContactImpulse *impulses, int64_t *ns,
                   double until);
