/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stopping rule of the iterative methods: after the first k sweeps, blocks of 8 follow while the residual
   (residual.h) is at least `near`, up to `more` sweeps. Most steps need few sweeps and an impact needs many, so the rule
   spends them where they are needed. Fails where the residual is small and the error is not: an error that is spread
   over a whole stack leaves each contact close to its target. */
#pragma once
#include "common/settings.h"
#include "sweeps/sweeps.h"

enum {
    STOPPING_BLOCK = 8, /* sweeps; the residual is read before each block */
    STOPPING_MORE = 48  /* the default of `more` */
};

/* The rule's settings, for a method's table. */
#define STOPPING_SETTINGS                                                                                             \
    {"near", "residual, m/s: after k sweeps, blocks of 8 follow while it is at least this (default: none follow)"}, { \
        "more", "with near: sweeps that may follow, rounded up to whole blocks (default: 48)"                         \
    }

/* Zero: no sweeps follow. */
typedef struct StoppingRule {
    float near; /* m/s, RMS over the contacts */
    int more;   /* a multiple of STOPPING_BLOCK */
} StoppingRule;

/* Overwrites the rule, which has the method's defaults, with the settings. ERROR_INPUT for a value out of range, and
   for `more` where no rule is. */
bool stopping_read(StoppingRule *rule, const Settings *chosen, Error *error);

/* True if another block must follow the first k sweeps and `done` more. */
bool stopping_needs_more(const StoppingRule *rule, int done, const Sweeps *sweeps, const ContactProblem *problem);

/* The same for a scalar reference implementation. */
bool stopping_needs_more_scalar(const StoppingRule *rule, int done, const ContactProblem *problem,
                                const ContactSolution *solution);

/* k sweeps, and more by the rule. run: sweeps_run or sweeps_run_blocks. False when memory is short. */
bool stopping_run(const StoppingRule *rule, Sweeps *sweeps, const ContactProblem *problem, int k,
                  bool (*run)(Sweeps *, int));
