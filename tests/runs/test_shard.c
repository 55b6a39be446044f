/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "runs/runs_internal.h"

TEST(every_piece_has_one_shard_and_shards_are_equally_large) {
    enum { MOST = 300 };
    for (int64_t pieces = 1; pieces < MOST; pieces += 7)
        for (int shards = 1; shards < 40; shards += 3) {
            int counts[40] = {0}, least = MOST, most = 0;
            for (int64_t i = 0; i < pieces; i++) {
                const int shard = shard_of(i, pieces, shards);
                assert_in_range(shard, 1, shards);
                counts[shard - 1]++;
            }
            for (int s = 0; s < shards; s++) {
                least = counts[s] < least ? counts[s] : least;
                most = counts[s] > most ? counts[s] : most;
            }
            assert_true(most - least <= 1);
        }
}

/* The last column of a map of ten columns is the slowest; no shard may have all of them. */
TEST(a_regular_pattern_is_spread) {
    const int64_t pieces = 400;
    int slow[10] = {0};
    for (int64_t i = 9; i < pieces; i += 10) slow[shard_of(i, pieces, 10) - 1]++;
    for (int s = 0; s < 10; s++) assert_in_range(slow[s], 1, 10);
}

/* Few shards keep together what shares work; many divide it. Times stay together in any case. */
TEST(pieces_that_share_work_are_divided_by_many_shards) {
    enum { FIRST = 40, COUNT = 20, PIECES = 400 };
    for (int shards = 1; shards <= 2 * PIECES_NEAR_SHARDS; shards++) {
        int others = 0;
        for (int64_t i = FIRST; i < FIRST + COUNT; i++) {
            const PieceInfo sharing = {.with = i, .near = FIRST}, timed = {.with = FIRST, .near = -1};
            others += piece_shard(&sharing, PIECES, shards) != shard_of(FIRST, PIECES, shards);
            assert_int_equal(piece_shard(&timed, PIECES, shards), shard_of(FIRST, PIECES, shards));
        }
        assert_true((others > COUNT / 2) == (shards > PIECES_NEAR_SHARDS));
    }
}

TEST(large_studies_do_not_overflow) {
    const int64_t pieces = PIECES_MAX;
    assert_in_range(shard_of(pieces - 1, pieces, SHARDS_MAX), 1, SHARDS_MAX);
    assert_int_equal(shard_of(0, pieces, SHARDS_MAX), 1);
}

TEST(a_share_is_read) {
    Shard shard;
    assert_ok(shard_parse(&shard, "3/16", &error), error);
    assert_int_equal(shard.number, 3);
    assert_int_equal(shard.count, 16);
}

static const char *const variables[] = {"SLURM_ARRAY_TASK_ID",
                                        "SLURM_ARRAY_TASK_MIN",
                                        "SLURM_ARRAY_TASK_MAX",
                                        "SLURM_ARRAY_TASK_STEP",
                                        "PMI_RANK",
                                        "PMI_SIZE",
                                        "OMPI_COMM_WORLD_RANK",
                                        "OMPI_COMM_WORLD_SIZE",
                                        "SLURM_PROCID",
                                        "SLURM_NTASKS"};

/* values: of the variables, in their order; NULL: not set. */
static bool request(ShardRequest *request, const char *const values[10], const char *option, Error *error) {
    for (size_t i = 0; i < 10; i++)
        if (values[i] != NULL)
            setenv(variables[i], values[i], 1);
        else
            unsetenv(variables[i]);
    return shard_request(request, option, error);
}

TEST(the_environment_says_which_share) {
    static const struct {
        const char *values[10];
        const char *option;
        int number, count, step;
    } rows[] = {
        {{NULL}, NULL, 1, 1, 0},
        {{"7", "3", "19", "4"}, NULL, 2, 5, 4},
        {{"7", "3", "19", "4", "0", "1"}, NULL, 2, 5, 4},
        {{"0", "0", "15", "1", NULL, NULL, NULL, NULL, "0", "4"}, NULL, 1, 16, 1},
        {{"5"}, NULL, 1, 1, 1},
        {{NULL, NULL, NULL, NULL, "2", "4", "1", "8"}, NULL, 3, 4, 0},
        {{NULL, NULL, NULL, NULL, NULL, NULL, "1", "8", "5", "6"}, NULL, 2, 8, 0},
        {{NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, "5", "6"}, NULL, 6, 6, 0},
        {{NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, "6"}, NULL, 1, 1, 0},
        {{"7", "3", "19", "4", "2", "4"}, "1/1", 1, 1, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ShardRequest found;
        assert_ok(request(&found, rows[i].values, rows[i].option, &error), error);
        assert_int_equal(found.shard.number, rows[i].number);
        assert_int_equal(found.shard.count, rows[i].count);
        assert_int_equal(found.array.step, rows[i].step);
        assert_true((found.source[0] != '\0') == (rows[i].option == NULL && (rows[i].count > 1 || rows[i].step > 0)));
    }
}

TEST(an_environment_that_contradicts_itself_is_refused) {
    static const struct {
        const char *values[10], *message;
    } rows[] = {{{"x"}, "SLURM_ARRAY_TASK_ID: error: 'x' in the environment"},
                {{"3", "4", "9", "1"}, "SLURM_ARRAY_TASK_MIN"},
                {{"3", "1", "2", "1"}, "SLURM_ARRAY_TASK_MAX"},
                {{"3", "1", "9", "0"}, "SLURM_ARRAY_TASK_STEP"},
                {{"3", "0", "2147483647", "1"}, "at most 1000000"},
                {{"3", "1", "9", "1", "0", "2"}, "of 2 ranks (PMI_RANK)"},
                {{NULL, NULL, NULL, NULL, "4", "4"}, "PMI_RANK"},
                {{NULL, NULL, NULL, NULL, "0", "0"}, "PMI_SIZE"},
                {{NULL, NULL, NULL, NULL, NULL, NULL, "-1", "4"}, "OMPI_COMM_WORLD_RANK"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ShardRequest found;
        assert_refused(request(&found, rows[i].values, NULL, &error), rows[i].message);
    }
}

TEST(a_list_of_shards_is_what_sbatch_takes) {
    static const struct {
        const char *shards, *list;
        JobArray array;
    } rows[] = {{"1", "1", {0}},
                {"0010000000000000100", "3,17", {0}},
                {"111", "1-3", {0}},
                {"1101", "1-2,4", {0}},
                {"0110", "1-2", {.first = 0, .step = 1}},
                {"0101110", "12,16-20:2", {.first = 10, .step = 2}}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        unsigned char shards[32] = {0};
        const int count = (int)strlen(rows[i].shards);
        for (int s = 0; s < count; s++) shards[s] = rows[i].shards[s] == '1';
        FREED char *list = pieces_shard_list(shards, count, &rows[i].array);
        assert_string_equal(list, rows[i].list);
    }
}

RUN_TESTS(NULL, NULL)
