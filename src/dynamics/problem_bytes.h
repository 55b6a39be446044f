/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems as bytes, for files that only the same program reads again (pieces/pieces.h). */
#pragma once
#include "common/error.h"
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* What is left of the contents of a file. */
typedef struct ProblemBytes {
    const char *at;
    size_t left;
    const char *path; /* for messages */
} ProblemBytes;

/* Takes `count` items of `size` bytes off the front. ERROR_INPUT if fewer are left. */
bool problem_bytes_take(ProblemBytes *bytes, void *items, size_t count, size_t size, Error *error);

/* Sets ERROR_INPUT: what was read is not possible. */
bool problem_bytes_refuse(const ProblemBytes *bytes, Error *error);

/* Whether writing failed is for the stream to tell. */
void problem_bytes_write(const ContactProblem *problem, FILE *out);

/* Takes a problem off the front; problem_bytes_free(), also after a failure. ERROR_INPUT if bytes are missing, counts are too
   large, numbers are NaN or infinite, or pairs are out of range or not sorted. */
bool problem_bytes_read(ContactProblem *problem, ProblemBytes *bytes, Error *error);
void problem_bytes_free(ContactProblem *problem);
