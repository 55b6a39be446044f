/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/compare_json.h"

#include "cli/json_output.h"
#include "report/regression_report.h"

#include <math.h>

typedef struct Runs {
    const char *const *paths;
    const Trajectory *runs[2];
    const TrajectoryDifference *difference;
} Runs;

static void write_pictures(JsonWriter *json, const void *context) { regression_write_json(json, context); }

bool compare_json_pictures(const Regression *regression, Error *error) {
    return json_output("twinbox compare 1", write_pictures, regression, error);
}

static void write_first(JsonWriter *json, const TrajectoryDifference *difference) {
    if (difference->frame < 0) {
        json_put_text(json, "first", NULL);
        return;
    }
    json_begin_object(json, "first", JSON_ONE_LINE);
    json_put_int(json, "frame", difference->frame);
    json_put_int(json, "body", difference->body);
    json_put_number(json, "distance", difference->distance);
    json_put_number(json, "angle", difference->angle);
    json_put_number(json, "speed", difference->poses_only ? NAN : difference->speed);
    json_end(json);
}

static void write_largest(JsonWriter *json, const TrajectoryDifference *difference) {
    if (difference->max_frame < 0) {
        json_put_text(json, "largest", NULL);
        return;
    }
    json_begin_object(json, "largest", JSON_ONE_LINE);
    json_put_int(json, "frame", difference->max_frame);
    json_put_int(json, "body", difference->max_body);
    json_put_number(json, "distance", difference->max_distance);
    json_end(json);
}

static void write_runs(JsonWriter *json, const void *context) {
    static const char *const keys[] = {"expected", "actual"};
    const Runs *compared = context;
    for (int i = 0; i < 2; i++) {
        json_begin_object(json, keys[i], JSON_ONE_LINE);
        json_put_text(json, "path", compared->paths[i]);
        json_put_text(json, "scene", compared->runs[i]->scene);
        json_put_text(json, "method", compared->runs[i]->method);
        json_put_int(json, "frames", compared->runs[i]->frames);
        json_put_int(json, "bodies", compared->runs[i]->bodies);
        json_end(json);
    }
    json_put_bool(json, "passed", compared->difference->equal);
    json_put_text(json, "words", compared->difference->what[0] != '\0' ? compared->difference->what : NULL);
    json_put_bool(json, "poses_only", compared->difference->poses_only);
    write_first(json, compared->difference);
    write_largest(json, compared->difference);
}

bool compare_json_runs(const char *const paths[2], const Trajectory *a, const Trajectory *b,
                       const TrajectoryDifference *difference, Error *error) {
    const Runs compared = {paths, {a, b}, difference};
    return json_output("twinbox compare runs 1", write_runs, &compared, error);
}
