/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CSV files: launches, the tables of charts and studies, runs. */
#include "fuzz.h"

#include "paper/paper_tables.h"
#include "runs/compare_runs.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/equal_time.h"
#include "studies/stability.h"

#include <math.h>
#include <string.h>

static void check_launches(const LaunchTable *table) {
    static BodyDef ground = {.size = {10, 1}, .fixed = true};
    const Scene scene = {.name = "fuzz",
                         .dt = 1.0F / 60,
                         .frames = 100,
                         .body_count = 1,
                         .bodies = &ground,
                         .bomb = {.present = true, .frame = 2, .size = {1, 1}, .mass.value = 1}};
    static Launch launches[LAUNCHES_MAX];
    Error error = {0};
    if (table->count < 1 || table->count > LAUNCHES_MAX) fuzz_fail("%d launches", table->count);
    const bool ok = launches_for(table, &scene, launches, &error);
    if (!ok && error.kind != ERROR_INPUT) fuzz_fail("%s", error.message);
    for (int i = 0; ok && i < table->count; i++)
        if (!(isfinite(launches[i].x) && isfinite(launches[i].rotation) && isfinite(launches[i].spin) &&
              (launches[i].mass > 0 || table->csv.fields[3] < 0)))
            fuzz_fail("launch %d is not possible", i + 1);
}

void fuzz_launches(const uint8_t *data, size_t size) {
    LaunchTable table;
    Error error = {0};
    const char *path = fuzz_file("launches.csv", data, size);
    const bool ok = FUZZ_READ(launches_read(&table, path, &error), path);
    if (!ok) return;
    check_launches(&table);
    launches_free(&table);
}

/* What was read can be written, and the same rows are read again. */
static void check_table(const CsvTable *table, const CsvLayout *layout) {
    CsvTable again;
    Error error = {0};
    const char *path = fuzz_file("again.csv", "", 0);
    if (!csv_table_write(path, layout, table->rows, table->count, &error) ||
        !csv_table_read(&again, path, layout, &error))
        fuzz_fail("rows that were read are lost: %s", error.message);
    if (again.count != table->count) fuzz_fail("%d rows become %d", table->count, again.count);
    csv_table_free(&again);
}

/* The first byte chooses the table: 'a' is a chart. */
void fuzz_tables(const uint8_t *data, size_t size) {
    static const CsvLayout *const layouts[] = {&chart_layout,       &map_layout,
                                               &border_layout,      &refusal_layout,
                                               &rest_layout,        &fallback_layout,
                                               &equal_time_layout,  &equal_methods_layout,
                                               &paper_score_layout, &paper_trained_layout,
                                               &paper_rate_layout,  &paper_closed_loop_layout,
                                               &paper_law_layout,   &paper_transfer_layout,
                                               &paper_fact_layout,  &system_score_layout,
                                               &unconverged_layout};
    enum { LAYOUTS = sizeof layouts / sizeof *layouts };
    if (size == 0 || data[0] < 'a' || data[0] >= 'a' + LAYOUTS) return;
    const CsvLayout *layout = layouts[data[0] - 'a'];
    const char *path = fuzz_file("table.csv", data + 1, size - 1);
    CsvTable table;
    Error error = {0};
    const bool ok = FUZZ_READ(csv_table_read(&table, path, layout, &error), path);
    if (!ok) return;
    check_table(&table, layout);
    csv_table_free(&table);
}

static bool same_bits(const void *a, const void *b, size_t size) { return size == 0 || memcmp(a, b, size) == 0; }

/* A run is written to CSV and read back bit by bit. */
static void check_run(const Trajectory *run) {
    Error error = {0};
    CsvRunNotes notes = {0};
    const char *path = fuzz_file("again.csv", "", 0);
    if (!csv_run_write(run, path, &error)) fuzz_fail("a run cannot be written: %s", error.message);
    Trajectory *again = csv_run_read(path, &(CsvRunOptions){.name = "again"}, &notes, &error);
    if (again == NULL) fuzz_fail("a run that was read is lost: %s", error.message);
    const size_t states = (size_t)run->frames * (size_t)run->bodies;
    if (again->frames != run->frames || again->bodies != run->bodies || again->dt != run->dt ||
        again->bomb != run->bomb || strcmp(again->scene, run->scene) != 0 || strcmp(again->method, run->method) != 0 ||
        !same_bits(again->position, run->position, states * sizeof *run->position) ||
        !same_bits(again->angle, run->angle, states * sizeof *run->angle) ||
        !same_bits(again->size, run->size, (size_t)run->bodies * sizeof *run->size) ||
        !same_bits(again->fixed, run->fixed, (size_t)run->bodies))
        fuzz_fail("a run changes when it is written and read");
    trajectory_destroy(again);
}

/* A trace is equal to itself. */
static void check_trace(const Trajectory *run) {
    TrajectoryDifference difference;
    trajectory_compare(run, run, &difference);
    if (!difference.equal) fuzz_fail("a trace is not equal to itself");
}

/* Options: bit 0 degrees, bit 1 a dt, bit 2 sizes, which begin behind a NUL; bit 3 as a trace. */
static Trajectory *read_run(const uint8_t *data, size_t size, const char **path, Error *error) {
    const unsigned choice = data[0];
    const uint8_t *text = data + 1, *end = memchr(text, '\0', size - 1);
    const size_t length = end == NULL || (choice & 4) == 0 ? size - 1 : (size_t)(end - text);
    const size_t rest = length < size - 1 ? size - 2 - length : 0;
    CsvRunOptions options = {.name = "fuzz",
                             .degrees = (choice & 1) != 0,
                             .dt = (choice & 2) != 0 ? 0.01F : 0,
                             .as_trace = (choice & 8) != 0};
    CsvRunNotes notes = {0};
    *path = fuzz_file("run.csv", text, length);
    if ((choice & 4) != 0) options.sizes = fuzz_file("sizes.csv", text + size - 1 - rest, rest);
    fuzz_begin();
    Trajectory *run = csv_run_read(*path, &options, &notes, error);
    if (run == NULL && options.sizes != NULL && strncmp(error->message, options.sizes, strlen(options.sizes)) == 0)
        *path = options.sizes;
    return run;
}

void fuzz_csv_run(const uint8_t *data, size_t size) {
    const char *path;
    Error error = {0};
    if (size == 0) return;
    Trajectory *run = read_run(data, size, &path, &error);
    fuzz_end(run != NULL, &error, path);
    if (run != NULL) (run->there != NULL ? check_trace : check_run)(run);
    trajectory_destroy(run);
}
