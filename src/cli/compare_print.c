/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/compare_print.h"

#include <stdio.h>

/* The names of frames with this verdict. */
static void print_names(const Regression *regression, PixelVerdict verdict, const char *folder) {
    enum { NAMED = 10 };
    int count = regression->by_verdict[verdict], named = 0;
    if (count == 0) return;
    printf("only in %s: %d %s:", folder, count, count == 1 ? "frame" : "frames");
    for (int i = 0; i < regression->count && named < NAMED; i++)
        if (regression->frames[i].pixels == verdict) {
            printf(" %s", frame_name(&regression->frames[i]));
            named++;
        }
    printf(count > NAMED ? " ...\n" : "\n");
}

static void print_difference(const Regression *regression) {
    const int *by = regression->by_verdict;
    print_names(regression, PIXELS_MISSING, regression->sequences[EXPECTED]->folder);
    print_names(regression, PIXELS_EXTRA, regression->sequences[ACTUAL]->folder);
    int compared = regression->count - by[PIXELS_MISSING] - by[PIXELS_EXTRA];
    int different = by[PIXELS_DIFFER] + by[PIXELS_RESIZED];
    const RegressionFrame *frames = regression->frames;
    for (int i = 0; different > 0 && i < regression->count; i++)
        if (frames[i].pixels == PIXELS_DIFFER || frames[i].pixels == PIXELS_RESIZED) {
            printf("first difference: %s: %s\n", frame_name(&frames[i]), frame_words(&frames[i]).text);
            printf("  FLIP: mean %.3g, 99th percentile %.3g\n", frames[i].flip, frames[i].flip_p99);
            break;
        }
    if (different > 0) printf("%d of %d frames differ\n", different, compared);
    RegressionText begin = regression_begin(regression);
    if (begin.text[0] != '\0') printf("%s\n", begin.text);
    printf("verdict: %s\n", regression_verdict(regression).text);
}

void compare_print(const Regression *regression) {
    int within = regression->by_verdict[PIXELS_WITHIN];
    if (!regression_passed(regression)) {
        print_difference(regression);
        return;
    }
    printf("%s: %d frames", within > 0 ? "passed" : "equal", regression->count);
    if (within > 0) printf(", %d of them not equal, but within tolerance", within);
    if (regression->run_count > 0) printf(", %d trajectories", regression->run_count);
    printf("\n");
}
