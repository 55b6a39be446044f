/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every method still holds at the last value at which it held, and fails at the first at which it failed: both sides of
   each border in golden/stability.csv, which golden/renew makes. */
#include "testing.h"

#include "common/csv.h"
#include "common/parallel.h"
#include "stability/stability_scan.h"

/* Columns of the file. */
enum { STUDY, METHOD, SETTING, PARAMETER, UNIT, HOLDS_AT, FAILS_AT, VERDICT };

static const char scenes[] = SOURCE_DIR "/scenes";

typedef struct Golden {
    Csv csv;
    ConvergedRuns converged[64]; /* of each study */
} Golden;

static bool method_of(const Golden *golden, int row, Method *method, Error *error) {
    char text[METHOD_TEXT_SIZE];
    const char *setting = csv_text(&golden->csv, row, SETTING);
    snprintf(text, sizeof text, "%s%s%s", csv_text(&golden->csv, row, METHOD), setting[0] != '\0' ? ":" : "", setting);
    return method_parse(method, text, error);
}

static Verdict verdict_of(const char *name) {
    for (int i = 0; i < VERDICTS; i++)
        if (strcmp(verdict_name((Verdict)i), name) == 0) return (Verdict)i;
    return VERDICT_SETTLES;
}

/* What a row says is expected of one of its sides; an empty side says nothing. The verdict is the worst there was: of the
   seeds that failed, or, without a border, of all values. */
static bool check_side(Golden *golden, int row, const StabilityScan *scan, int side, Error *error) {
    const Csv *csv = &golden->csv;
    VerdictReading reading;
    Method method;
    const char *value = csv_text(csv, row, side);
    if (value[0] == '\0') return true;
    if (!method_of(golden, row, &method, error) ||
        !stability_scan_run(scan, &method, atof(value), 0, &golden->converged[scan->study - stability_studies],
                            &reading, error))
        return false;
    if (verdict_holds(reading.verdict) == (side == HOLDS_AT) &&
        reading.verdict <= verdict_of(csv_text(csv, row, VERDICT)))
        return true;
    return csv_error(csv, row, side, error, "%s, %s: %s at %s %s (frame %d, body %d, %g %s)", scan->study->name,
                     method.text, verdict_name(reading.verdict), csv_text(csv, row, PARAMETER), value, reading.frame,
                     reading.body, reading.value, reading.unit);
}

/* The studies of the scene must refuse it. */
static bool check_refusal(const Golden *golden, int row, const StabilityScan *scan, Error *error) {
    Method method;
    Error reason = {0};
    const StabilityPlace place = {scenes, scan->study->scene};
    Scene *scene = stability_scene(&place, NULL, 0, error);
    bool ok = scene != NULL && method_of(golden, row, &method, error);
    if (ok && stability_applies(&method, scene, &reason))
        ok = csv_error(&golden->csv, row, VERDICT, error, "%s, %s: it does apply", scan->study->name, method.text);
    scene_destroy(scene);
    return ok;
}

static bool check_row(void *context, int i, Error *error) {
    Golden *golden = context;
    const int row = i + 1;
    const StabilityScan scan = {stability_study_find(csv_text(&golden->csv, row, STUDY)), scenes, NULL};
    if (scan.study == NULL) return csv_error(&golden->csv, row, STUDY, error, "no such study");
    if (strcmp(csv_text(&golden->csv, row, VERDICT), STABILITY_NOT_APPLICABLE) == 0)
        return check_refusal(golden, row, &scan, error);
    return check_side(golden, row, &scan, HOLDS_AT, error) && check_side(golden, row, &scan, FAILS_AT, error);
}

static void borders_are_where_they_were(void **state) {
    (void)state;
    Error error = {0};
    Golden golden = {0};
    assert_ok(csv_read(&golden.csv, SOURCE_DIR "/golden/stability.csv", 1 << 20, 1, 1000, &error), error);
    assert_true(golden.csv.rows > 40);
    assert_true(stability_study_count <= 64);
    const ParallelWork work = {check_row, &golden};
    bool ok = parallel_for(&work, golden.csv.rows - 1, "golden", NULL, &error);
    for (size_t i = 0; i < sizeof golden.converged / sizeof golden.converged[0]; i++)
        converged_runs_free(&golden.converged[i]);
    csv_free(&golden.csv);
    assert_ok(ok, error);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(borders_are_where_they_were)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
