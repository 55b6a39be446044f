/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of subspace: what is measured, and claims judged from a made-up table. */
#include "tables.h"

#include "paper/paper_internal.h"
#include "studies/piece_tables.h"

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context, (void)piece;
    snprintf(info->name, sizeof info->name, "single");
    info->alone = true;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const SystemStudy *study = context;
    const SystemPart *part = &system_subspace.parts[piece];
    return part->write(study, part->index, results, progress, error);
}

/* The part of the single box: the scene has two bodies that move, so one row of eight components, which lose
   nothing. */
TEST(a_scene_has_a_row_for_each_engine_and_size) {
    Pieces done;
    static const CsvLayout *const layout = &subspace_study_layout;
    SystemStudy study = {.scenes = SOURCE_DIR "/scenes", .quick = true, .seed = 1};
    const PiecePlan plan = {.count = 1, .describe = describe, .work = work, .context = &study};
    assert_ok(pieces_open(&done, folder(), &(StudyKey){.value = 1}, NULL, &error), error);
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

#define HEAD \
    "scene,method,components,launches,frames,us_step,rms,frames_near,floor_rms,floor_near,linear_rms,linear_near\n"

/* A stack 400 and 200 times as fast as the converged solution; the errors are 0.05 and 2 m. */
TEST(claims_follow_from_the_table) {
    static const char *const figures[] = {
        "\"200 to 400 times (converged solution), 10 to 20 times (interior), 5.0 to 10 times (engine)\"",
        "\"0.05 to 2 m; the components alone lose 0.001 to 0.01 m, the engine is 0.5 to 0.5 m away\"",
        "\"0.05 to 2.00 of the linear term's, below 1 in 1 of 2 cases\"",
        "\"40.00 to 40.00 of that with 8, below 1 in 0 of 1 scenes\""};
    write_text("system_subspace.csv", HEAD "stack,reference,0,20,300,800,0,300,,,,\n"
                                           "stack,interior:near=0.001,0,20,300,40,0,300,,,,\n"
                                           "stack,engine,0,20,300,20,0.5,60,,,,\n"
                                           "stack,subspace:components=8,8,20,300,2,0.05,300,0.01,300,1,10\n"
                                           "stack,subspace:components=128,44,20,300,4,2,30,0.001,300,1,10\n");
    expect_verdicts(&system_subspace, "partly partly partly no");
    for (int i = 0; i < 4; i++) assert_non_null(strstr(claims_of(&system_subspace), figures[i]));
    /* Without networks nothing was measured, so nothing holds. */
    write_text("system_subspace.csv", HEAD);
    expect_verdicts(&system_subspace, "no no no no");
}

RUN_TESTS(NULL, NULL)
