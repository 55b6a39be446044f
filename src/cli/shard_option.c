/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/shard_option.h"

#include "cli/notes.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is given to shard_option_take() by the merge. */
static const PiecesRun *merging;

void shard_option_merge(const PiecesRun *run) { merging = run; }

bool shard_option_is_merge(void) { return merging != NULL; }

/* The arguments that all shards have: without --shard, whose value differs. They last as long as the program. */
static bool keep_arguments(PiecesRun *run, int argc, char **argv, Error *error) {
    static char **kept;
    free(kept);
    kept = calloc((size_t)argc + 1, sizeof *kept);
    if (kept == NULL) return error_memory(error, argv[0]);
    run->argv = kept;
    for (int i = 0; i < argc; i++) {
        if (strncmp(argv[i], "--sha", strlen("--sha")) != 0)
            kept[run->argc++] = argv[i];
        else if (strchr(argv[i], '=') == NULL)
            i++;
    }
    return true;
}

bool shard_option_take(PiecesRun *run, const char *option, int argc, char **argv, Error *error) {
    *run = (PiecesRun){0};
    if (merging != NULL) {
        *run = *merging;
        return true;
    }
    if (!shard_request(&run->request, option, error) || !keep_arguments(run, argc, argv, error)) return false;
    if (run->request.source[0] != '\0')
        note_print("shard %d of %d, by %s; --shard 1/1 does all", run->request.shard.number, run->request.shard.count,
                   run->request.source);
    return true;
}

void shard_option_print(const Pieces *pieces, const char *output) {
    printf("shard %d of %d: %" PRId64 " pieces, %" PRId64 " of them done before -> %s\n", pieces->shard.number,
           pieces->shard.count, pieces->own - pieces->waiting, pieces->kept, pieces->folder);
    if (pieces->waiting > 0)
        printf("    %" PRId64 " more need pieces of other shards: run this shard again when those are done\n",
               pieces->waiting);
    printf("    when all shards are done: twinbox merge %s\n", output);
}
