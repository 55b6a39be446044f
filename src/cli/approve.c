/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/approve.h"

#include "cli/commands.h"
#include "cli/options.h"

#include <stdio.h>

enum { ONLY = 256 };

static const struct argp_option option_table[] = {
    {"only", ONLY, "GLOB", 0, "Only files whose names match, such as 'stack_*' (default: all that failed)", 0}, {0}};

typedef struct Options {
    const char *report, *only;
} Options;

static error_t parse(int key, char *value, struct argp_state *state) {
    Options *options = state->input;
    switch (key) {
    case ONLY: options->only = value; break;
    case ARGP_KEY_ARG:
        if (options->report != NULL) argp_error(state, "only one report can be given (second: '%s')", value);
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
    "Accept the changes that a report of twinbox compare (--report REPORT) shows: actual files replace the expected "
    "files that failed, new files are added, missing files are removed. If a selected file has changed since the "
    "report was written, nothing is changed. Run it in the folder in which compare ran. Exit status 1: failures that "
    "the report does not show remain.\v"
    "Example: twinbox approve out/report --only 'stack_*'",
    NULL,
    NULL,
    NULL};

static void print_change(const char *what, const char *path) { printf("%s %s\n", what, path); }

int command_approve(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&argp, argc, argv, &options)) return STATUS_DIFFERENT;
    Approval approval;
    if (!approve(options.report, options.only, print_change, &approval, error)) return STATUS_DIFFERENT;
    printf("%d replaced, %d added, %d removed", approval.replaced, approval.added, approval.removed);
    if (approval.already > 0) printf(", %d already accepted", approval.already);
    if (approval.not_selected > 0) printf(", %d not selected", approval.not_selected);
    if (approval.not_shown > 0) printf(", %d not shown: compare again with a larger --report-size", approval.not_shown);
    printf("\n");
    return approval.not_shown > 0 ? STATUS_DIFFERENT : STATUS_SAME;
}
