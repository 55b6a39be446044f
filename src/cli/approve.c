/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve.h"

#include "cli/commands.h"
#include "cli/options.h"

#include <stdio.h>

enum { ONLY = 256 };

static const struct argp_option option_table[] = {
    {"only", ONLY, "GLOB", 0, "Only files of such names, as 'stack_*' (default: all that failed)", 0}, {0}};

typedef struct Options {
    const char *report, *only;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case ONLY: options->only = value; break;
    case ARGP_KEY_ARG:
        if (options->report != NULL) argp_error(state, "one report, not more ('%s')", value);
        options->report = value;
        break;
    case ARGP_KEY_END:
        if (options->report == NULL) argp_error(state, "the folder of a report is needed");
        break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp argp = {
    option_table,
    parse,
    "REPORT",
    "Accept what the report of twinbox compare (--report REPORT) has shown: actual files take the place of expected "
    "ones "
    "that failed, new ones are added, missing ones removed. Nothing is touched unless every file asked for still is "
    "what the report was made of; folders are meant as compare was given them, from where it ran. Exit status 1: "
    "frames that failed were not shown, and stay.\v"
    "Example: twinbox approve out/report --only 'stack_*'",
    NULL,
    NULL,
    NULL};

static void told(const char *what, const char *path) { printf("%s %s\n", what, path); }

int command_approve(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    Approval approval;
    if (!approve(options.report, options.only, told, &approval, error)) return STATUS_DIFFERENT;
    printf("%d replaced, %d added, %d removed", approval.replaced, approval.added, approval.removed);
    if (approval.already > 0) printf(", %d already so", approval.already);
    if (approval.not_asked > 0) printf(", %d not asked for", approval.not_asked);
    if (approval.not_shown > 0) printf(", %d not shown: compare again with more --report-size", approval.not_shown);
    printf("\n");
    return approval.not_shown > 0 ? STATUS_DIFFERENT : STATUS_SAME;
}
