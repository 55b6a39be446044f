/* SPDX-License-Identifier: GPL-3.0-or-later */
/* results.json: also within the page, which reads it. */
#include "report/json.h"
#include "report/regression_parts.h"

#include <inttypes.h>
#include <math.h>

static void put_pair(FILE *file, const char *key, const char *text) {
    fprintf(file, "\"%s\": ", key);
    json_put(file, text);
    fputs(", ", file);
}

static void put_file(FILE *file, const char *key, const char *name, const RegressionFile *data, const char *end) {
    fprintf(file, "\"%s\": ", key);
    if (name == NULL)
        fputs("null", file);
    else {
        fputs("{\"name\": ", file);
        json_put(file, name);
        fprintf(file, ", \"size\": %zu, \"xxh3\": \"%016" PRIx64 "\"}", data->size, data->hash);
    }
    fputs(end, file);
}

static void put_flag(FILE *file, const char *key, bool value) {
    fprintf(file, "\"%s\": %s, ", key, value ? "true" : "false");
}

static void put_frame(FILE *file, const RegressionFrame *frame) {
    const ImageDifference *d = &frame->difference;
    const char *names[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        names[side] = frame->at[side] != NULL ? frame->at[side]->name : NULL;
    fputs("  {", file);
    put_pair(file, "name", frame_name(frame));
    put_pair(file, "verdict", frame_verdict(frame));
    put_flag(file, "failed", frame_failed(frame));
    put_flag(file, "shown", frame->shown);
    put_pair(file, "words", frame_words(frame).text);
    fprintf(file, "\"differing\": %" PRId64 ", \"counted\": %" PRId64 ", \"largest\": %d, ", d->pixels, d->counted,
            d->largest);
    if (d->pixels > 0)
        fprintf(file, "\"box\": [%d, %d, %d, %d], ", d->left, d->top, d->right, d->bottom);
    else
        fputs("\"box\": null, ", file);
    /* Four digits: the last bits of a power depend on the machine. */
    if (isfinite(frame->flip))
        fprintf(file, "\"flip\": %.4g, ", frame->flip);
    else
        fputs("\"flip\": null, ", file);
    put_file(file, "expected", names[EXPECTED], &frame->files[EXPECTED], ", ");
    put_file(file, "actual", names[ACTUAL], &frame->files[ACTUAL], "}");
}

static void put_run(FILE *file, const RegressionRun *run) {
    fputs("  {", file);
    put_pair(file, "name", run->name);
    put_pair(file, "verdict", run->difference.equal ? "equal" : "physics changed");
    put_flag(file, "failed", !run->difference.equal);
    put_flag(file, "shown", true);
    put_pair(file, "words", run_words(run).text);
    put_file(file, "expected", run->name, &run->files[EXPECTED], ", ");
    put_file(file, "actual", run->name, &run->files[ACTUAL], "}");
}

void report_put_json(FILE *file, const void *context) {
    const Report *report = context;
    const Regression *regression = report->regression;
    fputs("{\"format\": \"twinbox compare 1\",\n", file);
    put_pair(file, "expected", regression->sequences[EXPECTED]->folder);
    put_pair(file, "actual", regression->sequences[ACTUAL]->folder);
    put_pair(file, "verdict", regression_verdict(regression).text);
    fprintf(file, "\"fuzzy\": [%d, %.9g], \"masks\": %d,\n", regression->options.max_difference,
            regression->options.max_share, regression->options.mask == NULL ? 0 : regression->options.mask->count);
    fputs("\"frames\": [", file);
    for (int i = 0; i < regression->count; i++) {
        fputs(i > 0 ? ",\n" : "\n", file);
        put_frame(file, &regression->frames[i]);
    }
    fputs("],\n\"trajectories\": [", file);
    for (int i = 0; i < regression->run_count; i++) {
        fputs(i > 0 ? ",\n" : "\n", file);
        put_run(file, &regression->runs[i]);
    }
    fputs("]}\n", file);
}
