/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stopping rule of the iterative methods: after the first k sweeps, blocks of 8 follow while the residual is at
   least `near`, up to `more` sweeps. Most steps need few sweeps and an impact needs many, so the rule spends them
   where they are needed. Fails where the residual is small and the error is not: an error that is spread over a
   whole stack leaves each contact close to its target. */
#pragma once
#include "base/base.h"
#include "base/settings.h"
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    STOPPING_BLOCK = 8, /* sweeps; the residual is read before each block */
    STOPPING_MORE = 48  /* the default of `more` */
};

/* `more` 0: none follow the first k. */
typedef struct StoppingRule {
    int k;      /* sweeps */
    float near; /* m/s, RMS over the contacts */
    int more;   /* a multiple of STOPPING_BLOCK */
} StoppingRule;

/* The rule's settings, for the table of a method whose state begins with its rule. sweeps: what it counts, "sweeps". */
#define SWEEPS_SETTING                                                            \
    {                                                                             \
        "k", "sweeps over all contacts per step (default: the scene's, else 10)", \
            SETTING_INT(StoppingRule, k, 1, SWEEPS_MAX)                           \
    }
#define STOPPING_SETTINGS(sweeps)                                                                                      \
    {"near", sweeps " go on while contacts miss their velocity by this, m/s (after k, in blocks of 8; default: none)", \
     SETTING_OWN},                                                                                                     \
    {                                                                                                                  \
        "more", sweeps " that near may add (rounded up to whole blocks; default: 48)", SETTING_OWN                     \
    }

/* Overwrites the rule, which has the method's defaults, with `near` and `more`. ERROR_INPUT for a value out of range,
   and for `more` where no rule is. */
bool stopping_read(StoppingRule *rule, const Settings *chosen, Error *error);

/* settings_make() and stopping_read() for a state that begins with its rule. */
void *stopping_make(const Settings *chosen, const SettingSpec *known, const void *standard, size_t size,
                    const char *what, Error *error);

/* True if another block must follow the first k sweeps and `done` more. */
bool stopping_needs_more(const StoppingRule *rule, int done, const Sweeps *sweeps, const ContactProblem *problem);

/* The same for a scalar reference implementation. */
bool stopping_needs_more_scalar(const StoppingRule *rule, int done, const ContactProblem *problem,
                                const ContactSolution *solution);
