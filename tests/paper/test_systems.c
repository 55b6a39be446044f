/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of the systems that the paper cites: on short launches of the single box. */
#include "tables.h"
#include "owned.h"

#include "paper/paper_internal.h"
#include "studies/piece_tables.h"

static const PaperSize size = {
    .system_launches = 2, .system_frames = 50, .system_timed_frames = 5, .system_repetitions = 1};

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context, (void)piece;
    snprintf(info->name, sizeof info->name, "scores");
    info->alone = true;
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    return system_scores_write(context, &(PaperPart){.index = (int)piece}, results, progress, error);
}

static void score(CsvTable *scores, bool end) {
    Error error = {0};
    Pieces done;
    static PaperPlan whole = {.size = &size, .datasets.scenes = {SOURCE_DIR "/scenes/single.yaml"}};
    static const CsvLayout *const layouts[] = {&system_score_layout};
    const PiecePlan plan = {.count = 1, .describe = describe, .work = work, .context = &whole};
    assert_ok(pieces_open(&done, folder(), &(StudyKey){.value = 1}, &(Shard){0}, &error), error);
    assert_ok(pieces_do(&done, &plan, NULL, &error), error);
    assert_ok(piece_tables_write(&done, folder(), layouts, 1, NULL, 0, &error), error);
    if (end) assert_ok(pieces_end(&done, &error), error);
    assert_ok(csv_table_read_from(scores, folder(), &system_score_layout, &error), error);
}

static const SystemScoreRow *score_of(const CsvTable *scores, const char *method) {
    const SystemScoreRow *rows = scores->rows;
    for (int i = 0; i < scores->count; i++)
        if (strcmp(rows[i].method, method) == 0) return &rows[i];
    fail_msg("%s has no score", method);
    return NULL;
}

TEST(scores_are_those_of_runs_beside_the_engine_s) {
    OWN(CsvTable) first, again;
    score(&first, false);
    assert_int_equal(first.count, 14);
    const SystemScoreRow *engine = score_of(&first, "engine"), *sain = score_of(&first, "sain"),
                         *hybrid = score_of(&first, "hybrid");
    assert_string_equal(engine->system, "rival");
    assert_string_equal(sain->system, "sain");
    assert_near(sain->launches, 2, 0);
    assert_near(engine->frames_engine, 50, 0); /* never apart from itself */
    assert_near(engine->momentum_error, 0, 0);
    assert_near(engine->fallback_share, 0, 0);
    assert_near(hybrid->momentum_error, 0, 0); /* impulses are equal and opposite; sain's changes of velocity are not */
    assert_true(sain->momentum_error > 0);
    const SystemScoreRow *rows = first.rows;
    for (int i = 0; i < first.count; i++) {
        assert_true(rows[i].frames_engine >= 1 && rows[i].frames_engine <= 50 && rows[i].energy_created >= 0);
        assert_true(rows[i].us_step > 0 && rows[i].us_step_engine > 0);
    }
    /* A study that continues keeps what was measured, and does not measure anew. */
    score(&again, true);
    assert_int_equal(first.count, again.count);
    for (int i = 0; i < first.count; i++)
        assert_near(((const SystemScoreRow *)again.rows)[i].us_step, rows[i].us_step, 0);
}

RUN_TESTS(NULL, NULL)
