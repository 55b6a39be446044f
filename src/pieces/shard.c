/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/shard.h"

#include "common/parse.h"

#include <stdio.h>
#include <string.h>

bool shard_parse(Shard *shard, const char *text, Error *error) {
    char number[16];
    int64_t values[2];
    const size_t length = strcspn(text, "/");
    if (length >= sizeof number || text[length] != '/')
        return error_input(error, "--shard", "'%s' is not I/N, such as 3/16", text);
    snprintf(number, sizeof number, "%.*s", (int)length, text);
    if (!parse_int(number, 0, INT32_MAX, &values[0]) || !parse_int(text + length + 1, 0, INT32_MAX, &values[1]))
        return error_input(error, "--shard", "'%s' is not I/N, such as 3/16", text);
    if (values[1] < 1 || values[1] > SHARDS_MAX)
        return error_input(error, "--shard", "'%s': N must be from 1 to %d", text, SHARDS_MAX);
    if (values[0] < 1 || values[0] > values[1])
        return error_input(error, "--shard", "'%s': I must be from 1 to N", text);
    *shard = (Shard){(int)values[0], (int)values[1]};
    return true;
}

static int64_t greatest_common_divisor(int64_t a, int64_t b) {
    while (b != 0) {
        const int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* Pieces are put in an order that a step coprime to their number gives, and this order is cut into shards. The step is near
   the golden section, which no regular pattern of long and short pieces meets again and again. */
int shard_of(int64_t piece, int64_t pieces, int shards) {
    const double golden = 0.6180339887498949;
    if (shards <= 1 || pieces <= 1) return 1;
    int64_t step = (int64_t)((double)pieces * golden);
    if (step < 1) step = 1;
    while (greatest_common_divisor(step, pieces) != 1) step++;
    const int64_t place = piece * step % pieces; /* within 64 bits: PIECES_MAX */
    return (int)(place * shards / pieces) + 1;
}
