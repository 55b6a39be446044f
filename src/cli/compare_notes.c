/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/compare_notes.h"

#include <stdio.h>

static const char *plural(int count) { return count == 1 ? "" : "s"; }

static void print_skipped(const Regression *regression) {
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        const ImageSequence *sequence = regression->sequences[side];
        if (sequence->skipped > 0)
            printf("not compared: %d picture%s in subfolders of %s (--no-recursive)\n", sequence->skipped,
                   plural(sequence->skipped), sequence->folder);
    }
}

static void print_metadata(const Regression *regression) {
    if (regression->metadata == 0) return;
    const RegressionFrame *first = &regression->frames[regression->first_metadata];
    printf("metadata differs in %d frame%s, first in %s: %s%s\n", regression->metadata, plural(regression->metadata),
           frame_name(first), first->metadata.text,
           regression->options.strict_metadata ? "" : " (--metadata strict fails)");
}

void compare_print_notes(const Regression *regression) {
    int accepted = regression->other_accepted, left_out = regression->runs_left_out;
    int foreign = regression->runs_foreign;
    if (accepted > 0) printf("%d frame%s passed by another accepted picture\n", accepted, plural(accepted));
    print_metadata(regression);
    if (left_out > 0)
        printf("not compared: %d .npz file%s only in %s\n", left_out, plural(left_out),
               regression->sequences[EXPECTED]->folder);
    if (foreign > 0) printf("not compared: %d .npz file%s without a trajectory\n", foreign, plural(foreign));
    print_skipped(regression);
}
