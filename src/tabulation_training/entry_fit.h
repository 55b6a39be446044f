/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a memory learns from a solved impact: nothing, a larger ellipsoid, or a new entry. Source: Pope (1997), 3, and Lu, Pope
   (2009) for the checks of answers; the linear map is a fit over neighbours instead of a derivative (tabulation.h).

   A derivative by finite differences would take a converged solve for each direction of the key, most of which no launch
   takes, and the contacts change their features under small turns. The fit takes none, and is exact along the
   launches. */
#pragma once
#include "tabulation/tabulation.h"

/* RMS over the dynamic bodies of |dv|^2 + dspin^2 / 6, as in reference/solution_error.h, m/s. */
float velocity_error(const ContactProblem *problem, const BodyVelocity *a, const BodyVelocity *b);

/* A step, solved to convergence. */
typedef struct SolvedStep {
    const ContactProblem *problem;
    const ContactSolution *solution;
    TabulationQuery query;
} SolvedStep;

typedef enum Lesson {
    LESSON_KNOWN, /* the memory answers it by now */
    LESSON_GROWN, /* an ellipsoid includes it */
    LESSON_ADDED, /* an entry */
    LESSON_FULL   /* an entry would exceed the limit */
} Lesson;

/* limit: bytes of the memory. answer: work space of the problem's size. False with error set when memory is short. */
bool entry_learn(Tabulation *memory, const SolvedStep *step, size_t limit, ContactSolution *answer, Lesson *lesson,
                 Error *error);

/* Checks an entry that answered the step: if the answer's error exceeds the tolerance, its ellipsoid shrinks. Returns the
   error, m/s. */
float entry_check(Tabulation *memory, int entry, const SolvedStep *step, ContactSolution *answer);
