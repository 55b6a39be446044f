/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of rates and of closed loops: a row for each network, definition and phase, the same by one thread and by
   three, but for times. */
#include "testing.h"

#include "paper/paper_internal.h"

#include <omp.h>

enum { NETWORKS = 2, TABLE_SIZE = 1 << 14 };

static PaperNetwork networks[NETWORKS] = {{.name = "pair-net", .target = TARGET_PAIR},
                                          {.name = "contact-net", .target = TARGET_POINTS}};
static const PaperOptions options = {.seed = 1};
static const PaperSize size = {.scored_splits = 1,
                               .rate_launches = 3,
                               .closed_launches = 2,
                               .sampling = {.after = 30, .rest = 200},
                               .repetitions = 1};
static PaperPlan plan = {.size = &size,
                         .options = &options,
                         .datasets.scenes = {SOURCE_DIR "/scenes/single.yaml"},
                         .networks = networks,
                         .network_count = NETWORKS};

static void write_table(PaperWrite *write, int threads, char table[TABLE_SIZE]) {
    Error error = {0};
    const int before = omp_get_max_threads();
    FILE *lines = fmemopen(table, TABLE_SIZE, "w");
    assert_non_null(lines);
    omp_set_num_threads(threads);
    assert_ok(write(&plan, &(PaperPart){.index = 0}, lines, NULL, &error), error);
    omp_set_num_threads(before);
    assert_int_equal(fclose(lines), 0);
}

/* Ends each line before its two times. */
static void cut_times(char *table) {
    char *to = table;
    for (char *line = strtok(table, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        for (int i = 0; i < 2; i++) *strrchr(line, ',') = '\0';
        size_t length = strlen(line);
        memmove(to, line, length);
        to += length;
        *to++ = '\n';
    }
    *to = '\0';
}

static int count_lines(const char *table, const char *beginning) {
    int count = 0;
    for (const char *at = strstr(table, beginning); at != NULL; at = strstr(at + 1, beginning)) count++;
    return count;
}

TEST(threads_rate_alike) {
    char one[TABLE_SIZE], three[TABLE_SIZE];
    write_table(paper_rates_write, 1, one);
    write_table(paper_rates_write, 3, three);
    assert_string_equal(one, three);
    for (int i = 0; i < NETWORKS + 1; i++) {
        const char *beginning =
            printed("rates:%s,single,", i < NETWORKS ? printed("%s,1", networks[i].name) : "warm-start,");
        assert_int_equal(count_lines(one, beginning), RATE_DEFINITIONS * RATE_PHASES);
    }
}

TEST(threads_close_the_loop_alike) {
    char one[TABLE_SIZE], three[TABLE_SIZE];
    write_table(paper_closed_loop_write, 1, one);
    write_table(paper_closed_loop_write, 3, three);
    cut_times(one);
    cut_times(three);
    assert_string_equal(one, three);
    assert_int_equal(count_lines(one, "closed_loop:pair-net,1,single,"), 1);
    assert_int_equal(count_lines(one, "closed_loop:contact-net,1,single,"), 1);
    assert_int_equal(count_lines(one, "closed_loop:engine:k=10,,single,"), 1);
    assert_int_equal(count_lines(one, "closed_loop:engine:k=100,,single,"), 1);
    assert_int_equal(count_lines(one, "closed_loop:interior,,single,600,"), 1); /* one box has no chaos */
}

/* A thread that has yet to be created would be too late for the few pieces. */
FIXTURE(start_threads) {
    int running = 0;
#pragma omp parallel num_threads(3) reduction(+ : running)
    running++;
    assert_true(running > 0);
    /* Two shipped networks stand for those of split 1. */
    strcpy(plan.networks_folder, temporary_path("."));
    for (int i = 0; i < NETWORKS; i++)
        assert_int_equal(symlink(printed("%s/scenes/networks/%s.npz", SOURCE_DIR, networks[i].name),
                                 temporary_path(printed("%s-1.npz", networks[i].name))),
                         0);
}

RUN_TESTS(start_threads, NULL)
