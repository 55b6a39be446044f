/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of subspace: what is measured, and claims judged from a made-up table. */
#include "testing.h"

#include "base/file.h"
#include "paper/paper.h"
#include "paper/paper_internal.h"
#include "studies/chart.h"

#include <math.h>

static const char *folder(void) {
    temporary_path(""); /* makes it */
    return temporary_folder;
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context, (void)piece;
    snprintf(info->name, sizeof info->name, "single");
    info->alone = true;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    (void)piece;
    return system_part_write(context, results, progress, error);
}

/* The part of the single box: the scene has two bodies that move, so one row of eight components, which lose nothing. */
static void a_scene_has_a_row_for_each_engine_and_size(void **state) {
    (void)state;
    Pieces done;
    Error error = {0};
    static const CsvLayout *const layout = &subspace_study_layout;
    const SystemStudy study = {.scenes = SOURCE_DIR "/scenes", .quick = true, .seed = 1};
    SystemWork part = {&study, &system_subspace.parts[0]};
    const PiecePlan plan = {.count = 1, .describe = describe, .work = work, .context = &part};
    assert_ok(pieces_open(&done, folder(), false, &(StudyKey){.value = 1}, NULL, &error), error);
    assert_ok(pieces_do(&done, &plan, NULL, &error), error);
    assert_ok(piece_tables_write(&done, folder(), &layout, 1, NULL, 0, &error), error);
    assert_ok(pieces_end(&done, &error), error);
    CsvTable table;
    assert_ok(csv_table_read_from(&table, folder(), &subspace_study_layout, &error), error);
    assert_int_equal(table.count, 4);
    const SubspaceStudyRow *row = subspace_study_find(table.rows, table.count, 0, "subspace:components=8"),
                           *reference = subspace_study_find(table.rows, table.count, 0, SUBSPACE_STUDY_OFFLINE);
    assert_true(row != NULL && reference != NULL);
    assert_near(row->components, 8, 0);
    assert_near(row->launches, 2, 0);
    assert_near(row->floor_rms, 0, 1e-5);
    assert_near(row->floor_near, row->frames, 0);
    assert_true(row->us_step > 0 && reference->us_step > 0);
    assert_true(row->rms > 0 && row->linear_rms > 0);
    assert_near(reference->rms, 0, 0.01); /* the recorded runs are nearly converged */
    assert_true(isnan(reference->floor_rms));
    csv_table_free(&table);
}

static const char head[] = "scene,method,components,launches,frames,us_step,rms,frames_near,floor_rms,floor_near,"
                           "linear_rms,linear_near\n";

/* A stack 400 and 200 times as fast as the converged solution; the errors are 0.05 and 2 m. */
static const char rows[] = "stack,reference,0,20,300,800,0,300,,,,\n"
                           "stack,interior:near=0.001,0,20,300,40,0,300,,,,\n"
                           "stack,engine,0,20,300,20,0.5,60,,,,\n"
                           "stack,subspace:components=8,8,20,300,2,0.05,300,0.01,300,1,10\n"
                           "stack,subspace:components=128,44,20,300,4,2,30,0.001,300,1,10\n";

static void judge(const char *text, CsvTable *claims) {
    static const PaperSystem *const systems[] = {&system_subspace, NULL};
    Error error = {0};
    char all[2000];
    snprintf(all, sizeof all, "%s%s", head, text);
    assert_ok(file_write(temporary_path("system_subspace.csv"), all, strlen(all), &error), error);
    const SystemScoreRow engine = {SYSTEM_RIVAL, "engine", 1, .launches = 1, .frames = 1};
    assert_ok(csv_table_write(temporary_path("system_scores.csv"), &system_score_layout, &engine, 1, &error), error);
    assert_ok(system_claims_write(systems, folder(), &error), error);
    assert_ok(csv_table_read_from(claims, folder(), &claim_layout, &error), error);
}

static void claims_follow_from_the_table(void **state) {
    (void)state;
    CsvTable claims;
    judge(rows, &claims);
    assert_int_equal(claims.count, 4);
    const ClaimRow *row = claims.rows;
    assert_int_equal(row[0].holds, CLAIM_PARTLY);
    assert_string_equal(row[0].figure,
                        "200 to 400 times (converged solution), 10 to 20 times (interior), 5.0 to 10 times "
                        "(engine)");
    assert_int_equal(row[1].holds, CLAIM_PARTLY);
    assert_string_equal(row[1].figure,
                        "0.05 to 2 m; the components alone lose 0.001 to 0.01 m, the engine is 0.5 to 0.5 m away");
    assert_int_equal(row[2].holds, CLAIM_PARTLY);
    assert_string_equal(row[2].figure, "0.05 to 2.00 of the linear term's, below 1 in 1 of 2 cases");
    assert_int_equal(row[3].holds, CLAIM_NO);
    assert_string_equal(row[3].figure, "40.00 to 40.00 of that with 8, below 1 in 0 of 1 scenes");
    csv_table_free(&claims);
}

/* Without networks nothing was measured, so nothing holds. */
static void an_empty_table_supports_nothing(void **state) {
    (void)state;
    CsvTable claims;
    judge("", &claims);
    for (int i = 0; i < claims.count; i++) assert_int_equal(((const ClaimRow *)claims.rows)[i].holds, CLAIM_NO);
    csv_table_free(&claims);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_scene_has_a_row_for_each_engine_and_size),
                                       cmocka_unit_test(claims_follow_from_the_table),
                                       cmocka_unit_test(an_empty_table_supports_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
