/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both sides of every border in golden/stability.csv (made by golden/renew): each method still holds at holds_at and
   fails at fails_at. */
#include "owned.h"
#include "sanitized.h"

#include "base/machine.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

static const char scenes[] = SOURCE_DIR "/scenes";

typedef struct Golden {
    CsvTable table;
    ConvergedRuns converged[64]; /* of each study */
} Golden;

static bool method_of(const BorderRow *row, Method *method, Error *error) {
    return method_parse(method, printed("%s%s%s", row->method, row->setting[0] != '\0' ? ":" : "", row->setting),
                        error);
}

/* One side of a row; a side without a value is not checked. The row's verdict is the worst: of the failing seeds or,
   without a border, of all values. */
static bool check_side(Golden *golden, int i, const StabilityScan *scan, bool holds, Error *error) {
    const BorderRow *row = border_row(&golden->table, i);
    const double value = holds ? row->holds_at : row->fails_at;
    VerdictReading reading;
    Method method;
    if (isnan(value)) return true;
    if (!method_of(row, &method, error) ||
        !stability_scan_run(scan, &method, value, 0, &golden->converged[scan->study - stability_studies], &reading,
                            &(const ConvergedRun *){NULL}, error))
        return false;
    if (verdict_holds(reading.verdict) == holds && (int)reading.verdict <= row->verdict) return true;
    return csv_table_error(&golden->table, i, 0, error, "%s, %s: %s at %s %g (frame %d, body %d, %g %s)", row->study,
                           method.text, verdict_name(reading.verdict), row->parameter, value, reading.frame,
                           reading.body, reading.value, reading.unit);
}

static bool check_refusal(const Golden *golden, int i, const StabilityScan *scan, Error *error) {
    Method method;
    Error reason = {0};
    const StabilityPlace place = {.scenes = scenes, .scene = scan->study->scene};
    OWN(Scene) *scene = stability_scene(&place, NULL, 0, error);
    bool ok = scene != NULL && method_of(border_row(&golden->table, i), &method, error);
    if (ok && stability_applies(&method, scene, &reason))
        ok = csv_table_error(&golden->table, i, 0, error, "%s, %s: it does apply", scan->study->name, method.text);
    return ok;
}

static bool check_row(void *context, int i, Error *error) {
    Golden *golden = context;
    const BorderRow *row = border_row(&golden->table, i);
    if (i % sampled(4) != 0) return true;
    const StabilityScan scan = {stability_study_find(row->study), scenes, NULL};
    if (scan.study == NULL) return csv_table_error(&golden->table, i, 0, error, "no such study");
    if (row->verdict == CELL_NOT_APPLICABLE) return check_refusal(golden, i, &scan, error);
    return check_side(golden, i, &scan, true, error) && check_side(golden, i, &scan, false, error);
}

TEST(borders_are_where_they_were) {
    Golden golden = {0};
    assert_ok(csv_table_read_from(&golden.table, SOURCE_DIR "/golden", &border_layout, &error), error);
    assert_true(golden.table.count >= 40);
    assert_true(stability_study_count <= 64);
    const ParallelWork work = {check_row, &golden};
    bool ok = parallel_for(&work, golden.table.count, "golden", NULL, &error);
    for (size_t i = 0; i < sizeof golden.converged / sizeof golden.converged[0]; i++)
        converged_runs_free(&golden.converged[i]);
    csv_table_free(&golden.table);
    assert_ok(ok, error);
}

RUN_TESTS(NULL, NULL)
