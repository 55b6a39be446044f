/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/regression_github.h"

#include "report/regression_cases.h"

#include <string.h>

/* In a property, ':' and ',' end the value; in both, a line break ends the command. */
static void put_escaped(FILE *out, const char *text, const char *special) {
    for (; *text != '\0'; text++) {
        if ((unsigned char)*text < ' ' || *text == '%' || strchr(special, *text) != NULL)
            fprintf(out, "%%%02X", (unsigned)(unsigned char)*text);
        else
            fputc(*text, out);
    }
}

static void put_property(FILE *out, const char *text) { put_escaped(out, text, ":,"); }
static void put_message(FILE *out, const char *text) { put_escaped(out, text, ""); }

void github_annotate_message(FILE *out, const char *title, const char *message) {
    fputs("::error title=", out);
    put_property(out, title);
    fputs("::", out);
    put_message(out, message);
    fputc('\n', out);
}

/* Whether two neighbours of the list belong to one annotation: frames of one sequence that failed alike. */
static bool is_same_failure(const Regression *regression, int i, int next) {
    if (next >= regression->count) return false;
    const RegressionFrame *a = &regression->frames[i], *b = &regression->frames[next];
    const SequenceFrame *x = a->base, *y = b->base;
    return frame_failed(a) && frame_failed(b) && x->number >= 0 && y->number >= 0 &&
           sequence_compare_stems(x, y) == 0 && strcmp(frame_verdict(a), frame_verdict(b)) == 0;
}

typedef struct Failures {
    int begin, end; /* cases; end is exclusive */
} Failures;

static void annotate(FILE *out, const Regression *regression, Failures failures) {
    const RegressionCase made = regression_case(regression, failures.begin);
    fputs("::error file=", out);
    put_property(out, made.paths[made.paths[EXPECTED][0] != '\0' ? EXPECTED : ACTUAL]);
    fputs(",title=", out);
    put_property(out, made.verdict);
    fputs("::", out);
    put_message(out, made.name);
    if (failures.end - failures.begin > 1) {
        fputs(" to ", out);
        put_message(out, frame_name(&regression->frames[failures.end - 1]));
        fprintf(out, ", %d frames; the first", failures.end - failures.begin);
    }
    fputs(": ", out);
    put_message(out, made.words.text);
    fputc('\n', out);
}

void github_annotate(FILE *out, const Regression *regression) {
    Failures found[GITHUB_ANNOTATIONS_MAX];
    const int count = regression_case_count(regression);
    int groups = 0, left_out = 0;
    for (int k = 0; k < count; k++) {
        int begin = (k + regression->count) % count, end = begin + 1; /* trajectories first: they are the cause */
        if (!regression_case(regression, begin).failed) continue;
        while (is_same_failure(regression, end - 1, end)) end++;
        if (groups < GITHUB_ANNOTATIONS_MAX)
            found[groups] = (Failures){begin, end};
        else
            left_out += end - begin;
        groups++;
        k += end - begin - 1;
    }
    if (groups > GITHUB_ANNOTATIONS_MAX) {
        groups = GITHUB_ANNOTATIONS_MAX - 1;
        left_out += found[groups].end - found[groups].begin;
    }
    for (int i = 0; i < groups; i++) annotate(out, regression, found[i]);
    if (left_out == 0) return;
    char message[128];
    snprintf(message, sizeof message, "%d more failures; the step summary and the report list them", left_out);
    github_annotate_message(out, "twinbox compare", message);
}
