/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/compare_print.h"

#include "common/text_add.h"

#include <inttypes.h>
#include <math.h>
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

static const char *differ(int count) { return count == 1 ? "differs" : "differ"; }

/* The three largest regions. */
static void print_regions(const FrameChanges *changes) {
    enum { SHOWN = 3 };
    if (changes == NULL) return;
    int64_t more = changes->regions.count;
    for (int i = 0; i < changes->regions.kept && i < SHOWN; i++, more--)
        printf("  %s\n", region_words(changes, i).text);
    if (more > 0) printf("  and %" PRId64 " more %s\n", more, more == 1 ? "region" : "regions");
}

static void print_first(const Regression *regression) {
    for (int i = 0; i < regression->count; i++) {
        const RegressionFrame *frame = &regression->frames[i];
        if (frame->pixels != PIXELS_DIFFER && frame->pixels != PIXELS_RESIZED) continue;
        printf("first difference: %s: %s\n", frame_name(frame), frame_words(frame).text);
        if (!isnan(frame->flip)) printf("  FLIP: mean %.3g, 99th percentile %.3g\n", frame->flip, frame->flip_p99);
        print_regions(frame->changes);
        return;
    }
}

/* What the camera explains comes first: with another view, everything else is a consequence. */
static void print_views(const Regression *regression) {
    for (int i = 0; i < regression->cause_count && regression->causes[i].of_view; i++)
        printf("%s\n", cause_words(&regression->causes[i]).text);
}

static void print_causes(const Regression *regression) {
    enum { SHOWN = 8 };
    int shown = 0, more = regression->causes_left_out;
    for (int i = 0; i < regression->cause_count; i++) {
        if (regression->causes[i].of_view) continue;
        if (shown++ < SHOWN)
            printf("%s\n", cause_words(&regression->causes[i]).text);
        else
            more++;
    }
    if (more > 0) printf("and %d more cause%s\n", more, plural(more));
}

static void print_counts(const Regression *regression) {
    const int *by = regression->by_verdict, runs = regression->run_count, run_failed = regression->run_failed;
    int compared = regression->count - by[PIXELS_MISSING] - by[PIXELS_EXTRA];
    int different = by[PIXELS_DIFFER] + by[PIXELS_RESIZED];
    if (different > 0) printf("%d of %d frame%s %s", different, compared, plural(compared), differ(different));
    if (different > 0 && run_failed > 0) printf(", ");
    if (run_failed > 0)
        printf("%d of %d %s %s", run_failed, runs, runs == 1 ? "trajectory" : "trajectories", differ(run_failed));
    if (different > 0 || run_failed > 0) printf("\n");
}

static void print_difference(const Regression *regression) {
    print_views(regression);
    print_names(regression, PIXELS_MISSING, regression->sequences[EXPECTED]->folder);
    print_names(regression, PIXELS_EXTRA, regression->sequences[ACTUAL]->folder);
    print_first(regression);
    print_causes(regression);
    print_counts(regression);
    RegressionText begin = regression_begin(regression);
    if (begin.text[0] != '\0') printf("%s\n", begin.text);
    printf("verdict: %s\n", regression_verdict(regression).text);
}

void compare_print(const Regression *regression) {
    int within = regression->by_verdict[PIXELS_WITHIN], runs = regression->run_count;
    if (!regression_passed(regression)) {
        print_difference(regression);
        return;
    }
    printf("%s: %d frame%s", within > 0 ? "passed" : "equal", regression->count, plural(regression->count));
    if (within > 0) printf(", %d of them not equal, but within tolerance", within);
    if (runs > 0) printf(", %d %s", runs, runs == 1 ? "trajectory" : "trajectories");
    printf("\n");
}
