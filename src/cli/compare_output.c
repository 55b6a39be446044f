/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What compare prints about pictures. */
#include "base/base.h"
#include "base/json.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/report.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *trajectories(int count) { return count == 1 ? "trajectory" : "trajectories"; }

/* The frames, or the trajectories, that only this folder has. */
static void print_alone(const Regression *regression, RegressionSide side, bool runs) {
    enum { NAMED = 10 };
    const PixelVerdict verdict = side == EXPECTED ? PIXELS_MISSING : PIXELS_EXTRA;
    const int all = runs ? regression->run_count : regression->count;
    const int count = runs ? regression->runs_alone[side] : regression->by_verdict[verdict];
    if (count == 0) return;
    printf("only in %s: %d %s%s:", regression->sequences[side]->folder, count, runs ? trajectories(count) : "frame",
           runs ? "" : plural(count));
    for (int i = 0, named = 0; i < all && named < NAMED; i++) {
        if (runs ? !regression->runs[i].alone[side] : regression->frames[i].pixels != verdict) continue;
        printf(" %s", runs ? regression->runs[i].name : frame_name(&regression->frames[i]));
        named++;
    }
    printf(count > NAMED ? " ...\n" : "\n");
}

/* The three largest regions. */
static void print_regions(const FrameChanges *changes) {
    enum { SHOWN = 3 };
    if (changes == NULL) return;
    int64_t more = changes->regions.count;
    for (int i = 0; i < changes->regions.kept && i < SHOWN; i++, more--)
        printf("  %s\n", region_words(changes, i).text);
    if (more > 0) printf("  and %" PRId64 " more %s\n", more, more == 1 ? "region" : "regions");
}

/* Pictures that belong to no sequence: a line each, the worst first. No line begins with a name, which a CI system
   could take for a command. */
static bool print_cases(const Regression *regression, Error *error) {
    enum { SHOWN = 50 };
    const RegressionFrame **failures = regression_failures(regression, error);
    int shown = 0;
    for (int i = 0; failures != NULL && i < regression->failed; i++) {
        if (!failures[i]->alone || failures[i]->pixels >= PIXELS_MISSING) continue;
        if (shown++ == SHOWN) printf("and more; results.json of --report has all\n");
        if (shown > SHOWN) break;
        printf("differs: %s: %s\n", frame_name(failures[i]), case_words(failures[i]).text);
        if (regression->count == 1) print_regions(failures[i]->changes);
    }
    free(failures);
    return failures != NULL;
}

static bool print_difference(const Regression *regression, Error *error) {
    enum { CAUSES = 8, UNREAD = 50 };
    /* What the camera explains comes first: with another view, everything else is a consequence. */
    for (int i = 0; i < regression->cause_count && regression->causes[i].of_view; i++)
        printf("%s\n", cause_words(&regression->causes[i]).text);
    for (int i = 0; i < 2 * SIDES; i++) print_alone(regression, i % SIDES == 0 ? EXPECTED : ACTUAL, i >= SIDES);
    /* Files that cannot be read, but for the first, which is the error that ends the command. */
    for (int i = 0, count = 0; i < regression->count + regression->run_count && count < UNREAD; i++)
        if (regression_unread(regression, i) != NULL && count++ > 0)
            printf("not comparable: %s\n", regression_unread(regression, i));
    for (int i = 0; i < regression->count; i++) {
        const RegressionFrame *frame = &regression->frames[i];
        if (frame->alone || !frame_failed(frame) || frame->pixels >= PIXELS_MISSING) continue;
        printf("first difference: %s: %s\n", frame_name(frame), frame_words(frame).text);
        print_regions(frame->changes);
        break;
    }
    if (!print_cases(regression, error)) return false;
    int shown = 0, more = regression->causes_left_out;
    for (int i = 0; i < regression->cause_count; i++) {
        if (regression->causes[i].of_view) continue;
        if (shown++ < CAUSES)
            printf("%s\n", cause_words(&regression->causes[i]).text);
        else
            more++;
    }
    if (more > 0) printf("and %d more cause%s\n", more, plural(more));

    const int *by = regression->by_verdict, alone = regression->runs_alone[EXPECTED] + regression->runs_alone[ACTUAL];
    const int unread = alone + regression->runs_unread, runs = regression->run_count - unread,
              run_failed = regression->run_failed - unread;
    const int compared = regression->count - by[PIXELS_MISSING] - by[PIXELS_EXTRA] - by[PIXELS_UNREAD];
    const int different = by[PIXELS_DIFFER] + by[PIXELS_RESIZED];
    if (different > 0)
        printf("%d of %d frame%s %s", different, compared, plural(compared), different == 1 ? "differs" : "differ");
    if (different > 0 && run_failed > 0) printf(", ");
    if (run_failed > 0)
        printf("%d of %d %s %s", run_failed, runs, trajectories(runs), run_failed == 1 ? "differs" : "differ");
    if (different > 0 || run_failed > 0) printf("\n");
    const RegressionText begin = regression_begin(regression);
    if (begin.text[0] != '\0') printf("%s\n", begin.text);
    printf("verdict: %s\n", regression_verdict(regression).text);
    return true;
}

bool compare_print(const Regression *regression, Error *error) {
    const int within = regression->by_verdict[PIXELS_WITHIN], runs = regression->run_count;
    const RegressionText notes = regression_notes(regression);
    if (!regression_passed(regression)) {
        if (!print_difference(regression, error)) return false;
    } else {
        printf("%s: %d frame%s", within + regression->run_within > 0 ? "passed" : "equal", regression->count,
               plural(regression->count));
        if (within > 0) printf(", %d of them not equal, but within tolerance", within);
        if (runs > 0) printf(", %d %s", runs, trajectories(runs));
        if (regression->run_within > 0) printf(", %d of them not equal, but within tolerance", regression->run_within);
        printf("\n");
    }
    if (notes.text[0] != '\0') printf("%s\n", notes.text);
    return true;
}

static void write_pictures(JsonWriter *json, const void *context) { regression_write_json(json, context); }

bool compare_json_pictures(const Regression *regression, Error *error) {
    return json_output("twinbox compare 1", write_pictures, regression, error);
}
