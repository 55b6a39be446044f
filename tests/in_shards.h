/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces of a plan, done by shards in one process. Include it after testing.h. */
#pragma once
#include "runs/pieces.h"

/* Does the plan in `count` shards beside the file `output`, the last first, and opens their pieces as a merge does. */
static inline void in_shards(Pieces *merged, const PiecePlan *plan, const char *output, int count) {
    static char command[] = "twinbox test", option[] = "--shards", *arguments[] = {command, option};
    static PiecesRun run; /* pieces keep its address */
    const StudyKey key = {.value = 17};
    Error error = {0};
    for (int shard = count; shard >= 0; shard--) {
        run = (PiecesRun){.request = {.shard = {shard, count}}, .merge = shard == 0, .argc = 2, .argv = arguments};
        assert_ok(pieces_open(merged, output, true, &key, &run, &error), error);
        assert_ok(pieces_do(merged, plan, NULL, &error), error);
    }
    assert_int_equal(merged->mode, PIECES_MERGE);
}
