/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of a comparison for GitHub Actions: annotations (workflow commands on standard output) and the step
   summary (Markdown). Source: docs.github.com, "Workflow commands for GitHub Actions". Names and messages are escaped:
   none can become a command or markup. Other output with names belongs between "::stop-commands::TOKEN" and "::TOKEN::",
   with a token that nobody can know before: a runner searches whole lines for old commands ("##[...]"). */
#pragma once
#include "regression/regression.h"

#include <stddef.h>
#include <stdio.h>

/* GitHub shows ten errors of a step and drops the others. */
enum { GITHUB_ANNOTATIONS_MAX = 10 };

/* GitHub refuses a larger summary of a step as a whole. */
enum { GITHUB_SUMMARY_MAX = 1 << 20 };

/* An error for each failure, and one for successive frames of a sequence that failed alike; at most
   GITHUB_ANNOTATIONS_MAX: if there are more, the last one counts the others. */
void github_annotate(FILE *out, const Regression *regression);

/* One error that is about no file. */
void github_annotate_message(FILE *out, const char *title, const char *message);

/* Appends the summary to a file, which stays below GITHUB_SUMMARY_MAX bytes: rows that do not fit are counted. Writes
   nothing if not even the head fits. */
bool github_summary_append(const Regression *regression, const char *path, Error *error);
