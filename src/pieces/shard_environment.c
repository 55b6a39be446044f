/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What schedulers tell a process about its share. */
#include "pieces/shard.h"

#include "common/parse.h"

#include <stdio.h>
#include <stdlib.h>

/* The rank of a process, from 0, and their number. */
typedef struct Ranks {
    const char *rank, *count;
} Ranks;

static const Ranks mpi[] = {{"PMI_RANK", "PMI_SIZE"}, {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}},
                   slurm_tasks = {"SLURM_PROCID", "SLURM_NTASKS"};

static bool is_set(const char *name) {
    const char *text = getenv(name);
    return text != NULL && text[0] != '\0';
}

static bool read_number(const char *name, int64_t least, int64_t most, int *number, Error *error) {
    int64_t value;
    if (!parse_int(getenv(name), least, most, &value))
        return error_input(error, name, "'%s' in the environment is not a number from %lld to %lld; use --shard",
                           getenv(name), (long long)least, (long long)most);
    *number = (int)value;
    return true;
}

static bool read_ranks(ShardRequest *request, const Ranks *ranks, Error *error) {
    int rank = 0, count = 1;
    if (!read_number(ranks->count, 1, SHARDS_MAX, &count, error) ||
        !read_number(ranks->rank, 0, count - 1, &rank, error))
        return false;
    request->shard = (Shard){rank + 1, count};
    if (count > 1)
        snprintf(request->source, sizeof request->source, "%s=%d, %s=%d", ranks->rank, rank, ranks->count, count);
    return true;
}

static bool read_array(ShardRequest *request, Error *error) {
    int first = 1, last = 1, step = 1, id = 0;
    if (!read_number("SLURM_ARRAY_TASK_ID", 0, INT32_MAX, &id, error)) return false;
    first = last = id;
    if ((is_set("SLURM_ARRAY_TASK_MIN") && !read_number("SLURM_ARRAY_TASK_MIN", 0, id, &first, error)) ||
        (is_set("SLURM_ARRAY_TASK_MAX") && !read_number("SLURM_ARRAY_TASK_MAX", id, INT32_MAX, &last, error)) ||
        (is_set("SLURM_ARRAY_TASK_STEP") && !read_number("SLURM_ARRAY_TASK_STEP", 1, INT32_MAX, &step, error)))
        return false;
    const int64_t count = ((int64_t)last - first) / step + 1;
    if (count > SHARDS_MAX)
        return error_input(error, "SLURM_ARRAY_TASK_MAX", "the job array has %lld tasks; at most %d are allowed",
                           (long long)count, SHARDS_MAX);
    /* A list such as 3,17 has no step: the record of the study's first start tells what its ids mean. */
    request->array = (JobArray){first, step, id};
    request->shard = (Shard){(id - first) / step + 1, (int)count};
    snprintf(request->source, sizeof request->source, "SLURM_ARRAY_TASK_ID=%d of %d-%d:%d", id, first, last, step);
    return true;
}

static const Ranks *find_mpi(void) {
    for (size_t i = 0; i < sizeof mpi / sizeof *mpi; i++)
        if (is_set(mpi[i].rank) && is_set(mpi[i].count)) return &mpi[i];
    return NULL;
}

bool shard_request(ShardRequest *request, const char *option, Error *error) {
    const Ranks *ranks = find_mpi();
    *request = (ShardRequest){.shard = {1, 1}};
    if (option != NULL) return shard_parse(&request->shard, option, error);
    if (is_set("SLURM_ARRAY_TASK_ID")) {
        ShardRequest rank = {0};
        if (ranks != NULL && !read_ranks(&rank, ranks, error)) return false;
        if (rank.shard.count > 1)
            return error_input(error, "--shard", "is needed: this is a task of a job array, and one of %d ranks (%s)",
                               rank.shard.count, ranks->rank);
        return read_array(request, error);
    }
    if (ranks != NULL) return read_ranks(request, ranks, error);
    return !is_set(slurm_tasks.rank) || !is_set(slurm_tasks.count) || read_ranks(request, &slurm_tasks, error);
}
