/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox approve: new pictures become the expected ones. */
#include "base/base.h"
#include "cli/options.h"
#include "regression/approve.h"

#include <limits.h>
#include <stdio.h>

typedef struct Options {
    const char *report, *expected, *only;
    bool partial, remove;
} Options;

static const Option option_table[] = {
    {"--expected", 0, "DIR",
     "The folder to change (default: the one that the report names, which must be below the current directory)",
     OPTION_TEXT(Options, expected)},
    {"--only", 0, "GLOB", "Only files whose names match, such as 'stack_*' (default: all that failed)",
     OPTION_TEXT(Options, only)},
    {"--partial", 0, NULL, "Keep expected files that have no actual one, after a run that did not draw all",
     OPTION_FLAG(Options, partial)},
    {"--remove", 0, NULL, "Remove expected files that have no actual one", OPTION_FLAG(Options, remove)},
    {0}};

static const CommandSpec spec = {
    .options = option_table,
    .input = {.value = "REPORT", .needed = "the folder of a report is needed", OPTION_TEXT(Options, report)},
    .inputs = {1, 1, "report"},
    .help =
        "Accept the changes that a report of twinbox compare (--report REPORT) shows: actual files replace the "
        "expected files that failed, and new files are added. Nothing is changed if a selected file has changed since "
        "the report was written, or if expected files have no actual one and neither --partial nor --remove tells "
        "what becomes of them. Of several accepted pictures, that in the report is replaced. Run it in the folder in "
        "which compare ran; a folder outside of it changes only with --expected. Exit status 1: failures that the "
        "report does not show remain. Of a run whose verdict changed, both verdicts are printed; the report plays both "
        "runs.\v"
        "Example: twinbox render stack --method engine -o expected --frames 30:40\n"
        "         twinbox render stack --method momentum -o actual --frames 30:40\n"
        "         twinbox compare expected actual --report out/report\n"
        "         twinbox approve out/report --only 'frame_*'"};

static void print_change(const char *what, const char *path, const char *verdicts) {
    char shown[PATH_MAX];
    visible_text(shown, sizeof shown, path, VISIBLE_ONE_LINE);
    printf("%s %s\n", what, shown);
    if (verdicts == NULL) return;
    visible_text(shown, sizeof shown, verdicts, VISIBLE_ONE_LINE);
    printf("  %s\n", shown);
}

bool command_approve(int argc, char **argv, Error *error) {
    Options options = {0};
    if (!options_parse(&spec, argc, argv, &options, error)) return false;
    Approval approval;
    if (options.partial && options.remove) return error_input(error, "--remove", "cannot be combined with --partial");
    const ApprovalRequest request = {.report = options.report,
                                     .expected = options.expected,
                                     .only = options.only,
                                     .missing = options.partial  ? MISSING_KEPT
                                                : options.remove ? MISSING_REMOVED
                                                                 : MISSING_REFUSED,
                                     .on_change = print_change};
    if (!approve(&request, &approval, error)) return false;
    printf("%d replaced, %d added, %d removed", approval.replaced, approval.added, approval.removed);
    if (approval.already > 0) printf(", %d already accepted", approval.already);
    if (approval.kept > 0) printf(", %d kept without an actual file", approval.kept);
    if (approval.not_selected > 0) printf(", %d not selected", approval.not_selected);
    if (approval.not_shown > 0) printf(", %d not shown: report.html says why", approval.not_shown);
    printf("\n");
    return approval.not_shown == 0;
}
