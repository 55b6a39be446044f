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

static void annotate_case(FILE *out, const RegressionCase *made) {
    fputs("::error file=", out);
    put_property(out, made->paths[made->paths[EXPECTED][0] != '\0' ? EXPECTED : ACTUAL]);
    fputs(",title=", out);
    put_property(out, made->verdict);
    fputs("::", out);
    put_message(out, made->name);
    fputs(": ", out);
    put_message(out, made->words.text);
    fputc('\n', out);
}

void github_annotate(FILE *out, const Regression *regression) {
    const int failures = regression->failed + regression->run_failed, count = regression_case_count(regression);
    const int shown = failures > GITHUB_ANNOTATIONS_MAX ? GITHUB_ANNOTATIONS_MAX - 1 : failures;
    for (int i = 0, done = 0; i < count && done < shown; i++) {
        /* Trajectories first: they are the cause. */
        const RegressionCase made = regression_case(regression, (i + regression->count) % count);
        if (!made.failed) continue;
        annotate_case(out, &made);
        done++;
    }
    if (failures == shown) return;
    char message[128];
    snprintf(message, sizeof message, "%d more failures; the step summary and the report list them", failures - shown);
    github_annotate_message(out, "twinbox compare", message);
}
