/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frame of the systems that the paper cites, tried on a system made for this test: interior with other limits. */
#include "tables.h"
#include "owned.h"

#include "paper/paper_internal.h"
#include "sanitized.h"
#include "studies/piece_tables.h"

typedef struct DoubleRow {
    double launches, error;
} DoubleRow;

static const CsvColumn columns[] = {
    {"launches", CSV_NUMBER, .offset = offsetof(DoubleRow, launches), .minimum = 1, .maximum = 100},
    {"error", CSV_NUMBER, .offset = offsetof(DoubleRow, error), .maximum = 100},
};
static const CsvLayout double_table = CSV_LAYOUT("system_double", columns, DoubleRow, .min_rows = 1, .max_rows = 10);

static int parts_written;

static bool write_part(const SystemStudy *study, int index, FILE *lines, const Progress *progress, Error *error) {
    (void)progress;
    parts_written++;
    const DoubleRow row = {index, study->quick ? 4 : 0.5 * index};
    return piece_tables_print(lines, &double_table, -1, &row, error);
}

static const SystemPart parts[] = {{"one", 1, 1, 1, write_part, false}, {"ten", 1, 1, 10, write_part, false}, {0}};

static bool claim_error(const Claims *claims, const CsvTable *table, Error *error) {
    const DoubleRow *rows = table->rows;
    const Claim claim = {"The error falls, \"always\"", "A paper, section 1", "error",
                         claim_at_most(rows[1].error, 5, 10)};
    return claim_state(claims, &claim, error, "%.3g m/s", rows[1].error);
}

/* In the scene 1. */
static const SystemScoreRow *score_of(const SystemScoreRow *rows, int count, const char *method) {
    for (int i = 0; i < count; i++)
        if (rows[i].scene == 1 && strcmp(rows[i].method, method) == 0) return &rows[i];
    fail_msg("%s has no score", method);
    return NULL;
}

static bool claim_time(const Claims *claims, const CsvTable *table, Error *error) {
    const SystemScoreRow *score = score_of(claims->scores, claims->score_count, "interior:near=0.01");
    const Claim claim = {"It is quick", "A paper, section 2", "time", claim_at_most(score->us_step, 1e9, 1e9)};
    (void)table;
    return claim_state(claims, &claim, error, "below %g s, %.1f s, %g s", 1e3, (double)NAN, -(double)NAN);
}

static ClaimRule *const claims_double[] = {claim_error, claim_time, NULL};

static const PaperSystem system_double = {.name = "double",
                                          .methods = SYSTEM_METHODS("interior:near=0.01", "interior:near=0.5"),
                                          .table = &double_table,
                                          .parts = parts,
                                          .claims = claims_double};
static const PaperSystem *const systems[] = {&system_double, NULL};

static const SystemStudy study = {.scenes = SOURCE_DIR "/scenes", .seed = 1};

static void describe(void *context, int64_t piece, PieceInfo *info) {
    (void)context;
    snprintf(info->name, sizeof info->name, "%s", parts[piece].name != NULL ? parts[piece].name : "scores");
    info->alone = true;
}

/* The parts, then the scores. */
static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    return parts[piece].name != NULL ? parts[piece].write(&study, parts[piece].index, results, progress, error)
                                     : system_scores_write(context, &(PaperPart){.index = 1}, results, progress, error);
}

/* Does the study's parts in the folder; those that are there are not done again. */
static void do_parts(Pieces *done, bool end) {
    Error error = {0};
    static const CsvLayout *const layouts[] = {&double_table, &system_score_layout};
    static const PaperSize size = {
        .system_launches = 2, .system_frames = 50, .system_timed_frames = 5, .system_repetitions = 1};
    static PaperPlan whole = {
        .size = &size, .systems = systems, .datasets.scenes = {[1] = SOURCE_DIR "/scenes/stack.yaml"}};
    const PiecePlan plan = {.count = 3, .describe = describe, .work = work, .context = &whole};
    assert_ok(pieces_open(done, folder(), &(StudyKey){.value = 1}, NULL, &error), error);
    assert_ok(pieces_do(done, &plan, NULL, &error), error);
    assert_ok(piece_tables_write(done, folder(), layouts, 2, NULL, 0, &error), error);
    if (end) assert_ok(pieces_end(done, &error), error);
}

static void write_study(void) {
    Pieces done;
    do_parts(&done, false);
}

TEST(parts_and_scores_are_done_once) {
    remove_temporary_folder();
    temporary_folder[0] = '\0';
    parts_written = 0;
    Pieces done;
    do_parts(&done, false);
    assert_int_equal(parts_written, 2);
    OWN(CsvTable) first, again;
    assert_ok(csv_table_read_from(&first, folder(), &system_score_layout, &error), error);
    do_parts(&done, true); /* as after an interruption */
    assert_int_equal(parts_written, 2);
    assert_ok(csv_table_read_from(&again, folder(), &system_score_layout, &error), error);
    assert_int_equal(first.count, again.count);
    for (int i = 0; i < first.count; i++) {
        const SystemScoreRow *a = first.rows, *b = again.rows;
        assert_near(b[i].us_step, a[i].us_step, 0); /* the same measurement, not another */
    }
}

static const SystemScoreRow *score(const CsvTable *scores, const char *method) {
    return score_of(scores->rows, scores->count, method);
}

TEST(scores_are_those_of_runs_beside_the_engine_s) {
    OWN(CsvTable) scores;
    write_study();
    assert_ok(csv_table_read_from(&scores, folder(), &system_score_layout, &error), error);
    assert_int_equal(scores.count, 5); /* engine, momentum, interior, the system, its ablation */
    const SystemScoreRow *engine = score(&scores, "engine"), *net = score(&scores, "interior:near=0.01");
    assert_string_equal(engine->system, SYSTEM_RIVAL);
    assert_string_equal(net->system, "double");
    assert_near(engine->frames_engine, 50, 0); /* never apart from itself */
    assert_true(engine->frames_converged < 50 && net->frames_engine < 50);
    assert_near(net->launches, 2, 0);
    assert_near(engine->momentum_error, 0, 0);
    assert_near(engine->fallback_share, 0, 0);
    assert_true(net->fallback_share >= 0 && net->fallback_share <= 1);
    assert_true(net->us_step > 0 && net->us_step_engine > 0);
}

TEST(claims_follow_from_tables_and_scores) {
    OWN(CsvTable) claims;
    write_study();
    assert_ok(system_claims_write(systems, folder(), &error), error);
    assert_ok(csv_table_read_from(&claims, folder(), &claim_layout, &error), error);
    assert_int_equal(claims.count, 2);
    const ClaimRow *rows = claims.rows;
    assert_string_equal(rows[0].system, "double");
    assert_string_equal(rows[0].claim, "The error falls, \"always\"");
    assert_string_equal(rows[0].figure, "5 m/s"); /* half of ten launches */
    assert_int_equal(rows[0].holds, CLAIM_YES);
    assert_string_equal(rows[1].figure, "below 1000 s, – s, – s");
}

TEST(rules_have_two_limits) {
    static const double least[] = {3, 2.9, 1.9, (double)NAN}, most[] = {3, 4, 4.1, (double)NAN};
    static const ClaimHolds holds[] = {CLAIM_YES, CLAIM_PARTLY, CLAIM_NO, CLAIM_NO};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(claim_at_least(least[i], 3, 2), holds[i]);
        assert_int_equal(claim_at_most(most[i], 3, 4), holds[i]);
        assert_int_equal(claim_in_cases(i, 3), i == 0 ? CLAIM_NO : i == 3 ? CLAIM_YES : CLAIM_PARTLY);
    }
    assert_int_equal(claim_in_cases(0, 0), CLAIM_NO);
}

static void refuse(const char *message) {
    Error error = {0};
    assert_refused(system_claims_write(systems, folder(), &error), message);
}

TEST(damaged_tables_are_refused) {
    write_study();
    write_text("system_double.csv", "launches,error\n1,0.5\n10,-5\n");
    refuse("system_double.csv:3:4: error: ");
    write_text("system_double.csv", "launches,error\n");
    refuse("system_double.csv");
    write_text("system_scores.csv", "system,method\nrival,engine\n");
    refuse("system_scores.csv:1:1: error: ");
    assert_int_equal(unlink(temporary_path("system_scores.csv")), 0);
    refuse("system_scores.csv");
}

/* What the table could not hold is refused when it is written. */
TEST(a_text_that_cannot_be_read_back_is_refused) {
    char text[CLAIM_TEXT_SIZE + 2];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    FILE *lines = fopen("/dev/null", "w");
    assert_non_null(lines);
    const Claims claims = {.system = "double", .lines = lines};
    const Claim fits = {text + 1, "source", "measured", CLAIM_NO}, beyond = {text, "source", "measured", CLAIM_NO},
                empty = {"", "source", "measured", CLAIM_NO};
    assert_ok(claim_state(&claims, &fits, &error, "%d", 1), error);
    assert_refused(claim_state(&claims, &beyond, &error, "%d", 1), "double: error: ");
    error = (Error){0};
    assert_false(claim_state(&claims, &empty, &error, "%d", 1));
    error = (Error){0};
    assert_false(claim_state(&claims, &fits, &error, "%s", text));
    assert_int_equal(fclose(lines), 0);
}

static bool stop(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    return false;
}

TEST(strips_are_refused_or_stopped) {
    const Progress progress = {stop, NULL};
    assert_false(system_strips_draw(systems, SOURCE_DIR "/scenes", true, folder(), &progress, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped");
    assert_refused(system_strips_draw(systems, "/nowhere", true, folder(), NULL, &error), "/nowhere/stack.yaml");
}

/* The engine and the system, in this order. Not under sanitizers: in a process with the threads of OpenMP and of Mesa,
   the search for leaks crashes in one of a hundred runs. They watch strips and pages in other tests. */
TEST(a_page_plays_the_runs_of_the_strips) {
#ifdef SANITIZED
    skip();
#endif
    assert_ok(system_strips_draw(systems, SOURCE_DIR "/scenes", true, folder(), NULL, &error), error);
    for (int i = 0; i < STRIP_SCENES; i++) {
        char name[64];
        snprintf(name, sizeof name, "strip-%s.html", strip_scene_names[i]);
        char *page = text_of(temporary_path(name));
        const char *engine = strstr(page, "\"method\": \"engine\""),
                   *own = strstr(page, "\"method\": \"interior:near=0.01\"");
        assert_true(engine != NULL && own != NULL && engine < own);
        free(page);
        snprintf(name, sizeof name, "strip-double-%s.png", strip_scene_names[i]);
        assert_int_equal(access(temporary_path(name), R_OK), 0);
    }
}

RUN_TESTS(NULL, NULL)
