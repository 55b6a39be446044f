/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Times of different processors are not mixed: a merge refuses them, or leaves out those of others than the first. */
#include "owned.h"

#include "studies/chart.h"
#include "studies/chart_table.h"

static const char *const scenes[] = {SOURCE_DIR "/scenes/single.yaml", SOURCE_DIR "/scenes/stack.yaml"};

enum { LAUNCHES = 2, TIMES_OF_STACK = 2 * LAUNCHES + 1 };

/* What draw() sees: the chart's table is written. */
static int drawn;
static bool timed[2];

static bool draw(const SpeedAccuracyOptions *options, const SpeedAccuracyScene *summaries, uint64_t key, Error *error) {
    (void)options, (void)key, (void)error;
    drawn++;
    for (int i = 0; i < 2; i++) timed[i] = summaries[i].timed;
    return true;
}

static bool run_study(const PiecesRun *run, Error *error) {
    const SpeedAccuracyOptions options = {.scenes = scenes,
                                          .scene_count = 2,
                                          .methods = "engine:k=4,momentum:k=4",
                                          .launches = {.count = LAUNCHES},
                                          .quick = true,
                                          .folder = temporary_folder,
                                          .run = run,
                                          .draw = draw};
    Pieces pieces;
    SpeedAccuracyScene summaries[2];
    *error = (Error){0};
    return speed_accuracy_run(&options, &pieces, NULL, summaries, error);
}

static void do_shards(void) {
    Error error;
    char name[] = "twinbox chart", option[] = "--quick";
    char *argv[] = {name, option, NULL};
    temporary_path(""); /* makes the folder */
    for (int i = 1; i <= 2; i++) {
        const PiecesRun run = {.request = {.shard = {i, 2}}, .argc = 2, .argv = argv};
        assert_ok(run_study(&run, &error), error);
    }
    assert_int_equal(drawn, 0);
}

/* The times of the second scene, as another machine would have stored them. The key is in the file. */
static void change_processor(const char *cpu) {
    Error error = {0};
    size_t size;
    PieceHead head = {.number = TIMES_OF_STACK, .name = "times of stack"};
    const char *path = temporary_path("shards/0000/0000005");
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    unsigned long long key;
    assert_int_equal(fscanf(file, "twinbox piece 1\nkey %llx", &key), 1);
    fclose(file);
    head.key = key;
    FREED char *results = piece_file_read(path, &head, &size, &error);
    assert_ok(results != NULL, error);
    snprintf(head.cpu, sizeof head.cpu, "%s", cpu);
    assert_ok(piece_file_write(path, &head, results, size, &error), error);
}

TEST(times_of_other_processors_are_refused_or_left_out) {
    const PiecesRun merge = {.merge = true}, first = {.merge = true, .times_first = true};
    do_shards();
    assert_ok(run_study(&merge, &error), error);
    assert_true(drawn == 1 && timed[0] && timed[1]);
    change_processor("Other 1");
    assert_refused(run_study(&merge, &error), "shards: error: times were measured on different processors, on ");
    assert_int_equal(drawn, 1);
    assert_ok(run_study(&first, &error), error);
    assert_true(drawn == 2 && timed[0] && !timed[1]);

    OWN(CsvTable) table;
    char note[CHART_TIMES_SIZE], cpu[CPU_NAME_SIZE], wanted[CHART_TIMES_SIZE];
    cpu_name(cpu);
    assert_ok(csv_table_read(&table, temporary_path("chart.csv"), &chart_layout, &error), error);
    int with = 0, without = 0;
    for (int i = 0; i < table.count; i++) {
        const ChartRow *row = chart_row(&table, i);
        assert_int_equal(row->cpu[0] != '\0', !isnan(row->us_solver));
        if (strcmp(row->scene, "stack") == 0) {
            assert_true(isnan(row->us_solver) && isnan(row->us_solver_q1) && isnan(row->us_step));
            without += !isnan(row->error_mean);
        } else if (!isnan(row->us_solver)) {
            assert_string_equal(row->cpu, cpu);
            with++;
        }
    }
    assert_true(with >= 10 && without >= 10);
    assert_true(chart_scene_untimed(table.rows, table.count, "stack"));
    assert_false(chart_scene_untimed(table.rows, table.count, "single"));
    chart_times_note(note, table.rows, table.count);
    snprintf(wanted, sizeof wanted, "Times measured on %s. Those of other processors are left out.", cpu);
    assert_memory_equal(note, wanted, strlen(wanted)); /* then, on a busy machine, that some times vary */
}

RUN_TESTS(NULL, NULL)
